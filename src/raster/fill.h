/* Pixels of a run: what every combination of material, texture and target goes through
 * (private to the raster layer). */
#ifndef EW_RASTER_FILL_H
#define EW_RASTER_FILL_H

#include "edgewalk/raster.h"

/* The colours of the piece's n pixels become one. */
void ew_piece_paint(ew_piece *piece, const ew_target *target, uint16_t rgb565);

/* A rectangle inside the target in one colour; where `depth`, the target's, is not NULL it
 * becomes 0 there. Uses work.now.span.fill.any.piece. */
void ew_raster_fill(ew_raster *raster, const ew_rect *r, uint16_t rgb565, uint16_t *depth);

/* Draws n pixels. The run is used up: it moves along. */
void ew_fill_any(ew_raster *raster, ew_run *run, int32_t n);

#if EW_TRACE
/* u or v as ew_trace_fragment has it. */
ew_q20_12 ew_texture_traced(uint64_t u, uint32_t size, int wrap);
#endif

#endif
