/* edgewalk/scene.h - reading a baked scene (docs/scene-format.md) and drawing it.
 *
 * The scene stays where it is: an ew_scene only points into the caller's bytes, which
 * must outlive it, must not change, and must start on a multiple of 4.
 */
#ifndef EW_SCENE_H
#define EW_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "error.h"
#include "fixed.h"
#include "geometry.h"
#include "picture.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ew_scene_section {
    const uint8_t *records;
    uint32_t count;
} ew_scene_section;

/* Order of ew_scene.section. */
enum {
    EW_SECTION_CAMR, EW_SECTION_BOUN, EW_SECTION_NODE, EW_SECTION_PRIM, EW_SECTION_VERT,
    EW_SECTION_INDX, EW_SECTION_MATL, EW_SECTION_TEXR, EW_SECTION_TEXL, EW_SECTION_TRAK,
    EW_SECTION_KEYS, EW_SECTION_ANIM, EW_SECTION_COUNT
};

/* Fields may be read, not written. */
typedef struct ew_scene {
    ew_scene_section section[EW_SECTION_COUNT];
    uint32_t largest_primitive; /* vertices of the largest primitive          */
    uint32_t duration_ms;       /* of the animation, 0 when nothing moves     */
} ew_scene;

typedef struct ew_scene_camera {
    ew_mat34 view;      /* world to view                                      */
    ew_q16_16 focal;    /* 1 / tan(half the vertical field of view)           */
    ew_block near_z;    /* near distance, world units                         */
} ew_scene_camera;

typedef struct ew_scene_node {
    int16_t parent, track;
    uint16_t first_primitive, primitive_count;
    ew_mat34 local;
} ew_scene_node;

typedef struct ew_scene_primitive {
    const ew_vertex16 *vertices;
    const uint16_t *indices;
    uint32_t index_count;
    uint16_t vertex_count, material;
    ew_mat34 dequantise; /* vertex (as q1.15) to node                         */
    uint8_t uv_fraction_bits;
} ew_scene_primitive;

/* Checks a scene whole - lengths, checksum, every offset, index and reference, every
 * range of the format page - and points `scene` at it. After EW_OK nothing that the
 * functions below read can lie outside the `size` bytes. Returns EW_OK or
 * EW_ERR_ARGUMENT (bytes not on a multiple of 4), _MAGIC, _VERSION, _TRUNCATED,
 * _CHECKSUM, _CORRUPT; `scene` is unchanged then. */
int ew_scene_open(ew_scene *scene, const void *bytes, size_t size);

/* Records by number; the number must be below the section's count. */
void ew_scene_get_camera(const ew_scene *scene, ew_scene_camera *camera);
void ew_scene_get_bounds(const ew_scene *scene, ew_row *centre_radius);
void ew_scene_get_node(const ew_scene *scene, uint32_t i, ew_scene_node *node);
void ew_scene_get_primitive(const ew_scene *scene, uint32_t i, ew_scene_primitive *primitive);
void ew_scene_get_material(const ew_scene *scene, uint32_t i, ew_material *material, ew_texture *texture);

/* Node-to-world matrices of all nodes at time_ms, clamped to each track's keys.
 * `world` has room for as many matrices as there are nodes. Returns EW_OK or
 * EW_ERR_RANGE when a product of matrices leaves the number format; `world` is of no use then. */
int ew_scene_pose(const ew_scene *scene, uint32_t time_ms, ew_mat34 *world);

/* Draws the scene posed by ew_scene_pose with `camera` through `geometry` into its
 * raster's target, the picture as large as the viewport: neither clears nor changes the
 * scissor. `scratch` has room for scene->largest_primitive vertices. Returns the number of
 * triangles that reached a pixel, or the first error of the geometry layer. */
int32_t ew_scene_draw(const ew_scene *scene, const ew_scene_camera *camera, const ew_mat34 *world,
                      const ew_viewport *viewport, ew_geometry *geometry, ew_screen_vertex *scratch);

/* How many objects ew_scene_objects makes: as many as nodes have primitives. */
uint32_t ew_scene_object_count(const ew_scene *scene);

/* The scene as ew_scene_draw would draw it, as objects for ew_picture_draw. `geometry` is only worked
 * in. The objects point into the scene and at themselves: they must stay where they are. Returns
 * EW_OK, EW_ERR_ARGUMENT or EW_ERR_RANGE. */
int ew_scene_objects(const ew_scene *scene, const ew_scene_camera *camera, const ew_mat34 *world,
                     const ew_viewport *viewport, ew_geometry *geometry, ew_object *objects);

#ifdef __cplusplus
}
#endif

#endif
