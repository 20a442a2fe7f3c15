/* Cost against work: one thing grows, the rest stays. Triangles of a sheet that fills the picture, pixels across
 * and down, texels of the texture's side; and frames of the sample scenes over their animation, as ew_scene_draw
 * draws them. Each is drawn once, between bench_draw and bench_end, and its hash printed.
 *
 * On the host: `work --list`, built with EW_TRACE = 1, names the cases with their triangles and fragments. */
#include "edgewalk/geometry.h"
#include "edgewalk/scene.h"
#include "drawn.h"
#include "scene_data.h"

enum { SIDE_MOST = 1024, GRID_MOST = 224, FRAMES = 24, W = 320, H = 240, TOLERANCE = 4 };

typedef enum sweep { SWEEP_TRIANGLES, SWEEP_PIXELS, SWEEP_TEXELS, SWEEP_COUNT } sweep;
static const char *const sweep_names[SWEEP_COUNT] = { "triangles", "pixels", "texels" };

/* One case: a sheet of 2 cells^2 triangles, drawn side x side pixels large. */
typedef struct work_case {
    uint8_t sweep;
    uint16_t cells, side, texture;
} work_case;
static const work_case cases[] = {
    { SWEEP_TRIANGLES, 2, 240, 256 },  { SWEEP_TRIANGLES, 7, 240, 256 },  { SWEEP_TRIANGLES, 22, 240, 256 },
    { SWEEP_TRIANGLES, 71, 240, 256 }, { SWEEP_TRIANGLES, 224, 240, 256 },
    { SWEEP_PIXELS, 8, 32, 256 },      { SWEEP_PIXELS, 8, 64, 256 },      { SWEEP_PIXELS, 8, 128, 256 },
    { SWEEP_PIXELS, 8, 256, 256 },     { SWEEP_PIXELS, 8, 512, 256 },     { SWEEP_PIXELS, 8, 1024, 256 },
    { SWEEP_TEXELS, 8, 240, 4 },       { SWEEP_TEXELS, 8, 240, 16 },      { SWEEP_TEXELS, 8, 240, 64 },
    { SWEEP_TEXELS, 8, 240, 256 },     { SWEEP_TEXELS, 8, 240, 1024 },
};
enum { CASES = sizeof cases / sizeof *cases };

static uint16_t colour[SIDE_MOST * SIDE_MOST], depth[SIDE_MOST * SIDE_MOST];
static struct {
    ew_vertex16 vertices[(GRID_MOST + 1) * (GRID_MOST + 1)];
    ew_screen_vertex screen[(GRID_MOST + 1) * (GRID_MOST + 1)];
    uint16_t indices[GRID_MOST * GRID_MOST * 6];
} sheet;
static uint16_t texels[1024 * 1024];
static ew_mat34 world[BENCH_MOST_NODES];
static ew_raster raster;
static ew_geometry geometry;
static ew_mesh mesh;
static uint32_t vertex_count;

__attribute__((noinline, noclone)) int32_t bench_draw(const ew_scene *scene, const ew_scene_camera *camera, uint32_t time_ms);
__attribute__((noinline, noclone)) void bench_end(void);

int32_t bench_draw(const ew_scene *scene, const ew_scene_camera *camera, uint32_t time_ms)
{
    const ew_viewport whole = { 0, 0, W, H };
    if (!scene) {
        ew_transform_vertices(&geometry.transform, sheet.vertices, vertex_count, sheet.screen);
        return ew_draw_triangles(&geometry, &mesh);
    }
    int error = ew_scene_pose(scene, time_ms, world);
    return error ? error : ew_scene_draw(scene, camera, world, &whole, &geometry, sheet.screen);
}
void bench_end(void) { __asm__ volatile(""); }

static int begin(uint16_t width, uint16_t height)
{
    const ew_target target = { .colour = colour, .depth = depth, .width = width, .height = height, .stride = width };
    int error = ew_raster_init(&raster, &target);
    if (!error) ew_raster_clear(&raster, 0);
    ew_geometry_init(&geometry, &raster);
    return error;
}

/* A sheet over [-1, 1) both ways, leaning back by half. */
static void make_sheet(uint16_t cells)
{
    uint32_t at = 0;
    vertex_count = 0;
    for (int32_t j = 0; j <= cells; j++) {
        for (int32_t i = 0; i <= cells; i++) {
            const int16_t x = (int16_t)(-32000 + 64000 * i / cells), y = (int16_t)(-32000 + 64000 * j / cells);
            sheet.vertices[vertex_count++] = (ew_vertex16){ x, y, (int16_t)(-y / 4), (int16_t)(3200 * i / cells), (int16_t)(3200 * j / cells) };
            if (i == cells || j == cells) continue;
            const uint16_t corner = (uint16_t)(j * (cells + 1) + i), above = (uint16_t)(corner + cells + 1);
            const uint16_t six[6] = { corner, (uint16_t)(corner + 1), (uint16_t)(above + 1), corner, (uint16_t)(above + 1), above };
            for (int k = 0; k < 6; k++) sheet.indices[at++] = six[k];
        }
    }
    mesh = (ew_mesh){ sheet.vertices, sheet.screen, NULL, sheet.indices, at, 4 };
}

static int32_t draw_sheet(const work_case *c)
{
    const ew_projection projection = { 65536, 65536, { 1 << 29, -1 } };
    const ew_viewport viewport = { 0, 0, c->side, c->side };
    const ew_texture texture = { .texels = texels, .width = c->texture, .height = c->texture };
    const ew_material material = { .texture = &texture, .tolerance = TOLERANCE };
    ew_mat34 model_view;
    int32_t error = begin(c->side, c->side);
    make_sheet(c->cells);
    ew_mat34_identity(&model_view);
    model_view.row[2].m[3] = -(1 << 30), model_view.row[2].e_last = 0; /* 1 unit away, and up to 1/4 nearer */
    if (!error) error = ew_raster_set_material(&raster, &material);
    if (!error) error = ew_transform_set(&geometry.transform, &projection, &model_view, &viewport);
    if (!error) error = bench_draw(NULL, NULL, 0);
    bench_end();
    return error;
}

static int32_t draw_frame(const bench_scene *s, int frame)
{
    ew_scene scene;
    ew_scene_camera camera;
    int32_t error = begin(W, H);
    if (!error) error = ew_scene_open(&scene, s->file, s->file_bytes);
    if (!error && (scene.largest_primitive > BENCH_MOST_VERTICES || scene.section[EW_SECTION_NODE].count > BENCH_MOST_NODES)) {
        error = EW_ERR_RANGE;
    }
    if (error) return error;
    ew_scene_get_camera(&scene, &camera);
    error = bench_draw(&scene, &camera, scene.duration_ms / FRAMES * (uint32_t)frame);
    bench_end();
    return error;
}

/* Draws all cases; behind each calls `done` with its names and size. Returns 0, or 1 when one cannot be drawn. */
static int run_all(void (*done)(const char *sweep, uint32_t x, uint32_t pixels, int32_t triangles))
{
    for (uint32_t i = 0; i < 1024 * 1024; i++) texels[i] = (uint16_t)(i * 40503u >> 3);
    for (int i = 0; i < CASES; i++) {
        const work_case *c = &cases[i];
        const uint32_t x[SWEEP_COUNT] = { 2u * c->cells * c->cells, c->side, c->texture };
        int32_t drawn = draw_sheet(c);
        if (drawn < 0) return 1;
        done(sweep_names[c->sweep], x[c->sweep], (uint32_t)c->side * c->side, drawn);
    }
    for (int s = 0; s < bench_scene_count; s++) {
        for (int frame = 0; bench_scenes[s].file && frame < FRAMES; frame++) {
            int32_t drawn = draw_frame(&bench_scenes[s], frame);
            if (drawn < 0) return 1;
            done(bench_scenes[s].name, (uint32_t)frame, W * H, drawn);
        }
    }
    return 0;
}

static void print_case(const char *name, uint32_t x, uint32_t pixels, int32_t triangles)
{
    (void)name, (void)x, (void)triangles;
    drawn_print(drawn_hash(DRAWN_START, colour, depth, pixels));
}

#if __STDC_HOSTED__
#if EW_TRACE
static void list_case(const char *name, uint32_t x, uint32_t pixels, int32_t triangles)
{
    (void)pixels;
    printf("%s,%u,%d,%ld\n", name, (unsigned)x, (int)triangles, drawn_fragments);
    drawn_fragments = 0;
}
#endif

int main(int argc, char **argv)
{
#if EW_TRACE
    if (argc == 2 && strcmp(argv[1], "--list") == 0) return run_all(list_case);
#endif
    if (argc > 1) fprintf(stderr, "usage: %s\n", argv[0]);
    return argc > 1 ? 2 : run_all(print_case);
}
#else
int main(void) { return run_all(print_case); }
#endif
