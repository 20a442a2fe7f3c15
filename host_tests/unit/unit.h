/* What the unit tests share: cmocka, a seeded generator, and words about the case at hand. */
#ifndef EW_UNIT_H
#define EW_UNIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* The generator starts each test from EW_SEED, or 1. */
uint32_t test_random(void);
/* Numbers near the ends, near powers of two, and any. */
int32_t test_awkward(void);
/* Restarts the generator for one of many numbered cases, so that it can be drawn alone. */
void test_restart(uint64_t number);
/* Remembers the case at hand: the last one is printed, with the seed, behind the test's
 * own output, and host_tests/run.py shows that of a test that failed. */
void test_context(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* An entry for cmocka_run_group_tests. */
#define TEST(function) cmocka_unit_test_setup_teardown(function, test_begin, test_end)
int test_begin(void **state);
int test_end(void **state);

/* The path of a file below ../shared, or NULL after a skip reason was printed: then call
 * skip(). */
const char *test_shared(const char *name);

#endif
