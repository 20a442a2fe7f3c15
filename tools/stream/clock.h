/* Milliseconds of the monotonic clock. */
#ifndef EW_STREAM_CLOCK_H
#define EW_STREAM_CLOCK_H

#include <errno.h>
#include <stdint.h>
#include <time.h>

static inline int64_t ew_now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static inline int64_t ew_now_ms(void) { return ew_now_ns() / 1000000; }

static inline struct timespec ew_timespec_ns(int64_t ns)
{
    struct timespec t;
    t.tv_sec = (time_t)(ns / 1000000000);
    t.tv_nsec = (long)(ns % 1000000000);
    return t;
}

/* Sleeps until a time of ew_now_ns; returns early when a signal arrives. */
static inline void ew_sleep_until_ns(int64_t when)
{
    struct timespec t = ew_timespec_ns(when);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL);
}

static inline void ew_sleep_ms(unsigned ms)
{
    int64_t until = ew_now_ns() + (int64_t)ms * 1000000;
    struct timespec t = ew_timespec_ns(until);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) == EINTR) {
    }
}

#endif
