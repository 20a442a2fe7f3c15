/* Mesa as a second, independent referee: its software rasterizer, 8 subpixel bits, in memory.
 *
 * Mesa gets the snapped corners (k/256 px) under glOrtho, which it maps back to k/256 without
 * rounding when the viewport's sides are powers of two; our y as GL's y, so that its row 0 is
 * our top row. It clips in float what leaves the viewport, so the viewport holds every corner
 * though the buffer may be smaller. What is too large for that is counted as left out.
 * Texture coordinates are given as (u w, v w, 0, w): their quotient is perspective-correct.
 */
#include "../property/cases.h"

#include <GL/gl.h>
#include <GL/osmesa.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../property/triangles.h"
#include "../reference/coverage.h"
#include "../reference/exact.h"
#include "../reference/scenes.h"
#include "edgewalk/geometry.h"
#include "edgewalk/scene.h"

enum { W = STANDARD_WIDTH, H = STANDARD_HEIGHT, LOG2_SIZE = 8, SIZE = 1 << LOG2_SIZE, ONE = 1 << EW_SUBPIXEL_BITS };

static uint16_t colour[W * H], depth[W * H], hits[W * H], texels[SIZE * SIZE];
static GLubyte image[H][W][4];
static ew_raster raster;
static cover by_edges, by_rows;

/* ---- the core ---- */

enum { MOST_TRIANGLES = 4096 };

/* Triangles as the core sets them up: clipped, projected, in front. */
typedef struct triangle_list {
    ew_raster_vertex v[MOST_TRIANGLES][3];
    int width[MOST_TRIANGLES], height[MOST_TRIANGLES]; /* of the texture, 0 without */
    int count;
} triangle_list;
static triangle_list traced, listed;

/* The fragment that a picture's pixel shows, and its triangle. */
static struct {
    int32_t u, v;
    int triangle;
} seen_at[H][W];

void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c, int rung)
{
    const int i = traced.count++;
    (void)rung;
    if (i >= MOST_TRIANGLES) fail_msg("more than %d triangles", MOST_TRIANGLES);
    traced.v[i][0] = *a, traced.v[i][1] = *b, traced.v[i][2] = *c;
    traced.width[i] = raster.material.texture ? raster.texture.width : 0;
    traced.height[i] = raster.material.texture ? raster.texture.height : 0;
}

void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t d, ew_q20_12 u, ew_q20_12 v)
{
    hits[y * W + x]++;
    if (d > depth[y * W + x]) seen_at[y][x].u = u, seen_at[y][x].v = v, seen_at[y][x].triangle = traced.count - 1;
}

static void start(uint16_t width, uint16_t height, ew_rung rung, uint16_t tolerance)
{
    const ew_target target = { .colour = colour, .depth = depth, .width = width, .height = height, .stride = W };
    const ew_texture texture = { .texels = texels, .width = SIZE, .height = SIZE };
    const ew_material material = { .texture = &texture, .tolerance = tolerance, .rung = (uint8_t)rung,
                                   .flags = EW_DOUBLE_SIDED };
    for (int i = 0; i < SIZE * SIZE; i++) texels[i] = (uint16_t)i; /* a texel says which it is */
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
}

static void draw_core(const ew_raster_vertex v[3])
{
    memset(hits, 0, sizeof hits);
    traced.count = 0;
    ew_raster_clear(&raster, 0);
    assert_true(ew_raster_triangle(&raster, &v[0], &v[1], &v[2]) >= 0);
}

/* ---- Mesa ---- */

static int mesa_start(void)
{
    static OSMesaContext context;
    static GLubyte ids[SIZE][SIZE][4];
    if (context) return 1;
    setenv("LP_NUM_THREADS", "0", 1); /* small pictures: threads only wait */
    context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, NULL);
    GLint bits = 0;
    if (!context || !OSMesaMakeCurrent(context, image, GL_UNSIGNED_BYTE, W, H)) {
        printf("# SKIP OSMesa has no context to give\n");
        return 0;
    }
    glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
    if (bits != EW_SUBPIXEL_BITS) {
        printf("# SKIP %s has %d subpixel bits, the core %d\n", (const char *)glGetString(GL_RENDERER), bits,
               EW_SUBPIXEL_BITS);
        return 0;
    }
    for (int v = 0; v < SIZE; v++) {
        for (int u = 0; u < SIZE; u++) ids[v][u][0] = (GLubyte)u, ids[v][u][1] = (GLubyte)v, ids[v][u][2] = ids[v][u][3] = 255;
    }
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, SIZE, SIZE, 0, GL_RGBA, GL_UNSIGNED_BYTE, ids);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glEnable(GL_TEXTURE_2D);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_DITHER);
    return 1;
}

static int floor_px(int64_t s) { return (int)(s >= 0 ? s / ONE : -((-s + ONE - 1) / ONE)); }

/* The smallest power of two from 64 on that holds `px`; 0 beyond the largest viewport. */
static int side(int64_t px)
{
    int n = 64;
    while (n < px) n *= 2;
    return n <= 16384 ? n : 0;
}

static void clear_mesa(void) { glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT); }

/* Draws into `image`: texel in red and green, a number from 1 to 65535 in blue and alpha. Returns 0
 * for a triangle that no viewport holds. */
static int draw_mesa(const ew_raster_vertex v[3], int number)
{
    int64_t sx[3], sy[3];
    triangle_snapped(sx, sy, v);
    int64_t x0 = sx[0], x1 = sx[0], y0 = sy[0], y1 = sy[0];
    for (int i = 1; i < 3; i++) {
        x0 = sx[i] < x0 ? sx[i] : x0, x1 = sx[i] > x1 ? sx[i] : x1;
        y0 = sy[i] < y0 ? sy[i] : y0, y1 = sy[i] > y1 ? sy[i] : y1;
    }
    int left = floor_px(x0), top = floor_px(y0);
    int width = side(floor_px(x1) + 1 - left), height = side(floor_px(y1) + 1 - top);
    if (!width || !height) return 0;
    glViewport(left, top, width, height);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(0, width, 0, height, -2, 2); /* room on both sides of 1/z, which is from 0 to 1 */
    glColor4ub(255, 255, (GLubyte)(number & 255), (GLubyte)(number >> 8));
    glBegin(GL_TRIANGLES);
    for (int i = 0; i < 3; i++) {
        double w = ldexp(v[i].w, -31), scale = w / (4096.0 * SIZE);
        glTexCoord4d(v[i].u * scale, v[i].v * scale, 0, w);
        glVertex3f((float)(sx[i] - left * ONE) / ONE, (float)(sy[i] - top * ONE) / ONE, (float)w);
    }
    glEnd();
    glFinish();
    return 1;
}

static int mesa_number(int x, int y) { return image[y][x][2] | image[y][x][3] << 8; }

static int draw_mesa_alone(const ew_raster_vertex v[3])
{
    clear_mesa();
    return draw_mesa(v, 1);
}

/* ---- coverage ---- */

/* Draws a triangle with everyone. Returns pixels covered, -1 for one that Mesa cannot hold. */
static long compare(const ew_raster_vertex v[3], int width, int height)
{
    int64_t sx[3], sy[3];
    long covered = 0;
    triangle_snapped(sx, sy, v);
    cover_begin(&by_edges, width, height);
    cover_begin(&by_rows, width, height);
    cover_by_edges(&by_edges, sx, sy);
    cover_by_rows(&by_rows, sx, sy, 3);
    draw_core(v);
    int held = draw_mesa_alone(v);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            int exact = cover_at(&by_edges, x, y), mesa = held ? mesa_number(x, y) != 0 : exact;
            covered += exact;
            if (hits[y * W + x] != exact || (depth[y * W + x] != 0) != exact || mesa != exact ||
                cover_at(&by_rows, x, y) != exact) {
                fail_msg("pixel %d %d: exact %d, the core %d, Mesa %d", x, y, exact, hits[y * W + x], mesa);
            }
        }
    }
    return held ? covered : -1;
}

/* Corners inside of a 128 x 128 picture: of every kind, then folded in; every other triangle
 * on half pixels. */
static void random_triangles(void **state)
{
    (void)state;
    enum { PICTURE = 128 };
    long triangles = 0, judged = 0;
    if (!mesa_start()) skip();
    start(PICTURE, PICTURE, EW_RUNG_EXACT, 0);
    for (cases c = cases_of("Mesa", 10000, 100000); cases_next(&c);) {
        ew_raster_vertex v[3];
        memset(v, 0, sizeof v);
        triangle_kind kind = (triangle_kind)(c.number / 2 % KIND_COUNT);
        triangle_place(v, kind, PICTURE, PICTURE);
        for (int i = 0; i < 3; i++) {
            v[i].x &= PICTURE * 4096 - 1, v[i].y &= PICTURE * 4096 - 1;
            if (c.number & 1) v[i].x &= ~2047, v[i].y &= ~2047;
            v[i].w = UINT32_C(1) << 30;
        }
        triangle_context(triangle_kind_name[kind], c.number, v);
        long covered = compare(v, PICTURE, PICTURE);
        assert_true(covered >= 0);
        judged += covered;
        triangles++;
    }
    cases_figure("Mesa", "random triangles", triangles, judged, 0, NAN, "");
}

/* ---- the standard scenes ---- */

static void trace_standard(char name)
{
    static standard_scene scene;
    static ew_screen_vertex screen[33 * 33];
    const ew_viewport viewport = { 0, -40, 320, 320 };
    const ew_projection projection = { 65536, 65536, { 1 << 29, -1 } };
    ew_geometry geometry;
    ew_mat34 model_view;
    double exact[3][4];
    standard_scene_init(&scene, name);
    standard_model_view(&model_view, exact);
    ew_geometry_init(&geometry, &raster);
    assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
    ew_transform_vertices(&geometry.transform, scene.vertices, scene.vertex_count, screen);
    traced.count = 0;
    const ew_mesh mesh = { .vertices = scene.vertices, .screen = screen, .indices = scene.indices,
                           .index_count = scene.index_count, .uv_fraction_bits = scene.uv_fraction_bits };
    assert_true(ew_draw_triangles(&geometry, &mesh) > 0);
    listed = traced;
}

/* All of the list, each triangle on its own. */
static void compare_list(const char *what)
{
    long judged = 0, left_out = 0;
    for (int i = 0; i < listed.count; i++) {
        test_context("%s, triangle %d", what, i);
        long covered = compare(listed.v[i], W, H);
        if (covered < 0) left_out++;
        else judged += covered;
    }
    cases_figure("Mesa", what, listed.count - left_out, judged, 0, NAN, "");
    if (left_out) {
        printf("# %s: %ld triangles are larger than Mesa's largest viewport: the two exact counts only\n", what, left_out);
    }
}

static void standard_scenes(void **state)
{
    (void)state;
    if (!mesa_start()) skip();
    start(W, H, EW_RUNG_EXACT, 0);
    for (char name = 'A'; name <= 'E'; name++) {
        char text[64];
        trace_standard(name);
        snprintf(text, sizeof text, "scene %c", name);
        compare_list(text);
    }
}

/* ---- nearest texels ---- */

typedef struct texels_seen {
    long triangles, pixels, other; /* other: not Mesa's texel                                 */
    long core_off, mesa_off;       /* outside of the promise's disc: the core's, Mesa's        */
} texels_seen;

static int texel_allowed(const exact_forms *f, int u, int v, double radius)
{
    const double e = 1.0 / 64;
    return exact_texel_radius(f, &f->u, u, SIZE, e) <= radius && exact_texel_radius(f, &f->v, v, SIZE, e) <= radius;
}

static void compare_texels(texels_seen *seen, const ew_raster_vertex v[3], int width, int height, uint16_t tolerance)
{
    exact_corners corners;
    draw_core(v);
    if (!draw_mesa_alone(v) || !exact_corners_init(&corners, v)) return;
    seen->triangles++;
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            if (!hits[y * W + x]) continue;
            int core_u = colour[y * W + x] & (SIZE - 1), core_v = colour[y * W + x] >> LOG2_SIZE;
            int mesa_u = image[y][x][0], mesa_v = image[y][x][1];
            exact_forms f = exact_from_corners(&corners, x, y);
            seen->pixels++;
            seen->core_off += !texel_allowed(&f, core_u, core_v, tolerance / 16.0 + 1.0 / 256);
            seen->mesa_off += !texel_allowed(&f, mesa_u, mesa_v, 1.0 / 256);
            seen->other += core_u != mesa_u || core_v != mesa_v;
        }
    }
}

static void texels_figure(const char *what, uint16_t tolerance, const texels_seen *s)
{
    char text[64];
    snprintf(text, sizeof text, "%s at %d/16 px", what, tolerance);
    test_context("%s: %ld texels of the core, %ld of Mesa beyond the promise", text, s->core_off, s->mesa_off);
    cases_figure("Mesa texels", text, s->triangles, s->pixels, s->core_off, (double)s->other, "px of another texel");
    assert_int_equal(s->core_off, 0);
    /* Mesa counts in floats and promises nothing: one of 30,011,684 texels was off. More, and it is no witness. */
    assert_true(s->mesa_off * 10000000 <= s->pixels);
}

/* At tolerance 0 and 1/4 px: a texel may differ from Mesa's where the exact u and v of the
 * promise's disc touch both. */
static void nearest_texels(void **state)
{
    (void)state;
    if (!mesa_start()) skip();
    static const uint16_t tolerances[] = { 0, 4 };
    for (int k = 0; k < 2; k++) {
        start(W, H, EW_RUNG_AUTO, tolerances[k]);
        for (char name = 'A'; name <= 'D'; name++) {
            texels_seen seen = { 0 };
            char text[64];
            trace_standard(name);
            for (int i = 0; i < listed.count; i++) compare_texels(&seen, listed.v[i], W, H, tolerances[k]);
            snprintf(text, sizeof text, "scene %c", name);
            texels_figure(text, tolerances[k], &seen);
        }
        texels_seen seen = { 0 };
        start(128, 128, EW_RUNG_AUTO, tolerances[k]);
        for (cases c = cases_of("Mesa texels", 500, 20000); cases_next(&c);) {
            ew_raster_vertex r[3];
            memset(r, 0, sizeof r);
            triangle_place(r, KIND_ORDINARY, 128, 128);
            for (int i = 0; i < 3; i++) {
                r[i].x &= 128 * 4096 - 1, r[i].y &= 128 * 4096 - 1;
                r[i].w = (uint32_t)ldexp(0.9 * pow(10, uniform(-2, 0)), 31);
                r[i].u = (int32_t)pick(1u << 20), r[i].v = (int32_t)pick(1u << 20); /* 256 texels */
            }
            compare_texels(&seen, r, 128, 128, tolerances[k]);
        }
        texels_figure("random triangles", tolerances[k], &seen);
    }
}

/* ---- the sample scenes ---- */

static struct {
    ew_scene scene;
    ew_scene_camera camera;
    uint32_t bytes[1 << 18];
    ew_mat34 world[64];
    ew_screen_vertex scratch[4096];
    const char *name;
} sample;

/* EW_BIN is the folder of the programs; baked scenes lie beside it. */
static void open_sample(const char *name)
{
    char path[4096];
    const char *bin = getenv("EW_BIN");
    snprintf(path, sizeof path, "%s/../scenes/%s.ewb", bin ? bin : "build/release/bin", name);
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("%s: cannot be opened", path);
    size_t size = fread(sample.bytes, 1, sizeof sample.bytes, file);
    fclose(file);
    assert_int_equal(ew_scene_open(&sample.scene, sample.bytes, size), EW_OK);
    assert_true(sample.scene.section[EW_SECTION_NODE].count <= 64 && sample.scene.largest_primitive <= 4096);
    ew_scene_get_camera(&sample.scene, &sample.camera);
    sample.name = name;
}

/* Draws it as firmware would, and lists what was drawn. */
static void draw_sample(uint32_t time_ms)
{
    static ew_geometry geometry;
    const ew_viewport viewport = { 0, 0, W, H };
    const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    ew_geometry_init(&geometry, &raster);
    ew_raster_clear(&raster, 0);
    traced.count = 0;
    assert_int_equal(ew_scene_pose(&sample.scene, time_ms, sample.world), EW_OK);
    assert_true(ew_scene_draw(&sample.scene, &sample.camera, sample.world, &viewport, &geometry, sample.scratch) > 0);
    listed = traced;
}

typedef struct picture_seen {
    long pixels, other_triangle, other_texel, wrong;
} picture_seen;

/* The whole picture, depth tests and all. Mesa and the core show the same triangle, or two whose depths
 * are one and the same unit of the 16-bit buffer there; of the same triangle each shows a texel that
 * its promise allows. Texels are told apart modulo the texture's size, which divides SIZE. */
static void compare_picture(picture_seen *seen)
{
    static exact_corners corners[MOST_TRIANGLES];
    clear_mesa();
    for (int i = 0; i < listed.count; i++) {
        assert_true(draw_mesa(listed.v[i], i + 1));
        assert_true(exact_corners_init(&corners[i], listed.v[i]));
        if (listed.width[i]) assert_true(SIZE % listed.width[i] == 0 && SIZE % listed.height[i] == 0);
    }
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
            int shown = depth[y * W + x] != 0, core = seen_at[y][x].triangle, mesa = mesa_number(x, y) - 1;
            if (shown != (mesa >= 0)) fail_msg("%s, pixel %d %d: the core %d, Mesa %d", sample.name, x, y, shown, mesa + 1);
            if (!shown) continue;
            seen->pixels++;
            exact_forms f = exact_from_corners(&corners[mesa], x, y);
            if (core != mesa) {
                exact_forms own = exact_from_corners(&corners[core], x, y);
                seen->other_triangle++;
                /* a clamped depth, of which exact_depth_off says nothing, is wrong here, too */
                seen->wrong += !(exact_depth_off(&f, depth[y * W + x], 1.0 / 256) <= 1 &&
                                 exact_depth_off(&own, depth[y * W + x], 1.0 / 256) <= 1);
                continue;
            }
            int width = listed.width[core], height = listed.height[core];
            if (!width) continue;
            int u = seen_at[y][x].u >> 12 & (width - 1), v = seen_at[y][x].v >> 12 & (height - 1);
            int mesa_u = image[y][x][0] & (width - 1), mesa_v = image[y][x][1] & (height - 1);
            if (u == mesa_u && v == mesa_v) continue;
            const double e = 1.0 / 64, near = 1.0 / 256, radius = 4 / 16.0 + near;
            seen->other_texel++;
            seen->wrong += exact_texel_radius(&f, &f.u, u, width, e) > radius ||
                           exact_texel_radius(&f, &f.v, v, height, e) > radius ||
                           exact_texel_radius(&f, &f.u, mesa_u, width, e) > near ||
                           exact_texel_radius(&f, &f.v, mesa_v, height, e) > near;
        }
    }
}

static void sample_scenes(void **state)
{
    static const char *const names[] = { "courtyard", "crate" };
    enum { POSES = 3 };
    (void)state;
    if (!mesa_start()) skip();
    for (size_t s = 0; s < sizeof names / sizeof names[0]; s++) {
        picture_seen picture = { 0 };
        texels_seen texel = { 0 };
        char text[64];
        long triangles = 0;
        open_sample(names[s]);
        for (uint32_t pose = 0; pose < POSES; pose++) {
            uint32_t time_ms = sample.scene.duration_ms * pose / POSES;
            snprintf(text, sizeof text, "%s at %u ms", sample.name, (unsigned)time_ms);
            draw_sample(time_ms);
            triangles += listed.count;
            compare_picture(&picture);
            start(W, H, EW_RUNG_EXACT, 0);
            compare_list(text);
            start(W, H, EW_RUNG_AUTO, 4);
            for (int i = 0; i < listed.count; i++) {
                if (listed.width[i]) compare_texels(&texel, listed.v[i], W, H, 4);
            }
        }
        texels_figure(sample.name, 4, &texel);
        test_context("%s: %ld of %ld px wrong", sample.name, picture.wrong, picture.pixels);
        cases_figure("Mesa pictures", sample.name, triangles, picture.pixels, picture.wrong,
                     (double)(picture.other_texel + picture.other_triangle), "px of another texel or triangle");
        assert_int_equal(picture.wrong, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(random_triangles), TEST(standard_scenes), TEST(nearest_texels),
                                        TEST(sample_scenes) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
