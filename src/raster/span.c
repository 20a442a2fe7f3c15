/* Spans: what is done for each pixel, and how u and v get there.
 *
 * A span is drawn in runs: pieces over which u and v are linear. The affine rung makes one
 * run of it, the bound (docs/error-bound.md) as few as the tolerance allows, the table and
 * exact rungs one for each pixel. A run is filled by one of two loops: `fill_textured` for
 * the common case, `fill_any` for every other combination of material and target.
 *
 * 1/z and the texture quantities are taken as 32 bits at the span's first pixel and step
 * from there: a step is off by at most half a unit, so 4,096 pixels from the plane's column
 * a value is off by 2^11 units of 2^-31 in w, 1/16 of a depth unit. The exact rung, for
 * which u and v may fall from that to a small part of themselves, takes 64 bits.
 */
#include "fill.h"
#include "triangle.h"

#if defined(__GNUC__)
#define ALWAYS_INLINE static inline __attribute__((always_inline))
#else
#define ALWAYS_INLINE static inline
#endif

/* Where the next pixel goes, and its 1/z. */
typedef struct cursor {
    uint16_t *colour, *depth; /* depth may be NULL */
    uint32_t w, dw;
    uint16_t x, y;
} cursor;

/* u and v of the next pixel and what they grow by, top-aligned: 2^32 is the texture's
 * width or height, so that repeating is the wrapping of 32 bits. */
typedef struct texture_run {
    uint32_t u, du, v, dv;
} texture_run;

/* floor(a / 2^(32 - log2 of the size)): the texel; sizes of one texel shift by 32. */
ALWAYS_INLINE uint32_t texel_of(uint32_t a, int log2_size) { return a >> 1 >> (31 - log2_size); }

#if EW_TRACE
static void trace(const ew_raster *raster, cursor *at, uint16_t d, uint32_t u, uint32_t v)
{
    /* q20.12, modulo the texture's size */
    ew_trace_fragment(at->x, at->y, d, (ew_q20_12)(u >> (20 - raster->log2_width)),
                      (ew_q20_12)(v >> (20 - raster->log2_height)));
    at->x++;
}
#endif

/* ---- the loops ---- */

/* Everything else: fill.c. */
static void fill_any(const ew_raster *raster, cursor *at, const texture_run *run, int32_t n)
{
    ew_run r;
    r.x = at->x, r.y = at->y;
    r.w = at->w, r.dw = at->dw;
    r.u = (uint64_t)run->u << raster->log2_width;
    r.v = (uint64_t)run->v << raster->log2_height;
    r.du = (uint64_t)(int64_t)(int32_t)run->du << raster->log2_width;
    r.dv = (uint64_t)(int64_t)(int32_t)run->dv << raster->log2_height;
    ew_fill_any(raster, &r, n);
    at->x = (uint16_t)(at->x + n);
    at->w += at->dw * (uint32_t)n;
    at->colour += n;
    if (at->depth) at->depth += n;
}

/* Depth tested and written and inside its range, texture of at most 2^16 texels (t->plain),
 * n at most FAST_RUN. u and v share 64 bits: from the top u's texel and fraction, v's texel, v's
 * fraction. One addition steps both, one rotation brings the texel number together; what
 * v's texel carries goes into u's fraction, FAST_RUN times 2^-16 texel at most. */
enum { FAST_RUN = 512 };

static void fill_textured(const ew_raster *raster, cursor *at, const texture_run *run, int32_t n)
{
    const uint16_t *texels = raster->texture.texels;
    const int log2_height = raster->log2_height, turn = 32 - raster->log2_width;
    const uint32_t low = ((uint32_t)1 << log2_height) - 1u;
    const uint32_t mask = (low + 1u) * ((uint32_t)1 << raster->log2_width) - 1u;
    uint64_t p = ((uint64_t)((run->u & ~low) | run->v >> (32 - log2_height)) << 32) | run->v << log2_height;
    /* v's step has a sign: extended over u's bits, or the sum would lose a borrow */
    uint32_t v_texels = (uint32_t)EW_ASR((int32_t)run->dv, 32 - log2_height);
    const uint64_t dp = ((uint64_t)((run->du & ~low) + v_texels) << 32) | run->dv << log2_height;
    uint16_t *z = at->depth, *c = at->colour;
    uint16_t *const end = z + n;
    uint32_t w = at->w;
    const uint32_t dw = at->dw;
    do {
        uint32_t d = w >> 15, high = (uint32_t)(p >> 32);
#if EW_TRACE
        trace(raster, at, (uint16_t)d, high, (high << (32 - log2_height)) | (uint32_t)(p & 0xFFFFFFFFu) >> log2_height);
#endif
        if (d > *z) {
            *z = (uint16_t)d;
            *c = texels[(high << (32 - turn) | high >> turn) & mask];
        }
        w += dw;
        p += dp;
        c++;
    } while (++z != end);
#if !EW_TRACE
    at->x = (uint16_t)(at->x + n);
#endif
    at->w = w;
    at->depth = z;
    at->colour = c;
}

/* 1/z is linear: the first pixel's and the last's say whether any in between leaves depth's
 * range. */
ALWAYS_INLINE int is_plain(const ew_triangle *t, uint32_t w, uint32_t dw, int32_t n)
{
    if (t->plain != PLAIN_SOMETIMES) return t->plain;
    uint32_t last = w + dw * (uint32_t)(n - 1);
    return w >= 32768u && w <= INT32_MAX && last >= 32768u && last <= INT32_MAX;
}

ALWAYS_INLINE void fill(const ew_raster *raster, cursor *at, const texture_run *run, int32_t n, int plain)
{
    if (plain) fill_textured(raster, at, run, n);
    else fill_any(raster, at, run, n);
}

/* ---- u and v at a pixel ---- */

/* (u/z) / (1/z) with EW_UV_FRACTION(triangle) fraction bits: the quantity is normalised
 * together with w, so that its product with the reciprocal always has the same scale. */
ALWAYS_INLINE int32_t over_w(uint32_t uw, int lead, uint32_t reciprocal)
{
    return ew_mulh_s32((int32_t)(uw << lead), (int32_t)reciprocal); /* |uw << lead| < 2^31: triangle.c leaves the room */
}

/* A divisor made ready: 1/w. */
typedef struct divisor {
    uint32_t reciprocal;
    int lead;
} divisor;

/* w is brought into the range that the set-up allowed for, 1 <= w < 2^(32 - w_lead): the
 * rounding of steps may carry a value near 0 out of it. */
ALWAYS_INLINE divisor divisor_of(const ew_triangle *t, uint32_t w, int newton)
{
    uint32_t top = 0xFFFFFFFFu >> t->w_lead;
    if (w < 1) w = 1;
    if (w > top) w = top;
    int zeros = ew_clz32(w);
    divisor d;
    d.reciprocal = newton ? ew_recip_newton(w << zeros) : ew_recip_table(w << zeros);
    d.lead = zeros - t->w_lead;
    return d;
}

/* u with its fraction bits, top-aligned, the first corner's added. */
ALWAYS_INLINE uint32_t top_aligned(int32_t u, int shift, uint32_t base) { return ((uint32_t)u << shift) + base; }

/* ---- runs ---- */

/* One run for each pixel. */
static void span_per_pixel(const ew_raster *raster, const ew_triangle *t, cursor *at, uint64_t w, uint64_t uw,
                           uint64_t vw, int32_t n)
{
    const int newton = t->rung == EW_RUNG_EXACT;
    const uint16_t *texels = raster->texture.texels;
    texture_run run;
    run.du = run.dv = 0;
    at->dw = 0;
    int plain = is_plain(t, (uint32_t)(w >> 32), t->w.step, n);
    for (; n > 0; n--, w += t->w.dx, uw += t->u.dx, vw += t->v.dx) {
        at->w = (uint32_t)(w >> 32);
        uint32_t depth = at->w >> 15;
        if (plain && depth <= *at->depth && !EW_TRACE) {
            at->depth++;
            at->colour++;
            at->x++;
            continue;
        }
        divisor d = divisor_of(t, at->w, newton);
        run.u = top_aligned(over_w((uint32_t)(uw >> 32), d.lead, d.reciprocal), t->u_shift, t->u_base);
        run.v = top_aligned(over_w((uint32_t)(vw >> 32), d.lead, d.reciprocal), t->v_shift, t->v_base);
        if (plain && !EW_TRACE) {
            *at->depth++ = (uint16_t)depth;
            *at->colour++ = texels[texel_of(run.v, raster->log2_height) << raster->log2_width |
                                   texel_of(run.u, raster->log2_width)];
            at->x++;
        } else {
            fill_any(raster, at, &run, 1);
        }
    }
}

/* The longest run, as a power of two, that the bound allows from a pixel with 1/z = w:
 * the largest k with t->run_floor 4^k <= min(w, w + 2^k dw). */
ALWAYS_INLINE int run_log2(const ew_triangle *t, uint32_t w, uint32_t dw)
{
    enum { LONGEST = 9 }; /* FAST_RUN */
    int k = (ew_clz32(t->run_floor) - ew_clz32(w)) >> 1;
    if (k < 0) return 0;
    if (k > LONGEST) k = LONGEST;
    for (; k > 0; k--) {
        uint32_t far_end = (int32_t)dw < 0 ? w + (dw << k) : w;
        if (far_end <= w && far_end >> 2 * k >= t->run_floor) break;
    }
    return k;
}

/* What u grows by from pixel to pixel where it is u and u/z, w grow by du, dw:
 * (du/z - u dw) / w; `d` divides by that pixel's w. */
ALWAYS_INLINE int32_t slope(const ew_triangle *t, int32_t u, uint32_t du, uint32_t dw, const divisor *d)
{
    int scale = 30 - t->w_lead; /* u = (u/z) / w 2^scale */
    uint32_t turned = du - (uint32_t)EW_ASR(ew_mul_s32(u, (int32_t)dw), scale);
    return over_w(turned, d->lead, d->reciprocal);
}

/* A span or its rest as one run, uw and vw at its first pixel: the tangent in its middle,
 * which needs one reciprocal. It is displaced as little as the chord (docs/error-bound.md). */
static void span_as_one_run(const ew_raster *raster, const ew_triangle *t, cursor *at, uint32_t uw, uint32_t vw,
                            int32_t n, int plain)
{
    uint32_t half = (uint32_t)n >> 1, dw = at->dw;
    divisor d = divisor_of(t, at->w + dw * half, t->newton);
    int32_t u = over_w(uw + t->u.step * half, d.lead, d.reciprocal);
    int32_t v = over_w(vw + t->v.step * half, d.lead, d.reciprocal);
    texture_run run;
    run.du = top_aligned(slope(t, u, t->u.step, dw, &d), t->u_shift, 0);
    run.dv = top_aligned(slope(t, v, t->v.step, dw, &d), t->v_shift, 0);
    run.u = top_aligned(u, t->u_shift, t->u_base) - run.du * half;
    run.v = top_aligned(v, t->v_shift, t->v_base) - run.dv * half;
    for (; n > FAST_RUN; n -= FAST_RUN) {
        fill(raster, at, &run, FAST_RUN, plain);
        run.u += run.du * (uint32_t)FAST_RUN;
        run.v += run.dv * (uint32_t)FAST_RUN;
    }
    fill(raster, at, &run, n, plain);
}

/* Runs chosen by the bound: chords, exact at their first pixel and at the next run's first,
 * but for the last. */
static void span_by_bound(const ew_raster *raster, const ew_triangle *t, cursor *at, uint32_t uw, uint32_t vw, int32_t n,
                          int plain)
{
    const uint32_t dw = at->dw;
    int k = dw == 0 ? 30 : run_log2(t, at->w, dw);
    if (n > (int32_t)1 << k) {
        divisor d = divisor_of(t, at->w, t->newton);
        int32_t u = over_w(uw, d.lead, d.reciprocal), v = over_w(vw, d.lead, d.reciprocal);
        do {
            texture_run run;
            run.u = top_aligned(u, t->u_shift, t->u_base);
            run.v = top_aligned(v, t->v_shift, t->v_base);
            uw += t->u.step << k;
            vw += t->v.step << k;
            d = divisor_of(t, at->w + (dw << k), t->newton);
            int32_t u_end = over_w(uw, d.lead, d.reciprocal), v_end = over_w(vw, d.lead, d.reciprocal);
            run.du = top_aligned(EW_ASR(u_end - u, k), t->u_shift, 0);
            run.dv = top_aligned(EW_ASR(v_end - v, k), t->v_shift, 0);
            fill(raster, at, &run, (int32_t)1 << k, plain);
            n -= (int32_t)1 << k;
            u = u_end;
            v = v_end;
            k = run_log2(t, at->w, dw);
        } while (n > (int32_t)1 << k);
    }
    span_as_one_run(raster, t, at, uw, vw, n, plain);
}

void ew_span(const ew_raster *raster, const ew_triangle *t, int32_t x, int32_t y, int32_t n)
{
    int32_t columns = x - t->column;
    size_t offset = (size_t)y * raster->target.stride + (size_t)x;
    cursor at;
    at.colour = raster->target.colour + offset;
    at.depth = raster->target.depth ? raster->target.depth + offset : NULL;
    at.x = (uint16_t)x;
    at.y = (uint16_t)y;
    if (t->rung == EW_RUNG_EXACT || t->rung == EW_RUNG_TABLE) {
        span_per_pixel(raster, t, &at, t->w.row + ew_wrap_mul64(t->w.dx, columns),
                       t->u.row + ew_wrap_mul64(t->u.dx, columns), t->v.row + ew_wrap_mul64(t->v.dx, columns), n);
        return;
    }
    at.w = (uint32_t)(t->w.row >> 32) + t->w.step * (uint32_t)columns;
    at.dw = t->w.step;
    texture_run run;
    if (t->rung == EW_RUNG_CONSTANT) {
        run.u = run.v = run.du = run.dv = 0;
        fill_any(raster, &at, &run, n);
        return;
    }
    int plain = is_plain(t, at.w, at.dw, n);
    uint32_t u = (uint32_t)(t->u.row >> 32) + t->u.step * (uint32_t)columns;
    uint32_t v = (uint32_t)(t->v.row >> 32) + t->v.step * (uint32_t)columns;
    if (t->rung == EW_RUNG_RUNS) {
        span_by_bound(raster, t, &at, u, v, n, plain);
        return;
    }
    run.du = top_aligned((int32_t)t->u.step, t->u_shift, 0);
    run.dv = top_aligned((int32_t)t->v.step, t->v_shift, 0);
    run.u = top_aligned((int32_t)u, t->u_shift, t->u_base);
    run.v = top_aligned((int32_t)v, t->v_shift, t->v_base);
    for (; n > FAST_RUN; n -= FAST_RUN) {
        fill(raster, &at, &run, FAST_RUN, plain);
        run.u += run.du * (uint32_t)FAST_RUN;
        run.v += run.dv * (uint32_t)FAST_RUN;
    }
    fill(raster, &at, &run, n, plain);
}
