/* Saturating products, divisions and roots that C does not have in fixed point. */
#include "edgewalk/fixed.h"

static int32_t saturate32(int64_t a)
{
    if (a > INT32_MAX) return INT32_MAX;
    if (a < INT32_MIN) return INT32_MIN;
    return (int32_t)a;
}

EW_HOT uint64_t ew_mul_u32_pieces(uint32_t a, uint32_t b)
{
    uint32_t ah = a >> 16, al = ew_low16(a), bh = b >> 16, bl = ew_low16(b);
    uint32_t low = al * bl, middle = ah * bl + (low >> 16); /* <= (2^16 - 1)^2 + 2^16 - 1 */
    uint32_t other = al * bh + ew_low16(middle);            /* likewise                    */
    return (uint64_t)(ah * bh + (middle >> 16) + (other >> 16)) << 32 | (other << 16 | ew_low16(low));
}

int64_t ew_mul_s32_pieces(int32_t a, int32_t b)
{
    /* the upper halves keep the sign, as in ew_mulh_s32_pieces */
    int32_t ah = EW_ASR(a, 16), al = (int32_t)ew_low16((uint32_t)a), bh = EW_ASR(b, 16), bl = (int32_t)ew_low16((uint32_t)b);
    uint32_t low = (uint32_t)al * (uint32_t)bl;
    int32_t middle = ah * bl + (int32_t)(low >> 16);
    int32_t other = al * bh + (int32_t)ew_low16((uint32_t)middle);
    uint32_t high = (uint32_t)(ah * bh + EW_ASR(middle, 16) + EW_ASR(other, 16));
    return (int64_t)((uint64_t)high << 32 | ((uint32_t)other << 16 | ew_low16(low)));
}

ew_q16_16 ew_q16_16_mul(ew_q16_16 a, ew_q16_16 b)
{
    /* |a b| <= 2^62, so adding half a unit stays inside. */
    return saturate32(EW_ASR(ew_mul_s32(a, b) + 0x8000, 16));
}

ew_q16_16 ew_q16_16_div(ew_q16_16 a, ew_q16_16 b)
{
    if (b == 0) return a < 0 ? INT32_MIN : INT32_MAX;
    uint32_t d = ew_abs32(b), rest;
    uint64_t n = ((uint64_t)ew_abs32(a) << 16) + d / 2; /* <= 2^47 + 2^30 */
    int negative = (a < 0) != (b < 0);
    if (n >> 32 >= d) return negative ? INT32_MIN : INT32_MAX; /* the quotient has 33 bits */
    int64_t q = (int64_t)ew_udiv64_32(n, d, &rest);
    return saturate32(negative ? -q : q);
}

uint32_t ew_udiv64_32(uint64_t n, uint32_t d, uint32_t *remainder)
{
    EW_ASSERT(n >> 32 < d);
    if (n >> 32 == 0) {
        uint32_t low = (uint32_t)n;
        *remainder = low % d;
        return low / d;
    }
    /* One quotient bit a round: n's upper word is the partial remainder, always below d;
     * shifting it may carry out of 32 bits, which means that d certainly fits. */
    uint32_t high = (uint32_t)(n >> 32), low = (uint32_t)n;
    for (int i = 0; i < 32; i++) {
        uint32_t carry = high >> 31;
        high = high << 1 | low >> 31;
        low <<= 1;
        if (carry || high >= d) {
            high -= d;
            low |= 1u;
        }
    }
    *remainder = high;
    return low;
}

uint64_t ew_fraction64(uint64_t n, uint64_t d)
{
    EW_ASSERT(n < d);
    uint64_t q = 0;
    for (int i = 0; i < 64; i++) {
        uint64_t carry = n >> 63;
        n <<= 1;
        q <<= 1;
        if (carry || n >= d) {
            n -= d;
            q |= 1u;
        }
    }
    return q;
}

int64_t ew_scale64(int64_t a, uint64_t f)
{
    uint64_t u = ew_abs64(a);
    uint32_t uh = (uint32_t)(u >> 32), ul = (uint32_t)u, fh = (uint32_t)(f >> 32), fl = (uint32_t)f;
    /* u f = 2^64 uh fh + 2^32 (uh fl + ul fh) + ul fl; the middle sum with its carry is
     * below 3 2^64, so it is added in halves. */
    uint64_t m1 = ew_mul_u32(uh, fl), m2 = ew_mul_u32(ul, fh), low = ew_mul_u32(ul, fl);
    uint64_t carry = (low >> 32) + (uint32_t)m1 + (uint32_t)m2; /* < 3 2^32 */
    uint64_t high = ew_mul_u32(uh, fh) + (m1 >> 32) + (m2 >> 32) + (carry >> 32);
    int exact = (uint32_t)carry == 0 && (uint32_t)low == 0;
    if (a >= 0) return (int64_t)high;
    return -(int64_t)high - (exact ? 0 : 1); /* floor, and high < |a| <= 2^63 */
}

/* Two bits of n give one of the root; `twice` is the root so far, doubled, in its place. */
uint32_t ew_sqrt32(uint32_t n)
{
    uint32_t twice = 0;
    for (uint32_t bit = UINT32_C(1) << 30; bit; bit >>= 2) {
        uint32_t with = twice + bit;
        twice >>= 1;
        if (n >= with) n -= with, twice += bit;
    }
    return twice;
}

uint32_t ew_sqrt64(uint64_t n)
{
    uint64_t twice = 0;
    for (uint64_t bit = UINT64_C(1) << 62; bit; bit >>= 2) {
        uint64_t with = twice + bit;
        twice >>= 1;
        if (n >= with) n -= with, twice += bit;
    }
    return (uint32_t)twice;
}
