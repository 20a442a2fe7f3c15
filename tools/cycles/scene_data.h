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
enum { BENCH_MOST_VERTICES = 8192, BENCH_MOST_NODES = 256 };

#endif
