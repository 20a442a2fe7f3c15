/* One triangle: range checks, snapping, culling, its two halves. */
#include "triangle.h"

#include "arch.h"

static int32_t larger(int32_t a, int32_t b) { return a > b ? a : b; }
static int32_t smaller(int32_t a, int32_t b) { return a < b ? a : b; }

static int in_range(const ew_raster_vertex *v)
{
    const uint32_t guard = (uint32_t)EW_GUARD_PX * 4096u; /* 2^29 */
    return ew_abs32(v->x) <= guard && ew_abs32(v->y) <= guard && v->w > 0 && v->w <= 0x80000000u &&
           ew_abs32(v->u) < UINT32_C(1) << 30 && ew_abs32(v->v) < UINT32_C(1) << 30;
}

int ew_raster_triangle(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b,
                       const ew_raster_vertex *c)
{
    if (!in_range(a) || !in_range(b) || !in_range(c)) return EW_ERR_RANGE;
    return ew_raster_triangle_in_range(raster, a, b, c);
}

/* Starts one side's edge on `row`. */
EW_NOINLINE void start_edge(ew_raster *raster, uint8_t side, uint8_t from, uint8_t to, int32_t row)
{
    const ew_corners *c = &raster->work.corners;
    ew_edge_start(&raster->work.edge[side], c->x[from], c->y[from], c->x[to], c->y[to], row);
}

static void order(ew_corners *c)
{
    /* Order by y; an odd number of exchanges turns the area's sign. */
    const ew_snapped *sy = c->y;
    uint8_t top = 0, middle = 1, bottom = 2, swap;
    int middle_left = !c->positive;
    if (sy[middle] < sy[top]) swap = top, top = middle, middle = swap, middle_left = !middle_left;
    if (sy[bottom] < sy[middle]) {
        swap = middle, middle = bottom, bottom = swap, middle_left = !middle_left;
        if (sy[middle] < sy[top]) swap = top, top = middle, middle = swap, middle_left = !middle_left;
    }
    c->top = top, c->middle = middle, c->bottom = bottom;
    c->longest = (uint8_t)middle_left;
    c->turn = larger(c->first, smaller(ew_row_at(sy[middle]), c->end));
}

/* Fills in work.corners. Returns 0 for a triangle that faces away, has no area or covers no
 * pixel centre inside the scissor. */
EW_NOINLINE int place(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c)
{
    ew_corners *corners = &raster->work.corners;
    EW_KEEP_ORDER(corners); /* as in span.c */
    ew_snapped *sx = corners->x, *sy = corners->y;
    corners->v[0] = a, corners->v[1] = b, corners->v[2] = c;
    for (int i = 0; i < 3; i++) {
        sx[i] = ew_snapped_from_q20_12(corners->v[i]->x);
        sy[i] = ew_snapped_from_q20_12(corners->v[i]->y);
    }
    /* Differences are within 2^26, the area within 2^53. */
    int64_t area = ew_mul_s32(sx[1] - sx[0], sy[2] - sy[0]) - ew_mul_s32(sx[2] - sx[0], sy[1] - sy[0]);
    if (area == 0 || (area > 0 && !(raster->material.flags & EW_DOUBLE_SIDED))) return 0;
    corners->positive = area > 0;

    const ew_rect *clip = &raster->scissor;
    corners->first = larger(ew_row_at(smaller(sy[0], smaller(sy[1], sy[2]))), clip->y0);
    corners->end = smaller(ew_row_at(larger(sy[0], larger(sy[1], sy[2]))), clip->y1);
    corners->from = larger(ew_row_at(smaller(sx[0], smaller(sx[1], sx[2]))), clip->x0);
    corners->to = smaller(ew_row_at(larger(sx[0], larger(sx[1], sx[2]))), clip->x1);
    if (corners->first >= corners->end || corners->from >= corners->to) return 0;
    order(corners);
    return 1;
}

int ew_raster_triangle_in_range(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b,
                                const ew_raster_vertex *c)
{
    EW_ASSERT(in_range(a) && in_range(b) && in_range(c));
    if (!place(raster, a, b, c)) return 0;
    int error = ew_setup(raster);
    if (error) return error;
#if EW_TRACE
    ew_trace_triangle(a, b, c, raster->work.triangle.rung);
#endif
    const ew_corners *k = &raster->work.corners;
    EW_KEEP_ORDER(k);
    int reached = 0;
    start_edge(raster, k->longest, k->top, k->bottom, k->first);
    if (k->first < k->turn) {
        start_edge(raster, !k->longest, k->top, k->middle, k->first);
        reached |= ew_walk_rows(raster, k->first, k->turn);
    }
    if (k->turn < k->end) {
        start_edge(raster, !k->longest, k->middle, k->bottom, k->turn);
        reached |= ew_walk_rows(raster, k->turn, k->end);
    }
    return reached;
}
