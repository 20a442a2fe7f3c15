/* Rows and spans: what is done for each pixel, and how its attributes get there.
 *
 * A span is drawn in runs: pieces over which attributes are linear. The affine rung makes one
 * run of it, the bound (docs/error-bound.md) as few as the tolerance allows, the table and
 * exact rungs one for each pixel. A run is filled by `fill_pixels` in the common case, by
 * ew_loop_fill in some others, by ew_fill_any with every combination of material and target.
 *
 * Spans step in 32 bits. Those of narrow triangles may, whatever they do; those of wide ones
 * are cut where steps would lose too much, and each piece is aligned anew from 64 bits.
 */
#include "arch.h"
#include "fill.h"
#include "loops.h"
#include "run.h"

static int32_t larger(int32_t a, int32_t b) { return a > b ? a : b; }
static int32_t smaller(int32_t a, int32_t b) { return a < b ? a : b; }

static uint32_t top_of(uint64_t a, int up) { return (uint32_t)((a << up) >> 32); }

/* ---- division by w' ---- */

/* 1/w', made ready: a' 2^30 / w'. */
typedef struct divisor {
    uint32_t reciprocal;
    int zeros;
} divisor;

EW_ALWAYS_INLINE divisor divisor_of(uint32_t w, int newton)
{
    divisor d;
    d.zeros = ew_zeros_of(w);
    d.reciprocal = newton ? ew_recip_newton(w << d.zeros) : ew_recip_table_inline(w << d.zeros);
    return d;
}

/* |a'| < w'/4: a' 2^zeros < 2^30, and twice that for the slopes of runs (triangle.h). */
EW_ALWAYS_INLINE uint32_t over_w(uint32_t a, divisor d)
{
    return (uint32_t)ew_mulh_s32((int32_t)(a << d.zeros), (int32_t)d.reciprocal);
}

/* What an attribute grows by from pixel to pixel where it is a and grow a' by da, w' by dw:
 * (da - a dw) / w'. */
EW_ALWAYS_INLINE uint32_t slope(uint32_t a, uint32_t da, uint32_t dw, divisor d)
{
    return over_w(da - (uint32_t)ew_mulh_s32((int32_t)(a << 2), (int32_t)dw), d); /* a dw / 2^30; |a| < 2^29 */
}

/* ---- textured, depth tested and written: the common case ---- */

/* How a run's u and v become one texel number (t->plain says where this will do: depth inside
 * its range, sizes of 2 at least, 2^16 texels at most). u and v share 64 bits: from the top u's
 * texel and fraction, v's texel, v's fraction. One addition steps both, one rotation brings
 * the texel number together; what v's texel carries goes into u's fraction, 256 times 2^-16
 * texel at most. */

void ew_packing_init(ew_packing *k, const ew_raster *raster)
{
    const uint32_t texels = UINT32_C(1) << (raster->log2_width + raster->log2_height); /* 2^16 at most */
    k->texels = raster->texture.texels;
    k->turn = 32u - EW_INDEX_SHIFT - raster->log2_width;
    k->mask = (texels - 1u) << EW_INDEX_SHIFT;
    k->is_256 = raster->log2_width == 8 && raster->log2_height == 8;
    k->low = (UINT32_C(1) << raster->log2_height) - 1u;
    k->log2_width = raster->log2_width;
    k->log2_height = raster->log2_height;
}

/* w' 2^align = w 2^(lead + align - 1) as uq1.31, and its step. */
EW_ALWAYS_INLINE uint32_t depth_of(uint32_t w, int down) { return (w >> down) << 1; }
EW_ALWAYS_INLINE uint32_t depth_step(uint32_t dw, int down) { return (uint32_t)EW_ASR((int32_t)dw, down) << 1; }

EW_ALWAYS_INLINE void pen_at(ew_pen *pen, const ew_raster *raster, int32_t x, int32_t y)
{
    const int32_t offset = (y - raster->target.first_row) * raster->target.stride + x; /* 2^24 at most */
    pen->colour = (uint16_t *)raster->target.colour + offset;
    pen->depth = raster->target.depth + offset;
    pen->x = (uint16_t)x, pen->y = (uint16_t)y;
}

/* u and v at a pixel, or a step of theirs, in one number of 64 bits. */
typedef struct packed {
    uint32_t high, low;
} packed;

/* Top-aligned: 2^32 is the texture's size, so that repeating is the wrapping of 32 bits. */
EW_ALWAYS_INLINE packed pack(const ew_packing *k, const ew_triangle *t, uint32_t u, uint32_t v)
{
    const int log2_height = k->log2_height;
    u = (u << t->u_shift) + t->u_base, v = (v << t->v_shift) + t->v_base;
    return (packed){ (u & ~k->low) | v >> (32 - log2_height), v << log2_height };
}

/* v's step has a sign: extended over u's bits, or the sum would lose a borrow. */
EW_ALWAYS_INLINE packed pack_step(const ew_packing *k, const ew_triangle *t, uint32_t du, uint32_t dv)
{
    const int log2_height = k->log2_height;
    du <<= t->u_shift, dv <<= t->v_shift;
    return (packed){ (du & ~k->low) + (uint32_t)EW_ASR((int32_t)dv, 32 - log2_height), dv << log2_height };
}

EW_ALWAYS_INLINE void packed_add(packed *a, packed b)
{
    a->low += b.low;
    a->high += b.high + (a->low < b.low ? 1u : 0u);
}

#if !EW_HAS_PIXEL_LOOP
/* A pixel of a run, and to the next one. */
EW_ALWAYS_INLINE void fill_pixel(const ew_packing *k, uint16_t *z, uint16_t *c, uint32_t *w,
                                 uint32_t dw, packed *at, packed step)
{
    const uint32_t d = *w >> 15;
    if (d > *z) {
        *z = (uint16_t)d;
        *c = k->texels[(at->high << (32 - (int)k->turn) | at->high >> k->turn) & k->mask];
    }
    *w += dw;
    EW_KEEP_ORDER(*w);
    packed_add(at, step);
    EW_KEEP_ORDER(at->low);
}
#endif

/* n > 0 pixels, n at most EW_LONGEST_RUN, of a run. The pen moves behind the last. */
EW_ALWAYS_INLINE void fill_packed(ew_packing *k, ew_pen *pen, packed at, packed step, int32_t n)
{
    uint16_t *c = pen->colour, *z = pen->depth;
    uint32_t w = pen->w, dw = pen->dw;
    pen->colour = c + n;
    pen->depth = z + n;
#if EW_HAS_PIXEL_LOOP
    pen->w = ew_fill_pixels(k, c, z, n, w, dw, at.high, at.low, step.high, step.low);
#else
    const ew_packing now = *k; /* in registers: pixels are no part of it, which compilers cannot know */
#if !EW_TRACE && !defined(__OPTIMIZE_SIZE__) /* 14 instructions a pixel on x86-64 instead of 19 */
    for (int32_t i = n >> 3; i > 0; i--, z += 8, c += 8) {
        EW_KEEP_ORDER(c);
        EW_KEEP_ORDER(i);
        fill_pixel(&now, z, c, &w, dw, &at, step);
        fill_pixel(&now, z + 1, c + 1, &w, dw, &at, step);
        fill_pixel(&now, z + 2, c + 2, &w, dw, &at, step);
        fill_pixel(&now, z + 3, c + 3, &w, dw, &at, step);
        fill_pixel(&now, z + 4, c + 4, &w, dw, &at, step);
        fill_pixel(&now, z + 5, c + 5, &w, dw, &at, step);
        fill_pixel(&now, z + 6, c + 6, &w, dw, &at, step);
        fill_pixel(&now, z + 7, c + 7, &w, dw, &at, step);
    }
    n &= 7;
#endif
    //@ loop unroll 7;
    for (; n > 0; n--, z++, c++) {
        EW_KEEP_ORDER(c);
        EW_KEEP_ORDER(n);
#if EW_TRACE
        const int log2_height = k->log2_height;
        uint32_t row = at.high << (32 - log2_height) | at.low >> log2_height; /* q20.12, modulo the texture's size */
        ew_trace_fragment(pen->x++, pen->y, (uint16_t)(w >> 15), (ew_q20_12)(at.high >> (20 - k->log2_width)),
                          (ew_q20_12)(row >> (20 - log2_height)));
#endif
        fill_pixel(&now, z, c, &w, dw, &at, step);
    }
    pen->w = w;
#endif
}

/* The same, with u and v at the first pixel and their steps. */
EW_ALWAYS_INLINE void fill_pixels(ew_packing *k, const ew_triangle *t, ew_pen *pen, uint32_t u, uint32_t du,
                                  uint32_t v, uint32_t dv, int32_t n)
{
    fill_packed(k, pen, pack(k, t, u, v), pack_step(k, t, du, dv), n);
}

/* u and v times w', and their steps, become the tangent at pixel n / 2 of a run of n, at its first. */
EW_ALWAYS_INLINE void tangent(const ew_triangle *t, uint32_t w, uint32_t dw, uint32_t *u, uint32_t *du, uint32_t *v,
                              uint32_t *dv, int32_t n)
{
    const uint32_t half = (uint32_t)n >> 1;
    const divisor d = divisor_of(w + dw * half, t->newton);
    *u = over_w(*u + *du * half, d), *v = over_w(*v + *dv * half, d);
    *du = slope(*u, *du, dw, d), *dv = slope(*v, *dv, dw, d);
    *u -= *du * half, *v -= *dv * half;
}

EW_ALWAYS_INLINE void advance(ew_linear *l, uint32_t n)
{
    l->w += l->dw * n;
    l->u += l->du * n;
    l->v += l->dv * n;
}

/* px, and 1/16 px: what lies up to 1 px outside of the first is within the range of numbers. */
enum { LEAST_MOVED = 8, MOST_MOVED_BY = 16 };

static int may_move(const ew_triangle *t) { return t->run_tolerance > 0 && t->run_tolerance <= MOST_MOVED_BY; }

/* d t, for t in 1/16 px. */
static uint32_t in_tolerance(uint32_t d, uint32_t tolerance)
{
    return (uint32_t)EW_ASR((int32_t)d, 4) * tolerance + ((d & 15u) * tolerance >> 4);
}

/* A tangent is off to one side only. Moved by the tolerance to the other side, it may be
 * sqrt 2 as long (docs/error-bound.md). Returns whether that can be done for a piece of n
 * pixels; otherwise *by is 0. */
EW_NOINLINE int move_init(ew_move *by, const ew_triangle *t, const ew_linear *l, int32_t n)
{
    const uint32_t tolerance = t->run_tolerance;
    const uint32_t sign = (int32_t)l->dw < 0 ? UINT32_MAX : 1u;
    const uint32_t fall = in_tolerance(l->dw * sign, tolerance);
    by->w = by->u = by->v = by->shade[0] = by->shade[1] = by->shade[2] = 0;
    if (n < LEAST_MOVED || !may_move(t) || l->w <= fall) return 0;
    by->w = 0u - fall;
    by->u = 0u - in_tolerance(l->du, tolerance) * sign;
    by->v = 0u - in_tolerance(l->dv, tolerance) * sign;
    for (int i = 0; i < t->attributes - 2; i++) by->shade[i] = 0u - in_tolerance(l->dshade[i], tolerance) * sign;
    return 1;
}

EW_ALWAYS_INLINE void move(ew_linear *l, const ew_move *by, uint32_t sign, int attributes)
{
    l->w += by->w * sign;
    l->u += by->u * sign;
    l->v += by->v * sign;
    for (int i = 0; i < attributes - 2; i++) l->shade[i] += by->shade[i] * sign;
}

/* Whether a piece is drawn pixel by pixel whatever its runs would be. */
static int is_per_pixel(const ew_triangle *t) { return t->rung == EW_RUNG_TABLE || t->rung == EW_RUNG_EXACT; }
static int is_affine(const ew_triangle *t) { return t->rung == EW_RUNG_AFFINE || t->rung == EW_RUNG_CONSTANT; }

/* What a piece's runs take, of n pixels; all spans of a triangle that are not cut, nor short, have the same
 * but for those where 1/z is too small to be moved. */
static void make_ready(ew_span_work *span, const ew_triangle *t, int32_t n)
{
    const ew_linear *l = &span->linear;
    const int moved = move_init(&span->by, t, l, n);
    ew_run_limit_init(&span->limit, t, l->dw, l->align, moved);
    span->is_ready = l->align == 0 && (moved || !may_move(t));
    span->first = ew_run_first(&span->limit, l->w);
}

/* The first run of a piece of n pixels; span->linear is moved if that is to be. */
EW_NOINLINE int32_t first_run(ew_span_work *span, const ew_triangle *t, int32_t n)
{
    ew_linear *l = &span->linear;
    span->left = n;
    if (is_per_pixel(t)) {
        span->by.w = span->by.u = span->by.v = span->by.shade[0] = span->by.shade[1] = span->by.shade[2] = 0;
        return 0;
    }
    if (is_affine(t) || ew_one_run_suffices(t, l->w, l->dw, l->align, n)) return n;
    if (!span->is_ready || l->align || n < LEAST_MOVED || l->w <= 0u - span->by.w) make_ready(span, t, n);
    move(l, &span->by, 1, t->attributes);
    span->first = ew_run_near(&span->limit, l->w, span->first);
    return span->first;
}

/* Whether a run of m pixels does not pay. */
static int is_short(const ew_triangle *t, const ew_span_work *span, int32_t m)
{
    return m < span->left && (m < t->shortest || is_per_pixel(t));
}

/* A run of m pixels, then more as long as they pay. Returns the length of the run that would
 * come next. */
EW_NOINLINE int32_t runs_of_texture(ew_packing *k, const ew_triangle *t, ew_span_work *span, int32_t m)
{
    ew_linear *l = &span->linear;
    //@ dynamic_split span->left;
    for (;;) {
        uint32_t u = l->u, du = l->du, v = l->v, dv = l->dv;
        m = smaller(m, span->left);
        //@ split m;
        if (t->rung != EW_RUNG_AFFINE) tangent(t, l->w, l->dw, &u, &du, &v, &dv, m);
        fill_pixels(k, t, &span->fill.textured.pen, u, du, v, dv, m);
        span->left -= m;
        //@ merge m;
        if (span->left == 0) return 0;
        advance(l, (uint32_t)m);
        m = ew_run_after(&span->limit, l->w, m);
        if (m < t->shortest && m < span->left) return m;
    }
}

/* A function of its own: pixels_of_texture needs its registers. */
EW_NOINLINE int32_t next_run(const ew_span_work *span, int32_t n)
{
    return ew_run_near(&span->limit, span->linear.w, n);
}

/* All that are left of the piece, or as many as there may be before the next look whether a run
 * pays. */
static int32_t pixels_at_once(const ew_triangle *t, const ew_span_work *span)
{
    enum { AT_ONCE = 16 };
    return is_per_pixel(t) ? span->left : smaller(span->left, AT_ONCE);
}

/* Each pixel with a reciprocal of its own. Returns as runs_of_texture. */
EW_NOINLINE int32_t pixels_of_texture(ew_packing *k, const ew_triangle *t, ew_span_work *span)
{
    ew_linear *l = &span->linear;
    ew_pen *pen = &span->fill.textured.pen;
    const int32_t n = pixels_at_once(t, span);
    //@ split n;
    span->left -= n;
    move(l, &span->by, UINT32_MAX, 2); /* they are exact where they are */
#if EW_TRACE
    for (int32_t i = 0; i < n; i++, advance(l, 1)) {
        divisor d = divisor_of(l->w, t->newton);
        fill_pixels(k, t, pen, over_w(l->u, d), 0, over_w(l->v, d), 0, 1);
    }
#else
    const uint16_t *texels = k->texels;
    const int log2_width = k->log2_width, u_down = 32 - log2_width, v_down = 32 - k->log2_height;
    uint32_t w = l->w, u = l->u, v = l->v, z = pen->w;
    for (int32_t i = 0; i < n; i++, z += pen->dw, w += l->dw, u += l->du, v += l->dv) {
        uint32_t depth = z >> 15;
        if (depth <= pen->depth[i]) continue;
        divisor d = divisor_of(w, t->newton);
        uint32_t column = ((over_w(u, d) << t->u_shift) + t->u_base) >> u_down;
        uint32_t row = ((over_w(v, d) << t->v_shift) + t->v_base) >> v_down;
        pen->depth[i] = (uint16_t)depth;
        pen->colour[i] = texels[(row << log2_width) + column];
    }
    pen->depth += n, pen->colour += n;
    pen->w = z;
    l->w = w, l->u = u, l->v = v;
#endif
    move(l, &span->by, 1, 2);
    return span->left ? next_run(span, n) : 0;
}

/* What is left of a piece, when a run of m pixels is next. */
EW_HOT static void rest_of_piece(ew_raster *raster, const ew_triangle *t, int32_t m)
{
    ew_packing *k = &raster->work.packing;
    ew_span_work *span = &raster->work.now.span;
    //@ dynamic_split span->left;
    do {
        m = is_short(t, span, m) ? pixels_of_texture(k, t, span) : runs_of_texture(k, t, span, m);
    } while (span->left > 0);
}

/* A piece of a span, of at most EW_LONGEST_PIECE pixels. */
EW_NOINLINE void piece_of_texture(ew_raster *raster, const ew_triangle *t, int32_t n)
{
    rest_of_piece(raster, t, first_run(&raster->work.now.span, t, n));
}

/* ---- everything else ---- */

/* A tangent may leave a shade's range: ew_fill_any clamps. */
static void shade_run(ew_run *run, const ew_triangle *t, const ew_attribute_run *from)
{
    for (int i = 0; i < 3; i++) {
        run->shade[i] = (int32_t)ew_light_at(t, from, i);
        run->dshade[i] = (int32_t)ew_light_step(from, i);
    }
}

static uint64_t texels_of(const ew_triangle *t, uint32_t a)
{
    return (uint64_t)(int64_t)(int32_t)a << (32 - EW_FRACTION(t->uv_bits));
}

/* work.run of n pixels out of work.attributes; the position moves behind it. */
EW_NOINLINE void make_run(ew_raster *raster, int32_t n)
{
    const ew_triangle *t = &raster->work.triangle;
    const ew_attribute_run *from = &raster->work.now.span.fill.any.attributes;
    ew_position *at = &raster->work.now.span.fill.any.position;
    ew_run *run = &raster->work.now.span.fill.any.run;
    run->x = at->x, run->y = at->y;
    run->w = at->w, run->dw = at->dw;
    run->u = ((uint64_t)(int64_t)t->u_origin << 20) + texels_of(t, from->u);
    run->v = ((uint64_t)(int64_t)t->v_origin << 20) + texels_of(t, from->v);
    run->du = texels_of(t, from->du), run->dv = texels_of(t, from->dv);
    run->u_down = texels_of(t, from->u_down), run->v_down = texels_of(t, from->v_down);
    if (EW_WITH_SHADING && raster->material.flags & EW_SHADED) shade_run(run, t, from);
    at->x = (uint16_t)(at->x + n);
    at->w += at->dw * (uint32_t)n;
}

/* A plane's growth to the next row, as `linear` has that to the next pixel. */
static uint32_t down_of(const ew_triangle *t, int plane, int align)
{
    return t->is_wide ? top_of(t->plane.wide[plane].dy, align) : t->plane.narrow[plane].dy;
}

/* A slope where it may be any: held to 2^29 units, four times the triangle's whole range. */
static uint32_t steep_slope(uint32_t a, uint32_t da, uint32_t dw, divisor d)
{
    int32_t most = 0x3FFFFFFF >> d.zeros, turned = (int32_t)(da - (uint32_t)ew_mulh_s32((int32_t)(a << 2), (int32_t)dw));
    return over_w((uint32_t)larger(-most, smaller(turned, most)), d);
}

/* Slopes across and down of mip chains at a pixel: their level depends on all four. */
static void mip_slopes(ew_attribute_run *run, const ew_triangle *t, const ew_linear *l, uint32_t u, uint32_t v, divisor d)
{
    uint32_t dw = down_of(t, EW_PLANE_W, l->align);
    run->du = steep_slope(u, l->du, l->dw, d);
    run->dv = steep_slope(v, l->dv, l->dw, d);
    run->u_down = steep_slope(u, down_of(t, EW_PLANE_U, l->align), dw, d);
    run->v_down = steep_slope(v, down_of(t, EW_PLANE_V, l->align), dw, d);
}

/* A run as the tangent at its pixel `half`. */
static void run_of_any(ew_attribute_run *run, const ew_raster *raster, const ew_triangle *t, const ew_linear *l, uint32_t half)
{
    divisor d = divisor_of(l->w + l->dw * half, t->newton);
    uint32_t u = over_w(l->u + l->du * half, d), v = over_w(l->v + l->dv * half, d);
    run->u_down = run->v_down = 0;
    run->du = half ? slope(u, l->du, l->dw, d) : 0;
    run->dv = half ? slope(v, l->dv, l->dw, d) : 0;
    if (EW_WITH_MIPS && raster->texture.levels > 1) mip_slopes(run, t, l, u, v, d);
    run->u = u - run->du * half;
    run->v = v - run->dv * half;
    for (int i = 0; i < t->attributes - 2; i++) {
        uint32_t s = over_w(l->shade[i] + l->dshade[i] * half, d);
        run->dshade[i] = half ? slope(s, l->dshade[i], l->dw, d) : 0;
        run->shade[i] = s - run->dshade[i] * half;
    }
}

/* Attributes that need no division. */
static void run_of_affine(ew_attribute_run *run, const ew_triangle *t, const ew_linear *l)
{
    run->u = l->u, run->du = l->du, run->v = l->v, run->dv = l->dv;
    run->u_down = t->attributes ? down_of(t, EW_PLANE_U, 0) : 0;
    run->v_down = t->attributes ? down_of(t, EW_PLANE_V, 0) : 0;
    for (int i = 0; i < 3; i++) {
        run->shade[i] = t->attributes > 2 ? l->shade[i] : 0;
        run->dshade[i] = t->attributes > 2 ? l->dshade[i] : 0;
    }
}

/* work.attributes of a run of n pixels, behind which work.linear moves. */
EW_NOINLINE void next_of_any(ew_raster *raster, int32_t n)
{
    const ew_triangle *t = &raster->work.triangle;
    ew_linear *l = &raster->work.now.span.linear;
    ew_attribute_run *run = &raster->work.now.span.fill.any.attributes;
    EW_KEEP_ORDER(t);
    EW_KEEP_ORDER(l);
    EW_KEEP_ORDER(run);
    if (is_affine(t)) {
        run_of_affine(run, t, l);
        return;
    }
    run_of_any(run, raster, t, l, (uint32_t)n >> 1);
    advance(l, (uint32_t)n);
    for (int i = 0; i < t->attributes - 2; i++) l->shade[i] += l->dshade[i] * (uint32_t)n;
}

static void fill_next(ew_raster *raster, int32_t n)
{
    next_of_any(raster, n);
    if (ew_loop_fill(raster, n)) return;
    make_run(raster, n);
    ew_fill_any(raster, &raster->work.now.span.fill.any.run, n);
}

/* The same runs and pixels as piece_of_texture has. */
static void piece_of_any(ew_raster *raster, int32_t n)
{
    const ew_triangle *t = &raster->work.triangle;
    ew_span_work *span = &raster->work.now.span;
    int32_t m = first_run(span, t, n);
    //@ dynamic_split span->left;
    for (;;) {
        if (is_short(t, span, m)) {
            m = pixels_at_once(t, span);
            //@ split m;
            move(&span->linear, &span->by, UINT32_MAX, t->attributes);
            //@ loop unroll 20;
            for (int32_t i = 0; i < m; i++) fill_next(raster, 1);
            move(&span->linear, &span->by, 1, t->attributes);
        } else {
            m = smaller(m, span->left);
            //@ split m;
            fill_next(raster, m);
        }
        span->left -= m;
        //@ merge m;
        if (span->left == 0) return;
        m = ew_run_near(&span->limit, span->linear.w, m);
    }
}

/* ---- spans ---- */

/* 1/z is linear: the first pixel's and the last's say whether any in between leaves depth's
 * range. */
EW_ALWAYS_INLINE int stays_in_range(uint32_t w, uint32_t dw, int32_t n)
{
    uint32_t last = w + dw * (uint32_t)(n - 1);
    return w >= 32768u && w <= INT32_MAX && last >= 32768u && last <= INT32_MAX;
}

EW_ALWAYS_INLINE int is_plain(const ew_triangle *t, uint32_t w, uint32_t dw, int32_t n)
{
    return t->plain != PLAIN_SOMETIMES ? t->plain : stays_in_range(w, dw, n);
}

/* Makes ready for a piece of a span, of n <= EW_LONGEST_PIECE pixels from (x, y) on, that
 * work.linear describes. Returns whether piece_of_texture may draw it. */
EW_NOINLINE int start_piece(ew_raster *raster, int32_t x, int32_t y, int32_t n)
{
    const ew_triangle *t = &raster->work.triangle;
    const ew_linear *l = &raster->work.now.span.linear;
    EW_KEEP_ORDER(t);
    const int down = (int)smaller(t->w_lead + l->align, 31);
    const uint32_t w = depth_of(l->w, down), dw = depth_step(l->dw, down);
    if (is_plain(t, w, dw, n)) {
        ew_pen *pen = &raster->work.now.span.fill.textured.pen;
        pen->w = w, pen->dw = dw;
        pen_at(pen, raster, x, y);
        return 1;
    }
    ew_position *at = &raster->work.now.span.fill.any.position;
    at->x = (uint16_t)x, at->y = (uint16_t)y;
    at->w = w, at->dw = dw;
    if (EW_HAS_LOOPS) {
        at->loop = raster->loop > LOOP_TEXTURED && stays_in_range(w, dw, n) ? raster->loop : LOOP_NONE;
        if (at->loop) ew_loop_start(raster, (uint32_t)y);
    }
    return 0;
}

/* Of x, from where planes stand: below 4096. */
EW_ALWAYS_INLINE uint32_t columns_of(const ew_triangle *t, int32_t x)
{
    EW_ASSERT(x >= t->column && x - t->column < 4096);
    return (uint32_t)(x - t->column);
}

/* A span from x on. */
EW_NOINLINE void start_narrow(ew_linear *l, const ew_triangle *t, int32_t x)
{
    const ew_plane32 *p = &t->plane.narrow[EW_PLANE_SHADE];
    const uint32_t columns = (uint32_t)(x - t->column);
    EW_KEEP_ORDER(t);
    EW_KEEP_ORDER(l);
    l->align = 0;
    l->dw = t->plane.narrow[EW_PLANE_W].dx;
    l->du = t->plane.narrow[EW_PLANE_U].dx;
    l->dv = t->plane.narrow[EW_PLANE_V].dx;
    l->w = t->plane.narrow[EW_PLANE_W].row + l->dw * columns;
    l->u = t->plane.narrow[EW_PLANE_U].row + l->du * columns;
    l->v = t->plane.narrow[EW_PLANE_V].row + l->dv * columns;
    if (t->attributes == 0) l->u = l->du = l->v = l->dv = 0;
    for (int i = 0; i < t->attributes - 2; i++) {
        l->shade[i] = p[i].row + p[i].dx * columns;
        l->dshade[i] = p[i].dx;
    }
}

/* w' at two ends, aligned to the left as far as both allow; w' of a sliver's plane may come
 * out at or below 0. */
static int alignment(uint64_t w, uint64_t end, uint32_t *least)
{
    int64_t a = (int64_t)w, b = (int64_t)end, top = a > b ? a : b, bottom = a > b ? b : a;
    int up = top > 0 ? ew_clz64((uint64_t)top << 1) : 0; /* top << up has no sign */
    *least = bottom > 0 ? (uint32_t)(((uint64_t)bottom << up) >> 32) : 0;
    return up;
}

/* Up to how many pixels a piece of a span with attributes may have; on the affine rung it is one run. */
EW_ALWAYS_INLINE int32_t longest_piece(const ew_triangle *t)
{
    return t->rung == EW_RUNG_AFFINE ? EW_LONGEST_RUN : EW_LONGEST_PIECE;
}

/* Whether 32-bit steps keep attributes within 1/256 texel over n pixels: n 2^bits <= 2 w' at
 * both ends; affine, where w' does not matter: n 2^bits <= 2^32, 1/128 texel (docs/error-bound.md). */
EW_ALWAYS_INLINE int steps_suffice(const ew_triangle *t, uint32_t w, uint32_t last, int32_t n)
{
    const int32_t least = smaller((int32_t)w, (int32_t)last); /* rounding may take it below 0 */
    const int32_t most = t->rung == EW_RUNG_AFFINE ? (int32_t)1 << (32 - EW_BITS_LEAST) : EW_ASR(least, EW_BITS_LEAST - 1);
    return n <= longest_piece(t) && n * ((int32_t)1 << (t->uv_bits - EW_BITS_LEAST)) <= most; /* 2^9 2^8 */
}

/* The same for wide triangles, unaligned. */
EW_NOINLINE void wide_start(ew_linear *l, const ew_triangle *t, int32_t x)
{
    const ew_plane64 *p = t->plane.wide;
    const uint32_t columns = columns_of(t, x);
    l->align = 0;
    l->dw = top_of(p[EW_PLANE_W].dx, 0), l->du = top_of(p[EW_PLANE_U].dx, 0), l->dv = top_of(p[EW_PLANE_V].dx, 0);
    l->w = top_of(p[EW_PLANE_W].row + ew_wrap_mul64_u16(p[EW_PLANE_W].dx, columns), 0);
    l->u = top_of(p[EW_PLANE_U].row + ew_wrap_mul64_u16(p[EW_PLANE_U].dx, columns), 0);
    l->v = top_of(p[EW_PLANE_V].row + ew_wrap_mul64_u16(p[EW_PLANE_V].dx, columns), 0);
}

/* The longest piece, from the first pixel on, for which steps of 32 bits will do. */
static int32_t piece_length(const ew_triangle *t, uint64_t w, int32_t n, int *align)
{
    uint32_t least = 0;
    *align = 0;
    if (t->attributes == 0) return smaller(n, EW_LONGEST_RUN);
    n = smaller(n, longest_piece(t));
    for (;; n = (n + 1) >> 1) {
        if (t->rung != EW_RUNG_AFFINE) *align = alignment(w, w + ew_wrap_mul64_u16(t->plane.wide[EW_PLANE_W].dx, (uint32_t)n - 1u), &least);
        if (n == 1 || steps_suffice(t, least, least, n)) return n;
    }
}

EW_ALWAYS_INLINE uint32_t wide_at(const ew_plane64 *p, uint32_t columns, int align)
{
    return top_of(p->row + ew_wrap_mul64_u16(p->dx, columns), align);
}

/* work.linear from x on, for as many of n pixels as it will do. Returns their number. */
EW_NOINLINE int32_t next_of_wide(ew_raster *raster, const ew_triangle *t, int32_t x, int32_t n)
{
    const ew_plane64 *p = t->plane.wide;
    ew_linear *l = &raster->work.now.span.linear;
    EW_KEEP_ORDER(l);
    const uint32_t columns = columns_of(t, x);
    const uint64_t w = p[EW_PLANE_W].row + ew_wrap_mul64_u16(p[EW_PLANE_W].dx, columns);
    n = piece_length(t, w, n, &l->align);
    l->w = (int64_t)w > 0 ? top_of(w, l->align) : 1; /* then n is 1 */
    l->dw = top_of(p[EW_PLANE_W].dx, l->align);
    l->u = l->du = l->v = l->dv = 0;
    if (t->attributes) {
        l->u = wide_at(&p[EW_PLANE_U], columns, l->align), l->du = top_of(p[EW_PLANE_U].dx, l->align);
        l->v = wide_at(&p[EW_PLANE_V], columns, l->align), l->dv = top_of(p[EW_PLANE_V].dx, l->align);
    }
    p += EW_PLANE_SHADE;
    for (int i = 0; i < t->attributes - 2; i++, p++) {
        l->shade[i] = wide_at(p, columns, l->align), l->dshade[i] = top_of(p->dx, l->align);
    }
    return n;
}

/* ---- rows ---- */

#if EW_HAS_SPAN_LOOP
static void wide_step_back(ew_plane64 p[])
{
    for (int i = 0; i <= 2; i++) p[i].row -= p[i].dy;
}
#endif

/* To the next row; shades are rare. */
EW_ALWAYS_INLINE void planes_step(ew_triangle *t, int wide, int attributes)
{
    ew_plane32 *p = t->plane.narrow;
    ew_plane64 *q = t->plane.wide;
    if (wide) {
        for (int i = 0; i <= attributes; i++) q[i].row += q[i].dy;
        return;
    }
    p[EW_PLANE_W].row += p[EW_PLANE_W].dy;
    p[EW_PLANE_U].row += p[EW_PLANE_U].dy; /* no harm where there are none */
    p[EW_PLANE_V].row += p[EW_PLANE_V].dy;
    for (int i = EW_PLANE_SHADE; i <= attributes; i++) p[i].row += p[i].dy;
}

/* A span that may have to be cut, or whose runs may have to be found. */
EW_NOINLINE void span_of_texture(ew_raster *raster, const ew_triangle *t, int32_t x, int32_t y, int32_t n)
{
    ew_linear *l = &raster->work.now.span.linear;
    ew_pen *pen = &raster->work.now.span.fill.textured.pen;
    EW_KEEP_ORDER(l);
    pen_at(pen, raster, x, y);
    //@ dynamic_split n;
    while (n > 0) {
        int32_t m = n;
        if (!t->is_wide) {
            start_narrow(l, t, x);
        } else {
            wide_start(l, t, x);
            if (!steps_suffice(t, l->w, l->w + l->dw * (uint32_t)(n - 1), n)) m = next_of_wide(raster, t, x, n);
        }
        const int down = (int)smaller(t->w_lead + l->align, 31);
        //@ split m;
        pen->w = depth_of(l->w, down), pen->dw = depth_step(l->dw, down);
        piece_of_texture(raster, t, m);
        x += m;
        n -= m;
        //@ merge m;
    }
}

/* A span that is one run, surely. */
EW_ALWAYS_INLINE void run_of_texture(ew_raster *raster, const ew_triangle *t, int32_t x, int32_t y, int32_t n)
{
    uint32_t w, dw, u, du, v, dv;
    ew_pen pen; /* in registers */
    if (t->is_wide) {
        ew_linear *l = &raster->work.now.span.linear;
        EW_KEEP_ORDER(l);
        wide_start(l, t, x);
        w = l->w, dw = l->dw, u = l->u, du = l->du, v = l->v, dv = l->dv;
    } else {
        const ew_plane32 *p = t->plane.narrow;
        const uint32_t columns = (uint32_t)(x - t->column);
        dw = p[EW_PLANE_W].dx, du = p[EW_PLANE_U].dx, dv = p[EW_PLANE_V].dx;
        w = p[EW_PLANE_W].row + dw * columns;
        u = p[EW_PLANE_U].row + du * columns;
        v = p[EW_PLANE_V].row + dv * columns;
    }
    pen_at(&pen, raster, x, y);
    pen.w = depth_of(w, t->w_lead), pen.dw = depth_step(dw, t->w_lead);
    if (t->rung != EW_RUNG_AFFINE) tangent(t, w, dw, &u, &du, &v, &dv, n);
    fill_pixels(&raster->work.packing, t, &pen, u, du, v, dv, n);
}

EW_HOT int ew_rows_of_texture(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    int reached = 0;
    EW_ASSERT(row < end);
    raster->work.now.span.is_ready = 0;
    for (; row < end; row++) {
        const int32_t x = larger(edge[0].x, raster->scissor.x0), n = smaller(edge[1].x, raster->scissor.x1) - x;
        if (n > 0) {
            /* the same either way, but slower; with machine code for runs the other rungs are too few to pay for both */
            if (!EW_HAS_SPAN_LOOP && n <= t->sure_run) run_of_texture(raster, t, x, row, n);
            else span_of_texture(raster, t, x, row, n);
            reached = 1;
        }
        planes_step(t, t->is_wide, 2);
        ew_edges_step(edge);
    }
    return reached;
}

#if EW_HAS_ROW_LOOP
/* Makes ready for the machine code of arch.h, which then draws from `row` to below `end`. */
EW_ALWAYS_INLINE ew_rows *rows_init(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    ew_rows *rows = &raster->work.now.span.fill.textured.rows;
    EW_ASSERT(row < end);
    EW_KEEP_ORDER(rows);
    if (!raster->work.now.span.has_rows) {
        const ew_packing *k = &raster->work.packing;
        const ew_target *target = &raster->target;
        rows->texels = k->texels;
        rows->turn = k->turn, rows->mask = k->mask;
        rows->x0 = raster->scissor.x0, rows->x1 = raster->scissor.x1;
        rows->stride = target->stride * 2u;
        rows->apart = (uint32_t)((uintptr_t)target->colour - (uintptr_t)target->depth) - EW_APART_LESS;
        rows->origin = (uintptr_t)target->depth - target->first_row * rows->stride; /* modulo 2^32 */
        if (EW_HAS_SPAN_LOOP) {
            rows->recip = ew_recip_entries;
            rows->low = k->low, rows->log2_height = k->log2_height;
            rows->is_256 = k->is_256;
        }
        raster->work.now.span.has_rows = 1;
    }
    rows->edge = edge;
    rows->planes = t->plane.narrow; /* or wide: a union */
    rows->depth = (uint16_t *)(rows->origin + (uint32_t)row * rows->stride);
    rows->left = rows->reached = end - row;
    return rows;
}
#endif

#if EW_HAS_SPAN_LOOP
/* The span that machine code left for the m that it returned. Returns how many rows are left. */
EW_NOINLINE int32_t span_left(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t end, int32_t m)
{
    ew_span_work *span = &raster->work.now.span;
    ew_rows *rows = &span->fill.textured.rows;
    if (m == EW_SPAN_CUT) {
        const int32_t x = larger(edge[0].x, raster->scissor.x0), n = smaller(edge[1].x, raster->scissor.x1) - x;
        wide_step_back(t->plane.wide); /* only wide triangles' spans are cut */
        span_of_texture(raster, t, x, end - rows->left, n);
        planes_step(t, 1, 2);
    } else {
        ew_pen *pen = &span->fill.textured.pen;
        pen->depth = rows->first;
        if (m == EW_SPAN_FIRST) {
            span->linear.align = 0;
            m = first_run(span, t, rows->pixels);
        } else {
            pen->depth += rows->drawn;
            span->left = rows->pixels - (int32_t)rows->drawn;
            advance(&span->linear, rows->drawn);
        }
        pen->colour = (uint16_t *)(void *)((uint8_t *)pen->depth + rows->apart + EW_APART_LESS);
        rest_of_piece(raster, t, m);
    }
    ew_edges_step(edge);
    return --rows->left;
}

EW_HOT int ew_rows_of_runs(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    ew_rows *rows = rows_init(raster, t, edge, row, end);
    int32_t m;
    raster->work.now.span.is_ready = 0;
    while ((m = ew_walk_spans(rows)) != EW_ROWS_DONE && span_left(raster, t, edge, end, m)) continue;
    return rows->reached;
}
#endif

/* ---- rows of packed planes ---- */

/* Planes of u and v become one of both packed: steps lose as much, in all of a triangle's rows and columns, as
 * in one long run (docs/error-bound.md). 1/z cannot become depth: outside of the triangle, where planes begin,
 * it may be of any size, and shifted to the right it would not come back. */
void ew_planes_pack(ew_triangle *t, const ew_packing *k)
{
    ew_plane32 *high = &t->plane.narrow[EW_PLANE_U], *low = &t->plane.narrow[EW_PLANE_V];
    const packed row = pack(k, t, high->row, low->row), dx = pack_step(k, t, high->dx, low->dx);
    const packed dy = pack_step(k, t, high->dy, low->dy);
    high->row = row.high, high->dx = dx.high, high->dy = dy.high;
    low->row = row.low, low->dx = dx.low, low->dy = dy.low;
}

EW_ALWAYS_INLINE packed packed_row(const ew_plane32 p[])
{
    return (packed){ p[EW_PLANE_U].row, p[EW_PLANE_V].row };
}
EW_ALWAYS_INLINE packed packed_dx(const ew_plane32 p[]) { return (packed){ p[EW_PLANE_U].dx, p[EW_PLANE_V].dx }; }
EW_ALWAYS_INLINE packed packed_dy(const ew_plane32 p[]) { return (packed){ p[EW_PLANE_U].dy, p[EW_PLANE_V].dy }; }

/* n steps behind a; n < 2^16. */
EW_ALWAYS_INLINE packed packed_after(packed a, packed step, uint32_t n)
{
    const uint64_t low = ew_mul_u32_u16(step.low, n);
    packed_add(&a, (packed){ step.high * n + (uint32_t)(low >> 32), (uint32_t)low });
    return a;
}

void ew_planes_go(ew_triangle *t, uint32_t columns, uint32_t rows)
{
    ew_plane32 *p = t->plane.narrow;
    ew_plane64 *q = t->plane.wide;
    const int packed_ones = t->walk == WALK_PACKED ? 2 : 0;
    if (packed_ones) { /* of 256 rows and columns at most */
        const packed at = packed_after(packed_after(packed_row(p), packed_dx(p), columns), packed_dy(p), rows);
        p[EW_PLANE_U].row = at.high, p[EW_PLANE_V].row = at.low;
    }
    for (int i = 0; i <= t->attributes - packed_ones; i++) {
        if (t->is_wide) q[i].row += q[i].dx * columns + q[i].dy * rows;
        else p[i].row += p[i].dx * columns + p[i].dy * rows;
    }
}

#if EW_HAS_ROW_LOOP
EW_HOT int ew_rows_packed(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    ew_rows *rows = rows_init(raster, t, edge, row, end);
    ew_walk_rows(rows, t, raster->work.packing.is_256);
    return rows->reached;
}
#else
EW_HOT int ew_rows_packed(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    ew_plane32 *p = t->plane.narrow;
    int reached = 0;
    EW_ASSERT(row < end);
    for (; row < end; row++) {
        const int32_t x = larger(edge[0].x, raster->scissor.x0), n = smaller(edge[1].x, raster->scissor.x1) - x;
        if (n > 0) {
            const uint32_t columns = (uint32_t)(x - t->column);
            ew_pen pen; /* in registers */
            pen_at(&pen, raster, x, row);
            pen.w = depth_of(p[EW_PLANE_W].row + p[EW_PLANE_W].dx * columns, t->w_lead);
            pen.dw = depth_step(p[EW_PLANE_W].dx, t->w_lead);
            fill_packed(&raster->work.packing, &pen, packed_after(packed_row(p), packed_dx(p), columns), packed_dx(p), n);
            reached = 1;
        }
        packed at = packed_row(p);
        packed_add(&at, packed_dy(p));
        p[EW_PLANE_W].row += p[EW_PLANE_W].dy;
        p[EW_PLANE_U].row = at.high, p[EW_PLANE_V].row = at.low;
        ew_edges_step(edge);
    }
    return reached;
}
#endif

static void span_of_any(ew_raster *raster, int32_t x, int32_t y, int32_t n)
{
    const ew_triangle *t = &raster->work.triangle;
    //@ dynamic_split n;
    while (n > 0) {
        int32_t m = n;
        if (t->is_wide) m = next_of_wide(raster, t, x, n);
        else start_narrow(&raster->work.now.span.linear, t, x);
        //@ split m;
        if (start_piece(raster, x, y, m)) {
            piece_of_texture(raster, t, m);
        } else {
            piece_of_any(raster, m);
        }
        x += m;
        n -= m;
        //@ merge m;
    }
}

EW_HOT int ew_rows_of_any(ew_raster *raster, int32_t row, int32_t end)
{
    ew_triangle *t = &raster->work.triangle;
    ew_edge *edge = raster->work.edge;
    int reached = 0;
    ew_span_work *span = &raster->work.now.span;
    span->is_ready = span->has_rows = 0;
    for (; row < end; row++) {
        int32_t x = larger(edge[0].x, raster->scissor.x0), n = smaller(edge[1].x, raster->scissor.x1) - x;
        if (n > 0) {
            span_of_any(raster, x, row, n);
            reached = 1;
        }
        ew_edges_step(edge);
        planes_step(t, t->is_wide, t->attributes);
    }
    return reached;
}
