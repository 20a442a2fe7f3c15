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
} ew_plane;

typedef struct ew_triangle {
    ew_plane w;      /* near/z as uq1.31 in the upper half                */
    ew_plane u, v;   /* see ew_uv_form                                    */
    int32_t column;  /* the pixel column that `row` values belong to      */
    ew_q20_12 u_base, v_base; /* u and v of the first corner              */
    uint8_t rung;    /* never EW_RUNG_AUTO                                */
    uint8_t w_lead;  /* zero bits above every w of the triangle           */
    uint8_t uv_shift; /* right shift that ends at q20.12                  */
} ew_triangle;

/* Draws n pixels from (x, y); u and v from the triangle's planes at its current row. */
void ew_span(const ew_raster *raster, const ew_triangle *triangle, int32_t x, int32_t y, int32_t n);

#endif
