/* edgewalk/raster.h - triangles into a caller's RGB565 and depth memory.
 *
 * Conventions (all of them, with their reasons, in docs/conventions.md):
 *   - x grows to the right, y downwards; the centre of pixel (i, j) is (i + 1/2, j + 1/2).
 *   - A pixel belongs to a triangle when its centre lies inside, or on a left or a top
 *     edge, of the triangle of the *snapped* vertices: floor(2^S x + 1/2) with
 *     S = EW_SUBPIXEL_BITS. Triangles that share an edge share no pixel and leave none out.
 *   - Fronts appear counter-clockwise: their doubled area
 *     (x1 - x0)(y2 - y0) - (x2 - x0)(y1 - y0) is negative. Zero area covers nothing.
 *   - Depth is clamp(floor(65536 near/z), 1, 65535): larger is nearer, 0 is the cleared
 *     buffer, and a fragment wins if it is strictly greater.
 *   - Texel i covers [i, i + 1); nearest is floor(u). Textures repeat.
 */
#ifndef EW_RASTER_H
#define EW_RASTER_H

#include <stddef.h>
#include <stdint.h>

#include "error.h"
#include "fixed.h"

enum {
    EW_TARGET_MAX = 4096,   /* pixels across and down                                      */
    EW_TEXTURE_MAX = 2048,  /* texels across and down                                      */
    EW_TOLERANCE_MAX = 256  /* 16 px                                                       */
};
/* Screen positions: |x|, |y| <= 2^17 px. Not an enumerator: int may have 16 bits. */
#define EW_GUARD_PX INT32_C(131072)

typedef struct ew_target {
    uint16_t *colour; /* RGB565                                                           */
    uint16_t *depth;  /* the same shape, or NULL: no depth test and no depth written      */
    uint16_t width, height; /* 1 to 4096                                                  */
    uint16_t stride;  /* elements from one row to the next, of both; at least width       */
} ew_target;

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct ew_rect {
    uint16_t x0, y0, x1, y1;
} ew_rect;

typedef struct ew_texture {
    const void *texels;     /* uint16_t RGB565, rows from the top, `width` to a row        */
    uint16_t width, height; /* 1 to 2048, powers of two                                   */
} ew_texture;

/* How a triangle's u and v are found: the ladder. */
typedef enum ew_rung {
    EW_RUNG_AUTO = 0,  /* the cheapest of the others that keeps the material's tolerance    */
    EW_RUNG_AFFINE,    /* linear on the screen                                              */
    EW_RUNG_RUNS,      /* linear in runs, as long as the material's tolerance allows         */
    EW_RUNG_TABLE,     /* a table reciprocal for each pixel                                 */
    EW_RUNG_EXACT,     /* the same with a Newton step                                       */
    EW_RUNG_CONSTANT,  /* the material's colour: what is drawn without a texture            */
    EW_RUNG_RUNS_8, EW_RUNG_RUNS_16, EW_RUNG_RUNS_32, /* linear in runs of that many pixels,
                          whatever it costs in accuracy: for comparison                     */
    EW_RUNG_COUNT
} ew_rung;

enum {
    EW_DOUBLE_SIDED = 1,   /* do not cull back faces                                       */
    EW_NO_DEPTH_TEST = 2,  /* every fragment wins                                          */
    EW_NO_DEPTH_WRITE = 4,
    EW_SHADED = 8          /* multiply by the corners' colours: not drawn yet, refused     */
};

typedef struct ew_material {
    const ew_texture *texture; /* NULL: `colour` alone                                     */
    uint16_t colour;           /* RGB565                                                   */
    uint16_t tolerance;        /* 1/16 px, 0 = exact, at most EW_TOLERANCE_MAX: how far from its
                                  pixel's centre an attribute may have been taken          */
    uint8_t rung;              /* ew_rung                                                  */
    uint8_t flags;             /* EW_DOUBLE_SIDED ...                                      */
} ew_material;

/* A colour, or how much of each channel a light leaves: 255 is all of it. */
typedef struct ew_colour888 {
    uint8_t r, g, b;
} ew_colour888;

/* A corner, after projection. */
typedef struct ew_raster_vertex {
    ew_q20_12 x, y;  /* px, |x|, |y| <= EW_GUARD_PX                                        */
    ew_uq1_31 w;     /* near/z, 0 < w <= 2^31                                              */
    ew_q20_12 u, v;  /* texels                                                            */
    ew_colour888 colour; /* with EW_SHADED only                                            */
} ew_raster_vertex;

/* One drawing context. Plain memory of the caller's; two of them share nothing. Fields
 * may be read; change them only through the functions. */
typedef struct ew_raster {
    ew_target target;
    ew_rect scissor;
    ew_material material;
    ew_texture texture; /* copy of *material.texture                                       */
    uint8_t log2_width, log2_height; /* of the texture                                     */
} ew_raster;

/* Copies *target; the scissor is the whole of it, the material black and constant. Returns
 * EW_OK or EW_ERR_ARGUMENT. */
int ew_raster_init(ew_raster *raster, const ew_target *target);

/* Limits drawing and clearing to a rectangle, which may be empty. Returns EW_OK, or
 * EW_ERR_ARGUMENT for one that leaves the target or is inside out. */
int ew_raster_set_scissor(ew_raster *raster, const ew_rect *rect);

/* Copies *material and the texture's description, not its texels. Returns EW_OK or
 * EW_ERR_ARGUMENT. */
int ew_raster_set_material(ew_raster *raster, const ew_material *material);

/* Fills the scissor rectangle with a colour and its depth with 0. */
void ew_raster_clear(ew_raster *raster, uint16_t rgb565);

/* Draws one triangle. Corners are taken in order for orientation; their order changes
 * neither coverage nor depth by more than rounding.
 * Returns 1 when it was drawn, 0 when it faces away, has no area or covers no pixel
 * centre inside the scissor, or EW_ERR_RANGE when a corner is outside the ranges of
 * ew_raster_vertex or two corners are more than 32,768 texels apart. */
int ew_raster_triangle(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b,
                       const ew_raster_vertex *c);

/* The same for corners that are in range already, as those of the geometry layer are: that
 * is the caller's promise, and not checked. */
int ew_raster_triangle_in_range(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b,
                                const ew_raster_vertex *c);

#if EW_TRACE
/* For tests: what was set up, and every fragment before its depth test. u and v are modulo
 * the texture's size and meaningful with a texture only. Defined by whoever builds with EW_TRACE = 1. */
void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c,
                       int rung);
void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t depth, ew_q20_12 u, ew_q20_12 v);
#endif

#endif
