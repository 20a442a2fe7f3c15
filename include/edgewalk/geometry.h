/* edgewalk/geometry.h - indexed vertices to raster triangles: transform, cull, clip, project.
 *
 * View space is right-handed and the camera looks down -z, as in glTF; y points up there
 * and down on the screen.
 */
#ifndef EW_GEOMETRY_H
#define EW_GEOMETRY_H

#include <stdint.h>

#include "error.h"
#include "fixed.h"
#include "picture_work.h"
#include "raster.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A corner as it lies in flash: 10 bytes, aligned to 2. */
typedef struct ew_vertex16 {
    ew_q1_15 x, y, z; /* in the primitive's box                                           */
    int16_t u, v;     /* texels times 2^(fraction bits of the primitive)                   */
} ew_vertex16;

/* A corner after the transform: 16 bytes. */
typedef struct ew_screen_vertex {
    ew_uq1_31 w;      /* near/z                                                            */
    ew_q20_12 x, y;   /* px; only with neither EW_OUT_NEAR nor EW_OUT_GUARD                */
    uint8_t outcode;  /* EW_OUT_*                                                          */
} ew_screen_vertex;

enum {
    EW_OUT_LEFT = 1, EW_OUT_RIGHT = 2, EW_OUT_TOP = 4, EW_OUT_BOTTOM = 8, /* of the viewport */
    EW_OUT_NEAR = 16, /* nearer than the near plane                                        */
    EW_OUT_GUARD = 32 /* beyond EW_GUARD_PX                                                */
};

/* Where a picture lies in the target; may reach over its borders. */
typedef struct ew_viewport {
    int16_t x, y;           /* top-left corner, px, -8192 to 8191                          */
    uint16_t width, height; /* px, 1 to 8192                                               */
} ew_viewport;

/* A row whose sums with q1.15 vertices fit 31 bits; the units are ew_transform's own. */
typedef struct ew_row32 {
    int32_t m[3];
    int64_t rest;       /* 2^31 times (translation + 1 for rounding)                       */
} ew_row32;

/* The same for cores without a long multiply: m = high 2^15 + low, |low| <= 2^14. */
typedef struct ew_row_pieces {
    int32_t high[3], low[3];
    int32_t rest;       /* translation + 1                                                 */
} ew_row_pieces;

#if EW_LONG_MULTIPLY
typedef ew_row32 ew_quick_row;
#else
typedef ew_row_pieces ew_quick_row;
#endif

/* Model space to the screen, homogeneous: px = x/w, py = y/w, depth = near/w. */
typedef struct ew_transform {
    /* For the vertices that 32 bits suffice for (src/geometry/transform.c); ahead, for the short offsets of
     * ARMv6-M. */
    ew_quick_row quick_x, quick_y, quick_w;
    int32_t w_safe;     /* sums of quick_w from here on are beyond the near plane, and exact enough */
    int32_t w_hidden;   /* sums below this are nearer than it                               */
    uint32_t near_m;    /* near distance = near_m 2^-(near_shift + 3) in units of those sums */
    int8_t near_shift, shift_x, shift_y;
    ew_q20_12 left, top;      /* the viewport                                               */
    uint32_t across, down;    /* in the same units                                          */
    /* For all others. */
    ew_row x, y, w;     /* here e_last = e                                                  */
    int64_t near_w;     /* the near distance in units of 2^(w.e - 45), those of row w's sums */
} ew_transform;

/* Makes the transform for one model; `model_view` takes vertices as q1.15 to view space.
 * Returns EW_OK; EW_ERR_ARGUMENT for a projection or a viewport outside of its ranges;
 * EW_ERR_RANGE when the model's size or distance is more than about 2^30 times the near
 * distance. After an error *transform is of no use. */
int ew_transform_set(ew_transform *transform, const ew_projection *projection,
                     const ew_mat34 *model_view, const ew_viewport *viewport);

/* Transforms `count` vertices. Positions are rounded to the nearest 1/4096 px; before that
 * they are off by at most 2^-28 of position + viewport, times (size + distance of the
 * model) / z of the vertex. So a vertex snaps within 0.75 subpixel of its
 * exact projection unless it is nearer than about 1/1000 of the model's size.
 * Most vertices take the quick way, in 32 bits; those farther from the target's corner than
 * about twice the viewport's size, nearer than twice the near distance or than about 1/200 of
 * the model's size take four times as long.
 * `out` must not overlap `in`. */
void ew_transform_vertices(const ew_transform *transform, const ew_vertex16 *in, uint32_t count,
                           ew_screen_vertex *out);

/* Triangles of one material. Nothing is copied. */
typedef struct ew_mesh {
    const ew_vertex16 *vertices;
    const ew_screen_vertex *screen; /* what ew_transform_vertices made of them              */
    const ew_colour888 *colours;    /* one for each vertex; NULL: 255 everywhere            */
    const uint16_t *indices;        /* `index_count` of them, each below the number of vertices */
    uint32_t index_count;           /* a multiple of three                                  */
    uint8_t uv_fraction_bits;       /* of the vertices' u and v, 0 to 12                     */
} ew_mesh;

/* What ew_scene_draw needs while it draws. */
typedef struct ew_scene_work {
    ew_projection projection;
    ew_viewport viewport;
    const ew_mat34 *view;
    ew_mat34 node_view;
    union {
        ew_mat34 model_view; /* until the transform is made of it                           */
        ew_mesh mesh;
    } primitive_at_hand;
    ew_screen_vertex *vertices;
    int32_t drawn;
    uint32_t primitive, left; /* the next one's number, and how many the node has left      */
} ew_scene_work;

enum { EW_FEW = 8 };

/* The memory of the geometry layer: the caller's, about 560 bytes. What is kept here takes no
 * room on the stack while a triangle is drawn. */
typedef struct ew_geometry {
    ew_raster *raster;
    uint8_t corner_count, corner_next; /* of a clipped triangle's: how many, and the next one's number */
    ew_transform transform;
    /* What follows holds nothing between two calls. */
    union {
        ew_raster_vertex corner[EW_CLIP_MAX]; /* the triangle at hand: of 0, 1, 2, or a fan around 0 */
        ew_screen_vertex few[EW_FEW];         /* while a picture's triangles are listed            */
    } at_hand;
    union {
        ew_scene_work scene;
        ew_picture_work picture;
    } work;
} ew_geometry;

/* Points the layer at a raster context. */
void ew_geometry_init(ew_geometry *geometry, ew_raster *raster);

/* Draws a mesh with the raster's material and geometry->transform, the one that mesh->screen
 * was made with. That the indices are in range is the caller's promise; ew_scene_open checks
 * it for baked scenes. No triangle is left out: one that crosses the near plane or leaves the
 * guard band is clipped. A colour at a cut is off by half a unit and 1/50 at most, beside the
 * place of the cut itself.
 * Returns the number of triangles that reached a pixel, or the first error of
 * ew_raster_triangle. */
int32_t ew_draw_triangles(ew_geometry *geometry, const ew_mesh *mesh);

#ifdef __cplusplus
}
#endif

#endif
