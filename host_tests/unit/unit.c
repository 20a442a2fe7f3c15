#include "unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static uint64_t seed, random_state;
static char context[512];

uint32_t test_random(void)
{
    /* Steele, Lea and Flood's SplitMix64, upper half */
    uint64_t z = random_state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return (uint32_t)((z ^ z >> 31) >> 32);
}

void test_restart(uint64_t number)
{
    /* odd factors spread neighbouring seeds and numbers over all states */
    random_state = seed * UINT64_C(0xD1342543DE82EF95) + number * UINT64_C(0xA0761D6478BD642F);
}

int32_t test_awkward(void)
{
    uint32_t r = test_random(), power = 1u << (r >> 3 & 31);
    switch (r & 7) {
    case 0: return (int32_t)(power - 1 + (r >> 8 & 2));
    case 1: return (int32_t)(0u - power + (r >> 8 & 1));
    case 2: return (int32_t)(0x7FFFFFFFu - (r >> 8 & 3));
    case 3: return (int32_t)(0x80000000u + (r >> 8 & 3));
    case 4: return (int32_t)(r >> 8 & 3) - 1;
    default: return (int32_t)test_random() >> (r >> 8 & 31);
    }
}

void test_context(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(context, sizeof context, format, args);
    va_end(args);
}

int test_begin(void **state)
{
    (void)state;
    const char *text = getenv("EW_SEED");
    seed = text ? strtoull(text, NULL, 0) : 1;
    random_state = seed;
    context[0] = 0;
    return 0;
}

int test_end(void **state)
{
    (void)state;
    if (context[0]) printf("# EW_SEED=%llu, last case: %s\n", (unsigned long long)seed, context);
    return 0;
}

const char *test_shared(const char *name)
{
    static char path[1024];
    snprintf(path, sizeof path, "../shared/%s", name);
    if (access(path, R_OK) == 0) return path;
    printf("# SKIP ../shared/%s is not there\n", name);
    return NULL;
}
