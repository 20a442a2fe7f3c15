/* Clipping of triangles that cross the near plane or leave the guard band.
 *
 * It is done before the division, on the sums of the transform's rows, brought to
 * one unit. It is rare, so it is exact rather than fast: distances are 64-bit integers
 * and the cut's fraction has 64 bits. A cut is always computed from the inner to the outer
 * corner, so that two triangles that share an edge get the same new corner, and a corner
 * that survives keeps the position that its other triangles use: no crack opens.
 */
#include "project.h"

/* One unit for x, y and w: the transform's sums are below 2^47 in units of 2^(e - 45) of
 * their rows. With the exponent below, |x|, |y| < 2^61 and w < 2^44, so that
 * w EW_GUARD_PX < 2^61 and their differences stay inside 62 bits. */
typedef struct clip_unit {
    int32_t down_x, down_y, down_w; /* right shifts, negative to the left */
    int64_t near_w;
} clip_unit;

static int64_t shifted(int64_t a, int32_t down)
{
    if (down > 62) down = 62;
    return down >= 0 ? EW_ASR(a, down) : a * ((int64_t)1 << -down);
}

static EW_OWN_FRAME void choose_unit(clip_unit *unit, const ew_transform *t)
{
    int32_t e = t->w.e + 3;
    if (t->x.e - 14 > e) e = t->x.e - 14;
    if (t->y.e - 14 > e) e = t->y.e - 14;
    unit->down_x = e - t->x.e;
    unit->down_y = e - t->y.e;
    unit->down_w = e - t->w.e;
    unit->near_w = shifted(t->near_w, unit->down_w);
    if (unit->near_w < 1) unit->near_w = 1;
}

/* A little inside of EW_GUARD_PX: a cut corner is off by less than a pixel. */
static const int32_t GUARD = EW_GUARD_PX - 1;

enum { PLANE_NEAR, PLANE_LEFT, PLANE_RIGHT, PLANE_TOP, PLANE_BOTTOM, PLANE_COUNT };

/* Not negative on the inner side of the plane. A corner that has its place on the screen is
 * inside of all of them, whatever the rounding of this unit says: the other triangles that
 * it belongs to draw to that place. */
static EW_OWN_FRAME int64_t distance(const ew_clip_vertex *v, int plane, int64_t near_w)
{
    int64_t d;
    switch (plane) {
    case PLANE_NEAR: d = v->w - near_w; break;
    case PLANE_LEFT: d = v->w * GUARD + v->x; break;
    case PLANE_RIGHT: d = v->w * GUARD - v->x; break;
    case PLANE_TOP: d = v->w * GUARD + v->y; break;
    default: d = v->w * GUARD - v->y; break;
    }
    return d < 0 && v->corner >= 0 ? 0 : d;
}

/* `out` may be one of the two. */
static EW_OWN_FRAME void cut(ew_clip_vertex *out, const ew_clip_vertex *inner, int64_t d_inner,
                const ew_clip_vertex *outer, int64_t d_outer)
{
    uint64_t f = ew_fraction64((uint64_t)d_inner, (uint64_t)d_inner + ew_abs64(d_outer));
    out->x = inner->x + ew_scale64(outer->x - inner->x, f);
    out->y = inner->y + ew_scale64(outer->y - inner->y, f);
    out->w = inner->w + ew_scale64(outer->w - inner->w, f);
    out->u = inner->u + (ew_q20_12)ew_scale64((int64_t)outer->u - inner->u, f);
    out->v = inner->v + (ew_q20_12)ew_scale64((int64_t)outer->v - inner->v, f);
    for (int i = 0; i < 3; i++) { /* a mean of both, to the nearest 2^-8: |product| < 2^48 */
        int64_t change = ((int64_t)outer->colour[i] - inner->colour[i]) * (int64_t)(f >> 32);
        out->colour[i] = (uint16_t)(inner->colour[i] + EW_ASR(change + ((int64_t)1 << 31), 32));
    }
    out->corner = -1;
}

/* Sutherland and Hodgman's step: the polygon of `count` corners at `a`, with room for one more, cut by one plane. What is
 * left stands from EW_CLIP_AHEAD corners before `a` on. Each plane adds one corner at most, and where corners go in a
 * line along the plane, give or take a unit, two: so what is read is not yet written over. */
static EW_OWN_FRAME int clip_by(ew_clip_vertex *a, int count, int plane, int64_t near_w)
{
    ew_clip_vertex *const polygon = a - EW_CLIP_AHEAD, *const end = a + count;
    int made = 0;
    *end = *a;
    for (int64_t da = distance(a, plane, near_w), db; a < end && made < EW_CLIP_MAX; a++, da = db) {
        const ew_clip_vertex *const b = a + 1;
        db = distance(b, plane, near_w);
        const int is_in = da >= 0, crosses = is_in != (db >= 0);
        if (is_in) polygon[made++] = *a;
        if (!crosses || made == EW_CLIP_MAX) continue;
        if (is_in) cut(&polygon[made], a, da, b, db);
        else cut(&polygon[made], b, db, a, da);
        if (plane == PLANE_NEAR) polygon[made].w = near_w;
        made++;
    }
    return made;
}

/* Behind the near plane, so w > 0. */
static EW_OWN_FRAME int leaves_guard(const ew_clip_vertex *polygon, int count)
{
    for (int i = 0; i < count; i++) {
        const ew_clip_vertex *v = &polygon[i];
        const int64_t guard = v->w * GUARD;
        if (v->corner < 0 && (ew_abs64(v->x) > (uint64_t)guard || ew_abs64(v->y) > (uint64_t)guard)) return 1;
    }
    return 0;
}

/* Where x and w differ so much in size that one unit leaves few bits of w, a corner cut at
 * the guard band may come out beyond it. */
static ew_q20_12 within_guard(ew_q20_12 a)
{
    const ew_q20_12 guard = EW_GUARD_PX * 4096;
    return a > guard ? guard : a < -guard ? -guard : a;
}

/* Where the places of a triangle's corners wait until the polygon is known: behind those that come before them there. */
enum { PLACES = EW_CLIP_MAX - 3 };

/* The homogeneous corners of the triangle at hand, in the clipper's unit. */
static EW_OWN_FRAME void polygon_from(ew_clip_vertex polygon[3], ew_raster_vertex corner[EW_CLIP_MAX], const clip_unit *unit,
                                      const ew_transform *t, const ew_mesh *mesh, const uint16_t index[3], unsigned placeless)
{
    for (int i = 0; i < 3; i++) {
        const ew_raster_vertex *v = &corner[i];
        ew_homogeneous_vertex h;
        ew_homogeneous(&h, t, &mesh->vertices[index[i]]);
        polygon[i].x = shifted(h.x, unit->down_x);
        polygon[i].y = shifted(h.y, unit->down_y);
        polygon[i].w = shifted(h.w, unit->down_w);
        polygon[i].u = v->u;
        polygon[i].v = v->v;
        polygon[i].corner = placeless >> i & 1u ? -1 : (int8_t)i;
        polygon[i].colour[0] = (uint16_t)(v->colour.r * 256u);
        polygon[i].colour[1] = (uint16_t)(v->colour.g * 256u);
        polygon[i].colour[2] = (uint16_t)(v->colour.b * 256u);
        ew_raster_vertex *const kept = &corner[PLACES + i];
        kept->x = v->x, kept->y = v->y, kept->w = v->w;
    }
}

/* A corner of the clipped polygon to its place in the fan. What a triangle's corner k left in
 * places[k] is still there: corner 0 is the polygon's first, and behind corner 1 comes 2 or a cut. */
static EW_OWN_FRAME void place(ew_raster_vertex *out, const ew_clip_vertex *p, const ew_raster_vertex *places,
                               const ew_transform *t, int64_t near_w)
{
    if (p->corner >= 0) {
        const ew_raster_vertex *v = &places[p->corner];
        out->x = v->x, out->y = v->y, out->w = v->w;
    } else {
        ew_screen_vertex made;
        ew_homogeneous_vertex h;
        h.x = p->x, h.y = p->y, h.w = p->w;
        ew_project(&made, t, &h, 0, 0, near_w);
        out->x = within_guard(made.x);
        out->y = within_guard(made.y);
        out->w = made.w;
    }
    out->u = p->u;
    out->v = p->v;
    out->colour.r = (uint8_t)((p->colour[0] + 128u) >> 8); /* <= 255 256 + 128 */
    out->colour.g = (uint8_t)((p->colour[1] + 128u) >> 8);
    out->colour.b = (uint8_t)((p->colour[2] + 128u) >> 8);
}

/* Of a triangle EW_CLIP_AHEAD corners further on. Returns how many corners are left. */
static EW_OWN_FRAME int clip(ew_clip_vertex *polygon, int64_t near_w)
{
    ew_clip_vertex *const ahead = polygon + EW_CLIP_AHEAD;
    int count = clip_by(ahead, 3, PLANE_NEAR, near_w);
    for (int plane = PLANE_LEFT; plane < PLANE_COUNT && count >= 3; plane++) {
        if (plane == PLANE_LEFT && !leaves_guard(polygon, count)) break;
        for (int i = count; i-- > 0;) ahead[i] = polygon[i];
        count = clip_by(ahead, count, plane, near_w);
    }
    return count;
}

EW_OWN_FRAME void ew_clip_triangle(ew_geometry *g, const ew_transform *transform, const ew_mesh *mesh,
                                   const uint16_t index[3], unsigned placeless)
{
    ew_clip_vertex *const polygon = g->raster->work.now.polygon;
    ew_raster_vertex *const corner = g->at_hand.corner;
    clip_unit unit;
    choose_unit(&unit, transform);
    polygon_from(polygon + EW_CLIP_AHEAD, corner, &unit, transform, mesh, index, placeless);
    const int count = clip(polygon, unit.near_w);
    for (int i = 0; i < count; i++) place(&corner[i], &polygon[i], &corner[PLACES], transform, unit.near_w);
    g->corner_count = (uint8_t)count;
    g->corner_next = 2;
}

const ew_raster_vertex *ew_clip_next(ew_geometry *g)
{
    return g->corner_next < g->corner_count ? &g->at_hand.corner[g->corner_next++] : NULL;
}
