/* Triangles from indices: what cannot be seen is left out before anything is set up. */
#include "picture.h"
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

/* What is_away begins its sum with. */
static int64_t least_area(const ew_transform *t, int both_sides)
{
    const int32_t h = (int32_t)1 << (11 - EW_SUBPIXEL_BITS);
    if (both_sides) return INT64_MIN / 2;
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

/* The same of one that reaches over the viewport's border. */
static EW_OWN_FRAME int is_hidden(const ew_screen_vertex *a, const ew_screen_vertex *b, const ew_screen_vertex *c, int both_sides)
{
    return ew_is_hidden(a, b, c, both_sides);
}

static EW_OWN_FRAME int draw_clipped(ew_geometry *geometry)
{
    const ew_raster_vertex *const v = geometry->corner;
    int result = 0;
    while (result >= 0 && ew_clip_next(geometry)) {
        const int reached = ew_raster_triangle_in_range(geometry->raster, &v[0], &v[1], &v[2]);
        result = reached < 0 ? reached : result | reached;
    }
    return result;
}

int32_t ew_draw_triangles(ew_geometry *geometry, const ew_mesh *mesh)
{
    EW_ASSERT(mesh->index_count % 3 == 0 && mesh->uv_fraction_bits <= 12);
    const ew_screen_vertex *const screen = mesh->screen;
    const int both_sides = geometry->raster->material.flags & EW_DOUBLE_SIDED;
    const int64_t least = least_area(&geometry->transform, both_sides);
    const ew_colour888 *const colours = geometry->raster->material.flags & EW_SHADED ? mesh->colours : NULL;
    for (int k = 0; k < 3; k++) geometry->corner[k].colour = ew_white;

    ew_raster_vertex *const v = geometry->corner;
    int32_t drawn = 0;
    const uint16_t *index = mesh->indices, *const end = index + mesh->index_count;
    for (; index < end; index += 3) {
        const ew_screen_vertex *a = &screen[index[0]], *b = &screen[index[1]], *c = &screen[index[2]];
        const int any = a->outcode | b->outcode | c->outcode;
        int result;
        if (any ? is_hidden(a, b, c, both_sides) : is_away(a, b, c, least)) continue;
        if (any & (EW_OUT_NEAR | EW_OUT_GUARD)) {
            geometry->clip_screen[0] = a, geometry->clip_screen[1] = b, geometry->clip_screen[2] = c;
            ew_clip_triangle(geometry, mesh, index);
            result = draw_clipped(geometry);
        } else {
            take_corners(geometry, mesh, index, colours);
            result = ew_raster_triangle_in_range(geometry->raster, &v[0], &v[1], &v[2]);
        }
        if (result < 0) return result;
        drawn += result;
    }
    return drawn;
}
