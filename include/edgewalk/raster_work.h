/* edgewalk/raster_work.h - the raster layer's own; nothing for users.
 *
 * What the layer works with while it draws a triangle. It lies in the caller's context and
 * not on the stack, which stays below 512 bytes; nothing in it outlives a call, but for `packing`.
 */
#ifndef EW_RASTER_WORK_H
#define EW_RASTER_WORK_H

#include <stddef.h>
#include <stdint.h>

#include "fixed.h"

struct ew_raster_vertex;
struct ew_texture;

/* ---- set-up (setup.c, triangle.h) ---- */

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

enum {
    EW_ATTRIBUTES = 5, /* u, v, red, green, blue                                          */
    EW_PLANE_W = 0, EW_PLANE_U, EW_PLANE_V, EW_PLANE_SHADE, EW_PLANES = 1 + EW_ATTRIBUTES
};

/* What is read most lies within short offsets. What follows the planes is for generic fills
 * only: ew_active leaves it out where it can. */
typedef struct ew_triangle {
    uint16_t run_scale;         /* of run.h                                      */
    int16_t run_exponent;
    uint16_t run_tolerance;     /* 1/16 px, 0 for runs of fixed length           */
    uint16_t longest, shortest; /* run, px                                       */
    uint16_t sure_run;          /* spans up to so many pixels are filled in one go */
    uint16_t column; /* the pixel column that `row` values belong to: inside the scissor and the
                        triangle's box */
    uint8_t run_shift;          /* -run_exponent, 0 to 31: of ew_one_run_suffices */
    uint8_t attributes;         /* how many planes follow that of w: 0, 2, 5     */
    uint8_t is_wide;
    uint8_t walk;               /* WALK_ANY to WALK_PACKED                      */
    uint8_t rung;               /* never EW_RUNG_AUTO                            */
    uint8_t newton;             /* whether the better reciprocal is needed       */
    uint8_t plain;              /* PLAIN_NEVER, PLAIN_SOMETIMES, PLAIN_ALWAYS    */
    uint8_t w_lead;             /* 0 to 24: src/raster/triangle.h                */
    uint8_t uv_bits;            /* EW_BITS_LEAST to EW_BITS_MOST                 */
    uint8_t u_shift, v_shift;   /* left shifts that align u and v at the top, 1 to 20 */
    uint32_t u_base, v_base;    /* u and v of corner 0, top-aligned (span.c)     */
    union {
        ew_plane32 narrow[EW_PLANES];
        ew_plane64 wide[EW_PLANES];
    } plane; /* 1/z, then the attributes; WALK_PACKED: u and v are packed (span.c) */
    ew_q20_12 u_origin, v_origin; /* u and v of corner 0 in texels               */
    int32_t shade_origin[3];    /* its shades, 2^24 is all                       */
} ew_triangle;

/* A triangle's corners, snapped, and where it lies. */
typedef struct ew_corners {
    const struct ew_raster_vertex *v[3];
    ew_snapped x[3], y[3];
    int32_t first, end, from, to;    /* rows and columns of its box in the scissor */
    int32_t x0, y0;                  /* first column and row of the whole box      */
    int32_t steps;                   /* all of its rows and columns, added         */
    int32_t turn;                    /* the first row below the middle corner      */
    uint8_t top, middle, bottom;     /* numbers of corners, by y                   */
    uint8_t longest;                 /* the side of the edge from top to bottom: 0 is left */
    uint8_t positive;                /* the snapped area's sign                    */
} ew_corners;

/* Positions are within +-2^(17 + S), S = EW_SUBPIXEL_BITS <= 8, so differences are
 * within 2^26. The machine code of arch.h knows the order. */
typedef struct ew_edge {
    int32_t x;         /* first pixel at or right of the edge on the current row           */
    int32_t remainder; /* from -dy to -1: whenever it counts up to zero, x grows by one more */
    int32_t step;      /* floor(dx / dy): what x grows by on each row                      */
    int32_t rise;      /* dx - step dy, 0 <= rise < dy                                     */
    int32_t dy;
} ew_edge;

/* A triangle between two of its rows. The planes that it has not got may lack behind it. */
typedef struct ew_active {
    uint32_t number;             /* for whoever keeps it, as `next` and `seen`               */
    uint16_t next;
    uint16_t row, end, turn;     /* the next row to draw, and those of ew_corners: with
                                    ew_raster_draw_list row may be one that is drawn        */
    uint8_t longest;             /* likewise                                                */
    uint8_t places;              /* for whoever keeps it: what it takes                     */
    union {
        uint16_t seen;
        uint16_t quick; /* ew_raster_draw_list: it stands on the scissor's first row, and down to this
                           one no edge changes and it does not end; 0: it may not            */
    } at;
    ew_snapped x[2], y[2];       /* the middle and the lowest corner                        */
    ew_edge edge[2];             /* left, right                                             */
    ew_triangle triangle;
} ew_active;

/* Active triangles in memory of the caller's, in the order of drawing: each is found by its place, in
 * units of 8 bytes, and leads to the next; EW_NO_PLACE behind the last. */
#define EW_NO_PLACE UINT16_C(0xFFFF)
enum { EW_PLACE_BYTES = 8 };
typedef struct ew_active_list {
    uint8_t *places;
    uint16_t *link;  /* what leads to the next that is to be drawn                         */
    uint16_t ended;  /* the first of those that were taken out                             */
} ew_active_list;

static inline ew_active *ew_active_in(const ew_active_list *list, uint16_t place)
{
    return (ew_active *)(void *)(list->places + (size_t)place * EW_PLACE_BYTES);
}

/* Columns of a triangle's next row: from <= x < to. 1/z of pixel x, uq1.31 times 2^(31 + lead), is
 * w + x dw modulo 2^64, as a signed number. */
typedef struct ew_active_span {
    uint64_t w, dw;
    uint16_t from, to;
    uint16_t next; /* for whoever keeps it, as `part` */
    uint8_t lead;  /* 0 to 24                        */
    uint8_t part;
} ew_active_span;

/* Differences from corner 0, in one place for both kinds of set-up. */
typedef struct ew_basis {
    int32_t dx1, dy1, dx2, dy2; /* q20.12, |d| <= 2^30                                      */
    int64_t area;               /* dx1 dy2 - dx2 dy1, |area| <= 2^61                        */
    uint32_t reach;             /* the largest |d|                                          */
    int32_t to_x, to_y;         /* from corner 0 to the box's first pixel, q20.12           */
} ew_basis;

/* Gradients of the weights of corners 1 and 2, per q20.12 unit times 2^shift / 4096. */
typedef struct ew_weights {
    int32_t x1, x2, y1, y2; /* |.| <= 2^30 */
    int shift;              /* 26 to 38    */
    int32_t there1, there2; /* their weights at the box's first pixel, 2^26 is 1; |.| <= 2^30 */
} ew_weights;

/* What planes are made of: values of w' and of all attributes at corner 0, and at corners 1 and 2
 * less what they are at corner 0. */
typedef struct ew_differences {
    uint32_t a0[EW_PLANES];
    int32_t d[EW_PLANES][2];
} ew_differences;

/* What lies between corners 0 and 1, 0 and 2, 1 and 2: the side of a and b is a + b - 1. */
typedef struct ew_sides {
    int32_t dx[3], dy[3], dw[3]; /* q20.12, uq1.31; b's less a's                           */
    uint32_t length[3];
} ew_sides;

/* How attributes of the affine rung are moved: by a share of what they differ by along a side, of 0 and 1,
 * of 0 and 2, or of 1 and 2. */
typedef struct ew_affine_move {
    int32_t share; /* 2^32 is all: 21/1024 at most, docs/error-bound.md */
    uint8_t side;
} ew_affine_move;

/* ---- spans (span.c) ---- */

/* What is linear along a piece of a span, from its first pixel on. */
typedef struct ew_linear {
    uint32_t w, dw;       /* w' times 2^align                                            */
    uint32_t u, du, v, dv; /* attributes likewise; on the affine rung they alone, with their
                             fraction bits                                               */
    int align;
    uint32_t shade[3], dshade[3];
} ew_linear;

/* What w' and attributes of a span change by, to be drawn moved. */
typedef struct ew_move {
    uint32_t w, u, v, shade[3];
} ew_move;

/* How long the runs of a piece may be: src/raster/run.h. */
typedef struct ew_run_limit {
    uint32_t scale;
    uint32_t fall;    /* tolerance, 1/16 px, where w falls                                */
    int32_t longest;
    int down;
} ew_run_limit;

/* Attributes of a run's first pixel, with their fraction bits, and what they grow by. */
typedef struct ew_attribute_run {
    uint32_t u, du, v, dv;
    uint32_t u_down, v_down; /* what they grow by to the next row, with mip chains only */
    uint32_t shade[3], dshade[3];
} ew_attribute_run;

/* Where ew_loop_fill or ew_fill_any goes on, and 1/z there. */
typedef struct ew_position {
    uint16_t x, y;
    uint32_t w, dw;
    uint8_t loop; /* ew_raster.loop where the piece lets it, else 0                        */
} ew_position;

/* How a run's u and v become one texel number (span.c): what depends on the texture alone, and
 * what the pixel loop of arch.h reads; its machine code knows the order. */
typedef struct ew_packing {
    const uint16_t *texels;
    uint32_t turn, mask;   /* texel numbers are shifted by EW_INDEX_SHIFT (arch.h)         */
    uint32_t dhigh, dlow;
    const uint16_t *rest, *end;
    uint32_t low;          /* bits of v's texel                                            */
    uint8_t log2_width, log2_height;
    uint8_t is_256;        /* the texture is 256 x 256                                     */
} ew_packing;

/* What the machine code of arch.h reads while it draws rows, besides the triangle; it knows the order. */
typedef struct ew_rows {
    const uint16_t *texels; /* to `end`: as in ew_packing                                  */
    uint32_t turn, mask;
    uint32_t dhigh, dlow;
    const uint16_t *rest, *end;
    ew_edge *edge;
    ew_plane32 *planes;    /* inside of their triangle                                     */
    int32_t x0, x1;        /* the scissor's                                                */
    uint16_t *depth;       /* the row's first pixel                                        */
    uint32_t stride;       /* bytes                                                        */
    uint32_t apart;        /* from a pixel's depth to its colour, bytes, less EW_APART_LESS */
    int32_t left;          /* rows                                                         */
    int32_t reached;       /* rows that have pixels                                        */
    /* for runs: */
    const uint16_t *recip; /* the table                                                    */
    uint32_t low, log2_height; /* as in ew_packing                                         */
    uint32_t is_256;
    uint16_t *first;       /* depth of the span's first pixel                              */
    int32_t pixels, run;   /* of the span, of the run that is drawn                        */
    uint32_t drawn;        /* of the span, if it is left to span.c in between              */
    /* for span.c: */
    uintptr_t origin;      /* where row 0 of the depth buffer were                         */
} ew_rows;

/* Where the next pixel goes, and 1/z there, uq1.31. */
typedef struct ew_pen {
    uint16_t *colour, *depth;
    uint32_t w, dw;
    uint16_t x, y; /* for tests                                                            */
} ew_pen;

/* ---- fills (loops.c, fill.c, texture.c) ---- */

/* What the loops of loops.c need of a row, the texture and the triangle. */
typedef struct ew_loop_work {
    void *colour;              /* the row's first pixels                                   */
    uint16_t *depth;           /* the same, or NULL                                        */
    const uint8_t *thresholds; /* of the row's dither                                      */
    const uint16_t *texels;
    uint32_t columns, rows;    /* masks: of a column, of a row times the width             */
    uint32_t u_origin, v_origin; /* added to u and v, texels with 20 bits of fraction      */
    uint32_t key, turn;        /* 65,536: none; how far pixels are rotated                 */
    uint8_t down, up;          /* shifts: of v to a row times the width, of u and v        */
    uint8_t of_dither;         /* a shift that takes off what dither adds, or all          */
} ew_loop_work;

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

typedef struct ew_axis {
    uint64_t at, step; /* q32.32                                                           */
    uint32_t period;   /* texels; 0: clamped                                               */
    uint32_t size;     /* texels of the level                                              */
} ew_axis;

/* A level as it lies in memory, the position in it, and what to do with its colours. */
typedef struct ew_sampler {
    const struct ew_texture *texture;
    const uint8_t *texels;
    const uint8_t *mask; /* NULL: none                                                     */
    ew_axis u, v;
    uint8_t weight[4]; /* of four texels                                                   */
    uint16_t texel[3]; /* the colour of one of them                                        */
    uint16_t level_colour[3]; /* of a pixel, on the second of two levels                   */
    uint16_t level, next_share; /* the level, and the share of the one behind it            */
    uint16_t row_bytes, mask_row_bytes; /* 4096 at most                                     */
    uint16_t share;    /* of 256: how far they take the place of what the piece has        */
    uint8_t log2_bits; /* of a texel                                                      */
    uint8_t wide;      /* of ew_decode_565                                                */
    uint8_t smooth;    /* bilinear                                                        */
    uint8_t cuts;      /* EW_COLOUR_KEY, EW_ALPHA_MASK: by which this level leaves texels out */
} ew_sampler;

/* ---- between two triangles (src/geometry/clip.c) ---- */

/* A corner of a triangle while it is clipped; the clipper's own. */
typedef struct ew_clip_vertex {
    int64_t x, y, w; /* in one unit: src/geometry/clip.c                                   */
    ew_q20_12 u, v;
    int8_t corner;   /* of the triangle, 0 to 2; -1 for one without a place on the screen yet */
    uint16_t colour[3]; /* uq8.8 red, green, blue                                          */
} ew_clip_vertex;

enum {
    EW_CLIP_MAX = 8, /* corners of a triangle cut by five planes                            */
    EW_CLIP_AHEAD = 2 /* what is read lies so many corners ahead of what is written */
};

/* ---- all of it ---- */

/* While spans are drawn. */
typedef struct ew_span_work {
    ew_linear linear; /* and the pen: near each other, which short offsets reach           */
    ew_move by;
    ew_run_limit limit;
    int32_t left;      /* pixels of the piece                                             */
    int32_t first;     /* pixels of the run that a span began with, where is_ready         */
    uint8_t is_ready;  /* `by` and `limit` are those of all spans of the triangle          */
    uint8_t has_rows;  /* what of fill.textured.rows is the same for all triangles is made ready */
    union {
        struct {
            ew_pen pen;
            ew_rows rows;
        } textured;
        struct {
            ew_attribute_run attributes;
            ew_position position;
            ew_loop_work loop;
            ew_run run;
            ew_piece piece;
            ew_sampler sampler;
        } any;
    } fill;
} ew_span_work;

typedef struct ew_raster_work {
    ew_packing packing; /* set with the material                                       */
    ew_triangle triangle;
    ew_corners corners;
    ew_edge edge[2]; /* left, right                                                       */
    union {
        struct { /* while planes are made */
            ew_basis basis;
            ew_weights weights;
            ew_differences differences;
            ew_sides sides;
            ew_affine_move move;
            uint32_t w[3]; /* of the corners, scaled                                       */
        } setup;
        ew_span_work span;
        ew_clip_vertex polygon[EW_CLIP_MAX + EW_CLIP_AHEAD + 1]; /* while a triangle is clipped */
    } now;
} ew_raster_work;

#endif
