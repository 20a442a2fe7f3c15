/* Pixels of a run: what every combination of material, texture and target goes through
 * (private to the raster layer). */
#ifndef EW_RASTER_FILL_H
#define EW_RASTER_FILL_H

#include "edgewalk/raster.h"



/* Draws n pixels. The run is used up: it moves along. */
void ew_fill_any(ew_raster *raster, ew_run *run, int32_t n);

#if EW_TRACE
/* u or v as ew_trace_fragment has it. */
ew_q20_12 ew_texture_traced(uint64_t u, uint32_t size, int wrap);
#endif

#endif
