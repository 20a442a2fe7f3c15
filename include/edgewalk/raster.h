/* edgewalk/raster.h - triangles into a caller's colour and depth memory.
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
 *   - Texel i covers [i, i + 1); nearest is floor(u). Centres are at i + 1/2.
 *
 * What every fill makes of a pixel, to the bit: docs/fills.md. A part of them that
 * config.h left out is refused with EW_ERR_UNSUPPORTED.
 */
#ifndef EW_RASTER_H
#define EW_RASTER_H

#include <stddef.h>
#include <stdint.h>

#include "error.h"
#include "fixed.h"
#include "raster_work.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EW_TARGET_MAX = 4096,   /* pixels across and down                                      */
    EW_TEXTURE_MAX = 2048,  /* texels across and down                                      */
    EW_LEVELS_MAX = 12,     /* of a mip chain: 2048 to 1                                   */
    EW_TOLERANCE_MAX = 256  /* 16 px                                                       */
};
/* Screen positions: |x|, |y| <= 2^17 px. Not an enumerator: int may have 16 bits. */
#define EW_GUARD_PX INT32_C(131072)

/* How a target keeps a pixel. Of the packed ones, the left pixel is in a byte's high bits. */
typedef enum ew_target_format {
    EW_TARGET_RGB565 = 0,  /* uint16_t in the machine's byte order                        */
    EW_TARGET_RGB565_SWAPPED, /* the same with the bytes exchanged                         */
    EW_TARGET_RGB332,      /* a byte each                                                 */
    EW_TARGET_GREY8,
    EW_TARGET_GREY4,       /* two to a byte                                               */
    EW_TARGET_MONO         /* eight to a byte, 1 is white                                 */
} ew_target_format;

typedef struct ew_target {
    void *colour;     /* rows of `stride` pixels; 16-bit formats are aligned as uint16_t  */
    uint16_t *depth;  /* the same shape, or NULL: no depth test and no depth written      */
    uint16_t width, height; /* 1 to 4096                                                  */
    uint16_t stride;  /* pixels from one row to the next, of both; at least width, and
                         whole bytes: a multiple of 2 for EW_TARGET_GREY4, of 8 for _MONO */
    uint8_t format;   /* ew_target_format                                                 */
    uint8_t dither;   /* 1: ordered 8 x 8 dither, by position in the picture              */
    uint16_t first_row; /* the row of the whole picture that the memory begins with, 0 unless
                          the target is a band of it; with the height, at most 4096. Whatever
                          is said of rows elsewhere counts those of the picture           */
} ew_target;

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct ew_rect {
    uint16_t x0, y0, x1, y1;
} ew_rect;

/* How a texture keeps a texel. Of the packed ones, the left texel is in a byte's high bits,
 * and a row begins with a new byte. */
typedef enum ew_texture_format {
    EW_TEXTURE_RGB565 = 0, /* uint16_t in the machine's byte order                        */
    EW_TEXTURE_RGB332,     /* a byte each                                                 */
    EW_TEXTURE_GREY8,
    EW_TEXTURE_PALETTE8,   /* numbers of palette entries, a byte each                     */
    EW_TEXTURE_PALETTE4,   /* two to a byte                                               */
    EW_TEXTURE_PALETTE1    /* eight to a byte                                             */
} ew_texture_format;

/* What lies outside of [0, size), for u and v each. */
typedef enum ew_wrap {
    EW_WRAP_REPEAT = 0,
    EW_WRAP_CLAMP,  /* the border's texel                                                 */
    EW_WRAP_MIRROR  /* forth and back                                                     */
} ew_wrap;

typedef struct ew_texture {
    const void *texels;     /* rows from the top, `width` to a row; level after level, each
                               max(1, size >> level) wide and high; RGB565 aligned as uint16_t */
    uint16_t width, height; /* of the first level, 1 to 2048                              */
    const uint16_t *palette; /* RGB565: 256, 16 or 2 entries; for palette formats only    */
    const uint8_t *mask;    /* with EW_ALPHA_MASK only: a bit per texel, 1 is drawn; rows and
                               levels lie as those of EW_TEXTURE_PALETTE1                 */
    uint16_t key;           /* with EW_COLOUR_KEY: the stored value that is left out       */
    uint8_t format;         /* ew_texture_format                                          */
    uint8_t wrap_u, wrap_v; /* ew_wrap                                                    */
    uint8_t levels;         /* of the mip chain; 0 and 1: the texture alone. At most down to
                               the level of 1 x 1                                         */
} ew_texture;

/* How a colour is taken from texels. With more levels than one, the level comes from the
 * screen-space derivatives of u and v. */
typedef enum ew_filter {
    EW_FILTER_NEAREST = 0, /* the nearest texel of the nearest level                      */
    EW_FILTER_BILINEAR,    /* four texels of the nearest level                             */
    EW_FILTER_TRILINEAR    /* four texels of each of two neighbouring levels               */
} ew_filter;

/* What becomes of a colour and the one that stands in the target, per channel. */
typedef enum ew_blend {
    EW_BLEND_NONE = 0, /* the new one                                                     */
    EW_BLEND_HALF,     /* half of both                                                    */
    EW_BLEND_ADD       /* the sum, at most the channel's largest value                    */
} ew_blend;

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
    EW_SHADED = 8,         /* texture or material colour, times the corners' colours       */
    EW_COLOUR_KEY = 16,    /* leave out texels that equal texture->key: no colour, no depth */
    EW_ALPHA_MASK = 32,    /* leave out texels whose bit in texture->mask is 0             */
    EW_FOG = 64            /* towards the context's fog colour with distance               */
};

typedef struct ew_material {
    const ew_texture *texture; /* NULL: `colour` alone                                     */
    uint16_t colour;           /* RGB565                                                   */
    uint16_t tolerance;        /* 1/16 px, 0 = exact, at most EW_TOLERANCE_MAX: how far from its
                                  pixel's centre an attribute may have been taken          */
    uint8_t rung;              /* ew_rung                                                  */
    uint8_t flags;             /* EW_DOUBLE_SIDED ...; those of textures mean nothing without one */
    uint8_t blend;             /* ew_blend                                                 */
    uint8_t filter;            /* ew_filter                                                */
} ew_material;

/* A colour, or how much of each channel a light leaves: 255 is all of it. */
typedef struct ew_colour888 {
    uint8_t r, g, b;
} ew_colour888;

/* A corner, after projection. */
typedef struct ew_raster_vertex {
    ew_q20_12 x, y;  /* px, |x|, |y| <= EW_GUARD_PX                                        */
    ew_uq1_31 w;     /* near/z, 0 < w <= 2^31                                              */
    ew_q20_12 u, v;  /* texels, |u| and |v| below 2^18; within 32,768 of the other corners  */
    ew_colour888 colour; /* with EW_SHADED only                                            */
} ew_raster_vertex;

/* One drawing context. Plain memory of the caller's; two of them share nothing. Fields
 * may be read; change them only through the functions. */
typedef struct ew_raster {
    ew_target target;
    ew_rect scissor;
    ew_material material;
    ew_texture texture; /* copy of *material.texture; texels are NULL and the size is 1 x 1 without */
    uint32_t inverse_width, inverse_height; /* floor(2^32 / size); 0 for 1                 */
    ew_uq1_31 fog_near, fog_far;
    uint32_t fog_scale; /* ceil(2^31 / ((fog_near - fog_far) >> fog_shift))                */
    uint16_t fog_colour;
    uint8_t fog_shift;
    uint8_t log2_width, log2_height; /* of the texture, rounded up                         */
    uint16_t shortest_run; /* px: below that a pixel each is cheaper (ew_raster_set_cost)  */
    uint8_t loop; /* what draws the material: src/raster/loops.h                         */
    ew_raster_work work; /* the layer's own; no field of it means anything between calls   */
} ew_raster;

/* Copies *target; the scissor is the whole of it, the material black and constant, and
 * there is no fog. Returns EW_OK, EW_ERR_ARGUMENT or EW_ERR_UNSUPPORTED. */
int ew_raster_init(ew_raster *raster, const ew_target *target);

/* Limits drawing and clearing to a rectangle, which may be empty. Returns EW_OK, or
 * EW_ERR_ARGUMENT for one that leaves the target or is inside out. */
int ew_raster_set_scissor(ew_raster *raster, const ew_rect *rect);

/* Goes to other rows of the same picture: memory for `height` of them from `first_row` on, as in
 * ew_target. The scissor is then all of these rows and its columns are what they were; everything
 * else stays. Returns EW_OK; EW_ERR_ARGUMENT as ew_raster_init, and where one has depth and the
 * other has none. */
int ew_raster_set_rows(ew_raster *raster, void *colour, uint16_t *depth, uint16_t first_row, uint16_t height);

/* Copies *material and the texture's description, not its texels, palette or mask. The
 * constant rung takes no texture. Returns EW_OK, or EW_ERR_ARGUMENT or EW_ERR_UNSUPPORTED,
 * and then the material is unchanged. */
int ew_raster_set_material(ew_raster *raster, const ew_material *material);

/* Fog for materials with EW_FOG: none at near/z >= w_near, nothing but `rgb565` at near/z <=
 * w_far, linear in near/z between. Returns EW_OK, EW_ERR_ARGUMENT unless w_far < w_near <=
 * 2^31, or EW_ERR_UNSUPPORTED. */
int ew_raster_set_fog(ew_raster *raster, uint16_t rgb565, ew_uq1_31 w_near, ew_uq1_31 w_far);

/* What the automatic choice between runs and single pixels goes by, in instructions of a
 * target: a run takes `run` and `run_pixel` for each of its pixels, a pixel of its own takes
 * `pixel`. It depends on nothing else, so pictures drawn with equal costs are equal bit for
 * bit on every target. Fields are at least 1, and `pixel` is above `run_pixel`. */
typedef struct ew_cost {
    uint16_t run, run_pixel, pixel;
} ew_cost;

/* From `make count` (src/raster/cost.c); the generic one, which ew_raster_init sets, lies between them. */
extern const ew_cost ew_cost_generic, ew_cost_m0plus, ew_cost_m3, ew_cost_host;

/* Returns EW_OK or EW_ERR_ARGUMENT. */
int ew_raster_set_cost(ew_raster *raster, const ew_cost *cost);

/* Fills the scissor rectangle with a colour, converted and dithered as drawn ones are, and
 * its depth with 0. */
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

/* ---- a triangle some rows at a time ----
 *
 * ew_raster_begin sets a triangle up as ew_raster_triangle_in_range does; its first row is the
 * scissor's first or a later one, and its last one lies above `end`, which may be below the
 * scissor. Then either ew_raster_draw_begun draws what of it lies in the scissor, or
 * ew_raster_keep moves it into memory of the caller's, for ew_raster_draw_active to go on with: each
 * call draws what of the rest lies in the scissor, whose rows must begin with the triangle's next
 * one. The material has to be that of the set-up, the scissor's columns, too. However a
 * triangle is cut into rows, its pixels are those of ew_raster_triangle. */

/* Returns 1, 0 when there is nothing to draw, or EW_ERR_RANGE as ew_raster_triangle. */
int ew_raster_begin(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c,
                    uint16_t end);

/* The first row below the triangle that ew_raster_begin made ready, or `end`. */
static inline uint16_t ew_raster_begun_end(const ew_raster *raster) { return (uint16_t)raster->work.corners.end; }

/* Draws it without keeping it. Returns whether a pixel was reached. */
int ew_raster_draw_begun(ew_raster *raster);

/* What it takes to keep raster->work.triangle, or took to keep active->triangle: a multiple of 8, at
 * most sizeof(ew_active). */
size_t ew_active_bytes(const ew_triangle *triangle);

/* Keeps it, once, before it is drawn. `active` has that room and the alignment of an ew_active. */
void ew_raster_keep(ew_raster *raster, ew_active *active);

/* Returns whether a pixel was reached. It is done when active->row is active->end. */
int ew_raster_draw_active(ew_raster *raster, ew_active *active);

/* The same for those of a list with a number below `number`, all of one material. From the scissor that
 * was set when a triangle was kept, each must begin where the one before ended. What is done is taken out
 * of the list and put in front of list->ended, which is EW_NO_PLACE or a list already. */
void ew_raster_draw_list(ew_raster *raster, ew_active_list *list, uint32_t number);

/* The same row by row and column by column, for who finds out what is seen on a row and draws nothing
 * else: ew_raster_find_span says where the scissor's one row lies in its columns, ew_raster_draw_columns
 * draws columns of that, cut there as a scissor cuts, on a target without depth; both as often as it
 * takes. ew_active_step goes on to the next row. */

/* Returns whether there is a pixel: not above the triangle's first row, which may lie below. */
int ew_raster_find_span(const ew_raster *raster, ew_active *active, ew_active_span *span);

/* Columns from <= x < to. */
void ew_raster_draw_columns(ew_raster *raster, const ew_active *active, uint16_t from, uint16_t to);

/* From the scissor's row, after ew_raster_find_span there. */
void ew_active_step(ew_active *active);

#if EW_TRACE
/* For tests: what was set up, and every fragment before its depth test. u and v are modulo
 * the texture's period (twice its size where it is mirrored; clamped ones are whole) and
 * meaningful with a texture only. Defined by whoever builds with EW_TRACE = 1. */
void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c,
                       int rung);
void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t depth, ew_q20_12 u, ew_q20_12 v);
#endif

#ifdef __cplusplus
}
#endif

#endif
