/* The standard scenes on every counted rung, with a hash of colour and depth. */
#include "same_bits.h"

#if SAME_BITS_ROOM > 0

#include "../../examples/firmware/picture_hash.h"
#include "edgewalk/geometry.h"
#include "scene_data.h"

#if SAME_BITS_ROOM >= 2
enum { MOST_VERTICES = BENCH_MOST_VERTICES };
#else
enum { MOST_VERTICES = 4 };
#endif

static ew_screen_vertex screen[MOST_VERTICES];
static ew_raster raster;
static ew_geometry geometry;

static void draw(const bench_scene *s, const char *method, uint8_t rung, uint16_t tolerance,
                 uint16_t width, const char *size)
{
    const uint16_t height = (uint16_t)(width * 3u / 4u);
    const uint32_t pixels = (uint32_t)width * height;
    const ew_target target = { .colour = same_colour, .depth = same_depth, .width = width, .height = height, .stride = width };
    const ew_texture texture = { .texels = bench_texture, .width = 256, .height = 256 };
    const ew_material material = { .texture = &texture, .tolerance = tolerance, .rung = rung };
    const ew_projection projection = { 65536, 65536, { INT32_C(1) << 29, -1 } };
    const ew_viewport viewport = { 0, (int16_t)-(width / 8), width, width }; /* square, its middle is seen */
    ew_mat34 model_view;
    for (int i = 0; i < 3; i++) {
        const ew_q16_16 units = INT32_C(64) << 16; /* q1.15 times 64 is 1/512 unit */
        ew_row_from_q16_16(&model_view.row[i], i == 0 ? units : 0, i == 1 ? units : 0, i == 2 ? units : 0, 0);
    }
    int32_t result = ew_raster_init(&raster, &target);
    ew_raster_clear(&raster, 0);
    if (!result) result = ew_raster_set_material(&raster, &material);
    ew_geometry_init(&geometry, &raster);
    if (!result) result = ew_transform_set(&geometry.transform, &projection, &model_view, &viewport);
    ew_transform_vertices(&geometry.transform, s->vertices, s->vertex_count, screen);
    if (!result) result = ew_draw_triangles(&geometry, s->vertices, screen, s->indices, s->index_count, 4);
    if (result <= 0) print_failure(s->name, method);
    uint32_t hash = picture_hash(PICTURE_HASH_START, same_colour, pixels);
    print_hash(s->name, method, tolerance, size, picture_hash(hash, same_depth, pixels));
}

void scene_bits(void)
{
    static const bench_scene *const scenes[] = {
        &bench_a, &bench_c, &bench_d, &bench_e,
#if SAME_BITS_ROOM >= 2
        &bench_b,
#endif
    };
    static const struct {
        const char *method;
        uint16_t tolerance;
        uint8_t rung;
    } cases[] = {
#define SCENES(method, rung, tolerance) { method, tolerance, rung }
#include "../../tools/cycles/bench_cases.inc"
    };
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (unsigned k = 0; k < sizeof scenes / sizeof *scenes; k++) {
            draw(scenes[k], cases[i].method, cases[i].rung, cases[i].tolerance, 64, "64x48");
#if SAME_BITS_ROOM >= 3
            draw(scenes[k], cases[i].method, cases[i].rung, cases[i].tolerance, 320, "320x240");
#endif
        }
    }
}
#endif
