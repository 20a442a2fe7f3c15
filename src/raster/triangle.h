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
    EW_LONGEST_RUN = 256,
    EW_LONGEST_PIECE = 512 /* of a span, run after run: depth's steps lose 1/32 unit over it */
};
#define EW_FRACTION(bits) (39 - (bits))

/* Whether fill_pixels (span.c) may draw a triangle's spans: never, for its material or
 * target; where 1/z at the span's ends stays inside depth's range; or everywhere. */
enum { PLAIN_NEVER, PLAIN_SOMETIMES, PLAIN_ALWAYS };

/* How its rows are walked (span.c): by ew_rows_of_any; textured and plain, by ew_rows_of_texture; if the table's
 * reciprocal will do for its runs, too, by ew_rows_of_runs where arch.h has machine code for it; if u, v and depth
 * are linear over the whole triangle, by ew_rows_packed. */
enum { WALK_ANY, WALK_TEXTURE, WALK_RUNS, WALK_PACKED };

/* What the loop of span.c needs to know of raster->texture. */
void ew_packing_init(ew_packing *packing, const ew_raster *raster);

/* Rungs, planes and shifts of work.triangle; planes stand on work.corners.first. Returns EW_OK
 * or EW_ERR_RANGE. */
int ew_setup(ew_raster *raster);

/* Makes planes packed ones. */
void ew_planes_pack(ew_triangle *t, const ew_packing *packing);

/* Takes planes some columns to the right and rows down. */
void ew_planes_go(ew_triangle *t, uint32_t columns, uint32_t rows);

/* Draw rows from `row` to below `end`, one at least, of a triangle whose edges and planes stand on `row`, cut to
 * the scissor in x, and step both. Return other than 0 when a pixel was reached. The last is for all
 * triangles, which must be raster->work's. */
int ew_rows_of_texture(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end);
int ew_rows_of_runs(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end);
int ew_rows_packed(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end);
int ew_rows_of_any(ew_raster *raster, int32_t row, int32_t end);

#endif
