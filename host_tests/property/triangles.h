/* Random triangles of the kinds that break rasterizers. */
#ifndef EW_TEST_TRIANGLES_H
#define EW_TEST_TRIANGLES_H

#include "edgewalk/raster.h"

typedef enum triangle_kind {
    KIND_ORDINARY,  /* anywhere in and a little around the picture, on grids of 1/4096 px to 1 px */
    KIND_SLIVER,    /* two sides nearly one: up to 1/256 px apart, any direction and length         */
    KIND_ONE_PIXEL, /* around one pixel's centre                                                    */
    KIND_ZERO_AREA, /* of no area once snapped                                                      */
    KIND_TINY,      /* under a pixel                                                                */
    KIND_HUGE,      /* out to the guard band                                                        */
    KIND_AXIS,      /* edges along rows and columns                                                 */
    KIND_CENTRES,   /* corners on pixel centres                                                     */
    KIND_THROUGH,   /* edges through pixel centres, corners elsewhere                               */
    KIND_COUNT
} triangle_kind;

extern const char *const triangle_kind_name[KIND_COUNT];

/* x and y of three corners, for a picture of that size; the rest is left. */
void triangle_place(ew_raster_vertex v[3], triangle_kind kind, int width, int height);

/* The corners as the contract snaps them: floor(2^S x + 1/2), by integer division. */
void triangle_snapped(int64_t sx[3], int64_t sy[3], const ew_raster_vertex v[3]);

/* The triangle as a row of a list of cases: static memory, until the next call. */
const char *triangle_row(const ew_raster_vertex v[3]);

/* Remembers the triangle as the case at hand, ready to be pasted into a list of cases. */
void triangle_context(const char *what, long number, const ew_raster_vertex v[3]);

#endif
