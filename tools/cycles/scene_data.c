/* scene_data [NAME=FILE.ewb ...]: writes the standard scenes and baked ones as C arrays, for a
 * firmware that has no libm and no files. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../host_tests/reference/scenes.h"

static standard_scene scene;
static uint16_t texels[256 * 256];

static void write_triangles(char name)
{
    standard_scene_init(&scene, name);
    printf("static const ew_vertex16 vertices_%c[] = {", name);
    for (uint32_t i = 0; i < scene.vertex_count; i++) {
        const ew_vertex16 *v = &scene.vertices[i];
        printf("%s{ %d, %d, %d, %d, %d },", i % 4 ? " " : "\n    ", v->x, v->y, v->z, v->u, v->v);
    }
    printf("\n};\nstatic const uint16_t indices_%c[] = {", name);
    for (uint32_t i = 0; i < scene.index_count; i++) printf("%s%d,", i % 18 ? " " : "\n    ", scene.indices[i]);
    printf("\n};\n");
}

/* Returns the size, or -1 after a line on stderr. The word order is the host's: that of a
 * little-endian target, as all of ours are. */
static long write_file(int number, const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        return -1;
    }
    unsigned char word[4];
    long bytes = 0;
    printf("static const uint32_t file_%d[] = {", number);
    for (size_t got; (got = fread(word, 1, 4, file)) > 0; bytes += (long)got) {
        memset(word + got, 0, 4 - got);
        printf("%s0x%02x%02x%02x%02x,", bytes % 48 ? " " : "\n    ", word[3], word[2], word[1], word[0]);
    }
    printf("\n};\n");
    fclose(file);
    return bytes;
}

int main(int argc, char **argv)
{
    long *bytes = calloc((size_t)argc, sizeof *bytes);
    if (!bytes) abort();
    printf("/* Written by tools/cycles/scene_data.c. */\n#include \"scene_data.h\"\n\n");
    for (char name = 'A'; name <= 'E'; name++) write_triangles(name);
    for (int i = 1; i < argc; i++) {
        const char *path = strchr(argv[i], '=');
        if (!path || (bytes[i] = write_file(i, path + 1)) < 0) return 1;
    }
    printf("const bench_scene bench_scenes[] = {\n");
    for (char name = 'A'; name <= 'E'; name++) {
        printf("    { \"%c\", vertices_%c, indices_%c, sizeof vertices_%c / sizeof *vertices_%c,\n"
               "      sizeof indices_%c / sizeof *indices_%c, 0, 0 },\n", name, name, name, name, name, name, name);
    }
    for (int i = 1; i < argc; i++) {
        printf("    { \"%.*s\", 0, 0, 0, 0, file_%d, %ld },\n", (int)strcspn(argv[i], "="), argv[i], i, bytes[i]);
    }
    printf("};\nconst int bench_scene_count = sizeof bench_scenes / sizeof *bench_scenes;\n");
    standard_texture(texels);
    printf("const uint16_t bench_texture[65536] = {");
    for (int i = 0; i < 65536; i++) printf("%s%d,", i % 16 ? " " : "\n    ", texels[i]);
    printf("\n};\n");
    free(bytes);
    return 0;
}
