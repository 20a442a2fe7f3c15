/* A triangle made ready for its spans (private to the raster layer). */
#ifndef EW_RASTER_TRIANGLE_H
#define EW_RASTER_TRIANGLE_H

#include "edgewalk/raster.h"

/* A quantity that is linear on the screen, as a fraction of 2^64 that wraps: a 32-bit
 * value fills the upper half. Gradients of slivers may exceed the range many times over;
 * since sums wrap too, values inside the triangle still come out right. */
typedef struct ew_plane {
    uint64_t row;    /* at the centre of pixel (column, current row)      */
    uint64_t dx, dy; /* for one pixel to the right, for one row down      */
    uint32_t step;   /* dx as 32 bits, rounded                            */
} ew_plane;

typedef struct ew_triangle {
    ew_plane w;      /* near/z as uq1.31 in the upper half                */
    ew_plane u, v;   /* u/z and v/z, or u and v (affine), from corner 0   */
    int32_t column;  /* the pixel column that `row` values belong to: inside the scissor */
    uint32_t u_base, v_base; /* u and v of the first corner, top-aligned (span.c) */
    uint32_t run_floor; /* runs of 2^k pixels need 1/z >= run_floor 4^k   */
    uint8_t rung;    /* never EW_RUNG_AUTO                                */
    uint8_t newton;  /* whether runs need the better reciprocal           */
    uint8_t plain;   /* PLAIN_NEVER, PLAIN_SOMETIMES, PLAIN_ALWAYS        */
    uint8_t w_lead;  /* zero bits above every w of the triangle, at most 24 */
    uint8_t u_shift, v_shift; /* left shifts that align u and v at the top, 1 to 20 */
} ew_triangle;

/* Whether fill_textured (span.c) may draw a triangle's spans: never, for its material or
 * target; where 1/z at the span's ends stays inside depth's range; or everywhere. */
enum { PLAIN_NEVER, PLAIN_SOMETIMES, PLAIN_ALWAYS };

/* Draws n pixels from (x, y); u and v from the triangle's planes at its current row. */
void ew_span(const ew_raster *raster, const ew_triangle *triangle, int32_t x, int32_t y, int32_t n);

#endif
