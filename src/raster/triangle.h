/* A triangle made ready for its spans (private to the raster layer).
 *
 * 1/z is scaled to the triangle: w' = w 2^(lead - 1) has its largest corner value between a
 * third and two thirds of 2^31. Attributes (u, v, shades) are differences from corner 0; to
 * be linear on the screen they are multiplied by w', a' = d w' / 2^(3 + bits), where all
 * differences d are below 2^bits units of q20.12: |a'| < w'/8. Divided by w' again,
 * a' 2^30 / w' = d 2^(27 - bits): fraction bits FRACTION(bits) = 39 - bits, 12 to 20.
 */
#ifndef EW_RASTER_TRIANGLE_H
#define EW_RASTER_TRIANGLE_H

#include "edge.h"
#include "edgewalk/raster.h"

enum {
    EW_BITS_LEAST = 19, EW_BITS_MOST = 27, /* of attribute differences: 128 to 32,768 texels */
    EW_SHADE_BITS = 21,                    /* a shade's: 256 units of 1                      */
    EW_LONGEST_RUN = 256
};
#define EW_FRACTION(bits) (39 - (bits))

/* Whether fill_textured (span.c) may draw a triangle's spans: never, for its material or
 * target; where 1/z at the span's ends stays inside depth's range; or everywhere. */
enum { PLAIN_NEVER, PLAIN_SOMETIMES, PLAIN_ALWAYS };

/* Rungs, planes and shifts of work.triangle; planes stand on work.corners.first. Returns EW_OK
 * or EW_ERR_RANGE. */
int ew_setup(ew_raster *raster);

/* Draws rows from `row` to below `end` of a triangle whose edges and planes stand on `row`, cut to
 * the scissor in x, and steps both. Unless it is quick, t and edge are those of raster->work.
 * Returns whether a pixel was reached. */
int ew_walk_rows(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end);

#endif
