/* What stands in for test_mesa.c where there is no Mesa to ask. */
#include "../unit/unit.h"

#include <stdio.h>

static void mesa_agrees(void **state)
{
    (void)state;
    printf("# SKIP no libOSMesa (Debian: libosmesa6-dev)\n");
    skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(mesa_agrees) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
