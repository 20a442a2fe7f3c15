/* What src/raster/run.h promises span.c: `runs` proves it, the parts of span.c take it at its word. */
#ifndef EW_PROVE_RUNS_H
#define EW_PROVE_RUNS_H

#include "edgewalk/raster_work.h"

/*@ requires run_in_range: 0 <= n;
    requires limit_in_range: 0 <= limit->longest <= 256 && 0 <= limit->down <= 31;
    requires scale_in_range: limit->scale <= 65535 && limit->fall <= 512;
    assigns \result \from limit->scale, limit->fall, limit->longest, limit->down, w, n;
    ensures run_length: 0 <= \result <= 256; */
static inline int32_t ew_run_near(const ew_run_limit *limit, uint32_t w, int32_t n);
/*@ requires run_in_range: 0 <= n <= 256;
    requires limit_in_range: 0 <= limit->longest <= 256 && 0 <= limit->down <= 31;
    requires scale_in_range: limit->scale <= 65535 && limit->fall <= 512;
    assigns \result \from limit->scale, limit->fall, limit->longest, limit->down, w, n;
    ensures run_length: 0 <= \result <= 256; */
static inline int32_t ew_run_after(const ew_run_limit *limit, uint32_t w, int32_t n);
/*@ requires limit_in_range: 0 <= limit->longest <= 256 && 0 <= limit->down <= 31;
    requires scale_in_range: limit->scale <= 65535 && limit->fall <= 512;
    assigns \result \from limit->scale, limit->fall, limit->longest, limit->down, w;
    ensures run_length: 0 <= \result <= 256; */
static inline int32_t ew_run_first(const ew_run_limit *limit, uint32_t w);

#endif
