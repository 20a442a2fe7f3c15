/* Replays the triangles that `make worst` has found: none may break its promise. */
#include "cases.h"

#include <string.h>

#include "triangles.h"
#include "worst.h"

static const worst_case cases_found[] = {
#include "worst_triangles.inc"
};
enum { FOUND = sizeof cases_found / sizeof *cases_found };

static void found_triangles(void **state)
{
    (void)state;
    for (int i = 0; i < FOUND; i++) {
        const worst_case *c = &cases_found[i];
        worst_verdict v = worst_judge(c, 1);
        test_context("row %d, %s: %s: pixel %d %d: drawn %.6f, exact %.6f, uses %.3f of what is promised", i, c->way,
                     triangle_row(c->v), v.x, v.y, v.drawn, v.exact, v.used);
        assert_true(v.used > -1); /* or the row has lost its point */
        assert_true(v.used <= 1);
    }
}

/* A row for each way to draw, and for depth. */
static void every_way_has_a_row(void **state)
{
    (void)state;
    for (int k = 0; k <= PROMISE_WAYS; k++) {
        const char *name = k < PROMISE_WAYS ? promise_ways[k].name : "depth";
        int rows = 0;
        for (int i = 0; i < FOUND; i++) rows += strcmp(cases_found[i].way, name) == 0;
        test_context("%s", name);
        assert_true(rows > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(found_triangles), TEST(every_way_has_a_row) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
