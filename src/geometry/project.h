/* What transform, clip and draw share (private to the geometry layer). */
#ifndef EW_GEOMETRY_PROJECT_H
#define EW_GEOMETRY_PROJECT_H

#include "edgewalk/geometry.h"

/* Sums of a transform's rows, each in units of 2^(e - 45) of its own row: |.| <= 2^47. */
typedef struct ew_homogeneous_vertex {
    int64_t x, y, w;
} ew_homogeneous_vertex;

void ew_homogeneous(ew_homogeneous_vertex *out, const ew_transform *transform, const ew_vertex16 *v);

/* floor((T + 1) / 2) with T = (sum of m times the vertex) 2^-15 + translation. The vertex comes
 * as q1.31. |m| and |translation + 1| add up to less than 2^31, so |T| is below it too. */
static inline int32_t ew_sum32(const ew_row32 *row, int32_t x, int32_t y, int32_t z)
{
    int64_t sum = row->rest;
    sum += ew_mul_s32(row->m[0], x);
    sum += ew_mul_s32(row->m[1], y);
    sum += ew_mul_s32(row->m[2], z);
    return (int32_t)EW_ASR(sum, 32);
}

static inline void ew_row_pieces_init(ew_row_pieces *out, const ew_row32 *row)
{
    for (int i = 0; i < 3; i++) {
        out->high[i] = EW_ASR(row->m[i] + 0x4000, 15); /* |m| < 2^31 - 2^15 */
        out->low[i] = row->m[i] - out->high[i] * 32768;
    }
    out->rest = (int32_t)EW_ASR(row->rest, 31);
}

/* The same bits as ew_sum32, with the vertex as q1.15. */
static inline int32_t ew_sum32_pieces(const ew_row_pieces *row, int32_t x, int32_t y, int32_t z)
{
    int32_t low = row->low[0] * x + row->low[1] * y + row->low[2] * z; /* |.| <= 3 2^29 */
    /* sums on the way may wrap, the whole does not */
    uint32_t sum = (uint32_t)row->rest + (uint32_t)EW_ASR(low, 15) + (uint32_t)(row->high[0] * x) +
                   (uint32_t)(row->high[1] * y) + (uint32_t)(row->high[2] * z);
    return EW_ASR((int32_t)sum, 1);
}

/* Divides by w. x is in units 2^e_x times those of w, y in 2^e_y times; near_w in those of
 * w, 2^16 <= near_w. |x|, |y|, |w| < 2^63. A vertex nearer than near_w gets EW_OUT_NEAR and
 * no position; one outside the guard band gets EW_OUT_GUARD. */
void ew_project(ew_screen_vertex *out, const ew_transform *transform, const ew_homogeneous_vertex *h,
                int32_t e_x, int32_t e_y, int64_t near_w);

/* What a corner of a mesh without colours has. */
static const ew_colour888 ew_white = { 255, 255, 255 };

/* Whether the triangle of the snapped corners is a front: its area negative. Most of a
 * closed model is decided here. */
static inline int ew_faces_the_eye(const ew_screen_vertex *a, const ew_screen_vertex *b, const ew_screen_vertex *c)
{
    int32_t x0 = ew_snapped_from_q20_12(a->x), y0 = ew_snapped_from_q20_12(a->y);
    int32_t dx1 = ew_snapped_from_q20_12(b->x) - x0, dy1 = ew_snapped_from_q20_12(b->y) - y0;
    int32_t dx2 = ew_snapped_from_q20_12(c->x) - x0, dy2 = ew_snapped_from_q20_12(c->y) - y0;
    return ew_product_less(dx1, dy2, dx2, dy1); /* |d| <= 2^26 */
}

/* A corner of a triangle as the raster takes it; uv_unit is 2^(12 - fraction bits). */
static inline void ew_corner_from(ew_raster_vertex *out, const ew_vertex16 *vertex, const ew_screen_vertex *screen,
                                  int32_t uv_unit)
{
    out->x = screen->x;
    out->y = screen->y;
    out->w = screen->w;
    out->u = vertex->u * uv_unit; /* |u| 2^12 <= 2^27 */
    out->v = vertex->v * uv_unit;
}

/* Whether a vertex with this outcode has no place on the screen. */
static inline int ew_is_placeless(int outcode) { return (outcode & (EW_OUT_NEAR | EW_OUT_GUARD)) != 0; }

/* Which of three have none, a bit each. */
static inline unsigned ew_placeless(int a, int b, int c)
{
    return (unsigned)ew_is_placeless(a) | (unsigned)ew_is_placeless(b) << 1 | (unsigned)ew_is_placeless(c) << 2;
}

/* Clips a triangle of a mesh of `transform`: the first three corners at hand, as ew_corner_from leaves them. Bit k of
 * `placeless`: corner k has no place on the screen. What is left is a fan of triangles around corner 0, of
 * g->corner_count corners, with which those at hand are replaced. The raster must not have begun a triangle. */
void ew_clip_triangle(ew_geometry *g, const ew_transform *transform, const ew_mesh *mesh, const uint16_t index[3],
                      unsigned placeless);

/* The third corner of the next triangle of the fan, the second stands before it; or NULL behind the last. With
 * g->corner_next set to 2 it begins anew. */
const ew_raster_vertex *ew_clip_next(ew_geometry *g);

#endif
