/* What run.h promises span.c: the part `runs` proves it, the part `span` takes it at its word. */
#ifndef EW_PROVE_RUNS_H
#define EW_PROVE_RUNS_H

#include "edgewalk/raster_work.h"

/*@ assigns \result \from limit->scale, limit->fall, limit->longest, limit->tolerance, limit->down, w, n;
    ensures run_length: 0 <= \result <= 256; */
static inline int32_t ew_run_next(const ew_run_limit *limit, uint32_t w, int32_t n);
/*@ assigns \result \from limit->scale, limit->fall, limit->longest, limit->tolerance, limit->down, w;
    ensures run_length: 0 <= \result <= 256; */
static inline int32_t ew_run_first(const ew_run_limit *limit, uint32_t w);

/* The part of a triangle that run.h reads. */
static inline void any_runs(ew_triangle *t)
{
    t->longest = (uint16_t)Frama_C_unsigned_short_interval(0, 256);
    t->run_tolerance = (uint16_t)Frama_C_unsigned_short_interval(0, 256);
    t->run_exponent = (int16_t)Frama_C_short_interval(-100, 100);
    t->run_shift = (uint8_t)Frama_C_unsigned_char_interval(0, 31);
    t->rung = (uint8_t)Frama_C_unsigned_char_interval(1, 8);
}

#endif
