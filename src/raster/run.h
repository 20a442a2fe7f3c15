/* How long runs may be (private to the raster layer). docs/error-bound.md has the bound. */
#ifndef EW_RASTER_RUN_H
#define EW_RASTER_RUN_H

#include "arch.h"
#include "triangle.h"

/* 16 sqrt(q), for q = product 2^exponent, from below: in each octave the chord of the root,
 * at most 2.2 % short. 16 EW_LONGEST_RUN at most. */
EW_ALWAYS_INLINE uint32_t ew_root16(uint32_t product, int exponent)
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

/* The bound allows N^2 |dw| <= 4 t w for a run of N pixels, with w at its far end: with w at its
 * first pixel and q = 4 t w / |dw|, N^2 <= q where w grows along the run and N^2 + 4 t N <= q
 * where it falls. */

/* Whether a span of n pixels, at most EW_LONGEST_PIECE, may be one run. */
EW_ALWAYS_INLINE int ew_one_run_suffices(const ew_triangle *t, uint32_t w, uint32_t dw, int align, int32_t n)
{
    /* the tangent's far end is the mirrored first pixel: one beyond the last where n is even */
    int32_t there = (int32_t)(w + dw * (uint32_t)n), far_end = (int32_t)w < there ? (int32_t)w : there;
    int down = t->run_shift + align;
    return t->rung == EW_RUNG_RUNS && n <= t->longest && far_end > 0 &&
           (uint32_t)(n * n) << 8 <= ((uint32_t)far_end >> 15) * t->run_scale >> (down < 31 ? down : 31);
}

/* ---- run after run ---- */

/* 1/z is linear along a piece of a span: a run's length is found from that of the one before
 * it, with what stays the same. `twice` doubles t. */
EW_ALWAYS_INLINE void ew_run_limit_init(ew_run_limit *limit, const ew_triangle *t, uint32_t dw, int align, int twice)
{
    const int down = align - twice - t->run_exponent;
    limit->scale = t->run_scale;
    limit->fall = (int32_t)dw < 0 ? (uint32_t)t->run_tolerance << twice : 0;
    limit->longest = t->longest;
    limit->down = down < 0 ? 0 : down > 31 ? 31 : down; /* w' has bits enough for 256 px at 0 */
}

/* In 1/256. */
EW_ALWAYS_INLINE int ew_run_fits(const ew_run_limit *limit, uint32_t q, int32_t n)
{
    return (uint32_t)n * (4u * (uint32_t)n + limit->fall) << 6 <= q; /* 2^24 at most */
}

EW_ALWAYS_INLINE uint32_t ew_run_square(const ew_run_limit *limit, uint32_t w)
{
    return (w >> 15) * limit->scale >> limit->down;
}

/* The longest run from a pixel with 1/z = w on, by way of one of n pixels. */
EW_ALWAYS_INLINE int32_t ew_run_near(const ew_run_limit *limit, uint32_t w, int32_t n)
{
    const uint32_t q = ew_run_square(limit, w);
    //@ dynamic_split n;
    if (n > limit->longest) n = limit->longest;
    while (n < limit->longest && ew_run_fits(limit, q, n + 1)) n++;
    while (!ew_run_fits(limit, q, n)) n--;
    return n;
}

/* The same behind the longest run, of n pixels: it is no shorter where w grows, no longer where w falls. */
EW_ALWAYS_INLINE int32_t ew_run_after(const ew_run_limit *limit, uint32_t w, int32_t n)
{
    const uint32_t q = ew_run_square(limit, w);
    //@ dynamic_split n;
    if (limit->fall) while (!ew_run_fits(limit, q, n)) n--;
    else while (n < limit->longest && ew_run_fits(limit, q, n + 1)) n++;
    return n;
}

EW_ALWAYS_INLINE int32_t ew_run_first(const ew_run_limit *limit, uint32_t w)
{
    uint32_t n16 = ew_root16((w >> 15) * limit->scale, -limit->down);
    n16 = n16 > 2u * limit->fall ? n16 - 2u * limit->fall : 0;
    return ew_run_near(limit, w, (int32_t)(n16 >> 4));
}

#endif
