/* Triangle set-up and edge walk.
 *
 * Edges are made of snapped positions and are exact. The planes of 1/z, u/z and v/z are
 * made of the finer positions, q20.12: a silhouette triangle can gain thousands of depth
 * units over one pixel, and there a snap of 1/512 px would already be wrong by several.
 * Where the finer plane could leave the values of the corners too far when it is
 * evaluated a snap's width outside of the finer triangle - slivers - the plane of the
 * snapped corners is taken instead: it is never evaluated outside.
 *
 * Source: K.-L. Low, "Perspective-Correct Interpolation", 2002, equations 12 and 16:
 * 1/z and (attribute)/z are linear on the screen. Plane coefficients: docs/conventions.md.
 */
#include "triangle.h"

#include "edge.h"

static int32_t larger(int32_t a, int32_t b) { return a > b ? a : b; }
static int32_t smaller(int32_t a, int32_t b) { return a < b ? a : b; }

/* ---- planes ---- */

/* Differences from corner 0, and the reciprocal of the doubled area. */
typedef struct basis {
    int32_t dx1, dy1, dx2, dy2;  /* q20.12, |d| <= 2^30                                    */
    int64_t area;                /* dx1 dy2 - dx2 dy1, |area| <= 2^61                      */
    uint32_t reciprocal;         /* 1/|area| = reciprocal 2^(zeros - 94)                   */
    int zeros;
    int32_t to_x, to_y;          /* from corner 0 to the centre of its pixel, q20.12       */
} basis;

/* The numerators of a plane's gradients per 1/4096 px. */
typedef struct numerators {
    int64_t x, y; /* |.| <= 2^62 */
} numerators;

static void basis_init(basis *b, const int32_t x[3], const int32_t y[3], int32_t column, int32_t row)
{
    b->dx1 = x[1] - x[0], b->dy1 = y[1] - y[0];
    b->dx2 = x[2] - x[0], b->dy2 = y[2] - y[0];
    b->area = ew_mul_s32(b->dx1, b->dy2) - ew_mul_s32(b->dx2, b->dy1);
    b->to_x = column * 4096 + 2048 - x[0];
    b->to_y = row * 4096 + 2048 - y[0];
}

static void basis_invert(basis *b)
{
    uint64_t area = ew_abs64(b->area);
    b->zeros = ew_clz64(area);
    b->reciprocal = ew_recip_newton((uint32_t)((area << b->zeros) >> 32));
}

/* d1 and d2 are the quantity's differences from corner 0, |d| < 2^31. */
static numerators gradients(const basis *b, int32_t d1, int32_t d2)
{
    numerators n;
    n.x = ew_mul_s32(d1, b->dy2) - ew_mul_s32(d2, b->dy1);
    n.y = ew_mul_s32(d2, b->dx1) - ew_mul_s32(d1, b->dx2);
    if (b->area < 0) n.x = -n.x, n.y = -n.y;
    return n;
}

/* Whether the plane, evaluated up to a snap's width (half a subpixel each way) outside of
 * its triangle, stays within `limit` of the corners' values. limit <= 2^30. */
static int stays_near(const basis *b, const numerators *n, uint32_t limit)
{
    /* (|nx| + |ny|) snap <= limit area, snap = 2^(11 - S) units of q20.12; both sides are
     * shifted so that the area keeps at most 32 bits, the left side rounded up */
    uint64_t area = ew_abs64(b->area);
    int shift = ew_clz64(area) < 32 ? 32 - ew_clz64(area) : 0;
    uint64_t sum = ew_abs64(n->x) + ew_abs64(n->y);                   /* <= 2^63 */
    uint64_t allowed = ew_mul_u32((uint32_t)(area >> shift), limit);  /* <= 2^62 */
    return (sum >> shift) + 1 <= allowed >> (11 - EW_SUBPIXEL_BITS);
}

/* n / area as a fraction of 2^64 where a unit of n is 2^-32: floor(n 2^32 / area), modulo
 * 2^64. The reciprocal's error, below 2^-29, scales all gradients of the triangle alike:
 * it moves a value by 2^-29 of its distance to corner 0's. */
static uint64_t over_area(int64_t n, const basis *b)
{
    /* n = h 2^32 + l: n r = t 2^32 + low, exact in 96 bits; |h r| <= 2^61. */
    uint64_t low = ew_mul_u32((uint32_t)(uint64_t)n, b->reciprocal);
    int64_t t = (int64_t)(int32_t)EW_ASR(n, 32) * (int64_t)b->reciprocal + (int64_t)(low >> 32);
    int shift = 62 - b->zeros; /* -1 (area 1) to 60 */
    if (shift >= 32) return (uint64_t)EW_ASR(t, shift - 32);
    if (shift > 0) return ((uint64_t)t << (32 - shift)) | ((uint32_t)low >> shift);
    return ((uint64_t)t << 32 | (uint32_t)low) << -shift;
}

/* The plane through a0 at corner 0 with the given gradients. */
static void plane_init(ew_plane *p, const basis *b, uint32_t a0, const numerators *n)
{
    uint64_t gx = over_area(n->x, b), gy = over_area(n->y, b);
    p->row = ((uint64_t)a0 << 32) + ew_wrap_mul64(gx, b->to_x) + ew_wrap_mul64(gy, b->to_y);
    p->dx = gx << 12;
    p->dy = gy << 12;
    p->step = (uint32_t)((p->dx + 0x80000000u) >> 32);
}

static void plane_move(ew_plane *p, int32_t columns, int32_t rows)
{
    p->row += ew_wrap_mul64(p->dx, columns) + ew_wrap_mul64(p->dy, rows);
}

/* ---- the ladder ---- */

static uint32_t largest3(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t m = a > b ? a : b;
    return m > c ? m : c;
}
static uint32_t smallest3(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t m = a < b ? a : b;
    return m < c ? m : c;
}

/* Whether u and v drawn linearly over the whole triangle are displaced by at most the
 * tolerance: max over edges of L |dw| <= 3 t w_min (docs/error-bound.md). */
static int affine_suffices(const ew_raster_vertex *const v[3], uint32_t tolerance, uint32_t w_min)
{
    uint64_t allowed = (uint64_t)w_min * (3u * 256u * tolerance); /* q12: 2^31 2^18 */
    for (int i = 0; i < 3; i++) {
        const ew_raster_vertex *a = v[i], *b = v[i == 2 ? 0 : i + 1];
        uint32_t dx = ew_abs32(a->x - b->x), dy = ew_abs32(a->y - b->y); /* <= 2^30 */
        /* never below the true length, at most 12 % above it */
        uint32_t length = dx > dy ? dx + dy / 2 : dy + dx / 2;
        uint32_t dw = a->w > b->w ? a->w - b->w : b->w - a->w;
        if (ew_mul_u32(length, dw) > allowed) return 0; /* <= 2^31 2^31 */
    }
    return 1;
}

static uint8_t choose_rung(const ew_raster *raster, const ew_raster_vertex *const v[3], uint32_t w_min)
{
    const ew_material *m = &raster->material;
    if (!m->texture || m->rung == EW_RUNG_CONSTANT) return EW_RUNG_CONSTANT;
    if (m->rung != EW_RUNG_AUTO) return m->rung;
    if (affine_suffices(v, m->tolerance, w_min)) return EW_RUNG_AFFINE;
    return m->tolerance > 0 ? EW_RUNG_RUNS : EW_RUNG_EXACT;
}

/* The least run_floor with |dw| 4^k <= 4 t w for every w >= run_floor 4^k: a run of 2^k
 * pixels is displaced by at most 4^k |dw| / (4 w) px (docs/error-bound.md). Runs of one
 * pixel are always allowed. */
static uint32_t run_floor(uint32_t step, uint32_t tolerance)
{
    uint64_t least = (uint64_t)ew_abs32((int32_t)step) * 4u; /* 4 t = tolerance / 4 */
    uint32_t rest, floor;
    if (tolerance == 0 || least >> 32 >= tolerance) return 0xFFFFFFFFu;
    floor = ew_udiv64_32(least, tolerance, &rest);
    return rest ? floor + 1 : floor;
}

/* ---- texture quantities ---- */

/* Differences of u and v from corner 0 take 2^uv_bits units of q20.12, at least 2^UV_LEAST.
 * u/z has UV_BITS bits of that at the corners, with room for as much again outside;
 * divided by 1/z it has two bits fewer, and so has u itself on the affine rung. Then there
 * are UV_MOST + 12 - uv_bits fraction bits: 12 to 20. */
enum { UV_BITS = 29, UV_MOST = UV_BITS - 2, UV_LEAST = 19 };

/* w is taken as a number of 8 bits at least, though at z = 2^23 near it has fewer. */
enum { W_LEAD_MOST = 24 };

/* The table is off by 2^-17 of the distance to corner 0 with 256 entries or more, and by
 * four times as much for each bit less: at most 1/256 texel for differences of TABLE_REACH
 * bits. */
enum { TABLE_REACH = 12 + 9 - (EW_RECIP_BITS < 8 ? 2 * (8 - EW_RECIP_BITS) : 0) };

/* d w / 2^w_bits, |d| < 2^uv_bits, with UV_BITS bits. */
static int32_t times_w(int32_t d, uint32_t w, int uv_bits, int w_bits)
{
    int shift = uv_bits + w_bits - UV_BITS;          /* -2 to 30 */
    int64_t product = (int64_t)d * (int64_t)w;       /* < 2^59    */
    return (int32_t)(shift >= 0 ? EW_ASR(product, shift) : product * ((int64_t)1 << -shift));
}

/* The quantity to interpolate for texture coordinate differences d1, d2 from corner 0,
 * whose own is 0. */
static void uv_differences(int32_t out[2], const ew_triangle *t, const ew_raster_vertex *const v[3],
                           int32_t d1, int32_t d2, int uv_bits)
{
    if (t->rung == EW_RUNG_AFFINE) {
        out[0] = d1 * ((int32_t)1 << (UV_MOST - uv_bits));
        out[1] = d2 * ((int32_t)1 << (UV_MOST - uv_bits));
    } else {
        out[0] = times_w(d1, v[1]->w, uv_bits, 32 - t->w_lead);
        out[1] = times_w(d2, v[2]->w, uv_bits, 32 - t->w_lead);
    }
}

/* ---- set-up ---- */

/* How far a plane's 32-bit steps are off after `columns`, in 2^-16 unit, rounded up: 2^27 at most. */
static uint32_t steps_off(const ew_plane *p, int32_t columns)
{
    uint32_t low = (uint32_t)p->dx;                              /* of 2^32: what rounding dropped or added */
    uint32_t residue = low < 0x80000000u ? low : 0u - low;
    return ((residue >> 16) + 1u) * (uint32_t)columns;
}

/* Whether runs, which step in 32 bits, keep u and v within 1/128 texel: an error of w is
 * worth `reach` of it, one of u/z is worth 2^(uv_bits + w_bits - UV_BITS), both over w. */
static int steps_suffice(const ew_triangle *t, uint32_t reach, int uv_bits, uint32_t w_min, int32_t columns)
{
    uint32_t uv_off = largest3(steps_off(&t->u, columns), steps_off(&t->v, columns), 0);
    int up = uv_bits + 32 - t->w_lead - UV_BITS; /* -2 to 30 */
    uint64_t off = (uint64_t)reach * steps_off(&t->w, columns) + (up > 0 ? (uint64_t)uv_off << up : uv_off);
    return off <= (uint64_t)w_min << (16 + 12 - 7); /* 2^54 + 2^57; 2^52 */
}

static uint8_t plainness(const ew_raster *raster, uint32_t w_min, uint32_t w_max)
{
    if (!raster->target.depth || (raster->material.flags & (EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE)) ||
        raster->log2_width < 1 || raster->log2_height < 1 || raster->log2_width + raster->log2_height > 16) {
        return PLAIN_NEVER;
    }
    /* what lies outside of the corners, and steps' rounding: see w_lead */
    return w_min >= 65536u && w_max <= 0x50000000u ? PLAIN_ALWAYS : PLAIN_SOMETIMES;
}

/* Rungs, planes and shifts for a triangle with snapped area != 0; planes stand on `row`.
 * Returns EW_OK or EW_ERR_RANGE. */
static int setup(ew_triangle *t, const ew_raster *raster, const ew_raster_vertex *const v[3],
                 const ew_snapped sx[3], const ew_snapped sy[3], int positive, int32_t row)
{
    uint32_t w_max = largest3(v[0]->w, v[1]->w, v[2]->w), w_min = smallest3(v[0]->w, v[1]->w, v[2]->w);
    int32_t du1 = v[1]->u - v[0]->u, du2 = v[2]->u - v[0]->u; /* |u| < 2^30 */
    int32_t dv1 = v[1]->v - v[0]->v, dv2 = v[2]->v - v[0]->v;
    uint32_t reach = largest3(ew_abs32(du1), ew_abs32(du2), ew_abs32(dv1));
    reach = largest3(reach, ew_abs32(dv2), 0);
    int uv_bits = 32 - ew_clz32(reach);
    if (uv_bits < UV_LEAST) uv_bits = UV_LEAST;

    t->rung = choose_rung(raster, v, w_min);
    if (t->rung != EW_RUNG_CONSTANT && uv_bits > UV_MOST) return EW_ERR_RANGE;
    t->newton = uv_bits > TABLE_REACH;
    /* Outside of the corners w may exceed the largest by a quarter (stays_near, below), and by
     * the rounding of its steps: 2^11 units, another quarter wherever depth is not clamped. */
    t->w_lead = (uint8_t)smaller(ew_clz32(w_max + w_max / 2), W_LEAD_MOST);
    /* 2^32 is the texture's size: texels are shifted by 32 - log2 of it, 21 at least */
    int u_align = 32 - raster->log2_width, v_align = 32 - raster->log2_height;
    t->u_shift = (uint8_t)(u_align - (UV_MOST + 12 - uv_bits));
    t->v_shift = (uint8_t)(v_align - (UV_MOST + 12 - uv_bits));
    t->u_base = (uint32_t)v[0]->u << (u_align - 12);
    t->v_base = (uint32_t)v[0]->v << (v_align - 12);

    int32_t du[2], dv[2];
    int textured = t->rung != EW_RUNG_CONSTANT;
    if (textured) {
        uv_differences(du, t, v, du1, du2, uv_bits);
        uv_differences(dv, t, v, dv1, dv2, uv_bits);
    }
    int32_t dw1 = (int32_t)(v[1]->w - v[0]->w), dw2 = (int32_t)(v[2]->w - v[0]->w);

    int32_t x[3], y[3];
    for (int i = 0; i < 3; i++) x[i] = v[i]->x, y[i] = v[i]->y;
    int32_t column = EW_ASR(sx[0], EW_SUBPIXEL_BITS), corner_row = EW_ASR(sy[0], EW_SUBPIXEL_BITS);
    basis b;
    numerators nw, nu, nv;
    for (int snapped = 0;; snapped = 1) {
        basis_init(&b, x, y, column, corner_row);
        nw = gradients(&b, dw1, dw2);
        int near_enough = b.area != 0 && (b.area > 0) == positive && stays_near(&b, &nw, w_min / 4);
        if (textured) {
            nu = gradients(&b, du[0], du[1]);
            nv = gradients(&b, dv[0], dv[1]);
            near_enough = near_enough && stays_near(&b, &nu, (uint32_t)1 << UV_BITS) &&
                          stays_near(&b, &nv, (uint32_t)1 << UV_BITS);
        }
        if (near_enough || snapped) break;
        for (int i = 0; i < 3; i++) x[i] = ew_q20_12_from_snapped(sx[i]), y[i] = ew_q20_12_from_snapped(sy[i]);
    }
    basis_invert(&b);
    /* From a corner that may be far away to a column of the picture, exactly; from there
     * spans step in 32 bits. */
    t->column = larger(raster->scissor.x0, smaller(column, raster->scissor.x1));
    plane_init(&t->w, &b, v[0]->w, &nw);
    plane_move(&t->w, t->column - column, row - corner_row);
    if (textured) {
        plane_init(&t->u, &b, 0, &nu);
        plane_init(&t->v, &b, 0, &nv);
        plane_move(&t->u, t->column - column, row - corner_row);
        plane_move(&t->v, t->column - column, row - corner_row);
    }
    /* the columns that steps may go: t->column lies inside the scissor */
    if (t->rung == EW_RUNG_RUNS &&
        !steps_suffice(t, reach, uv_bits, w_min, raster->scissor.x1 - raster->scissor.x0)) {
        t->rung = EW_RUNG_EXACT;
    }
    t->plain = plainness(raster, w_min, w_max);
    t->run_floor = run_floor(t->w.step, raster->material.tolerance);
    return EW_OK;
}

/* ---- walk ---- */

/* Draws rows from `row` to below `end`, cut to the scissor in x. Returns whether a pixel
 * was reached. */
static int walk_rows(const ew_raster *raster, ew_triangle *t, ew_edge *left, ew_edge *right, int32_t row,
                     int32_t end)
{
    int reached = 0;
    const int textured = t->rung != EW_RUNG_CONSTANT;
    const int32_t clip_left = raster->scissor.x0, clip_right = raster->scissor.x1;
    ew_edge l = *left, r = *right; /* or they would be read and written around each span */
    for (; row < end; row++) {
        int32_t x0 = larger(l.x, clip_left), x1 = smaller(r.x, clip_right);
        if (x0 < x1) {
            ew_span(raster, t, x0, row, x1 - x0);
            reached = 1;
        }
        ew_edge_step(&l);
        ew_edge_step(&r);
        t->w.row += t->w.dy;
        if (textured) {
            t->u.row += t->u.dy;
            t->v.row += t->v.dy;
        }
    }
    *left = l;
    *right = r;
    return reached;
}

static int walk(const ew_raster *raster, ew_triangle *t, const ew_snapped sx[3], const ew_snapped sy[3],
                int positive, int32_t first, int32_t end)
{
    /* Order by y; an odd number of exchanges turns the area's sign. */
    int top = 0, middle = 1, bottom = 2, swap;
    int middle_left = !positive;
    if (sy[middle] < sy[top]) swap = top, top = middle, middle = swap, middle_left = !middle_left;
    if (sy[bottom] < sy[middle]) {
        swap = middle, middle = bottom, bottom = swap, middle_left = !middle_left;
        if (sy[middle] < sy[top]) swap = top, top = middle, middle = swap, middle_left = !middle_left;
    }
    ew_edge longest, shorter;
    int reached = 0;
    int32_t turn = larger(first, smaller(ew_row_at(sy[middle]), end));
    if (first < end) ew_edge_start(&longest, sx[top], sy[top], sx[bottom], sy[bottom], first);
    ew_edge *left = middle_left ? &shorter : &longest, *right = middle_left ? &longest : &shorter;
    if (first < turn) {
        ew_edge_start(&shorter, sx[top], sy[top], sx[middle], sy[middle], first);
        reached |= walk_rows(raster, t, left, right, first, turn);
    }
    if (turn < end) {
        ew_edge_start(&shorter, sx[middle], sy[middle], sx[bottom], sy[bottom], turn);
        reached |= walk_rows(raster, t, left, right, turn, end);
    }
    return reached;
}

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

int ew_raster_triangle_in_range(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b,
                                const ew_raster_vertex *c)
{
    EW_ASSERT(in_range(a) && in_range(b) && in_range(c));
    const ew_raster_vertex *const v[3] = { a, b, c };
    ew_snapped sx[3], sy[3];
    for (int i = 0; i < 3; i++) {
        sx[i] = ew_snapped_from_q20_12(v[i]->x);
        sy[i] = ew_snapped_from_q20_12(v[i]->y);
    }
    /* Differences are within 2^26, the area within 2^53. */
    int64_t area = ew_mul_s32(sx[1] - sx[0], sy[2] - sy[0]) - ew_mul_s32(sx[2] - sx[0], sy[1] - sy[0]);
    if (area == 0 || (area > 0 && !(raster->material.flags & EW_DOUBLE_SIDED))) return 0;

    const ew_rect *clip = &raster->scissor;
    int32_t first = larger(ew_row_at(smaller(sy[0], smaller(sy[1], sy[2]))), clip->y0);
    int32_t end = smaller(ew_row_at(larger(sy[0], larger(sy[1], sy[2]))), clip->y1);
    int32_t from = larger(ew_row_at(smaller(sx[0], smaller(sx[1], sx[2]))), clip->x0);
    int32_t to = smaller(ew_row_at(larger(sx[0], larger(sx[1], sx[2]))), clip->x1);
    if (first >= end || from >= to) return 0;

    ew_triangle t;
    int error = setup(&t, raster, v, sx, sy, area > 0, first);
    if (error) return error;
#if EW_TRACE
    ew_trace_triangle(a, b, c, t.rung);
#endif
    return walk(raster, &t, sx, sy, area > 0, first, end);
}
