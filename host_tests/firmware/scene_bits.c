/* The standard scenes on every counted rung, with a hash of colour and depth. */
#include "same_bits.h"

#if SAME_BITS_ROOM > 0

#include "../../examples/firmware/picture_hash.h"
#include "../../tools/cycles/cases.h"
#include "../../tools/cycles/scene_data.h"

/* Scene B has 33 x 33 vertices, the others 4. */
enum { MOST_VERTICES = SAME_BITS_ROOM >= 2 ? 33 * 33 : 4 };

static ew_screen_vertex screen[MOST_VERTICES];
static ew_geometry geometry;

static void draw(const bench_scene *s, const bench_method *method, uint16_t tolerance, uint16_t width,
                 const char *size)
{
    const uint16_t height = (uint16_t)(width * 3u / 4u);
    const uint32_t pixels = (uint32_t)width * height;
    const ew_target target = { .colour = same_picture.colour, .depth = same_picture.depth,
                               .width = width, .height = height, .stride = width };
    const ew_texture texture = { .texels = bench_texture, .width = 256, .height = 256 };
    const ew_material material = { .texture = &texture, .tolerance = tolerance, .rung = method->rung };
    const ew_mesh mesh = { .vertices = s->vertices, .screen = screen, .indices = s->indices,
                           .index_count = s->index_count, .uv_fraction_bits = 4 };
    int32_t result = ew_raster_init(&same_raster, &target);
    ew_raster_clear(&same_raster, 0);
    if (!result) result = ew_raster_set_material(&same_raster, &material);
    ew_geometry_init(&geometry, &same_raster);
    if (!result) result = bench_view(&geometry.transform, width);
    ew_transform_vertices(&geometry.transform, s->vertices, s->vertex_count, screen);
    if (!result) result = ew_draw_triangles(&geometry, &mesh);
    if (result <= 0) print_failure(s->name, method->name);
    uint32_t hash = picture_hash(PICTURE_HASH_START, same_picture.colour, pixels);
    print_hash(s->name, method->name, tolerance, size, picture_hash(hash, same_picture.depth, pixels));
}

void scene_bits(void)
{
    const bench_method *method;
    uint16_t tolerance;
    for (int k = 0; k < bench_scene_count; k++) {
        if (bench_scenes[k].vertex_count > MOST_VERTICES) continue;
        for (int i = 0; bench_case(i, &method, &tolerance); i++) {
            draw(&bench_scenes[k], method, tolerance, 64, "64x48");
#if SAME_BITS_ROOM >= 3
            draw(&bench_scenes[k], method, tolerance, 320, "320x240");
#endif
        }
    }
}

#else
void scene_bits(void) {}
#endif
