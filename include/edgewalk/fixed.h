/* edgewalk/fixed.h - numbers: formats, conversions, reciprocals, matrices.
 *
 * A format's name says where its binary point is: ew_qM_N has M bits before the point,
 * the sign among them, and N after it; M + N is the width. ew_uqM_N has no sign. C does
 * not check typedefs, so a value changes its format only in a function whose name holds
 * both formats.
 *
 * Numbers whose size is not known beforehand - matrices, distances - are block numbers:
 * integer mantissas with one power of two for a whole row.
 *
 * Rounding is to nearest with ties upwards (floor(x + 1/2)) unless a name says
 * otherwise. Arithmetic that is meant to wrap is spelled ew_wrap_*; everything else
 * stays inside its type, and the comments say why.
 */
#ifndef EW_FIXED_H
#define EW_FIXED_H

#include <limits.h>
#include <stdint.h>

#include "config.h"
#include "error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef int16_t ew_q1_15;  /* [-1, 1)                 vertex coordinates in their box          */
typedef int16_t ew_q2_14;  /* [-2, 2)                 stored quaternions                        */
typedef int32_t ew_q2_30;  /* [-2, 2)                 quaternions, sines                        */
typedef int32_t ew_q16_16; /* [-32768, 32768)         lengths, focal ratios                     */
typedef int32_t ew_q20_12; /* [-524288, 524288)       screen positions (px), u and v (texels)   */
typedef int32_t ew_snapped; /* screen position times 2^EW_SUBPIXEL_BITS: what edges are made of */
typedef uint32_t ew_uq1_31; /* [0, 2)                 near/z: 2^31 at the near plane            */

/* ---- shifts, wrapping, products ---- */

/* The core shifts negative values to the right and expects the sign to be copied in. C
 * leaves that to the compiler; every one that this library meets does it. This macro is
 * the only place that relies on it, and test_fixed checks it. */
#define EW_ASR(value, bits) ((value) >> (bits))

/* Sums and products modulo 2^32 and 2^64: overflow is expected and harmless. ew_wrap_mul64_u16, below, is the last one
 * for b < 2^16. */
static inline int32_t ew_wrap_add32(int32_t a, int32_t b) { return (int32_t)((uint32_t)a + (uint32_t)b); }
static inline int32_t ew_wrap_sub32(int32_t a, int32_t b) { return (int32_t)((uint32_t)a - (uint32_t)b); }
static inline uint64_t ew_wrap_mul64(uint64_t a, int32_t b) { return a * (uint64_t)(int64_t)b; }

/* 32 x 32 -> 64 bits, exact, also with b < 2^16, and the high word: floor(a b / 2^32). Forms in pieces are
 * made of 16-bit ones, for cores without a long multiply, where compilers call a library for
 * 64 x 64 bits; all give the same bits. */
uint64_t ew_mul_u32_pieces(uint32_t a, uint32_t b);
int64_t ew_mul_s32_pieces(int32_t a, int32_t b);
/* a mod 2^16. GCC shifts twice for it on ARMv6-M. */
static inline uint32_t ew_low16(uint32_t a)
{
#if defined(__GNUC__) && (defined(__ARM_ARCH_6M__) || defined(__ARM_ARCH_8M_BASE__)) && !defined(EW_PORTABLE)
    uint32_t low;
    __asm__("uxth %0, %1" : "=l"(low) : "l"(a));
    return low;
#else
    return a & 0xFFFFu;
#endif
}
static inline uint32_t ew_mulh_u32_pieces(uint32_t a, uint32_t b)
{
    uint32_t ah = a >> 16, al = ew_low16(a), bh = b >> 16, bl = ew_low16(b);
    uint32_t middle = ah * bl + ((al * bl) >> 16);   /* <= (2^16 - 1)^2 + 2^16 - 1 */
    uint32_t other = al * bh + ew_low16(middle);     /* likewise                    */
    return ah * bh + (middle >> 16) + (other >> 16);
}
static inline uint64_t ew_mul_u32_u16_pieces(uint32_t a, uint32_t b)
{
    const uint32_t low = ew_low16(a) * b, high = (a >> 16) * b + (low >> 16); /* <= (2^16 - 1)^2 + 2^16 - 1 */
    return (uint64_t)(high >> 16) << 32 | (high << 16 | ew_low16(low));
}
static inline uint64_t ew_wrap_mul64_u16_pieces(uint64_t a, uint32_t b)
{
    return ew_mul_u32_u16_pieces((uint32_t)a, b) + ((uint64_t)((uint32_t)(a >> 32) * b) << 32); /* the upper half wraps */
}
static inline int32_t ew_mulh_s32_pieces(int32_t a, int32_t b)
{
    /* the upper halves keep the sign: no correction is needed afterwards */
    int32_t ah = EW_ASR(a, 16), al = (int32_t)ew_low16((uint32_t)a), bh = EW_ASR(b, 16), bl = (int32_t)ew_low16((uint32_t)b);
    int32_t low = (int32_t)(((uint32_t)al * (uint32_t)bl) >> 16);
    int32_t middle = ah * bl + low;                              /* -2^15 (2^16 - 1) to 2^15 (2^16 - 1) */
    int32_t other = al * bh + (int32_t)ew_low16((uint32_t)middle); /* likewise                            */
    return ah * bh + EW_ASR(middle, 16) + EW_ASR(other, 16);
}
#if !EW_LONG_MULTIPLY
static inline int64_t ew_mul_s32(int32_t a, int32_t b) { return ew_mul_s32_pieces(a, b); }
static inline uint64_t ew_mul_u32(uint32_t a, uint32_t b) { return ew_mul_u32_pieces(a, b); }
static inline int32_t ew_mulh_s32(int32_t a, int32_t b) { return ew_mulh_s32_pieces(a, b); }
static inline uint32_t ew_mulh_u32(uint32_t a, uint32_t b) { return ew_mulh_u32_pieces(a, b); }
static inline uint64_t ew_mul_u32_u16(uint32_t a, uint32_t b) { return ew_mul_u32_u16_pieces(a, b); }
static inline uint64_t ew_wrap_mul64_u16(uint64_t a, uint32_t b) { return ew_wrap_mul64_u16_pieces(a, b); }
#define ew_product_less ew_product_less_pieces
#else
static inline int64_t ew_mul_s32(int32_t a, int32_t b) { return (int64_t)a * b; }
static inline uint64_t ew_mul_u32(uint32_t a, uint32_t b) { return (uint64_t)a * b; }
static inline int32_t ew_mulh_s32(int32_t a, int32_t b) { return (int32_t)EW_ASR((int64_t)a * b, 32); }
static inline uint32_t ew_mulh_u32(uint32_t a, uint32_t b) { return (uint32_t)(((uint64_t)a * b) >> 32); }
static inline uint64_t ew_mul_u32_u16(uint32_t a, uint32_t b) { return (uint64_t)a * b; }
static inline uint64_t ew_wrap_mul64_u16(uint64_t a, uint32_t b) { return a * b; }
#define ew_product_less ew_product_less_long
#endif

/* Whether a b < c d, for |a| ... |d| < 2^31 - 2^15. The second form tries 32 bits first, which
 * most differences of corners fit. */
static inline int ew_product_less_long(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return ew_mul_s32(a, b) < ew_mul_s32(c, d);
}
static inline int ew_product_less_pieces(int32_t a, int32_t b, int32_t c, int32_t d)
{
    /* bits 31 to 15 the same: from 2^16 on, two neighbours that differ leave a one */
    uint32_t all = ((uint32_t)a ^ (uint32_t)a << 1) | ((uint32_t)b ^ (uint32_t)b << 1);
    all |= ((uint32_t)c ^ (uint32_t)c << 1) | ((uint32_t)d ^ (uint32_t)d << 1);
    if (all >> 16 == 0) return a * b < c * d; /* |.| <= 2^30 */
    return ew_product_less_long(a, b, c, d);
}

/* Magnitude; right for INT32_MIN and INT64_MIN too. */
static inline uint32_t ew_abs32(int32_t a) { return a < 0 ? 0u - (uint32_t)a : (uint32_t)a; }
static inline uint64_t ew_abs64(int64_t a) { return a < 0 ? 0u - (uint64_t)a : (uint64_t)a; }

/* Number of zero bits above the highest one; 32 or 64 for zero. The second is what a
 * compiler without a built-in gets, and the first is tested against it. */
static inline int ew_clz32_portable(uint32_t x)
{
    int n = 0;
    if (x == 0) return 32;
    if (!(x & 0xFFFF0000u)) n += 16, x <<= 16;
    if (!(x & 0xFF000000u)) n += 8, x <<= 8;
    if (!(x & 0xF0000000u)) n += 4, x <<= 4;
    if (!(x & 0xC0000000u)) n += 2, x <<= 2;
    if (!(x & 0x80000000u)) n += 1;
    return n;
}
static inline int ew_clz32(uint32_t x)
{
#if defined(__GNUC__) && UINT_MAX == 0xFFFFFFFFu
    return x ? __builtin_clz(x) : 32;
#elif defined(__GNUC__) && ULONG_MAX == 0xFFFFFFFFu
    return x ? __builtin_clzl(x) : 32;
#else
    return ew_clz32_portable(x);
#endif
}
static inline int ew_clz64(uint64_t x)
{
    return x > 0xFFFFFFFFu ? ew_clz32((uint32_t)(x >> 32)) : 32 + ew_clz32((uint32_t)x);
}

/* ---- conversions ---- */

/* Nearest, ties up. Exact when the argument is a whole number of subpixels. */
static inline ew_snapped ew_snapped_from_q20_12(ew_q20_12 a)
{
    /* half a subpixel; |a| <= 2^31 - 1 - half is the caller's (screen positions stay below 2^29) */
    return EW_ASR(a + ((int32_t)1 << (11 - EW_SUBPIXEL_BITS)), 12 - EW_SUBPIXEL_BITS);
}
/* Exact; |a| < 2^19 px. */
static inline ew_q20_12 ew_q20_12_from_snapped(ew_snapped a)
{
    return a * ((int32_t)1 << (12 - EW_SUBPIXEL_BITS));
}
/* Exact; saturates outside [-32768, 32767]. */
static inline ew_q16_16 ew_q16_16_from_int(int32_t a)
{
    if (a > 32767) return INT32_MAX;
    if (a < -32768) return INT32_MIN;
    return a * 65536;
}
/* floor. */
static inline int32_t ew_int_from_q16_16_floor(ew_q16_16 a) { return EW_ASR(a, 16); }
/* Nearest, ties up; saturates at 32768 (which an int32_t holds). */
static inline int32_t ew_int_from_q16_16(ew_q16_16 a) { return EW_ASR(EW_ASR(a, 15) + 1, 1); }
/* Exact. */
static inline ew_q2_30 ew_q2_30_from_q2_14(ew_q2_14 a) { return (int32_t)a * 65536; }
/* Nearest, ties up; saturates at 32767. */
static inline ew_q2_14 ew_q2_14_from_q2_30(ew_q2_30 a)
{
    int32_t r = EW_ASR(EW_ASR(a, 15) + 1, 1);
    return (int16_t)(r > 32767 ? 32767 : r);
}
/* Nearest, ties up; saturates both ways. */
ew_q16_16 ew_q16_16_mul(ew_q16_16 a, ew_q16_16 b);
/* Nearest, ties away from zero; saturates both ways; b = 0 saturates by the sign of a. */
ew_q16_16 ew_q16_16_div(ew_q16_16 a, ew_q16_16 b);

/* ---- division and roots ---- */

/* floor(n / d) and the remainder, for d > 0 and a quotient below 2^32. */
uint32_t ew_udiv64_32(uint64_t n, uint32_t d, uint32_t *remainder);
/* floor(n 2^64 / d) for n < d. */
uint64_t ew_fraction64(uint64_t n, uint64_t d);
/* floor(a f / 2^64): a scaled by a fraction below one. */
int64_t ew_scale64(int64_t a, uint64_t f);
/* floor(sqrt(n)). */
uint32_t ew_sqrt64(uint64_t n);
uint32_t ew_sqrt32(uint32_t n);

/* Approximate reciprocals of a normalised mantissa m, 2^31 <= m < 2^32: 2^62 / m, so in
 * (2^30, 2^31]. The first interpolates a table of 2^EW_RECIP_BITS entries linearly, the
 * second adds one Newton step. Worst relative errors, held by test_recip over all 2^31
 * mantissas for 8 bits and every 61st for the others (bits 4 5 6 7 8 9):
 *   ew_recip_table   2^-11.02 2^-12.97 2^-14.91 2^-16.53 2^-17.00 2^-17.00
 *   ew_recip_newton  2^-22.04 2^-25.90 2^-29.29 2^-29.94 2^-29.94 2^-29.94
 * How the table's entries are chosen: fixed/recip_table.py. */
uint32_t ew_recip_table(uint32_t m);
uint32_t ew_recip_newton(uint32_t m);

/* The same two without a call, for loops, and their table. */
extern const uint16_t ew_recip_entries[(1 << EW_RECIP_BITS) + 1];
static inline uint32_t ew_recip_table_inline(uint32_t m)
{
    /* m = 2^31 (1 + i/2^b + f/2^(b+16) + ...): the bits below f are worth less than the
     * table's own rounding. */
    uint32_t i = (m >> (31 - EW_RECIP_BITS)) & ((UINT32_C(1) << EW_RECIP_BITS) - 1u);
    uint32_t f = (m >> (15 - EW_RECIP_BITS)) & 0xFFFFu;
    uint32_t a = ew_recip_entries[i];
    /* Falls from entry to entry by at most 2^17 / 17 (b = 4), so the product is below 2^29. */
    uint32_t fall = (a - ew_recip_entries[i + 1]) * f;
    /* Table units are 2^14 of the result; (2^16 + a) 2^14 < 2^31. */
    return ((UINT32_C(65536) + a) << 14) - (fall >> 2);
}
/* A Newton step: m r = 2^62 (1 + d) with |d| < 2^-11, and the better reciprocal is r (1 - d), off by d^2.
 * The second form, of 16-bit pieces with the same bits, needs |d| < 2^-16: a table of 7 bits. */
static inline uint32_t ew_newton_long(uint32_t m, uint32_t r)
{
    uint32_t t = ew_mulh_u32(m, r); /* 2^30 (1 + d); r (2^31 - t) / 2^30 with twice each factor in 32 bits */
    return ew_mulh_u32(r << 1, 0u - (t << 1));
}
static inline uint32_t ew_newton_pieces(uint32_t m, uint32_t r)
{
    uint32_t mh = m >> 16, ml = ew_low16(m), rh = r >> 16, rl = ew_low16(r);
    uint32_t middle = ((ml * rl) >> 16) + mh * rl + ml * rh; /* may wrap, as what it is worth mod 2^16 does */
    int32_t s = (int16_t)ew_low16(mh * rh + (middle >> 16)); /* t - 2^30 */
    return r + (uint32_t)EW_ASR(EW_ASR((int32_t)rl * -s, 16) - (int32_t)rh * s, 14); /* |.| < 2^30 */
}
static inline uint32_t ew_recip_newton_inline(uint32_t m)
{
#if EW_LONG_MULTIPLY || EW_RECIP_BITS < 7
    return ew_newton_long(m, ew_recip_table_inline(m));
#else
    return ew_newton_pieces(m, ew_recip_table_inline(m));
#endif
}

/* ---- vectors ---- */

typedef struct ew_vec3 {
    ew_q16_16 x, y, z;
} ew_vec3;

/* Exact: value times 2^32. Each component below 2^30 in magnitude keeps it inside 64 bits. */
int64_t ew_vec3_dot(const ew_vec3 *a, const ew_vec3 *b);
/* Nearest, saturating. `out` may be a or b. */
void ew_vec3_cross(ew_vec3 *out, const ew_vec3 *a, const ew_vec3 *b);
/* Unit length within 4 units of 2^-16; the null vector gives EW_ERR_ARGUMENT and is left.
 * `out` may be a. */
int ew_vec3_normalise(ew_vec3 *out, const ew_vec3 *a);

/* ---- block numbers and matrices ---- */

/* m * 2^(e - 30). */
typedef struct ew_block {
    int32_t m;
    int16_t e;
} ew_block;

/* Three numbers m[0..2] * 2^(e - 30) and a fourth, m[3] * 2^(e_last - 30), |m[k]| <= 2^30:
 * a matrix row whose translation may be of quite another size than its scale. Functions
 * write the largest |m| of the three, and the fourth, in [2^29, 2^30], zeros with an
 * exponent of 0. Exponents are within +-1000. */
typedef struct ew_row {
    int32_t m[4];
    int16_t e, e_last;
} ew_row;

/* Affine: rows of (x, y, z, 1); the fourth row is 0 0 0 1. */
typedef struct ew_mat34 {
    ew_row row[3];
} ew_mat34;

typedef struct ew_mat44 {
    ew_row row[4];
} ew_mat44;

/* A unit quaternion x i + y j + z k + w. */
typedef struct ew_quat {
    ew_q2_30 x, y, z, w;
} ew_quat;

void ew_row_from_q16_16(ew_row *row, ew_q16_16 a, ew_q16_16 b, ew_q16_16 c, ew_q16_16 d);
void ew_mat34_identity(ew_mat34 *out);
/* out = a b (b is applied first). `out` may be a or b. Returns EW_OK or EW_ERR_RANGE
 * when an exponent leaves +-1000; `out` is unchanged then. An element's error is
 * below 2^-28 of (largest of a's row) (largest of b), each taken over the three or the
 * fourth that meet in it. */
int ew_mat34_mul(ew_mat34 *out, const ew_mat34 *a, const ew_mat34 *b);
/* The same for a 4 x 4 matrix times an affine one. */
int ew_mat44_mul_mat34(ew_mat44 *out, const ew_mat44 *a, const ew_mat34 *b);
/* A row times a matrix: one row of such a product. `out` may be a, but no row of b; after EW_ERR_RANGE it
 * is of no use. */
int ew_row_mul_mat34(ew_row *out, const ew_row *a, const ew_mat34 *b);
int ew_row_mul_mat44(ew_row *out, const ew_row *a, const ew_mat44 *b);
/* translation * rotation * scale: t and s are value m * 2^(e - 30). The quaternion's
 * length is divided out (it may be off by a factor of two); the null quaternion gives
 * EW_ERR_ARGUMENT. Errors as ew_mat34_mul. */
int ew_mat34_from_trs(ew_mat34 *out, const int32_t t[3], int16_t t_exponent, const ew_quat *r,
                      const int32_t s[3], int16_t s_exponent);

/* ---- quaternions ---- */

/* The other way round; components of -2 do not change. */
static inline ew_quat ew_quat_conjugate(const ew_quat *a)
{
    ew_quat r = { ew_wrap_sub32(0, a->x), ew_wrap_sub32(0, a->y), ew_wrap_sub32(0, a->z), a->w };
    return r;
}
/* out = a b: b's rotation first. Nearest within 2^-25 of a unit, saturating. `out` may be a or b. */
void ew_quat_mul(ew_quat *out, const ew_quat *a, const ew_quat *b);
/* Unit length, each component within 2 units of 2^-30, for a of any length but 0: the null
 * quaternion gives EW_ERR_ARGUMENT and is left. `out` may be a. */
int ew_quat_normalise(ew_quat *out, const ew_quat *a);
/* The rotation a part t 2^-31 of the way from a to b, 0 <= t <= 2^31, at constant angular speed
 * along the shorter way: b and -b are the same rotation, and where both are equally far (half
 * a turn) b is taken as it is. a and b may have any length but 0, see ew_quat_normalise; the
 * ends are exactly what that makes of a, and of b or -b. In between, the rotation is within
 * 2^-27 radians of the exact one and its length within 2^-28 of 1.
 * Returns EW_OK, or EW_ERR_ARGUMENT for a null quaternion. `out` may be a or b. */
int ew_quat_slerp(ew_quat *out, const ew_quat *a, const ew_quat *b, uint32_t t);

/* A perspective with an infinite far plane, for a camera that looks down -z. */
typedef struct ew_projection {
    ew_q16_16 focal_x, focal_y; /* 2f/W and 2f/H: 1 / tan of half the field of view across and
                                   up; above 0                                           */
    ew_block near_z;            /* distance of the near plane, above 0                    */
} ew_projection;

/* Its matrix:
 *   focal_x 0 0 0 / 0 focal_y 0 0 / 0 0 -1 -2n / 0 0 -1 0
 * z_ndc = 1 - 2n/z for a point at distance z: -1 at the near plane, 1 at infinity, and
 * w' = z. In the third row a near distance far below 1 shares the exponent of the -1; the
 * geometry layer takes it from the projection itself.
 * Source: lecture 6 notes, "Perspective Projection and Texture Mapping", with the focal
 * factors and the sign of the last row corrected (docs/conventions.md).
 * Returns EW_OK or EW_ERR_ARGUMENT. */
int ew_mat44_perspective(ew_mat44 *out, const ew_projection *projection);

#ifdef __cplusplus
}
#endif

#endif
