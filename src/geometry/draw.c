/* Triangles from indices: what cannot be seen is left out before anything is set up. */
#include "project.h"

/* The triangle at hand is that of three vertices on the screen. Without `colours` the corners keep those that they
 * have. */
static EW_OWN_FRAME void take_corners(ew_geometry *geometry, const ew_mesh *mesh, const uint16_t index[3],
                                      const ew_colour888 *colours)
{
    ew_raster_vertex *v = geometry->corner;
    const int32_t uv_unit = (int32_t)1 << (12 - mesh->uv_fraction_bits);
    for (const uint16_t *const end = index + 3; index < end; index++, v++) {
        ew_corner_from(v, &mesh->vertices[*index], &mesh->screen[*index], uv_unit);
        if (colours) v->colour = colours[*index];
    }
}

void ew_geometry_init(ew_geometry *geometry, ew_raster *raster) { geometry->raster = raster; }

static int is_double_sided(const ew_geometry *geometry) { return geometry->raster->material.flags & EW_DOUBLE_SIDED; }

/* What is_away begins its sum with. */
static int64_t least_area(const ew_geometry *geometry)
{
    const ew_transform *const t = &geometry->transform;
    const int32_t h = (int32_t)1 << (11 - EW_SUBPIXEL_BITS);
    if (is_double_sided(geometry)) return INT64_MIN / 2;
    return EW_LONG_MULTIPLY ? ((int64_t)t->across + t->down) * (-2 * h) - 8 * h * h : 0;
}

/* Whether a triangle inside the viewport is surely none that the raster would draw. Where 64 bits cost little, the corners
 * need not be snapped for that: snapping moves a corner by h at most, half a subpixel, and with it the doubled area by h
 * times the sum of the edges' extents in x and y, which is at most twice the viewport's, and by 8 h^2. */
static inline int is_away(const ew_screen_vertex *a, const ew_screen_vertex *b, const ew_screen_vertex *c, int64_t area)
{
#if EW_LONG_MULTIPLY
    area += ew_mul_s32(b->x - a->x, c->y - a->y); /* |d| <= 2^25 */
    area += ew_mul_s32(a->x - c->x, b->y - a->y);
    return area >= 0;
#else
    return area == 0 && !ew_faces_the_eye(a, b, c);
#endif
}

/* Whether a triangle lies beyond one border of the viewport. Apart: few registers are left where it is asked for. */
static EW_OWN_FRAME int is_outside(const ew_screen_vertex *a, const ew_screen_vertex *b, const ew_screen_vertex *c)
{
    return a->outcode & b->outcode & c->outcode & ~EW_OUT_GUARD;
}

/* The triangle at hand. */
static EW_OWN_FRAME int draw_corners(ew_geometry *geometry)
{
    const ew_raster_vertex *const v = geometry->corner;
    return ew_raster_triangle_in_range(geometry->raster, &v[0], &v[1], &v[2]);
}

int32_t ew_draw_triangles(ew_geometry *geometry, const ew_mesh *mesh)
{
    EW_ASSERT(mesh->index_count % 3 == 0 && mesh->uv_fraction_bits <= 12);
    const ew_screen_vertex *const screen = mesh->screen;
    const int64_t least = least_area(geometry);
    const ew_colour888 *const colours = geometry->raster->material.flags & EW_SHADED ? mesh->colours : NULL;
    for (int k = 0; k < 3; k++) geometry->corner[k].colour = ew_white;

    int32_t drawn = 0;
    const uint16_t *index = mesh->indices, *const end = index + mesh->index_count;
    for (; index < end; index += 3) {
        const ew_screen_vertex *a = &screen[index[0]], *b = &screen[index[1]], *c = &screen[index[2]];
        const int any = a->outcode | b->outcode | c->outcode;
        if (any ? is_outside(a, b, c) : is_away(a, b, c, least)) continue;
        const int is_clipped = any & (EW_OUT_NEAR | EW_OUT_GUARD);
        if (is_clipped) {
            geometry->clip_screen[0] = a, geometry->clip_screen[1] = b, geometry->clip_screen[2] = c;
            ew_clip_triangle(geometry, mesh, index);
            if (!ew_clip_next(geometry)) continue;
        } else {
            take_corners(geometry, mesh, index, colours);
        }
        int reached = 0;
        do {
            const int result = draw_corners(geometry);
            if (result < 0) return result;
            reached |= result;
        } while (is_clipped && ew_clip_next(geometry));
        drawn += reached;
    }
    return drawn;
}
