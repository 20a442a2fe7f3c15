/* What is counted: transform, culling, set-up and spans of a standard scene, once for each
 * case of bench_cases.inc. The same file is firmware and host program; the picture's hash
 * goes where a debugger or main's caller can see it.
 *
 * On the host: `bench N` draws case N (callgrind's --toggle-collect=bench_draw counts it),
 * `bench --list` names the cases. */
#include "edgewalk/geometry.h"
#include "scene_data.h"

#if __STDC_HOSTED__
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#endif

enum { W = 320, H = 240 };

typedef struct bench_case {
    const bench_scene *scene;
    const char *method;
    uint16_t tolerance; /* 1/16 px */
    uint8_t rung;
} bench_case;

static const bench_case cases[] = {
#define SCENES(method, rung, tolerance) \
    { &bench_a, method, tolerance, rung }, { &bench_b, method, tolerance, rung }, { &bench_c, method, tolerance, rung }, \
    { &bench_d, method, tolerance, rung }, { &bench_e, method, tolerance, rung }
#include "bench_cases.inc"
};
enum { CASES = sizeof cases / sizeof *cases };

static uint16_t colour[W * H], depth[W * H];
static ew_screen_vertex screen[BENCH_MOST_VERTICES];
static ew_raster raster;
static ew_geometry geometry;

uint32_t bench_hash;

/* Counted from its first instruction to the first of bench_end. */
__attribute__((noinline)) int32_t bench_draw(const bench_scene *s);
__attribute__((noinline)) void bench_end(void);

int32_t bench_draw(const bench_scene *s)
{
    ew_transform_vertices(&geometry.transform, s->vertices, s->vertex_count, screen);
    const ew_mesh mesh = { s->vertices, screen, NULL, s->indices, s->index_count, 4 };
    return ew_draw_triangles(&geometry, &mesh);
}
void bench_end(void) { __asm__ volatile(""); }

static void run(const bench_case *c)
{
    const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };
    const ew_texture texture = { .texels = bench_texture, .width = 256, .height = 256 };
    const ew_material material = { .texture = &texture, .tolerance = c->tolerance, .rung = c->rung };
    const ew_projection projection = { 65536, 65536, { 1 << 29, -1 } };
    const ew_viewport viewport = { 0, -40, 320, 320 };
    ew_mat34 model_view;
    for (int i = 0; i < 3; i++) {
        ew_row_from_q16_16(&model_view.row[i], i == 0 ? 64 << 16 : 0, i == 1 ? 64 << 16 : 0, i == 2 ? 64 << 16 : 0, 0);
    }
    ew_raster_init(&raster, &target);
    ew_raster_clear(&raster, 0);
    ew_raster_set_material(&raster, &material);
    ew_geometry_init(&geometry, &raster);
    ew_transform_set(&geometry.transform, &projection, &model_view, &viewport);
    bench_draw(c->scene);
    bench_end();
    for (int i = 0; i < W * H; i++) { /* FNV-1a over 16-bit units */
        bench_hash = (bench_hash ^ colour[i]) * 16777619u;
        bench_hash = (bench_hash ^ depth[i]) * 16777619u;
    }
}

#if __STDC_HOSTED__
int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--list") == 0) {
        for (int i = 0; i < CASES; i++) {
            const bench_case *c = &cases[i];
            printf("%s,%s,%g,%ld\n", c->scene->name, c->method, c->tolerance / 16.0, c->scene->fragments);
        }
        return 0;
    }
    int first = argc == 2 ? atoi(argv[1]) : 0, end = argc == 2 ? first + 1 : CASES;
    if (first < 0 || end > CASES) return 2;
    for (int i = first; i < end; i++) run(&cases[i]);
    printf("%08x\n", (unsigned)bench_hash);
    return 0;
}
#else
int main(void)
{
    for (int i = 0; i < CASES; i++) run(&cases[i]);
    return 0;
}
#endif
