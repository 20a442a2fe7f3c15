/* A standard scene (host_tests/reference/scenes.h) held against the referee. */
#ifndef EW_STANDARD_MEASURE_H
#define EW_STANDARD_MEASURE_H

#include "measure.h"

/* Draws the scene of that letter, 'A' to 'E', with the standard texture into `target`, which is
 * STANDARD_WIDTH x STANDARD_HEIGHT and cleared to `background` here, and judges it. `cost` is
 * for the automatic choice, NULL the generic one. Returns 0 or an error of the core. */
int measure_standard(char name, ew_rung rung, uint16_t tolerance, const ew_cost *cost, const ew_target *target,
                     uint16_t background, measures *result);

#endif
