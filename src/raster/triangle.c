/* One triangle: range checks, snapping, culling, its two halves. */
#include "triangle.h"

#include "arch.h"

static int32_t larger(int32_t a, int32_t b) { return a > b ? a : b; }
static int32_t smaller(int32_t a, int32_t b) { return a < b ? a : b; }

static int in_range(const ew_raster_vertex *v)
{
    const int32_t guard = EW_GUARD_PX * 4096, uv = INT32_C(1) << 30; /* 2^29 */
    return v->x >= -guard && v->x <= guard && v->y >= -guard && v->y <= guard && v->w > 0 && v->w <= 0x80000000u &&
           v->u > -uv && v->u < uv && v->v > -uv && v->v < uv;
}

int ew_raster_triangle(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b,
                       const ew_raster_vertex *c)
{
    if (!in_range(a) || !in_range(b) || !in_range(c)) return EW_ERR_RANGE;
    return ew_raster_triangle_in_range(raster, a, b, c);
}

/* Starts one side's edge on `row`. */
static EW_OWN_FRAME void start_edge(ew_raster *raster, uint8_t side, uint8_t from, uint8_t to, int32_t row)
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
 * pixel centre inside the scissor, whose last row is here the one above `end`. */
static EW_OWN_FRAME int place(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c,
                      int32_t end)
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
    const int32_t top = ew_row_at(smaller(sy[0], smaller(sy[1], sy[2])));
    const int32_t bottom = ew_row_at(larger(sy[0], larger(sy[1], sy[2])));
    const int32_t left = ew_row_at(smaller(sx[0], smaller(sx[1], sx[2])));
    const int32_t right = ew_row_at(larger(sx[0], larger(sx[1], sx[2])));
    corners->x0 = left, corners->y0 = top;
    corners->steps = bottom - top + right - left;
    corners->first = larger(top, clip->y0);
    corners->end = smaller(bottom, end);
    corners->from = larger(left, clip->x0);
    corners->to = smaller(right, clip->x1);
    if (corners->first >= corners->end || corners->from >= corners->to) return 0;
    order(corners);
    return 1;
}

/* Set up in `work`. Returns 1, 0 when there is nothing to draw, or an error. */
static int set_up(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c,
                  int32_t end)
{
    EW_ASSERT(in_range(a) && in_range(b) && in_range(c));
    if (!place(raster, a, b, c, end)) return 0;
    int error = ew_setup(raster);
    if (error) return error;
#if EW_TRACE
    ew_trace_triangle(a, b, c, raster->work.triangle.rung);
#endif
    return 1;
}

/* Rows between two changes of edges of a triangle that needs no fill to be looked for. */
EW_ALWAYS_INLINE int draw_quick(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    if (t->walk == WALK_PACKED) return ew_rows_packed(raster, t, edge, row, end);
#if EW_HAS_SPAN_LOOP
    if (t->walk == WALK_RUNS) return ew_rows_of_runs(raster, t, edge, row, end);
#endif
    return ew_rows_of_texture(raster, t, edge, row, end);
}

/* The same of work.triangle, whatever it needs. */
EW_ALWAYS_INLINE int draw_some(ew_raster *raster, int32_t row, int32_t end)
{
    ew_triangle *t = &raster->work.triangle;
    return t->walk == WALK_ANY ? ew_rows_of_any(raster, row, end) : draw_quick(raster, t, raster->work.edge, row, end);
}

/* Draws the rows of work.triangle above `end`. */
EW_ALWAYS_INLINE int draw_rows(ew_raster *raster, int32_t end)
{
    const ew_corners *k = &raster->work.corners;
    EW_KEEP_ORDER(k);
    const int32_t turn = smaller(k->turn, end);
    int reached = 0;
    raster->work.now.span.has_rows = 0;
    start_edge(raster, k->longest, k->top, k->bottom, k->first);
    if (k->first < turn) {
        start_edge(raster, !k->longest, k->top, k->middle, k->first);
        reached |= draw_some(raster, k->first, turn);
    }
    if (turn < end) {
        start_edge(raster, !k->longest, k->middle, k->bottom, turn);
        reached |= draw_some(raster, turn, end);
    }
    return reached != 0;
}

int ew_raster_triangle_in_range(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b,
                                const ew_raster_vertex *c)
{
    const int result = set_up(raster, a, b, c, raster->scissor.y1);
    return result <= 0 ? result : draw_rows(raster, raster->work.corners.end);
}

/* ---- some rows at a time ---- */

int ew_raster_begin(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c,
                    uint16_t end)
{
    return set_up(raster, a, b, c, end);
}

int ew_raster_draw_begun(ew_raster *raster)
{
    const int32_t first = raster->work.corners.first, end = smaller(raster->work.corners.end, raster->scissor.y1);
    return first < end ? draw_rows(raster, end) : 0;
}

/* What an ew_active keeps of a triangle: the head, as many planes as there are, and behind these,
 * unless it is not theirs, what generic fills need. */
enum { HEAD_BYTES = offsetof(ew_triangle, plane), TAIL_BYTES = sizeof(ew_triangle) - offsetof(ew_triangle, u_origin) };

static size_t plane_bytes(const ew_triangle *t)
{
    return (t->attributes + 1u) * (t->is_wide ? sizeof *t->plane.wide : sizeof *t->plane.narrow);
}

size_t ew_active_bytes(const ew_triangle *t)
{
    const size_t bytes = HEAD_BYTES + plane_bytes(t) + (t->walk == WALK_ANY ? TAIL_BYTES : 0);
    return (offsetof(ew_active, triangle) + bytes + 7u) / 8u * 8u;
}

static void copy_planes(ew_triangle *to, const ew_triangle *from)
{
    if (from->is_wide) {
        for (int i = 0; i <= from->attributes; i++) EW_COPY_WORDS(&to->plane.wide[i], &from->plane.wide[i], sizeof *to->plane.wide);
    } else if (from->attributes == 2) { /* most of them */
        EW_COPY_WORDS(&to->plane.narrow[0], &from->plane.narrow[0], 3 * sizeof *to->plane.narrow);
    } else {
        for (int i = 0; i <= from->attributes; i++) EW_COPY_WORDS(&to->plane.narrow[i], &from->plane.narrow[i], sizeof *to->plane.narrow);
    }
}

static uint16_t quick_until(const ew_active *active, int32_t row)
{
    const int32_t last = active->end - 1;
    if (active->triangle.walk == WALK_ANY) return 0;
    return (uint16_t)(row <= active->turn ? smaller(active->turn, last) : last);
}

void ew_raster_keep(ew_raster *raster, ew_active *active)
{
    const ew_corners *k = &raster->work.corners;
    const ew_triangle *t = &raster->work.triangle;
    const ew_snapped *x = k->x, *y = k->y;
    const int32_t first = k->first;
    const unsigned top = k->top, middle = k->middle, bottom = k->bottom, longest = k->longest;
    active->row = (uint16_t)first;
    active->turn = (uint16_t)k->turn;
    active->end = (uint16_t)k->end;
    active->longest = (uint8_t)longest;
    active->x[0] = x[middle], active->y[0] = y[middle];
    active->x[1] = x[bottom], active->y[1] = y[bottom];
    ew_edge_start(&active->edge[longest], x[top], y[top], x[bottom], y[bottom], first);
    if (first < k->turn) ew_edge_start(&active->edge[!longest], x[top], y[top], x[middle], y[middle], first);
    EW_COPY_WORDS(&active->triangle, t, HEAD_BYTES);
    copy_planes(&active->triangle, t);
    if (t->walk == WALK_ANY) EW_COPY_WORDS((uint8_t *)&active->triangle.plane + plane_bytes(t), &t->u_origin, TAIL_BYTES);
    active->at.quick = first == raster->scissor.y0 ? quick_until(active, first) : 0;
}

/* Generic fills only know work.triangle. Copying has frames of its own: it needs many registers. */
EW_NOINLINE void copy_to_work(ew_raster *raster, const ew_active *active)
{
    ew_triangle *t = &raster->work.triangle;
    const ew_triangle *from = &active->triangle;
    EW_COPY_WORDS(t, from, HEAD_BYTES);
    copy_planes(t, from);
    EW_COPY_WORDS(&t->u_origin, (const uint8_t *)&from->plane + plane_bytes(t), TAIL_BYTES);
}

/* What a row changes. */
EW_NOINLINE void copy_from_work(ew_active *active, const ew_raster *raster)
{
    const ew_triangle *t = &raster->work.triangle;
    ew_triangle *to = &active->triangle;
    for (int i = 0; i <= t->attributes; i++) {
        if (t->is_wide) to->plane.wide[i].row = t->plane.wide[i].row;
        else to->plane.narrow[i].row = t->plane.narrow[i].row;
    }
    for (int i = 0; i < 2; i++) {
        active->edge[i].x = raster->work.edge[i].x;
        active->edge[i].remainder = raster->work.edge[i].remainder;
    }
}

EW_NOINLINE void start_lowest_edge(ew_active *active)
{
    ew_edge_start(&active->edge[!active->longest], active->x[0], active->y[0], active->x[1], active->y[1], active->turn);
}

/* To a row on which edges change, or above. */
EW_ALWAYS_INLINE int draw_part(ew_raster *raster, ew_active *active, int32_t row, int32_t end)
{
    if (active->triangle.walk != WALK_ANY) return draw_quick(raster, &active->triangle, active->edge, row, end);
    copy_to_work(raster, active);
    raster->work.edge[0] = active->edge[0];
    raster->work.edge[1] = active->edge[1];
    const int reached = ew_rows_of_any(raster, row, end);
    copy_from_work(active, raster);
    return reached;
}

int ew_raster_draw_active(ew_raster *raster, ew_active *active)
{
    const int32_t end = smaller(active->end, raster->scissor.y1), turn = active->turn;
    int32_t row = larger(active->row, raster->scissor.y0);
    int reached = 0;
    if (row >= end) return 0;
    raster->work.now.span.has_rows = 0;
    active->row = (uint16_t)end;
    active->at.quick = quick_until(active, end);
    if (row < turn && turn < end) {
        reached = draw_part(raster, active, row, turn);
        row = turn;
    }
    if (row == turn) start_lowest_edge(active);
    return (draw_part(raster, active, row, end) | reached) != 0;
}

void ew_raster_draw_list(ew_raster *raster, ew_active_list *list, uint32_t number)
{
    const int32_t row = raster->scissor.y0, end = raster->scissor.y1;
    const ew_active_list in = *list; /* so that it stays in registers */
    uint16_t *link = in.link;
    if (row >= end) { /* only to where the next triangles go */
        while (*link != EW_NO_PLACE && ew_active_in(&in, *link)->number < number) link = &ew_active_in(&in, *link)->next;
        list->link = link;
        return;
    }
    raster->work.now.span.has_rows = 0;
    while (*link != EW_NO_PLACE) {
        ew_active *active = ew_active_in(&in, *link);
        if (active->number >= number) break;
        if (end <= active->at.quick) {
            draw_quick(raster, &active->triangle, active->edge, row, end);
        } else {
            ew_raster_draw_active(raster, active);
            if (active->row >= active->end) {
                const uint16_t place = *link;
                *link = active->next;
                active->next = list->ended;
                list->ended = place;
                continue;
            }
        }
        link = &active->next;
    }
    list->link = link;
}

/* ---- some columns at a time ---- */

int ew_raster_find_span(const ew_raster *raster, ew_active *active, ew_active_span *span)
{
    const ew_triangle *t = &active->triangle;
    if (active->row != raster->scissor.y0) return 0;
    if (active->row == active->turn) start_lowest_edge(active);
    const int32_t from = larger(active->edge[0].x, raster->scissor.x0), to = smaller(active->edge[1].x, raster->scissor.x1);
    if (from >= to) return 0;
    span->from = (uint16_t)from, span->to = (uint16_t)to;
    span->lead = t->w_lead;
    if (t->is_wide) {
        span->dw = t->plane.wide[EW_PLANE_W].dx;
        span->w = t->plane.wide[EW_PLANE_W].row - ew_wrap_mul64(span->dw, t->column);
    } else {
        const uint32_t dw = t->plane.narrow[EW_PLANE_W].dx;
        span->dw = (uint64_t)dw << 32;
        span->w = (uint64_t)(t->plane.narrow[EW_PLANE_W].row - dw * t->column) << 32;
    }
    return 1;
}

void ew_raster_draw_columns(ew_raster *raster, const ew_active *active, uint16_t from, uint16_t to)
{
    EW_ASSERT(active->triangle.walk == WALK_ANY); /* all others need depth */
    const ew_edge upright = { .remainder = -1, .dy = 1 };
    ew_edge *edge = raster->work.edge;
    copy_to_work(raster, active);
    edge[0] = edge[1] = upright;
    edge[0].x = from, edge[1].x = to;
    ew_rows_of_any(raster, active->row, active->row + 1);
}

void ew_active_step(ew_active *active)
{
    ew_triangle *t = &active->triangle;
    ew_plane32 *narrow = t->plane.narrow;
    ew_plane64 *wide = t->plane.wide;
    if (t->is_wide) {
        for (ew_plane64 *const end = wide + t->attributes; wide <= end; wide++) wide->row += wide->dy;
    } else {
        for (ew_plane32 *const end = narrow + t->attributes; narrow <= end; narrow++) narrow->row += narrow->dy;
    }
    ew_edge_step(&active->edge[0]);
    ew_edge_step(&active->edge[1]);
    active->row++;
}
