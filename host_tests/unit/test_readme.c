/* The README's program draws what it says: each pixel against exact coverage. */
#include "unit.h"

#include "edgewalk/fixed.h"
#include "../reference/referee.h"

extern uint16_t colour[64 * 48], depth[64 * 48];
int readme_main(void);

static void the_example_draws_a_triangle(void **state)
{
    (void)state;
    const int64_t sx[3] = { 32 << EW_SUBPIXEL_BITS, 8 << EW_SUBPIXEL_BITS, 56 << EW_SUBPIXEL_BITS };
    const int64_t sy[3] = { 4 << EW_SUBPIXEL_BITS, 44 << EW_SUBPIXEL_BITS, 44 << EW_SUBPIXEL_BITS };
    assert_int_equal(readme_main(), 0);
    for (int y = 0; y < 48; y++) {
        for (int x = 0; x < 64; x++) {
            int inside = ref_covers(sx, sy, EW_SUBPIXEL_BITS, x, y);
            test_context("pixel %d %d", x, y);
            assert_int_equal(colour[y * 64 + x], inside ? 0xF800 : 0x001F);
            assert_int_equal(depth[y * 64 + x], inside ? 32768 : 0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(the_example_draws_a_triangle) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
