/* The reciprocals over their whole domain. Built once for each table size. */
#include "unit.h"

#include <math.h>
#include <stdio.h>

#include "edgewalk/fixed.h"

/* Worst relative error is 2^-bits: the figures of include/edgewalk/fixed.h. */
static const double table_bits[6] = { 11.02, 12.97, 14.91, 16.53, 17.00, 17.00 };
static const double newton_bits[6] = { 22.04, 25.90, 29.29, 29.94, 29.94, 29.94 };

/* Every mantissa for the default table; for the others every 61st: 61 is odd, so that
 * all low bits occur. */
enum { STRIDE = EW_RECIP_BITS == 8 ? 1 : 61 };

/* |m r - 2^62| <= 2^62 error, in integers: 2^62 error as a 64-bit number. */
static void hold(uint32_t (*reciprocal)(uint32_t), double bits)
{
    const int64_t allowed = (int64_t)floor(exp2(62 - bits));
    int64_t worst = 0;
    uint32_t largest = 0;
    for (uint64_t m = UINT64_C(1) << 31; m < UINT64_C(1) << 32; m += STRIDE) {
        uint32_t r = reciprocal((uint32_t)m);
        int64_t off = (int64_t)(m * r - (UINT64_C(1) << 62));
        if (off < 0) off = -off;
        if (off > worst) worst = off;
        if (r > largest) largest = r;
    }
    test_context("%d bits: worst 2^%.3f", EW_RECIP_BITS, log2((double)worst) - 62);
    assert_true(worst <= allowed);
    /* and the stated figure is not a loose one */
    assert_true(log2((double)worst) - 62 > -bits - 0.03);
    /* span.c multiplies with it as a signed number */
    assert_true(largest <= INT32_MAX);
}

static void table_error_over_all_mantissas(void **state)
{
    (void)state;
    hold(ew_recip_table, table_bits[EW_RECIP_BITS - 4]);
}

static void newton_error_over_all_mantissas(void **state)
{
    (void)state;
    hold(ew_recip_newton, newton_bits[EW_RECIP_BITS - 4]);
}

#if EW_RECIP_BITS >= 7
static void newton_steps_give_the_same_bits(void **state)
{
    (void)state;
    for (uint64_t i = UINT64_C(1) << 31; i < UINT64_C(1) << 32; i += STRIDE) {
        const uint32_t m = (uint32_t)i, r = ew_recip_table_inline(m);
        if (ew_newton_long(m, r) != ew_newton_pieces(m, r)) fail_msg("m = 0x%08X", m);
    }
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(table_error_over_all_mantissas),
        TEST(newton_error_over_all_mantissas),
#if EW_RECIP_BITS >= 7
        TEST(newton_steps_give_the_same_bits),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
