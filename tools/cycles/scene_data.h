/* The scenes that a bench draws, as data: written by scene_data.c. */
#ifndef EW_CYCLES_SCENE_DATA_H
#define EW_CYCLES_SCENE_DATA_H

#include "edgewalk/geometry.h"

/* Triangles with the standard texture and camera, or the bytes of a baked scene. */
typedef struct bench_scene {
    const char *name;
    const ew_vertex16 *vertices;
    const uint16_t *indices;
    uint32_t vertex_count, index_count;
    const uint32_t *file; /* NULL: triangles */
    uint32_t file_bytes;
} bench_scene;

extern const bench_scene bench_scenes[];
extern const int bench_scene_count;
extern const uint16_t bench_texture[256 * 256];

/* Of the largest scene. */
enum { BENCH_MOST_VERTICES = 8192, BENCH_MOST_NODES = 256, BENCH_MOST_COLOURS = 33 * 33 };

/* The standard camera (host_tests/reference/scenes.h) for a picture of `width` x 3/4 width: a
 * square of which the middle is seen. */
static inline int bench_view(ew_transform *transform, uint16_t width)
{
    const ew_projection projection = { 65536, 65536, { INT32_C(1) << 29, -1 } };
    const ew_viewport square = { 0, (int16_t)-(width / 8), width, width };
    const ew_q16_16 units = INT32_C(64) << 16; /* q1.15 times 64 is 1/512 unit */
    ew_mat34 model_view;
    for (int i = 0; i < 3; i++) {
        ew_row_from_q16_16(&model_view.row[i], i == 0 ? units : 0, i == 1 ? units : 0, i == 2 ? units : 0, 0);
    }
    return ew_transform_set(transform, &projection, &model_view, &square);
}

#endif
