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
    uint64_t u, du, v, dv; /* texels, q32.32; du and dv modulo the texture's period would do
                              but for mip chains                                            */
    uint64_t u_down, v_down; /* du/dy and dv/dy at the first pixel, q32.32 per pixel, with mip
                                chains only: the level of EW_PIECE pixels comes from du, dv,
                                u_down, v_down                                               */
    int32_t shade[3], dshade[3]; /* red, green, blue, with EW_SHADED only: 2^24 is all of a channel.
                                    Half a step, 2^15, is added already; what lies outside of
                                    [0, 2^24] is clamped                                     */
} ew_run;

enum { EW_PIECE = 8 };

/* A piece of a run on its way to the target. Channels have 12 bits. */
typedef struct ew_piece {
    uint16_t x, y;
    int n;         /* pixels, at most EW_PIECE                                             */
    uint8_t live;  /* bit i: pixel i is drawn                                              */
    uint16_t colour[EW_PIECE][3];
} ew_piece;

/* Draws n pixels. The run is used up: it moves along. */
void ew_fill_any(const ew_raster *raster, ew_run *run, int32_t n);

#if EW_TRACE
/* u or v as ew_trace_fragment has it. */
ew_q20_12 ew_texture_traced(uint64_t u, uint32_t size, int wrap);
#endif

#endif
