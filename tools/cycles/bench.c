/* What is counted: transform, culling, set-up and spans of each scene (posing its nodes, where it
 * is a baked one), once for each case of cases.h, then of scenes A and D with each fill. The same file is firmware and host program; both
 * print the hash of every picture, which is the same on all targets.
 *
 * On the host: `bench --list` names the cases and says how many fragments each scene has, when
 * it is built with EW_TRACE = 1. */
#include "cases.h"
#include "edgewalk/geometry.h"
#include "edgewalk/scene.h"
#include "scene_data.h"

enum { W = BENCH_WIDTH, H = BENCH_HEIGHT, BACKGROUND = 0 };

/* What the port gives: the board in firmware, the end of this file on the host. */
void bench_line(const char *text);

static uint16_t colour[W * H], depth[W * H];
static ew_screen_vertex screen[BENCH_MOST_VERTICES];
static ew_mat34 world[BENCH_MOST_NODES];
static ew_raster raster;
static ew_geometry geometry;
static ew_scene scene;
static ew_colour888 colours[BENCH_MOST_COLOURS]; /* of the standard scenes' vertices */

/* Counted from its first instruction to the first of bench_end. */
__attribute__((noinline, noclone)) int32_t bench_draw(const bench_scene *s, const ew_material *material);
__attribute__((noinline, noclone)) void bench_end(void);

static int32_t draw_mesh(const ew_vertex16 *vertices, uint32_t vertex_count, const ew_colour888 *colours_of,
                         const uint16_t *indices, uint32_t index_count, uint8_t uv_fraction_bits)
{
    const ew_mesh mesh = { vertices, screen, colours_of, indices, index_count, uv_fraction_bits };
    ew_transform_vertices(&geometry.transform, vertices, vertex_count, screen);
    return ew_draw_triangles(&geometry, &mesh);
}

/* As ew_scene_draw, but for the method that replaces each material's own. */
static int32_t draw_primitive(uint32_t number, const ew_projection *projection, const ew_mat34 *node_view,
                              const ew_material *method)
{
    const ew_viewport whole = { 0, 0, W, H };
    ew_scene_primitive p;
    ew_material material;
    ew_texture texture;
    ew_mat34 model_view;
    ew_scene_get_primitive(&scene, number, &p);
    ew_scene_get_material(&scene, p.material, &material, &texture);
    if (material.texture) material.rung = method->rung, material.tolerance = method->tolerance;
    int error = ew_mat34_mul(&model_view, node_view, &p.dequantise);
    if (!error) error = ew_raster_set_material(&raster, &material);
    if (!error) error = ew_transform_set(&geometry.transform, projection, &model_view, &whole);
    if (error) return error;
    return draw_mesh(p.vertices, p.vertex_count, NULL, p.indices, p.index_count, p.uv_fraction_bits);
}

static int32_t draw_baked(const ew_material *method)
{
    ew_scene_camera camera;
    ew_scene_get_camera(&scene, &camera);
    /* focal_x is focal H/W to the nearest, as in ew_scene_draw; focal <= 1024, so it fits */
    const ew_projection projection = { (ew_q16_16)(((int64_t)camera.focal * H + W / 2) / W), camera.focal, camera.near_z };
    int32_t error = ew_scene_pose(&scene, BENCH_TIME_MS, world);
    for (uint32_t i = 0; i < scene.section[EW_SECTION_NODE].count && error >= 0; i++) {
        ew_scene_node node;
        ew_mat34 node_view;
        ew_scene_get_node(&scene, i, &node);
        error = ew_mat34_mul(&node_view, &camera.view, &world[i]);
        for (uint32_t k = 0; k < node.primitive_count && error >= 0; k++) {
            error = draw_primitive(node.first_primitive + k, &projection, &node_view, method);
        }
    }
    return error;
}

int32_t bench_draw(const bench_scene *s, const ew_material *material)
{
    if (s->file) return draw_baked(material);
    return draw_mesh(s->vertices, s->vertex_count, colours, s->indices, s->index_count, 4);
}
void bench_end(void) { __asm__ volatile(""); }

static uint32_t hash(void)
{
    uint32_t h = 2166136261u; /* FNV-1a over 16-bit units */
    for (int i = 0; i < W * H; i++) h = (((h ^ colour[i]) * 16777619u) ^ depth[i]) * 16777619u;
    return h;
}

static void print_hash(uint32_t h)
{
    char text[10] = { 0 };
    for (int i = 0; i < 8; i++) text[i] = "0123456789abcdef"[h >> (28 - 4 * i) & 15];
    text[8] = '\n';
    bench_line(text);
}

/* Returns 0, or 1 when the scene cannot be drawn. */
static int run(const bench_scene *s, const ew_target *target, const ew_material *material)
{
    int error = ew_raster_init(&raster, target);
    ew_raster_clear(&raster, BACKGROUND);
    if (!error) error = ew_raster_set_material(&raster, material);
    ew_geometry_init(&geometry, &raster);
    if (!error) error = bench_view(&geometry.transform, W);
    if (!error && s->file) {
        error = ew_scene_open(&scene, s->file, s->file_bytes);
        if (!error && (scene.largest_primitive > BENCH_MOST_VERTICES ||
                       scene.section[EW_SECTION_NODE].count > BENCH_MOST_NODES)) {
            error = EW_ERR_RANGE;
        }
    }
    if (!error) error = bench_draw(s, material) < 0;
    bench_end();
    if (error) bench_line("cannot draw a scene\n");
    else print_hash(hash());
    return error != 0;
}

static int run_method(const bench_scene *s, const bench_method *method, uint16_t tolerance)
{
    const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };
    const ew_texture texture = { .texels = bench_texture, .width = 256, .height = 256 };
    const ew_material material = { .texture = &texture, .tolerance = tolerance, .rung = method->rung };
    return run(s, &target, &material);
}

/* Scenes that fills are counted on: the number-th, 0 behind the last. */
static const bench_scene *fill_scene(int number)
{
    static const uint8_t scenes[] = { 0, 3 }; /* A, D */
    return number < (int)sizeof scenes ? &bench_scenes[scenes[number]] : NULL;
}

static int run_fill(const bench_scene *s, const bench_fill *fill)
{
    const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W,
                               .format = fill->format, .dither = fill->format > EW_TARGET_RGB565_SWAPPED };
    const ew_texture texture = { .texels = bench_texture, .width = 256, .height = 256, .key = bench_texture[0],
                                 .wrap_u = fill->wrap, .wrap_v = fill->wrap };
    const ew_material material = { .texture = fill->textured ? &texture : NULL, .colour = 0xA5B4, .tolerance = BENCH_FILL_TOLERANCE,
                                   .flags = fill->flags, .blend = fill->blend, .filter = fill->filter };
    for (uint32_t i = 0; i < BENCH_MOST_COLOURS; i++) {
        colours[i] = (ew_colour888){ (uint8_t)(128 + i % 120), (uint8_t)(255 - i % 77), (uint8_t)(160 + i % 31) };
    }
    return run(s, &target, &material);
}

static int run_all(void)
{
    const bench_method *method;
    uint16_t tolerance;
    for (int s = 0; s < bench_scene_count; s++) {
        for (int i = 0; bench_case(i, &method, &tolerance); i++) {
            if (run_method(&bench_scenes[s], method, tolerance)) return 1;
        }
    }
    const bench_scene *of_fills;
    for (int s = 0; (of_fills = fill_scene(s)); s++) {
        for (int i = 0; i < BENCH_FILLS; i++) {
            if (run_fill(of_fills, &bench_fills[i])) return 1;
        }
    }
    return 0;
}

#if __STDC_HOSTED__
#include <stdio.h>
#include <string.h>

static int quiet;
void bench_line(const char *text)
{
    if (!quiet) fputs(text, stdout);
}

#if EW_TRACE
static long fragments;
void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c, int rung)
{
    (void)a, (void)b, (void)c, (void)rung;
}
void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t d, ew_q20_12 u, ew_q20_12 v)
{
    (void)x, (void)y, (void)d, (void)u, (void)v;
    fragments++;
}

static int list(void)
{
    const bench_method *method;
    uint16_t tolerance;
    quiet = 1;
    for (int s = 0; s < bench_scene_count; s++) {
        for (int i = 0; bench_case(i, &method, &tolerance); i++) {
            if (i == 0) {
                fragments = 0;
                if (run_method(&bench_scenes[s], method, tolerance)) return 1;
            }
            printf("%s,%s,%g,%ld\n", bench_scenes[s].name, method->name, tolerance / 16.0, fragments);
        }
    }
    const bench_scene *of_fills;
    for (int s = 0; (of_fills = fill_scene(s)); s++) {
        for (int i = 0; i < BENCH_FILLS; i++) {
            fragments = 0;
            if (run_fill(of_fills, &bench_fills[i])) return 1;
            printf("%s,%s,%g,%ld\n", of_fills->name, bench_fills[i].name, BENCH_FILL_TOLERANCE / 16.0, fragments);
        }
    }
    return 0;
}
#endif

int main(int argc, char **argv)
{
#if EW_TRACE
    if (argc == 2 && strcmp(argv[1], "--list") == 0) return list();
#endif
    if (argc > 1) fprintf(stderr, "usage: %s\n", argv[0]);
    return argc > 1 ? 2 : run_all();
}
#else
#include "../../examples/firmware/board/board.h"

void bench_line(const char *text) { board_print(text); }
int main(void) { return run_all(); }
#endif
