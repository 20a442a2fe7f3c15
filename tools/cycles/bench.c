/* What is counted: transform, culling, set-up and spans of each scene (posing its nodes, where it
 * is a baked one), once for each case of cases.h, and with BENCH_COST, the target's own cost profile, the
 * automatic choice by that, at each tolerance; then of scenes A and D with each fill. The same file is firmware and host program; both
 * print the hash of every picture, which is the same on all targets.
 *
 * On the host, built with EW_TRACE = 1: `bench --list` names the cases and says how many fragments each scene has,
 * `bench --references` how often its triangles would stand in the lists of bands. */
#include "cases.h"
#include "edgewalk/geometry.h"
#include "edgewalk/picture.h"
#include "edgewalk/scene.h"
#include "drawn.h"
#include "scene_data.h"

enum { W = BENCH_WIDTH, H = BENCH_HEIGHT, BACKGROUND = 0 };

static uint16_t colour[W * H], depth[W * H];
static ew_screen_vertex screen[BENCH_MOST_VERTICES];
static ew_mat34 world[BENCH_MOST_NODES];
static ew_raster raster;
static ew_geometry geometry;
static ew_scene scene;
static ew_colour888 colours[BENCH_MOST_COLOURS]; /* of the standard scenes' vertices */

/* ---- in less memory ---- */

enum { MOST_OBJECTS = BENCH_MOST_NODES, MODE_MEMORY = 600000 };
static ew_object objects[MOST_OBJECTS];
static uint32_t object_count;
static ew_picture picture;
static ew_picture_counts counts;
static size_t mode_bytes;
static uint8_t mode_memory[MODE_MEMORY];
static const bench_mode *mode; /* NULL: by the layers below */

static void make_object(const bench_scene *s, const ew_material *material)
{
    objects[0].mesh = (ew_mesh){ s->vertices, NULL, NULL, s->indices, s->index_count, 4 };
    objects[0].vertex_count = s->vertex_count;
    objects[0].material = *material;
    bench_view(&objects[0].transform, W);
    object_count = 1;
}

static int make_objects(const ew_material *method)
{
    const ew_viewport whole = { 0, 0, W, H };
    ew_scene_camera camera;
    ew_scene_get_camera(&scene, &camera);
    int error = ew_scene_pose(&scene, BENCH_TIME_MS, world);
    if (!error) error = ew_scene_objects(&scene, &camera, world, &whole, &geometry, objects);
    object_count = ew_scene_object_count(&scene);
    for (uint32_t i = 0; i < object_count; i++) {
        ew_material *m = &objects[i].material;
        if (m->texture) m->rung = method->rung, m->tolerance = method->tolerance;
    }
    return error;
}

static int make_all(const bench_scene *s, const ew_material *material)
{
    if (s->file) return make_objects(material);
    make_object(s, material);
    return EW_OK;
}

static int32_t draw_mode(const bench_scene *s, const ew_material *material)
{
    const int error = make_all(s, material);
    return error ? error : ew_picture_draw(&picture, objects, object_count, &geometry, mode_memory, mode_bytes, &counts);
}

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
    if (mode) return draw_mode(s, material);
    if (s->file) return draw_baked(material);
    return draw_mesh(s->vertices, s->vertex_count, colours, s->indices, s->index_count, 4);
}
void bench_end(void) { __asm__ volatile(""); }

/* Returns 0, or 1 when the scene cannot be drawn. */
static int run(const bench_scene *s, const ew_target *target, const ew_material *material, const ew_cost *cost)
{
    int error = ew_raster_init(&raster, target);
    if (!error && cost) error = ew_raster_set_cost(&raster, cost);
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
    else drawn_print(drawn_hash(DRAWN_START, colour, depth, W * H));
    return error != 0;
}

static uint32_t band_hash;
static void no_band(void *user, const ew_target *band) { (void)user, (void)band; }
static void hash_band(void *user, const ew_target *band)
{
    (void)user;
    band_hash = drawn_hash(band_hash, band->colour, band->depth, W * band->height);
}

static void print_decimal(uint32_t n)
{
    char text[12], *at = text + sizeof text - 1;
    *at = '\0';
    do *--at = (char)('0' + n % 10); while ((n /= 10) > 0);
    *--at = ' ';
    bench_line(at);
}

/* `memory`, then bytes of everything but the scene and its objects, bytes of these, and what
 * ew_picture_counts has; vertices and triangles of the scene. */
static void print_memory(void)
{
    uint32_t triangles = 0, vertices = 0;
    for (uint32_t i = 0; i < object_count; i++) {
        triangles += objects[i].mesh.index_count / 3;
        vertices += objects[i].vertex_count;
    }
    const uint32_t figures[] = { (uint32_t)(mode_bytes + sizeof raster + sizeof geometry), (uint32_t)(object_count * sizeof *objects),
                                 counts.most_active, counts.set_up, counts.again, counts.transformed, triangles, vertices };
    bench_line("memory");
    for (unsigned i = 0; i < sizeof figures / sizeof *figures; i++) print_decimal(figures[i]);
    bench_line("\n");
}

static const ew_texture mode_texture = { .texels = bench_texture, .width = 256, .height = 256 };
static const ew_material mode_material = { .texture = &mode_texture, .tolerance = BENCH_MODE_TOLERANCE, .rung = EW_RUNG_AUTO };

static int start_mode(const bench_scene *s, const bench_mode *m)
{
    const ew_picture p = { .width = W, .height = H, .rows = m->rows, .visibility = m->visibility, .buffers = 1, .end_row = H,
                           .background = BACKGROUND, .scissor = { 0, 0, W, H }, .band = hash_band };
    picture = p;
    mode = m;
    ew_geometry_init(&geometry, &raster);
    int error = s->file ? ew_scene_open(&scene, s->file, s->file_bytes) : EW_OK;
    if (!error && s->file && ew_scene_object_count(&scene) > MOST_OBJECTS) error = EW_ERR_RANGE;
    return error;
}

/* With room for as many triangles as are active at a time. */
static int run_mode(const bench_scene *s, const bench_mode *m)
{
    int error = start_mode(s, m);
    mode_bytes = sizeof mode_memory;
    if (!error) error = draw_mode(s, &mode_material);
    const uint32_t active = counts.most_active;
    mode_bytes = ew_picture_bytes(&picture, objects, object_count, active);
    band_hash = DRAWN_START;
    if (!error) error = draw_mode(s, &mode_material);
    picture.band = no_band;
    if (!error) error = bench_draw(s, &mode_material);
    bench_end();
    mode = NULL;
    counts.most_active = active;
    if (error) bench_line("cannot draw a scene in bands\n");
    else drawn_print(band_hash);
    if (!error) print_memory();
    return error != 0;
}

static int run_method(const bench_scene *s, ew_rung rung, uint16_t tolerance, const ew_cost *cost)
{
    const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };
    const ew_texture texture = { .texels = bench_texture, .width = 256, .height = 256 };
    const ew_material material = { .texture = &texture, .tolerance = tolerance, .rung = (uint8_t)rung };
    return run(s, &target, &material, cost);
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
    return run(s, &target, &material, NULL);
}

static int run_all(void)
{
    const bench_method *method;
    uint16_t tolerance;
    for (int s = 0; s < bench_scene_count; s++) {
        for (int i = 0; bench_case(i, &method, &tolerance); i++) {
            if (run_method(&bench_scenes[s], method->rung, tolerance, NULL)) return 1;
        }
#ifdef BENCH_COST
        for (int i = 0; i < BENCH_TOLERANCES; i++) {
            if (run_method(&bench_scenes[s], EW_RUNG_AUTO, bench_tolerances[i], &BENCH_COST)) return 1;
        }
#endif
    }
    const bench_scene *of_fills;
    for (int s = 0; (of_fills = fill_scene(s)); s++) {
        for (int i = 0; i < BENCH_FILLS; i++) {
            if (run_fill(of_fills, &bench_fills[i])) return 1;
        }
    }
    for (int s = 0; s < bench_scene_count; s++) {
        for (int i = 0; i < BENCH_MODES; i++) {
            if (run_mode(&bench_scenes[s], &bench_modes[i])) return 1;
        }
    }
    return 0;
}

#if __STDC_HOSTED__
#if EW_TRACE
static int list(void)
{
    const bench_method *method;
    uint16_t tolerance;
    static long of_scene[16];
    drawn_quiet = 1;
    for (int s = 0; s < bench_scene_count && s < 16; s++) {
        for (int i = 0; bench_case(i, &method, &tolerance); i++) {
            if (i == 0) {
                drawn_fragments = 0;
                if (run_method(&bench_scenes[s], method->rung, tolerance, NULL)) return 1;
                of_scene[s] = drawn_fragments;
            }
            printf("%s,%s,%g,%ld\n", bench_scenes[s].name, method->name, tolerance / 16.0, drawn_fragments);
        }
        for (int i = 0; i < BENCH_PROFILES * BENCH_TOLERANCES; i++) {
            printf("%s,%s,%g,%ld\n", bench_scenes[s].name, bench_profiles[i / BENCH_TOLERANCES].name,
                   bench_tolerances[i % BENCH_TOLERANCES] / 16.0, drawn_fragments);
        }
    }
    const bench_scene *of_fills;
    for (int s = 0; (of_fills = fill_scene(s)); s++) {
        for (int i = 0; i < BENCH_FILLS; i++) {
            drawn_fragments = 0;
            if (run_fill(of_fills, &bench_fills[i])) return 1;
            printf("%s,%s,%g,%ld\n", of_fills->name, bench_fills[i].name, BENCH_FILL_TOLERANCE / 16.0, drawn_fragments);
        }
    }
    for (int s = 0; s < bench_scene_count && s < 16; s++) {
        for (int i = 0; i < BENCH_MODES; i++) {
            printf("%s,%s,%g,%ld\n", bench_scenes[s].name, bench_modes[i].name, BENCH_MODE_TOLERANCE / 16.0, of_scene[s]);
        }
    }
    return 0;
}

/* What memory goals go by. */
enum { LISTED_ROWS = 8 };

/* Whether anything of an object is set up in a band. Returns -1 where it cannot be drawn. */
static int is_in_band(const ew_object *object, uint16_t first_row)
{
    enum { BYTES = 1 << 15 }; /* all of the memory is used */
    ew_picture band = picture;
    band.first_row = first_row;
    band.end_row = (uint16_t)(first_row + LISTED_ROWS);
    band.rows = LISTED_ROWS / 2; /* in a single band set-ups are not counted */
    band.band = no_band;
    if (ew_picture_draw(&band, object, 1, &geometry, mode_memory, BYTES, &counts)) return -1;
    return counts.set_up > 0;
}

/* How often an object's triangles would stand in lists of bands, one list for each band. Returns -1 where one of them
 * cannot be drawn. */
static int32_t references_of(const ew_object *object)
{
    const uint16_t *const indices = object->mesh.indices;
    ew_object one = *object;
    int32_t references = 0;
    one.mesh.index_count = 3;
    for (uint32_t i = 0; i < object->mesh.index_count; i += 3) {
        one.mesh.indices = indices + i;
        for (uint16_t row = 0; row < H; row = (uint16_t)(row + LISTED_ROWS)) {
            const int is_in = is_in_band(&one, row);
            if (is_in < 0) return -1;
            references += is_in;
        }
    }
    return references;
}

static int list_references(void)
{
    for (int s = 0; s < bench_scene_count; s++) {
        int32_t references = start_mode(&bench_scenes[s], &bench_modes[0]);
        if (!references) references = make_all(&bench_scenes[s], &mode_material);
        for (uint32_t i = 0; i < object_count && references >= 0; i++) {
            const int32_t of_object = references_of(&objects[i]);
            references = of_object < 0 ? of_object : references + of_object;
        }
        if (references < 0) return 1;
        printf("%s,%ld\n", bench_scenes[s].name, (long)references);
    }
    return 0;
}
#endif

int main(int argc, char **argv)
{
#if EW_TRACE
    if (argc == 2 && strcmp(argv[1], "--list") == 0) return list();
    if (argc == 2 && strcmp(argv[1], "--references") == 0) return list_references();
#endif
    if (argc > 1) fprintf(stderr, "usage: %s\n", argv[0]);
    return argc > 1 ? 2 : run_all();
}
#else
int main(void) { return run_all(); }
#endif
