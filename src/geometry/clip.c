/* Triangles from indices; clipping of those that cross the near plane or leave the guard
 * band.
 *
 * Clipping is done before the division, on the sums of the transform's rows, brought to
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

static clip_unit choose_unit(const ew_transform *t)
{
    int32_t e = t->w.e + 3;
    if (t->x.e - 14 > e) e = t->x.e - 14;
    if (t->y.e - 14 > e) e = t->y.e - 14;
    clip_unit unit;
    unit.down_x = e - t->x.e;
    unit.down_y = e - t->y.e;
    unit.down_w = e - t->w.e;
    unit.near_w = shifted(t->near_w, unit.down_w);
    if (unit.near_w < 1) unit.near_w = 1;
    return unit;
}

/* A little inside of EW_GUARD_PX: a cut corner is off by less than a pixel. */
static const int32_t GUARD = EW_GUARD_PX - 1;

enum { PLANE_NEAR, PLANE_LEFT, PLANE_RIGHT, PLANE_TOP, PLANE_BOTTOM, PLANE_COUNT };

/* Not negative on the inner side of the plane. A corner that has its place on the screen is
 * inside of all of them, whatever the rounding of this unit says: the other triangles that
 * it belongs to draw to that place. */
static int64_t distance(const ew_clip_vertex *v, int plane, int64_t near_w)
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

static void cut(ew_clip_vertex *out, const ew_clip_vertex *inner, int64_t d_inner,
                const ew_clip_vertex *outer, int64_t d_outer)
{
    uint64_t f = ew_fraction64((uint64_t)d_inner, (uint64_t)d_inner + ew_abs64(d_outer));
    out->x = inner->x + ew_scale64(outer->x - inner->x, f);
    out->y = inner->y + ew_scale64(outer->y - inner->y, f);
    out->w = inner->w + ew_scale64(outer->w - inner->w, f);
    out->u = inner->u + (ew_q20_12)ew_scale64((int64_t)outer->u - inner->u, f);
    out->v = inner->v + (ew_q20_12)ew_scale64((int64_t)outer->v - inner->v, f);
    out->corner = -1;
}

/* Sutherland and Hodgman's step: `in` cut by one plane. Each plane adds one corner at most. */
static int clip_by(ew_clip_vertex *out, const ew_clip_vertex *in, int count, int plane, int64_t near_w)
{
    int made = 0;
    for (int i = 0; i < count; i++) {
        const ew_clip_vertex *a = &in[i], *b = &in[i + 1 == count ? 0 : i + 1];
        int64_t da = distance(a, plane, near_w), db = distance(b, plane, near_w);
        if (da >= 0) out[made++] = *a;
        if ((da >= 0) == (db >= 0)) continue;
        if (da >= 0) cut(&out[made], a, da, b, db);
        else cut(&out[made], b, db, a, da);
        if (plane == PLANE_NEAR) out[made].w = near_w;
        made++;
    }
    return made;
}

static int leaves_guard(const ew_clip_vertex *polygon, int count)
{
    for (int i = 0; i < count; i++) {
        for (int plane = PLANE_LEFT; plane < PLANE_COUNT; plane++) {
            if (distance(&polygon[i], plane, 0) < 0) return 1;
        }
    }
    return 0;
}

static void corner_from(ew_raster_vertex *out, const ew_screen_vertex *screen, ew_q20_12 u, ew_q20_12 v)
{
    out->x = screen->x;
    out->y = screen->y;
    out->w = screen->w;
    out->u = u;
    out->v = v;
}

/* Where x and w differ so much in size that one unit leaves few bits of w, a corner cut at
 * the guard band may come out beyond it. */
static ew_q20_12 within_guard(ew_q20_12 a)
{
    const ew_q20_12 guard = EW_GUARD_PX * 4096;
    return a > guard ? guard : a < -guard ? -guard : a;
}

/* Clips and draws one triangle. Returns 1 or 0 as ew_raster_triangle, or its error. */
static int draw_clipped(ew_geometry *g, const ew_vertex16 *const corner[3],
                        const ew_screen_vertex *const screen[3], int uv_shift)
{
    const ew_transform *t = &g->transform;
    clip_unit unit = choose_unit(t);
    ew_clip_vertex *polygon = g->polygon[0], *other = g->polygon[1];
    for (int i = 0; i < 3; i++) {
        ew_homogeneous_vertex h;
        ew_homogeneous(&h, t, corner[i]);
        polygon[i].x = shifted(h.x, unit.down_x);
        polygon[i].y = shifted(h.y, unit.down_y);
        polygon[i].w = shifted(h.w, unit.down_w);
        polygon[i].u = corner[i]->u * ((int32_t)1 << uv_shift);
        polygon[i].v = corner[i]->v * ((int32_t)1 << uv_shift);
        polygon[i].corner = screen[i]->outcode & (EW_OUT_NEAR | EW_OUT_GUARD) ? -1 : (int8_t)i;
    }
    int count = 3;
    for (int plane = PLANE_NEAR; plane < PLANE_COUNT; plane++) {
        if (plane == PLANE_LEFT && !leaves_guard(polygon, count)) break;
        count = clip_by(other, polygon, count, plane, unit.near_w);
        if (count < 3) return 0;
        ew_clip_vertex *swap = polygon;
        polygon = other;
        other = swap;
    }

    ew_raster_vertex fan[3];
    int drawn = 0;
    for (int i = 0; i < count; i++) {
        const ew_clip_vertex *p = &polygon[i];
        ew_screen_vertex made;
        if (p->corner >= 0) {
            made = *screen[p->corner];
        } else {
            ew_homogeneous_vertex h;
            h.x = p->x, h.y = p->y, h.w = p->w;
            ew_project(&made, t, &h, 0, 0, unit.near_w);
            made.x = within_guard(made.x);
            made.y = within_guard(made.y);
        }
        corner_from(&fan[i < 2 ? i : 2], &made, p->u, p->v);
        if (i < 2) continue;
        int result = ew_raster_triangle_in_range(g->raster, &fan[0], &fan[1], &fan[2]);
        if (result < 0) return result;
        drawn |= result;
        fan[1] = fan[2];
    }
    return drawn;
}

/* Whether the triangle of the snapped corners is a front: its area negative. Most of a
 * closed model is decided here, before anything is set up. */
static int faces_the_eye(const ew_screen_vertex *const v[3])
{
    int32_t x0 = ew_snapped_from_q20_12(v[0]->x), y0 = ew_snapped_from_q20_12(v[0]->y);
    int32_t dx1 = ew_snapped_from_q20_12(v[1]->x) - x0, dy1 = ew_snapped_from_q20_12(v[1]->y) - y0;
    int32_t dx2 = ew_snapped_from_q20_12(v[2]->x) - x0, dy2 = ew_snapped_from_q20_12(v[2]->y) - y0;
    return ew_product_less(dx1, dy2, dx2, dy1); /* |d| <= 2^26 */
}

void ew_geometry_init(ew_geometry *geometry, ew_raster *raster) { geometry->raster = raster; }

int32_t ew_draw_triangles(ew_geometry *geometry, const ew_vertex16 *vertices,
                          const ew_screen_vertex *screen, const uint16_t *indices,
                          uint32_t index_count, uint8_t uv_fraction_bits)
{
    int uv_shift = 12 - uv_fraction_bits; /* |u| 2^12 < 2^28 */
    const int one_sided = !(geometry->raster->material.flags & EW_DOUBLE_SIDED);
    int32_t drawn = 0;
    for (uint32_t i = 0; i + 2 < index_count; i += 3) {
        const ew_vertex16 *corner[3];
        const ew_screen_vertex *on_screen[3];
        uint8_t all = 0xFF, any = 0;
        for (int k = 0; k < 3; k++) {
            corner[k] = &vertices[indices[i + (uint32_t)k]];
            on_screen[k] = &screen[indices[i + (uint32_t)k]];
            all &= on_screen[k]->outcode;
            any |= on_screen[k]->outcode;
        }
        if (all & ~EW_OUT_GUARD) continue; /* wholly beside the viewport or behind the near plane */

        int result;
        if (any & (EW_OUT_NEAR | EW_OUT_GUARD)) {
            result = draw_clipped(geometry, corner, on_screen, uv_shift);
        } else {
            if (one_sided && !faces_the_eye(on_screen)) continue;
            ew_raster_vertex v[3];
            for (int k = 0; k < 3; k++) {
                corner_from(&v[k], on_screen[k], corner[k]->u * ((int32_t)1 << uv_shift),
                            corner[k]->v * ((int32_t)1 << uv_shift));
            }
            result = ew_raster_triangle_in_range(geometry->raster, &v[0], &v[1], &v[2]);
        }
        if (result < 0) return result;
        drawn += result;
    }
    return drawn;
}
