/* Writes the standard scenes as C arrays, for a firmware that has no libm. */
#include <stdio.h>

#include "../../host_tests/reference/scenes.h"

static standard_scene scene;
static uint16_t texels[256 * 256];

int main(void)
{
    static const long fragments[STANDARD_SCENES] = { 31472, 30620, 34400, 12849, 37600 };
    printf("/* Written by tools/cycles/scene_data.c. */\n#include \"edgewalk/geometry.h\"\n\n"
           "typedef struct bench_scene {\n    const char *name;\n    const ew_vertex16 *vertices;\n"
           "    const uint16_t *indices;\n    uint32_t vertex_count, index_count;\n    long fragments;\n} bench_scene;\n"
           "enum { BENCH_MOST_VERTICES = 33 * 33 };\n");
    for (char name = 'A'; name <= 'E'; name++) {
        standard_scene_init(&scene, name);
        printf("static const ew_vertex16 bench_%c_vertices[] = {", name + 32);
        for (uint32_t i = 0; i < scene.vertex_count; i++) {
            const ew_vertex16 *v = &scene.vertices[i];
            printf("%s{ %d, %d, %d, %d, %d },", i % 4 ? " " : "\n    ", v->x, v->y, v->z, v->u, v->v);
        }
        printf("\n};\nstatic const uint16_t bench_%c_indices[] = {", name + 32);
        for (uint32_t i = 0; i < scene.index_count; i++) printf("%s%d,", i % 18 ? " " : "\n    ", scene.indices[i]);
        printf("\n};\nstatic const bench_scene bench_%c = { \"%c\", bench_%c_vertices, bench_%c_indices, %u, %u, %ld };\n",
               name + 32, name, name + 32, name + 32, scene.vertex_count, scene.index_count, fragments[name - 'A']);
    }
    standard_texture(texels);
    printf("static const uint16_t bench_texture[65536] = {");
    for (int i = 0; i < 65536; i++) printf("%s%d,", i % 16 ? " " : "\n    ", texels[i]);
    printf("\n};\n");
    return 0;
}
