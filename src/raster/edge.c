#include "edge.h"

void ew_edge_start(ew_edge *edge, ew_snapped xa, ew_snapped ya, ew_snapped xb, ew_snapped yb, int32_t row)
{
    int32_t dx = xb - xa, dy = yb - ya;       /* |dx| <= 2^26, 0 < dy <= 2^26 */
    int32_t s = row * EW_ONE + EW_HALF - ya;  /* 0 <= s < dy                  */
    //@ assert row_in_edge: 0 <= s < dy;
    int32_t step = dx / dy, rise = dx % dy;
    if (rise < 0) {
        step--;
        rise += dy;
    }
    /* x dy = (xa + s step) dy + s rise, and s rise = q dy + r, q <= s. */
    uint32_t r, q = ew_udiv64_32(ew_mul_u32((uint32_t)s, (uint32_t)rise), (uint32_t)dy, &r);
    int32_t along = (int32_t)((uint32_t)s * (uint32_t)step); /* |s step| < |dx| + dy, also inside */
    //@ assert between_corners: along == s * step && -(1 << 27) <= along <= 1 << 27 && q <= s && r < dy;
    /* ceil(n / d) = floor((n - 1) / d) + 1 for integers: n - 1 = t dy + r - 1. The point
     * xa + s step + q lies between xa and xb, or within dy of it: below 2^27. */
    int32_t t = xa - EW_HALF + along + (int32_t)q;
    int32_t rest = (int32_t)r - 1;
    if (rest < 0) {
        t--;
        rest += dy;
    }
    edge->x = EW_ASR(t, EW_SUBPIXEL_BITS) + 1;
    /* The remainder of n - 1 over ONE dy is f dy + rest with f the subpixel part of t.
     * Rows add ONE rise to it, so its lowest S bits never change: keep it shifted. */
    uint64_t fine = ew_mul_u32((uint32_t)t & (EW_ONE - 1), (uint32_t)dy) + (uint32_t)rest;
    edge->remainder = (int32_t)(fine >> EW_SUBPIXEL_BITS) - dy;
    edge->step = step;
    edge->rise = rise;
    edge->dy = dy;
}
