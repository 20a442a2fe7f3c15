/* Pixels of a run: what every combination of material, texture and target goes through
 * (private to the raster layer). */
#ifndef EW_RASTER_FILL_H
#define EW_RASTER_FILL_H

#include "edgewalk/raster.h"

/* A run: a piece of a span over which everything is linear. Values belong to its first
 * pixel, steps lead to the next; sums wrap and are only meaningful inside the run. */
typedef struct ew_run {
    uint16_t x, y;         /* of the first pixel                                           */
    uint32_t w, dw;        /* near/z, uq1.31                                               */
    uint64_t u, du, v, dv; /* texels, q32.32                                               */
    int32_t shade[3], dshade[3]; /* red, green, blue, with EW_SHADED only: 2^24 is all of a channel */
} ew_run;

/* Draws n pixels. */
void ew_fill_any(const ew_raster *raster, const ew_run *run, int32_t n);

#endif
