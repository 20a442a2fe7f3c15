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
    EW_ATTRIBUTES = 5                      /* u, v, red, green, blue                         */
};
#define EW_FRACTION(bits) (39 - (bits))

/* A quantity that is linear on the screen. Narrow triangles have 32 bits of it, all others
 * 64 as a fraction that wraps, the 32 bits in the upper half: gradients of slivers may
 * exceed the range many times over; since sums wrap too, values inside the triangle still
 * come out right. */
typedef struct ew_plane32 {
    uint32_t row;    /* at the centre of pixel (column, current row)      */
    uint32_t dx, dy; /* for one pixel to the right, for one row down      */
} ew_plane32;
typedef struct ew_plane64 {
    uint64_t row, dx, dy;
} ew_plane64;

enum { EW_PLANE_W, EW_PLANE_U, EW_PLANE_V, EW_PLANE_SHADE, EW_PLANES = 1 + EW_ATTRIBUTES };

typedef struct ew_triangle {
    union {
        ew_plane32 narrow[EW_PLANES];
        ew_plane64 wide[EW_PLANES];
    } plane; /* 1/z, then the attributes                              */
    int32_t column; /* the pixel column that `row` values belong to: inside the scissor and the
                       triangle's box */
    uint32_t u_base, v_base;    /* u and v of corner 0, top-aligned (span.c)     */
    ew_q20_12 u_origin, v_origin; /* the same in texels                          */
    int32_t shade_origin[3];    /* corner 0's, 2^24 is all                       */
    uint16_t run_scale;         /* of run_length in span.c                       */
    int16_t run_exponent;
    uint16_t run_tolerance;     /* 1/16 px, 0 for runs of fixed length           */
    uint16_t longest, shortest; /* run, px                                       */
    uint8_t run_shift;          /* -run_exponent, 0 to 31: of one_run_suffices   */
    uint8_t attributes;         /* how many planes follow that of w: 0, 2, 5     */
    uint8_t is_wide;
    uint8_t is_quick;           /* rows_of_texture (span.c) will do              */
    uint8_t rung;               /* never EW_RUNG_AUTO                            */
    uint8_t newton;             /* whether the better reciprocal is needed       */
    uint8_t plain;              /* PLAIN_NEVER, PLAIN_SOMETIMES, PLAIN_ALWAYS    */
    uint8_t w_lead;             /* 0 to 24: see above                            */
    uint8_t uv_bits;            /* EW_BITS_LEAST to EW_BITS_MOST                 */
    uint8_t u_shift, v_shift;   /* left shifts that align u and v at the top, 1 to 20 */
} ew_triangle;

/* Whether fill_textured (span.c) may draw a triangle's spans: never, for its material or
 * target; where 1/z at the span's ends stays inside depth's range; or everywhere. */
enum { PLAIN_NEVER, PLAIN_SOMETIMES, PLAIN_ALWAYS };

/* A triangle's corners, snapped, and where it lies. */
typedef struct ew_corners {
    const ew_raster_vertex *v[3];
    ew_snapped x[3], y[3];
    int positive;                    /* the snapped area's sign                    */
    int32_t first, end, from, to;    /* rows and columns of its box in the scissor */
} ew_corners;

/* Rungs, planes and shifts; planes stand on corners->first. Returns EW_OK or EW_ERR_RANGE. */
int ew_setup(ew_triangle *t, const ew_raster *raster, const ew_corners *corners);

/* Draws rows from `row` to below `end`, cut to the scissor in x, and steps edges and planes.
 * Returns whether a pixel was reached. */
int ew_walk_rows(const ew_raster *raster, ew_triangle *t, ew_edge *left, ew_edge *right, int32_t row, int32_t end);

#endif
