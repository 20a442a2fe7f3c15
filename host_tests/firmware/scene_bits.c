/* The standard scenes on every counted rung, with a hash of colour and depth; and in every memory mode,
 * as tools/cycles counts them. */
#include "same_bits.h"

#if SAME_BITS_ROOM > 0

#include "../../examples/firmware/picture_hash.h"
#include "edgewalk/picture.h"
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

/* ---- in bands and lines ---- */

static ew_object object;
static uint32_t band_hash;

static void hash_band(void *user, const ew_target *band)
{
    const uint32_t pixels = (uint32_t)band->height * band->stride;
    (void)user;
    band_hash = picture_hash(band_hash, band->colour, pixels);
    if (band->depth) band_hash = picture_hash(band_hash, band->depth, pixels);
}

/* The list of scene B and its vertices do not fit in the memory of a picture of 64x48. */
#if SAME_BITS_ROOM == 2
static uint8_t band_memory[20000];
#else
#define band_memory same_picture
#endif

#if SAME_BITS_ROOM >= 3
/* Draws it again in the memory that triangles are set up once in, and prints what that is, with ew_raster and ew_geometry:
 * `memory SCENE MODE BYTES ACTIVE SET_UP AGAIN TRANSFORMED TRIANGLES VERTICES`. */
static void draw_in_less(const bench_scene *s, const bench_mode *mode, const ew_picture *picture, ew_picture_counts *counts)
{
    const uint32_t hash = band_hash, active = counts->most_active;
    const size_t bytes = ew_picture_bytes(picture, &object, 1, active);
    band_hash = PICTURE_HASH_START;
    if (ew_picture_draw(picture, &object, 1, &geometry, &band_memory, bytes, counts) || band_hash != hash) {
        print_failure(s->name, "in less memory");
    }
    print_memory(s->name, mode->name, (uint32_t)(bytes + sizeof same_raster + sizeof geometry), active, counts,
                 s->index_count / 3, s->vertex_count);
}
#endif

static void draw_in_bands(const bench_scene *s, const bench_mode *mode, uint16_t width, const char *size)
{
    const uint16_t height = (uint16_t)(width * 3u / 4u);
    const ew_picture picture = { .width = width, .height = height, .buffers = 1, .rows = mode->rows, .visibility = mode->visibility,
                                 .end_row = height, .scissor = { 0, 0, width, height }, .band = hash_band };
    const ew_texture texture = { .texels = bench_texture, .width = 256, .height = 256 };
    const ew_material material = { .texture = &texture, .tolerance = BENCH_MODE_TOLERANCE, .rung = EW_RUNG_AUTO };
    const ew_mesh mesh = { .vertices = s->vertices, .indices = s->indices, .index_count = s->index_count, .uv_fraction_bits = 4 };
    object.mesh = mesh;
    object.vertex_count = s->vertex_count;
    object.material = material;
    ew_picture_counts counts;
    band_hash = PICTURE_HASH_START;
    ew_geometry_init(&geometry, &same_raster);
    int error = bench_view(&object.transform, width);
    if (!error) error = ew_picture_draw(&picture, &object, 1, &geometry, &band_memory, sizeof band_memory, &counts);
    if (error) print_failure(s->name, mode->name);
    print_hash(s->name, mode->name, BENCH_MODE_TOLERANCE, size, band_hash);
#if SAME_BITS_ROOM >= 3
    if (!error && width == 320 && mode->rows <= 8) draw_in_less(s, mode, &picture, &counts);
#endif
}

static void in_bands(const bench_scene *s)
{
    for (int i = 0; i < BENCH_MODES; i++) {
        if (!EW_WITH_SPANS && bench_modes[i].visibility == EW_DEPTH_SPANS) continue;
        if (bench_modes[i].rows <= 16) draw_in_bands(s, &bench_modes[i], 64, "64x48");
#if SAME_BITS_ROOM >= 3
        if (bench_modes[i].rows <= 64) draw_in_bands(s, &bench_modes[i], 320, "320x240");
#endif
    }
}

void scene_bits(void)
{
    const bench_method *method;
    uint16_t tolerance;
    for (int k = 0; k < bench_scene_count; k++) {
        if (bench_scenes[k].vertex_count > MOST_VERTICES) continue;
        in_bands(&bench_scenes[k]);
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
