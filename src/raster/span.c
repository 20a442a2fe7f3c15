/* Rows and spans: what is done for each pixel, and how its attributes get there.
 *
 * A span is drawn in runs: pieces over which attributes are linear. The affine rung makes one
 * run of it, the bound (docs/error-bound.md) as few as the tolerance allows, the table and
 * exact rungs one for each pixel. A run is filled by one of two loops: `fill_textured` for
 * the common case, ew_fill_any for every other combination of material and target.
 *
 * Spans step in 32 bits. Those of narrow triangles may, whatever they do; those of wide ones
 * are cut where steps would lose too much, and each piece is aligned anew from 64 bits.
 */
#include "arch.h"
#include "fill.h"
#include "triangle.h"



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
    d.zeros = ew_clz32(w);
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


/* ---- run lengths ---- */

/* 16 sqrt(q), for q = product 2^exponent, from below: in each octave the chord of the root,
 * at most 2.2 % short. 16 EW_LONGEST_RUN at most. */
EW_ALWAYS_INLINE uint32_t root_of(uint32_t product, int exponent)
{
    if (product == 0) return 0;
    int zeros = ew_clz32(product);
    uint32_t m = (product << zeros) >> 16; /* 2^15 to 2^16 */
    exponent += 31 - zeros;
    if (exponent >= 26) return 16 * EW_LONGEST_RUN;
    if (exponent < 0) return 0;
    /* 2^15 sqrt(m / 2^15), or sqrt 2 times that: (2 - sqrt 2) + (sqrt 2 - 1) x, times sqrt 2 */
    uint32_t root = exponent & 1 ? 27145u + (m * 19194u >> 15) : 19195u + (m * 13572u >> 15);
    return root >> (15 - (exponent >> 1));
}

/* The longest run that the bound allows from a pixel with 1/z = w: N^2 |dw| <= 4 t w at its
 * far end, so with q = 4 t w / |dw|, N = sqrt q where w grows along the run and
 * sqrt(q + 4 t^2) - 2 t where it falls. Twice within a run is as far as w may grow or fall,
 * for the run's slope to be a number of 32 bits: N <= w / |dw| = q / 4 t. */
EW_ALWAYS_INLINE uint32_t run_length(const ew_triangle *t, uint32_t w, uint32_t dw, int align)
{
    const uint32_t tolerance = t->run_tolerance;
    uint32_t n16 = root_of((w >> 15) * t->run_scale, t->run_exponent - align);
    if ((int32_t)dw < 0) n16 = n16 > 2u * tolerance ? n16 - 2u * tolerance : 0;
    uint32_t n = n16 >> 4;
    if (4u * n < tolerance) n = 4u * n * n / tolerance;
    return n < t->longest ? n : t->longest;
}


/* Whether a span of n pixels, at most EW_LONGEST_RUN, may be one run; as in run_length. */
EW_ALWAYS_INLINE int one_run_suffices(const ew_triangle *t, uint32_t w, uint32_t dw, int32_t n)
{
    /* the tangent's far end is the mirrored first pixel: one beyond the last where n is even */
    int32_t far_end = smaller((int32_t)w, (int32_t)(w + dw * (uint32_t)n));
    return far_end > 0 && 4u * (uint32_t)n >= t->run_tolerance &&
           (uint32_t)(n * n) << 8 <= ((uint32_t)far_end >> 15) * t->run_scale >> t->run_shift;
}

/* ---- textured, depth tested and written: the common case ---- */

/* How a run's u and v become one texel number (t->plain says where this will do: depth inside
 * its range, sizes of 2 at least, 2^16 texels at most). u and v share 64 bits: from the top u's
 * texel and fraction, v's texel, v's fraction. One addition steps both, one rotation brings
 * the texel number together; what v's texel carries goes into u's fraction, 256 times 2^-16
 * texel at most. */

static void packing_init(ew_packing *k, const ew_raster *raster, const ew_triangle *t)
{
    k->loop.texels = raster->texture.texels;
    k->loop.turn = 32u - raster->log2_width;
    k->low = (UINT32_C(1) << raster->log2_height) - 1u;
    k->loop.mask = (k->low + 1u) * (UINT32_C(1) << raster->log2_width) - 1u;
    k->log2_height = raster->log2_height;
    k->u_shift = t->u_shift, k->v_shift = t->v_shift;
    k->u_base = t->u_base, k->v_base = t->v_base;
    k->newton = t->newton;
}

/* w' 2^align = w 2^(lead + align - 1) as uq1.31, and its step. */
EW_ALWAYS_INLINE uint32_t depth_of(uint32_t w, int down) { return (w >> down) << 1; }
EW_ALWAYS_INLINE uint32_t depth_step(uint32_t dw, int down) { return (uint32_t)EW_ASR((int32_t)dw, down) << 1; }

#if EW_TRACE
static void trace(ew_packing *k)
{
    const ew_pixel_loop *p = &k->loop;
    uint32_t v = p->high << (32 - k->log2_height) | p->low >> k->log2_height;
    /* q20.12, modulo the texture's size */
    ew_trace_fragment(k->x++, k->y, (uint16_t)(p->w >> 15), (ew_q20_12)(p->high >> (p->turn - 12)),
                      (ew_q20_12)(v >> (20 - k->log2_height)));
}
#else
#define trace(k) ((void)0)
#endif

/* n > 0 pixels, n at most EW_LONGEST_RUN, of a run with u and v at its first pixel. */
EW_NOINLINE void fill_textured(ew_packing *k, uint32_t u, uint32_t du, uint32_t v, uint32_t dv, int32_t n)
{
    const int log2_height = k->log2_height;
    const uint32_t low = k->low;
    /* top-aligned: 2^32 is the texture's size, so that repeating is the wrapping of 32 bits */
    u = (u << k->u_shift) + k->u_base, v = (v << k->v_shift) + k->v_base;
    du <<= k->u_shift, dv <<= k->v_shift;
    ew_pixel_loop *loop = &k->loop;
    loop->high = (u & ~low) | v >> (32 - log2_height), loop->low = v << log2_height;
    /* v's step has a sign: extended over u's bits, or the sum would lose a borrow */
    loop->dhigh = (du & ~low) + (uint32_t)EW_ASR((int32_t)dv, 32 - log2_height), loop->dlow = dv << log2_height;
    uint16_t *c = k->colour, *z = k->depth;
    k->colour += n;
    k->depth += n;
#if EW_HAS_PIXEL_LOOP && !EW_TRACE
    ew_fill_pixels(loop, c, z, n);
#else
    for (int32_t i = 0; i < n; i++) {
        uint32_t d = loop->w >> 15, high = loop->high;
        trace(k);
        if (d > z[i]) {
            z[i] = (uint16_t)d;
            c[i] = loop->texels[(high << (32 - loop->turn) | high >> loop->turn) & loop->mask];
        }
        loop->w += loop->dw;
        loop->low += loop->dlow;
        loop->high += loop->dhigh + (loop->low < loop->dlow ? 1u : 0u);
    }
#endif
}

/* A run of n pixels that is exact at its pixel `half`. */
EW_NOINLINE void run_of_texture(ew_packing *k, const ew_linear *l, uint32_t half, int32_t n)
{
    uint32_t dw = l->dw, du = l->du, dv = l->dv;
    divisor d = divisor_of(l->w + dw * half, k->newton);
    uint32_t u = over_w(l->u + du * half, d), v = over_w(l->v + dv * half, d);
    du = slope(u, du, dw, d), dv = slope(v, dv, dw, d);
    fill_textured(k, u - du * half, du, v - dv * half, dv, n);
}

EW_ALWAYS_INLINE void advance(ew_linear *l, uint32_t n)
{
    l->w += l->dw * n;
    l->u += l->du * n;
    l->v += l->dv * n;
}

/* Each pixel with a reciprocal of its own. */
EW_NOINLINE void textured_pixels(ew_packing *k, ew_linear *l, int32_t n)
{
#if EW_TRACE
    for (; n > 0; n--, advance(l, 1)) {
        divisor d = divisor_of(l->w, k->newton);
        fill_textured(k, over_w(l->u, d), 0, over_w(l->v, d), 0, 1);
    }
#else
    const uint16_t *texels = k->loop.texels;
    const int turn = (int)k->loop.turn, log2_width = 32 - turn, v_down = 32 - k->log2_height;
    uint32_t z = k->loop.w, w = l->w, u = l->u, v = l->v;
    for (int32_t i = 0; i < n; i++, z += k->loop.dw, w += l->dw, u += l->du, v += l->dv) {
        uint32_t depth = z >> 15;
        if (depth <= k->depth[i]) continue;
        divisor d = divisor_of(w, k->newton);
        uint32_t column = ((over_w(u, d) << k->u_shift) + k->u_base) >> turn;
        uint32_t row = ((over_w(v, d) << k->v_shift) + k->v_base) >> v_down;
        k->depth[i] = (uint16_t)depth;
        k->colour[i] = texels[(row << log2_width) + column];
    }
    k->loop.w = z;
    l->w = w, l->u = u, l->v = v;
    k->depth += n;
    k->colour += n;
#endif
}

/* A piece of a span, of at most EW_LONGEST_RUN pixels. */
EW_NOINLINE void piece_of_texture(ew_packing *k, const ew_triangle *t, ew_linear *l, int32_t n)
{
    enum { AT_ONCE = 16 }; /* pixels of their own before the next look whether a run pays */
    const int32_t shortest = t->shortest;
    if (t->rung == EW_RUNG_AFFINE || t->rung == EW_RUNG_CONSTANT) {
        fill_textured(k, l->u, l->du, l->v, l->dv, n);
        return;
    }
    if (t->rung == EW_RUNG_TABLE || t->rung == EW_RUNG_EXACT) {
        textured_pixels(k, l, n);
        return;
    }
    for (;;) {
        int32_t m = (int32_t)run_length(t, l->w, l->dw, l->align);
        if (m < shortest && n > 1) {
            m = smaller(n, AT_ONCE);
            textured_pixels(k, l, m);
            n -= m;
            if (n == 0) return;
            continue;
        }
        if (m > n || n == 1) m = n;
        run_of_texture(k, l, (uint32_t)m >> 1, m);
        n -= m;
        if (n == 0) return;
        advance(l, (uint32_t)m);
    }
}

/* ---- everything else ---- */

/* A tangent may leave a shade's range: ew_fill_any clamps. */
static void shade_run(ew_run *run, const ew_triangle *t, const ew_attribute_run *from)
{
    enum { DOWN = EW_FRACTION(EW_SHADE_BITS) - 16 };
    for (int i = 0; i < 3; i++) {
        /* rounds to nearest where fill.c drops the fraction */
        run->shade[i] = t->shade_origin[i] * 16 + 32768 + EW_ASR((int32_t)from->shade[i], DOWN);
        run->dshade[i] = EW_ASR((int32_t)from->dshade[i], DOWN);
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

/* work.attributes of the next run, of at most n pixels, behind which work.linear moves. Returns
 * its length. */
EW_NOINLINE int32_t next_of_any(ew_raster *raster, int32_t n)
{
    const ew_triangle *t = &raster->work.triangle;
    ew_linear *l = &raster->work.now.span.linear;
    ew_attribute_run *run = &raster->work.now.span.fill.any.attributes;
    EW_KEEP_ORDER(t);
    EW_KEEP_ORDER(l);
    EW_KEEP_ORDER(run);
    if (t->rung == EW_RUNG_AFFINE || t->rung == EW_RUNG_CONSTANT) {
        run_of_affine(run, t, l);
        return n;
    }
    const int per_pixel = t->rung == EW_RUNG_TABLE || t->rung == EW_RUNG_EXACT;
    int32_t m = per_pixel ? 1 : (int32_t)run_length(t, l->w, l->dw, l->align);
    m = larger(1, smaller(m, n));
    run_of_any(run, raster, t, l, (uint32_t)m >> 1);
    advance(l, (uint32_t)m);
    for (int i = 0; i < t->attributes - 2; i++) l->shade[i] += l->dshade[i] * (uint32_t)m;
    return m;
}

static void piece_of_any(ew_raster *raster, int32_t n)
{
    while (n > 0) {
        const int32_t m = next_of_any(raster, n);
        make_run(raster, m);
        ew_fill_any(raster, &raster->work.now.span.fill.any.run, m);
        n -= m;
    }
}

/* ---- spans ---- */

/* 1/z is linear: the first pixel's and the last's say whether any in between leaves depth's
 * range. */
EW_ALWAYS_INLINE int is_plain(const ew_triangle *t, uint32_t w, uint32_t dw, int32_t n)
{
    if (t->plain != PLAIN_SOMETIMES) return t->plain;
    uint32_t last = w + dw * (uint32_t)(n - 1);
    return w >= 32768u && w <= INT32_MAX && last >= 32768u && last <= INT32_MAX;
}

/* Makes ready for a piece of a span, of n <= EW_LONGEST_RUN pixels from (x, y) on, that
 * work.linear describes. Returns whether piece_of_texture may draw it. */
EW_NOINLINE int start_piece(ew_raster *raster, int32_t x, int32_t y, int32_t n)
{
    const ew_triangle *t = &raster->work.triangle;
    const ew_linear *l = &raster->work.now.span.linear;
    EW_KEEP_ORDER(t);
    const int down = (int)smaller(t->w_lead + l->align, 31);
    const uint32_t w = depth_of(l->w, down), dw = depth_step(l->dw, down);
    if (is_plain(t, w, dw, n)) {
        const size_t offset = (size_t)(y - raster->target.first_row) * raster->target.stride + (size_t)x;
        ew_packing *k = &raster->work.now.span.fill.packing;
        EW_KEEP_ORDER(k);
        packing_init(k, raster, t);
        k->loop.w = w, k->loop.dw = dw;
        k->colour = (uint16_t *)raster->target.colour + offset;
        k->depth = raster->target.depth + offset;
        k->x = (uint16_t)x, k->y = (uint16_t)y;
        return 1;
    }
    ew_position *at = &raster->work.now.span.fill.any.position;
    at->x = (uint16_t)x, at->y = (uint16_t)y;
    at->w = w, at->dw = dw;
    return 0;
}

/* w', u and v at x on the current row. */
EW_ALWAYS_INLINE void narrow_start(ew_linear *l, const ew_triangle *t, int32_t x)
{
    const ew_plane32 *p = t->plane.narrow;
    uint32_t columns = (uint32_t)(x - t->column);
    l->w = p[EW_PLANE_W].row + l->dw * columns;
    l->u = p[EW_PLANE_U].row + l->du * columns;
    l->v = p[EW_PLANE_V].row + l->dv * columns;
}

/* work.linear from x on. */
EW_NOINLINE void start_narrow(ew_raster *raster, int32_t x)
{
    const ew_triangle *t = &raster->work.triangle;
    const ew_plane32 *p = &t->plane.narrow[EW_PLANE_SHADE];
    ew_linear *l = &raster->work.now.span.linear;
    EW_KEEP_ORDER(t);
    EW_KEEP_ORDER(l);
    l->align = 0;
    l->dw = t->plane.narrow[EW_PLANE_W].dx;
    l->du = t->plane.narrow[EW_PLANE_U].dx;
    l->dv = t->plane.narrow[EW_PLANE_V].dx;
    narrow_start(l, t, x);
    if (t->attributes == 0) l->u = l->du = l->v = l->dv = 0;
    for (int i = 0; i < t->attributes - 2; i++) {
        l->shade[i] = p[i].row + p[i].dx * (uint32_t)(x - t->column);
        l->dshade[i] = p[i].dx;
    }
}

/* w' at two ends, aligned to the left as far as both allow; w' of a sliver's plane may come
 * out at or below 0. */
static int alignment(uint64_t w, uint64_t end, uint32_t *least)
{
    int64_t a = (int64_t)w, b = (int64_t)end, top = a > b ? a : b, bottom = a > b ? b : a;
    int up = top > 0 ? ew_clz64((uint64_t)top) - 1 : 0;
    *least = bottom > 0 ? (uint32_t)(((uint64_t)bottom << up) >> 32) : 0;
    return up;
}

/* Whether 32-bit steps keep attributes within 1/256 texel over n pixels: n 2^bits <= 2 w' at
 * both ends; affine, where w' does not matter: n 2^bits <= 2^32, 1/128 texel (docs/error-bound.md). */
EW_ALWAYS_INLINE int steps_suffice(const ew_triangle *t, uint32_t w, uint32_t last, int32_t n)
{
    int32_t least = smaller((int32_t)w, (int32_t)last); /* rounding may take it below 0 */
    if (t->rung == EW_RUNG_AFFINE) least = INT32_MAX;
    return n <= EW_LONGEST_RUN && n * ((int32_t)1 << (t->uv_bits - EW_BITS_LEAST)) <= EW_ASR(least, EW_BITS_LEAST - 1); /* 2^8 2^8 */
}

/* The same for wide triangles, unaligned. */
EW_NOINLINE void wide_start(ew_linear *l, const ew_triangle *t, int32_t x)
{
    const ew_plane64 *p = t->plane.wide;
    x -= t->column;
    l->w = top_of(p[EW_PLANE_W].row + ew_wrap_mul64(p[EW_PLANE_W].dx, x), 0);
    l->u = top_of(p[EW_PLANE_U].row + ew_wrap_mul64(p[EW_PLANE_U].dx, x), 0);
    l->v = top_of(p[EW_PLANE_V].row + ew_wrap_mul64(p[EW_PLANE_V].dx, x), 0);
}

/* The longest piece, from the first pixel on, for which steps of 32 bits will do. */
static int32_t piece_length(const ew_triangle *t, uint64_t w, int32_t n, int *align)
{
    uint32_t least = 0;
    *align = 0;
    n = smaller(n, EW_LONGEST_RUN);
    if (t->attributes == 0) return n;
    for (;; n = (n + 1) >> 1) {
        if (t->rung != EW_RUNG_AFFINE) *align = alignment(w, w + ew_wrap_mul64(t->plane.wide[EW_PLANE_W].dx, n - 1), &least);
        if (n == 1 || steps_suffice(t, least, least, n)) return n;
    }
}

static uint32_t wide_at(const ew_plane64 *p, int32_t columns, int align)
{
    return top_of(p->row + ew_wrap_mul64(p->dx, columns), align);
}

/* work.linear from x on, for as many of n pixels as it will do. Returns their number. */
EW_NOINLINE int32_t next_of_wide(ew_raster *raster, const ew_triangle *t, int32_t x, int32_t n)
{
    const ew_plane64 *p = t->plane.wide;
    ew_linear *l = &raster->work.now.span.linear;
    EW_KEEP_ORDER(l);
    x -= t->column;
    const uint64_t w = p[EW_PLANE_W].row + ew_wrap_mul64(p[EW_PLANE_W].dx, x);
    n = piece_length(t, w, n, &l->align);
    l->w = (int64_t)w > 0 ? top_of(w, l->align) : 1; /* then n is 1 */
    l->dw = top_of(p[EW_PLANE_W].dx, l->align);
    l->u = l->du = l->v = l->dv = 0;
    if (t->attributes) {
        l->u = wide_at(&p[EW_PLANE_U], x, l->align), l->du = top_of(p[EW_PLANE_U].dx, l->align);
        l->v = wide_at(&p[EW_PLANE_V], x, l->align), l->dv = top_of(p[EW_PLANE_V].dx, l->align);
    }
    p += EW_PLANE_SHADE;
    for (int i = 0; i < t->attributes - 2; i++, p++) {
        l->shade[i] = wide_at(p, x, l->align), l->dshade[i] = top_of(p->dx, l->align);
    }
    return n;
}

/* ---- rows ---- */

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

/* Steps along rows, which stay as they are. */
EW_ALWAYS_INLINE void steps_start(ew_packing *k, ew_linear *s, const ew_triangle *t, int wide)
{
    s->align = 0;
    s->dw = wide ? top_of(t->plane.wide[EW_PLANE_W].dx, 0) : t->plane.narrow[EW_PLANE_W].dx;
    s->du = wide ? top_of(t->plane.wide[EW_PLANE_U].dx, 0) : t->plane.narrow[EW_PLANE_U].dx;
    s->dv = wide ? top_of(t->plane.wide[EW_PLANE_V].dx, 0) : t->plane.narrow[EW_PLANE_V].dx;
    k->loop.dw = depth_step(s->dw, t->w_lead);
}

/* work.linear and the packing's 1/z for the next piece of a span that is too long for steps of
 * 32 bits. Returns its length. */
EW_NOINLINE int32_t next_of_texture(ew_raster *raster, const ew_triangle *t, int32_t x, int32_t n)
{
    const ew_linear *l = &raster->work.now.span.linear;
    ew_packing *k = &raster->work.now.span.fill.packing;
    n = next_of_wide(raster, t, x, n);
    const int down = t->w_lead + l->align;
    k->loop.w = depth_of(l->w, down), k->loop.dw = depth_step(l->dw, down);
    return n;
}

/* Triangles with a texture, depth and nothing else, on the affine rung or in runs: ew_walk_rows
 * for the common case. */
EW_ALWAYS_INLINE int rows_of_texture(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end, int wide)
{
    const int32_t clip_left = raster->scissor.x0, clip_right = raster->scissor.x1;
    const size_t offset = (size_t)(row - raster->target.first_row) * raster->target.stride;
    uint16_t *colour = (uint16_t *)raster->target.colour + offset, *depth = raster->target.depth + offset;
    ew_edge l = edge[0], r = edge[1]; /* or they would be read and written around each span */
    ew_span_work *span = &raster->work.now.span;
    int reached = 0;
    EW_KEEP_ORDER(span); /* a base of its own, with short offsets from it */
    ew_linear *s = &span->linear;
    ew_packing *k = &span->fill.packing;
    packing_init(k, raster, t);
    steps_start(k, s, t, wide);
    for (; row < end; row++) {
        int32_t x = larger(l.x, clip_left), n = smaller(r.x, clip_right) - x;
        if (n > 0) {
            int whole = 1;
            k->colour = colour + x;
            k->depth = depth + x;
#if EW_TRACE
            k->x = (uint16_t)x, k->y = (uint16_t)row;
#endif
            if (wide) {
                wide_start(s, t, x);
                whole = steps_suffice(t, s->w, s->w + s->dw * (uint32_t)(n - 1), n);
            } else {
                narrow_start(s, t, x);
            }
            k->loop.w = depth_of(s->w, t->w_lead);
            if (!whole) {
                while (n > 0) {
                    const int32_t m = next_of_texture(raster, t, x, n);
                    piece_of_texture(k, t, s, m);
                    x += m;
                    n -= m;
                }
                steps_start(k, s, t, wide);
            } else if (t->rung == EW_RUNG_AFFINE) fill_textured(k, s->u, s->du, s->v, s->dv, n);
            else if (one_run_suffices(t, s->w, s->dw, n)) run_of_texture(k, s, (uint32_t)n >> 1, n);
            else piece_of_texture(k, t, s, n);
            reached = 1;
        }
        ew_edge_step(&l);
        ew_edge_step(&r);
        planes_step(t, wide, 2);
        colour += raster->target.stride;
        depth += raster->target.stride;
    }
    edge[0] = l;
    edge[1] = r;
    return reached;
}
EW_NOINLINE int rows_of_narrow(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    return rows_of_texture(raster, t, edge, row, end, 0);
}
EW_NOINLINE int rows_of_wide(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    return rows_of_texture(raster, t, edge, row, end, 1);
}

static void span_of_any(ew_raster *raster, int32_t x, int32_t y, int32_t n)
{
    const ew_triangle *t = &raster->work.triangle;
    while (n > 0) {
        int32_t m = n;
        if (t->is_wide) m = next_of_wide(raster, t, x, n);
        else start_narrow(raster, x);
        if (start_piece(raster, x, y, m)) {
            piece_of_texture(&raster->work.now.span.fill.packing, t, &raster->work.now.span.linear, m);
        } else {
            piece_of_any(raster, m);
        }
        x += m;
        n -= m;
    }
}

EW_NOINLINE int rows_of_any(ew_raster *raster, int32_t row, int32_t end)
{
    ew_triangle *t = &raster->work.triangle;
    ew_edge *edge = raster->work.edge;
    int reached = 0;
    for (; row < end; row++) {
        int32_t x = larger(edge[0].x, raster->scissor.x0), n = smaller(edge[1].x, raster->scissor.x1) - x;
        if (n > 0) {
            span_of_any(raster, x, row, n);
            reached = 1;
        }
        ew_edge_step(&edge[0]);
        ew_edge_step(&edge[1]);
        planes_step(t, t->is_wide, t->attributes);
    }
    return reached;
}

EW_HOT int ew_walk_rows(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    if (!t->is_quick) return rows_of_any(raster, row, end);
    return t->is_wide ? rows_of_wide(raster, t, edge, row, end) : rows_of_narrow(raster, t, edge, row, end);
}
