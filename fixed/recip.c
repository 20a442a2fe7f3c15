/* Reciprocals of normalised mantissas: a table, linear interpolation, one Newton step. */
#include "edgewalk/fixed.h"

static const uint16_t recip_table[(1 << EW_RECIP_BITS) + 1] = {
#include "recip_table.inc"
};

uint32_t ew_recip_table(uint32_t m)
{
    /* m = 2^31 (1 + i/2^b + f/2^(b+16) + ...): the bits below f are worth less than the
     * table's own rounding. */
    uint32_t i = (m >> (31 - EW_RECIP_BITS)) & ((1u << EW_RECIP_BITS) - 1u);
    uint32_t f = (m >> (15 - EW_RECIP_BITS)) & 0xFFFFu;
    uint32_t a = recip_table[i];
    /* Falls from entry to entry by at most 2^17 / 17 (b = 4), so the product is below 2^29. */
    uint32_t fall = (a - recip_table[i + 1]) * f;
    /* Table units are 2^14 of the result; (2^16 + a) 2^14 <= 2^31. */
    return ((65536u + a) << 14) - (fall >> 2);
}

uint32_t ew_recip_newton(uint32_t m)
{
    uint32_t r = ew_recip_table(m);
    /* m r = 2^62 (1 + d) with |d| < 2^-11, so t = 2^30 (1 + d), and the better reciprocal
     * is r (1 - d) = r (2^31 - t) / 2^30, off by d^2. The product is at most 2^61 (1 - d^2). */
    uint32_t t = ew_mulh_u32(m, r);
    return (uint32_t)(ew_mul_u32(r, 0x80000000u - t) >> 30);
}
