/* fixed/: what the raster core and the display calculate with, for all that the contracts admit. */
#include "edgewalk/fixed.h"

#include "unknown.h"

void prove_fixed(void)
{
    uint32_t remainder, n, d, r;
    (void)ew_wrap_add32(any_s32(), any_s32());
    (void)ew_wrap_sub32(any_s32(), any_s32());
    (void)ew_wrap_mul64(any64(), any_s32());
    (void)ew_mul_s32(any_s32(), any_s32());
    (void)ew_mul_u32(any32(), any32());
    (void)ew_mul_s32_pieces(any_s32(), any_s32());
    (void)ew_mul_u32_pieces(any32(), any32());
    (void)ew_mulh_u32_pieces(any32(), any32());
    (void)ew_mul_u32_u16_pieces(any32(), between(0, 65535));
    (void)ew_wrap_mul64_u16_pieces(any64(), between(0, 65535));
    (void)ew_wrap_mul64_u16(any64(), between(0, 65535));
    (void)ew_mulh_s32_pieces(any_s32(), any_s32());
    (void)ew_mulh_u32(any32(), any32());
    (void)ew_mulh_s32(any_s32(), any_s32());
    (void)ew_abs32(any_s32());
    (void)ew_abs64(any_s64());
    (void)ew_clz32(any32());
    (void)ew_clz64(any64());
    (void)ew_snapped_from_q20_12(between(INT32_MIN, INT32_MAX - 128));
    const int32_t most = ((int32_t)1 << (19 + EW_SUBPIXEL_BITS)) - 1;
    (void)ew_q20_12_from_snapped(between(-most - 1, most));
    (void)ew_q16_16_from_int(any_s32());
    (void)ew_int_from_q16_16_floor(any_s32());
    (void)ew_int_from_q16_16(any_s32());
    (void)ew_q2_30_from_q2_14(any_s16());
    (void)ew_q2_14_from_q2_30(any_s32());
    (void)ew_q16_16_mul(any_s32(), any_s32());
    (void)ew_q16_16_div(any_s32(), any_s32());
    n = any32(), d = any32();
    if (d > n) (void)ew_udiv64_32((uint64_t)n << 32 | any32(), d, &remainder);
    r = any32();
    (void)ew_fraction64(any64(), any64());
    (void)ew_sqrt32(any32());
    (void)ew_sqrt64(any64());
    if (r >= UINT32_C(0x80000000)) {
        (void)ew_recip_table(r);
        (void)ew_recip_newton(r);
    }
}
