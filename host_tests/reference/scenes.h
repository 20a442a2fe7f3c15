/* The standard scenes A to E that every figure of the project is measured on.
 *
 * 320 x 240, camera at the origin, sx = 160 + 160 x / z, sy = 120 - 160 y / z with z the
 * distance, near plane 0.25, texture 256 x 256. Vertices are in 1/512 unit, u and v in 1/16
 * texel. A: a floor inside the picture. B: a sphere of 1,984 triangles. C: a floor across
 * the near plane and the sides. D: the floor rolled by 60 degrees. E: a floor of 80 x 65
 * units across the near plane.
 */
#ifndef EW_TEST_SCENES_H
#define EW_TEST_SCENES_H

#include "edgewalk/geometry.h"

enum { STANDARD_SCENES = 5, STANDARD_WIDTH = 320, STANDARD_HEIGHT = 240 };

typedef struct standard_scene {
    char name;
    ew_vertex16 vertices[33 * 33];
    uint16_t indices[3 * 1984];
    uint32_t vertex_count, index_count;
    uint8_t uv_fraction_bits;
} standard_scene;

/* Fills the scene of that letter, 'A' to 'E'. */
void standard_scene_init(standard_scene *scene, char name);

/* Vertices (q1.15) to view space, and its twin in double. */
void standard_model_view(ew_mat34 *fixed, double exact[3][4]);

/* A 256 x 256 RGB565 texture whose neighbouring texels always differ. */
void standard_texture(uint16_t texels[256 * 256]);

#endif
