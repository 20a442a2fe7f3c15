/* edgewalk/picture.h - a whole picture in as much memory as there is: at once, in bands, line by
 * line (docs/memory-modes.md).
 *
 * There is one picture. However many rows are drawn at a time and however much memory there is
 * beyond the least, every pixel is the same bit for bit; less memory only takes longer.
 */
#ifndef EW_PICTURE_H
#define EW_PICTURE_H

#include <stddef.h>
#include <stdint.h>

#include "error.h"
#include "geometry.h"
#include "raster.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Triangles of one material and one transform. Nothing of it is copied or changed: two contexts
 * may draw from the same objects at the same time. */
typedef struct ew_object {
    ew_transform transform;   /* of ew_transform_set                                        */
    ew_mesh mesh;             /* `screen`: NULL, or what ew_transform_vertices made of all vertices */
    uint32_t vertex_count;    /* up to 65,536                                              */
    ew_material material;
    ew_texture texture;       /* for material.texture to point at; it may point elsewhere  */
} ew_object;

/* How it is decided which triangle is seen at a pixel. */
typedef enum ew_visibility {
    EW_DEPTH_BUFFER = 0, /* by depth, 16 bits for each pixel of a band                      */
    EW_DEPTH_NONE,       /* by order: what is drawn later covers what is drawn before       */
    EW_DEPTH_SPANS       /* by depth, where spans begin and end; only what is seen is drawn, and
                            everything has to be opaque (docs/memory-modes.md)              */
} ew_visibility;

/* What a picture is and how it is drawn. */
typedef struct ew_picture {
    uint16_t width, height;      /* 1 to 4096                                                 */
    uint8_t format, dither;      /* as in ew_target                                           */
    uint8_t visibility;          /* ew_visibility                                             */
    uint8_t buffers;             /* 1, or 2: bands take turns, so that one may be sent while the
                                    next is drawn                                             */
    uint16_t rows;               /* of a band: 1 is line by line, `height` the picture at once */
    uint16_t first_row, end_row; /* the rows to draw: first_row <= y < end_row <= height; 0 and
                                    height for the whole picture                              */
    uint16_t background;         /* RGB565                                                    */
    ew_rect scissor;             /* where triangles are drawn; the rest is background         */
    const ew_cost *cost;         /* NULL: ew_cost_generic                                     */
    ew_uq1_31 fog_near, fog_far; /* as in ew_raster_set_fog; both 0: none                     */
    uint16_t fog_colour;
    /* Called for each finished band, from the top: its memory, first_row and height; may draw
     * into it, also with the geometry's raster, whose scissor it need not put back, but its material; the
     * geometry itself is in use.
     * With one buffer the band has to be sent before it returns; with two, the band before this one has. */
    void (*band)(void *user, const ew_target *band);
    void *user;
} ew_picture;

/* What happened, for those who tune. */
typedef struct ew_picture_counts {
    uint32_t set_up;      /* triangles and parts of clipped ones; not in one band             */
    uint32_t again;       /* set-ups of triangles that were set up before: for want of memory  */
    uint32_t transformed; /* vertices                                                         */
    uint32_t most_active; /* triangles that went on to another band, at most; with EW_DEPTH_SPANS
                             those of one row                                                */
    uint32_t crossings;   /* with EW_DEPTH_SPANS: spans of which a part is in front of another span and a
                             part behind it, where both were seen until then: 0 unless triangles
                             pass through one another. They are cut there                    */
    uint32_t sections;    /* with EW_DEPTH_SPANS: what rows were cut into beyond one piece each, for
                             want of memory                                                  */
} ew_picture_counts;

/* The least memory that ew_picture_draw asks for; 0 for a picture out of its ranges, or more than
 * 2^20 - 2 triangles or 2^24 - 2 vertices. */
size_t ew_picture_least(const ew_picture *picture, const ew_object *objects, uint32_t count);

/* What it takes for `active` triangles that reach from one band into the next to be set up once:
 * the least, 112 bytes for each, or 256 with EW_DEPTH_SPANS, and 408 or, of three at most, 124 more for
 * each. Three may be wide, but not shaded; of more it is enough where most are neither (docs/memory-modes.md). */
size_t ew_picture_bytes(const ew_picture *picture, const ew_object *objects, uint32_t count, uint32_t active);

/* Draws objects in order, as ew_draw_triangles would after ew_raster_clear, with geometry->raster,
 * which is initialised first; geometry->transform may be lost. All of the memory is used; it needs no alignment and holds nothing
 * afterwards, but for the last band. `counts` may be NULL.
 * Returns EW_OK, EW_ERR_ROOM for less than ew_picture_least, EW_ERR_ARGUMENT, EW_ERR_UNSUPPORTED (also for
 * EW_DEPTH_SPANS with a material that blends, leaves texels out or goes without a part of the depth test)
 * or EW_ERR_RANGE; rows that came before an error were handed over. */
int ew_picture_draw(const ew_picture *picture, const ew_object *objects, uint32_t count, ew_geometry *geometry,
                    void *memory, size_t bytes, ew_picture_counts *counts);

#ifdef __cplusplus
}
#endif

#endif
