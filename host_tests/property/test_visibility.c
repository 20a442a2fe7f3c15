/* EW_DEPTH_SPANS: what is seen, and how it is drawn.
 *
 * Triangles are objects of their own here. Drawn in one colour each they tell who is seen at a pixel, which
 * depth buffers judge: one for each triangle alone. Who is seen known, every piece of a row is drawn once
 * more by itself, in its material, cut by a scissor: that is the picture, to the bit. */
#include "cases.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../reference/scenes.h"
#include "random_scene.h"

enum { MOST = 2000, WIDEST = STANDARD_WIDTH, HIGHEST = STANDARD_HEIGHT, PIXELS = WIDEST * HIGHEST };

static struct {
    ew_picture picture;
    ew_object object[MOST];
    uint32_t count;
    const ew_screen_vertex *screen[MOST]; /* of all vertices */
} scene;

static random_scene from;

static uint16_t owner[PIXELS];            /* 1 + the object that is seen, by EW_DEPTH_SPANS; 0: none */
static uint16_t expected[PIXELS], depth[PIXELS], best[PIXELS];
static const uint8_t bits_of[] = { 16, 16, 8, 8, 4, 1 };

static uint32_t stride(void) { return (scene.picture.width + 7u) / 8u * 8u; }

/* ---- scenes ---- */

static void make_opaque(ew_material *m)
{
    m->blend = EW_BLEND_NONE;
    m->flags &= (uint8_t)~(EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE | EW_COLOUR_KEY | EW_ALPHA_MASK);
}

static ew_object *add(const ew_object *of, const uint16_t *index, const ew_screen_vertex *screen)
{
    ew_object *o = &scene.object[scene.count];
    scene.screen[scene.count++] = screen;
    *o = *of;
    o->mesh.indices = index;
    o->mesh.index_count = 3;
    if (o->material.texture == &of->texture) o->material.texture = &o->texture;
    return o;
}

/* Triangles anywhere, through each other; some of them twice. */
static void random_triangles(void)
{
    random_scene_init(&from);
    scene.picture = from.picture;
    scene.picture.visibility = EW_DEPTH_SPANS;
    scene.count = 0;
    for (uint32_t i = 0; i < from.count; i++) {
        ew_object *o = &from.object[i];
        make_opaque(&o->material);
        for (uint32_t k = 0; k < o->mesh.index_count; k += 3) {
            add(o, o->mesh.indices + k, from.screen[i]);
            if (pick(8) == 0) add(o, o->mesh.indices + k, from.screen[i]);
        }
    }
}

static int is_twin(uint32_t i)
{
    if (i == 0) return 0;
    const uint32_t before = i - 1;
    return scene.object[i].mesh.indices == scene.object[before].mesh.indices && scene.screen[i] == scene.screen[before];
}

/* ---- drawing ---- */

typedef struct context {
    ew_raster raster;
    ew_geometry geometry;
    ew_picture picture;
    ew_picture_counts counts;
    size_t bytes;
    uint16_t *out; /* rows of stride() pixels */
    int result, next_row;
} context;

static void take_band(void *user, const ew_target *band)
{
    context *c = user;
    const uint32_t bits = bits_of[band->format], bytes = band->stride * bits / 8, out_bytes = stride() * bits / 8;
    if (band->first_row != c->next_row || band->depth) c->next_row = -10000;
    c->next_row += band->height;
    for (uint32_t y = 0; y < band->height; y++) {
        memcpy((uint8_t *)c->out + (band->first_row + y) * out_bytes, (const uint8_t *)band->colour + y * bytes, bytes);
    }
}

/* Into memory of just that size, at any address. */
static void *draw(void *user)
{
    context *c = user;
    uint8_t *const all = malloc(c->bytes + 8), *const memory = all ? all + c->bytes % 8 : NULL;
    if (!memory) abort();
    memset(all, 0x5A, c->bytes + 8);
    c->picture.band = take_band;
    c->picture.user = c;
    c->next_row = c->picture.first_row;
    ew_geometry_init(&c->geometry, &c->raster);
    c->result = ew_picture_draw(&c->picture, scene.object, scene.count, &c->geometry, memory, c->bytes, &c->counts);
    for (size_t i = 0; i < c->bytes % 8; i++) c->result = all[i] == 0x5A ? c->result : 100;
    for (size_t i = c->bytes % 8; i < 8; i++) c->result = all[c->bytes + i] == 0x5A ? c->result : 100;
    free(all);
    return NULL;
}

static size_t least(const ew_picture *p) { return ew_picture_least(p, scene.object, scene.count); }

static void random_memory(context *c)
{
    assert_true(least(&c->picture) > 0);
    c->bytes = least(&c->picture) + (pick(3) == 0 ? 0 : pick(3) ? pick(6000) : pick(60000));
}

static void check(const context *c)
{
    assert_int_equal(c->result, EW_OK);
    assert_int_equal(c->next_row, c->picture.end_row);
}

/* Each object with a colour of its own, on a target that keeps it. */
static void find_owners(context *c)
{
    static ew_material kept[MOST];
    for (uint32_t i = 0; i < scene.count; i++) {
        ew_material *m = &scene.object[i].material;
        kept[i] = *m;
        *m = (ew_material){ .colour = (uint16_t)(i + 1), .rung = EW_RUNG_CONSTANT, .flags = m->flags & EW_DOUBLE_SIDED };
    }
    c->picture = scene.picture;
    c->picture.format = EW_TARGET_RGB565;
    c->picture.dither = 0;
    c->picture.background = 0;
    c->picture.buffers = 1;
    c->picture.rows = (uint16_t)(1 + pick(c->picture.height));
    random_memory(c);
    c->out = memset(owner, 0, sizeof owner);
    draw(c);
    check(c);
    for (uint32_t i = 0; i < scene.count; i++) scene.object[i].material = kept[i];
}

static ew_raster alone;
static ew_geometry alone_geometry;

static void start_alone(uint16_t *colour, uint16_t *z, uint8_t format, uint8_t dither)
{
    const ew_picture *p = &scene.picture;
    const ew_target target = { .colour = colour, .depth = z, .width = p->width, .height = p->height, .stride = (uint16_t)stride(),
                               .format = format, .dither = dither };
    assert_int_equal(ew_raster_init(&alone, &target), EW_OK);
    if (p->cost) assert_int_equal(ew_raster_set_cost(&alone, p->cost), EW_OK);
    if (p->fog_near) assert_int_equal(ew_raster_set_fog(&alone, p->fog_colour, p->fog_near, p->fog_far), EW_OK);
    ew_geometry_init(&alone_geometry, &alone);
}

static void draw_alone(uint32_t i, const ew_rect *rect)
{
    const ew_object *o = &scene.object[i];
    ew_mesh mesh = o->mesh;
    mesh.screen = scene.screen[i];
    alone_geometry.transform = o->transform;
    assert_int_equal(ew_raster_set_scissor(&alone, rect), EW_OK);
    assert_true(ew_draw_triangles(&alone_geometry, &mesh) >= 0);
}

/* ---- judging ---- */

/* Whoever is seen is nearest, but for a unit of 16 bits, the last bits of a depth that is stepped; whoever comes
 * twice is seen the first time. Returns how many of whoever covers a pixel are not seen there. */
static long judge_owners(void)
{
    static uint16_t ignored[PIXELS];
    long hidden = 0;
    memset(best, 0, sizeof best);
    for (int again = 0; again < 2; again++) {
        for (uint32_t i = 0; i < scene.count; i++) {
            memset(depth, 0, stride() * scene.picture.height * sizeof *depth);
            start_alone(ignored, depth, EW_TARGET_RGB565, 0);
            const ew_material m = { .rung = EW_RUNG_CONSTANT, .flags = scene.object[i].material.flags & EW_DOUBLE_SIDED };
            assert_int_equal(ew_raster_set_material(&alone, &m), EW_OK);
            draw_alone(i, &scene.picture.scissor);
            for (uint32_t at = 0; at < stride() * scene.picture.height; at++) {
                if (!again) {
                    if (depth[at] > best[at]) best[at] = depth[at];
                } else if (owner[at] != i + 1) {
                    hidden += depth[at] > 0;
                    if (owner[at] == 0 && depth[at]) fail_msg("pixel %u,%u: %u is not seen", at % stride(), at / stride(), i);
                } else if (depth[at] == 0 || depth[at] + 1 < best[at] || is_twin(i)) {
                    fail_msg("pixel %u,%u: %u with depth %d is seen and not %d", at % stride(), at / stride(), i, depth[at], best[at]);
                }
            }
        }
    }
    return hidden;
}

/* The picture, piece by piece, to `expected`. */
static long draw_pieces(void)
{
    const ew_picture *p = &scene.picture;
    long pieces = 0;
    memset(expected, 0, sizeof expected);
    start_alone(expected, NULL, p->format, p->dither);
    ew_raster_clear(&alone, p->background);
    for (uint16_t y = 0; y < p->height; y++) {
        const uint16_t *row = owner + y * stride();
        for (uint16_t x = 0, end; x < p->width; x = end) {
            for (end = x + 1; end < p->width && row[end] == row[x];) end++;
            if (row[x] == 0) continue;
            assert_int_equal(ew_raster_set_material(&alone, &scene.object[row[x] - 1u].material), EW_OK);
            draw_alone(row[x] - 1u, &(ew_rect){ x, y, end, (uint16_t)(y + 1) });
            pieces++;
        }
    }
    return pieces;
}

static unsigned pixel_at(const uint16_t *memory, uint32_t x, uint32_t y)
{
    const uint32_t bits = bits_of[scene.picture.format], at = (y * stride() + x) * bits;
    const uint8_t *byte = (const uint8_t *)memory + at / 8;
    if (bits == 16) return byte[0] | (unsigned)byte[1] << 8;
    return (unsigned)(byte[0] >> (8 - bits - at % 8) & ((1 << bits) - 1));
}

static long differing(const context *c)
{
    long n = 0;
    for (uint32_t y = c->picture.first_row; y < c->picture.end_row; y++) {
        for (uint32_t x = 0; x < c->picture.width; x++) n += pixel_at(c->out, x, y) != pixel_at(expected, x, y);
    }
    return n;
}

/* ---- tests ---- */

static void nearest_is_seen(void **state)
{
    (void)state;
    static context c;
    static uint16_t out[PIXELS];
    long count = 0, hidden = 0, pieces = 0, crossings = 0, again = 0, sections = 0;
    for (cases k = cases_of("visibility", 2500, 100000); cases_next(&k); count++) {
        random_triangles();
        find_owners(&c);
        test_context("EW_CASE=%ld, %dx%d, %u triangles, bands of %d, %zu bytes", k.number, c.picture.width, c.picture.height,
                     (unsigned)scene.count, c.picture.rows, c.bytes);
        hidden += judge_owners();
        pieces += draw_pieces();
        c.picture = scene.picture;
        c.picture.buffers = (uint8_t)(1 + pick(2));
        c.picture.rows = (uint16_t)(pick(2) ? 1 : 1 + pick(c.picture.height));
        random_memory(&c);
        test_context("EW_CASE=%ld, %dx%d, %u triangles, bands of %d, %zu bytes", k.number, c.picture.width, c.picture.height,
                     (unsigned)scene.count, c.picture.rows, c.bytes);
        c.out = out;
        draw(&c);
        check(&c);
        assert_int_equal(differing(&c), 0);
        crossings += c.counts.crossings, again += c.counts.again, sections += c.counts.sections;
        c.bytes = least(&c.picture) - 1;
        draw(&c);
        assert_int_equal(c.result, EW_ERR_ROOM);
    }
    cases_figure("visibility", "nearest is seen", count, pieces, 0, (double)crossings, "crossings");
    printf("# %ld hidden fragments, %ld set-ups for want of room, %ld sections\n", hidden, again, sections);
    assert_true((hidden > 100 * count && pieces > 20 * count && crossings > 3 * count && again > count && sections > count / 4) || cases_alone());
}

/* Sheets that do not intersect: parallel planes, each a grid of triangles that touch; the sheets in any
 * order. */
enum { SHEETS = 12, GRID = 4 };

static void random_sheets(void)
{
    static ew_vertex16 vertex[SHEETS][GRID * GRID];
    static uint16_t index[6 * (GRID - 1) * (GRID - 1)];
    static ew_screen_vertex screen[SHEETS][GRID * GRID];
    const int32_t across = (int32_t)pick(40000) - 20000, down = (int32_t)pick(40000) - 20000;
    random_scene_init(&from);
    ew_picture *p = &scene.picture;
    *p = from.picture;
    p->visibility = EW_DEPTH_SPANS;
    scene.count = 1 + pick(SHEETS);
    for (unsigned i = 0, at = 0; i < GRID * GRID - GRID; i++) {
        if (i % GRID == GRID - 1) continue;
        const uint16_t corner = (uint16_t)i;
        const uint16_t six[] = { corner, corner + GRID, corner + 1, corner + 1, corner + GRID, corner + GRID + 1 };
        memcpy(index + at, six, sizeof six);
        at += 6;
    }
    static uint32_t place[SHEETS];
    for (uint32_t i = 0; i < scene.count; i++) {
        const uint32_t at = pick(i + 1);
        place[i] = place[at];
        place[at] = i;
    }
    for (uint32_t i = 0; i < scene.count; i++) {
        ew_object *o = &scene.object[i];
        const ew_projection projection = { 98304, 98304, { INT32_C(1) << 29, -1 } };
        const ew_viewport viewport = { 0, 0, p->width, p->height };
        /* x and y in units of 1/32, z = -2 - i/4 + a x + b y, |a x + b y| <= 1.25; near is 0.5 */
        ew_mat34 m;
        ew_row_from_q16_16(&m.row[0], 2 * 65536, 0, 0, 0);
        ew_row_from_q16_16(&m.row[1], 0, 2 * 65536, 0, 0);
        ew_row_from_q16_16(&m.row[2], across, down, 0, -131072 - (int32_t)place[i] * 16384);
        assert_int_equal(ew_transform_set(&o->transform, &projection, &m, &viewport), EW_OK);
        for (int k = 0; k < GRID * GRID; k++) {
            vertex[i][k] = (ew_vertex16){ .x = (int16_t)(k % GRID * 20000 - 30000 + (int32_t)pick(8000) - 4000 + (k % GRID == 0 ? 2000 : k % GRID == 3 ? -2000 : 0)),
                                          .y = (int16_t)(30000 - k / GRID * 20000 + (int32_t)pick(8000) - 4000 + (k / GRID == 0 ? -2000 : k / GRID == 3 ? 2000 : 0)),
                                          .u = (int16_t)pick(4096), .v = (int16_t)pick(4096) };
        }
        o->vertex_count = GRID * GRID;
        o->mesh = (ew_mesh){ .vertices = vertex[i], .indices = index, .index_count = sizeof index / sizeof *index, .uv_fraction_bits = 4 };
        ew_transform_vertices(&o->transform, vertex[i], GRID * GRID, screen[i]);
        scene.screen[i] = screen[i];
        random_material(&o->material, &o->texture);
        make_opaque(&o->material);
        o->material.flags &= (uint8_t)~EW_DOUBLE_SIDED;
    }
}

/* The picture with a depth buffer, at once, to `expected`. */
static void draw_with_depth(void)
{
    memset(expected, 0, sizeof expected);
    start_alone(expected, depth, scene.picture.format, scene.picture.dither);
    ew_raster_clear(&alone, scene.picture.background);
    for (uint32_t i = 0; i < scene.count; i++) {
        assert_int_equal(ew_raster_set_material(&alone, &scene.object[i].material), EW_OK);
        draw_alone(i, &scene.picture.scissor);
    }
}

static void draw_any_way(context *c)
{
    static uint16_t out[PIXELS];
    c->picture = scene.picture;
    c->picture.buffers = (uint8_t)(1 + pick(2));
    c->picture.rows = (uint16_t)(1 + pick(c->picture.height));
    random_memory(c);
    c->out = out;
    draw(c);
    check(c);
}

/* Where nothing intersects the picture is the depth buffer's: who is seen, always; the pixels, at tolerance 0. */
static void depth_buffer_agrees(void **state)
{
    (void)state;
    static context c;
    long count = 0, pixels = 0, differ = 0;
    for (cases k = cases_of("visibility, sheets", 1500, 60000); cases_next(&k); count++) {
        random_sheets();
        for (uint32_t i = 0; i < scene.count; i++) {
            scene.object[i].material.tolerance = 0;
            scene.object[i].material.rung = EW_RUNG_AUTO;
        }
        draw_with_depth();
        draw_any_way(&c);
        test_context("EW_CASE=%ld, %dx%d, %u sheets", k.number, c.picture.width, c.picture.height, (unsigned)scene.count);
        differ += differing(&c);
        assert_int_equal(c.counts.crossings, 0);
        for (uint32_t i = 0; i < scene.count; i++) {
            scene.object[i].material = (ew_material){ .colour = (uint16_t)((i + 1) * 0x1234), .rung = EW_RUNG_CONSTANT };
        }
        draw_with_depth();
        draw_any_way(&c);
        assert_int_equal(differing(&c), 0);
        pixels += c.picture.width * c.picture.height;
    }
    cases_figure("visibility", "depth buffer agrees", count, pixels, differ, NAN, "");
    assert_int_equal(differ, 0);
}

/* The standard scenes, each triangle by itself, textured; B's sphere, whose back faces are culled, is as all closed
 * meshes are. */
static void standard_scenes(void **state)
{
    (void)state;
    static context c;
    static standard_scene standard;
    static ew_screen_vertex screen[33 * 33];
    static uint16_t texels[256 * 256];
    const ew_texture texture = { .texels = texels, .width = 256, .height = 256 };
    const ew_projection projection = { 65536, 65536, { INT32_C(1) << 29, -1 } };
    const ew_viewport square = { 0, -40, STANDARD_WIDTH, STANDARD_WIDTH };
    ew_mat34 model_view;
    double exact[3][4];
    standard_texture(texels);
    standard_model_view(&model_view, exact);
    for (char name = 'A'; name <= 'E'; name++) {
        standard_scene_init(&standard, name);
        ew_object o = { .vertex_count = standard.vertex_count, .material = { .texture = &texture } };
        assert_int_equal(ew_transform_set(&o.transform, &projection, &model_view, &square), EW_OK);
        ew_transform_vertices(&o.transform, standard.vertices, standard.vertex_count, screen);
        o.mesh = (ew_mesh){ standard.vertices, screen, NULL, NULL, 0, standard.uv_fraction_bits };
        scene.picture = (ew_picture){ .width = STANDARD_WIDTH, .height = STANDARD_HEIGHT, .visibility = EW_DEPTH_SPANS,
                                      .end_row = STANDARD_HEIGHT, .scissor = { 0, 0, STANDARD_WIDTH, STANDARD_HEIGHT } };
        scene.count = 0;
        for (uint32_t k = 0; k < standard.index_count; k += 3) add(&o, standard.indices + k, screen);
        find_owners(&c);
        judge_owners();
        draw_with_depth();
        draw_any_way(&c);
        test_context("scene %c", name);
        assert_int_equal(c.counts.crossings, 0);
        /* at tolerance 0 narrow triangles, B's and D's, are the same to the bit */
        const long differ = differing(&c);
        assert_true(name == 'B' || name == 'D' ? differ == 0 : differ < 250);
    }
}

/* Two contexts, two threads, different rows. */
static void two_threads(void **state)
{
    (void)state;
    static context c[2];
    static uint16_t out[2][PIXELS];
    for (cases k = cases_of("visibility, threads", 300, 10000); cases_next(&k);) {
        random_triangles();
        if (scene.picture.height < 2) continue;
        find_owners(&c[0]);
        draw_pieces();
        const uint16_t border = (uint16_t)(1 + pick(scene.picture.height - 1u));
        pthread_t thread[2];
        for (int i = 0; i < 2; i++) {
            random_half(&c[i].picture, &scene.picture, border, i);
            c[i].out = out[i];
            random_memory(&c[i]);
        }
        test_context("EW_CASE=%ld, border %d, bands of %d and %d", k.number, border, c[0].picture.rows, c[1].picture.rows);
        for (int i = 0; i < 2; i++) assert_int_equal(pthread_create(&thread[i], NULL, draw, &c[i]), 0);
        for (int i = 0; i < 2; i++) assert_int_equal(pthread_join(thread[i], NULL), 0);
        for (int i = 0; i < 2; i++) {
            check(&c[i]);
            assert_int_equal(differing(&c[i]), 0);
        }
    }
}

/* One sheet through another: each row on which they pass through one another is counted once. */
static void crossings_are_counted(void **state)
{
    (void)state;
    static context c;
    static const ew_vertex16 flat[3] = { { -30000, 30000, 0, 0, 0 }, { -30000, -30000, 0, 0, 0 }, { 30000, -30000, 0, 0, 0 } };
    static const ew_vertex16 sloped[3] = { { -30000, 30000, -9000, 0, 0 }, { -30000, -30000, -9000, 0, 0 }, { 30000, -30000, 9000, 0, 0 } };
    static const uint16_t index[3] = { 0, 1, 2 };
    const ew_projection projection = { 65536, 65536, { INT32_C(1) << 29, -1 } };
    const ew_viewport viewport = { 0, 0, 64, 64 };
    ew_mat34 m;
    for (int i = 0; i < 3; i++) {
        ew_row_from_q16_16(&m.row[i], i == 0 ? 131072 : 0, i == 1 ? 131072 : 0, i == 2 ? 131072 : 0, i == 2 ? -131072 : 0);
    }
    scene.picture = (ew_picture){ .width = 64, .height = 64, .visibility = EW_DEPTH_SPANS, .end_row = 64, .scissor = { 0, 0, 64, 64 } };
    scene.count = 2;
    static ew_screen_vertex screen[2][3];
    for (int i = 0; i < 2; i++) {
        ew_object *o = &scene.object[i];
        *o = (ew_object){ .vertex_count = 3 };
        assert_int_equal(ew_transform_set(&o->transform, &projection, &m, &viewport), EW_OK);
        o->mesh = (ew_mesh){ i ? sloped : flat, NULL, NULL, index, 3, 0 };
        ew_transform_vertices(&o->transform, o->mesh.vertices, 3, screen[i]);
        scene.screen[i] = screen[i];
    }
    find_owners(&c);
    assert_true(judge_owners() > 500);
    unsigned rows = 0;
    for (int y = 0; y < 64; y++) { /* both are seen */
        int seen[3] = { 0, 0, 0 };
        for (int x = 0; x < 64; x++) seen[owner[y * 64 + x]] = 1;
        rows += seen[1] && seen[2];
    }
    assert_true(rows > 20);
    assert_int_equal(c.counts.crossings, rows);
}

/* What cannot be drawn so is refused, before a row is. */
static void refusals(void **state)
{
    (void)state;
    static context c;
    static uint16_t out[PIXELS];
    test_restart(1);
    do random_triangles(); while (scene.count == 0);
    c.picture = scene.picture;
    c.picture.buffers = 1;
    c.picture.rows = 1;
    c.out = out;
    c.bytes = least(&c.picture);
    if (!EW_WITH_SPANS) {
        draw(&c);
        assert_int_equal(c.result, EW_ERR_UNSUPPORTED);
        return;
    }
    ew_material *const m = &scene.object[scene.count - 1].material, before = *m;
    const struct {
        uint8_t flags, blend, textured;
        int result;
    } table[] = { { 0, EW_BLEND_HALF, 0, EW_ERR_UNSUPPORTED }, { 0, EW_BLEND_ADD, 1, EW_ERR_UNSUPPORTED },
                  { EW_NO_DEPTH_TEST, 0, 0, EW_ERR_UNSUPPORTED }, { EW_NO_DEPTH_WRITE, 0, 0, EW_ERR_UNSUPPORTED },
                  { EW_COLOUR_KEY, 0, 1, EW_ERR_UNSUPPORTED }, { EW_COLOUR_KEY, 0, 0, EW_OK },
                  { EW_ALPHA_MASK, 0, 1, EW_ERR_UNSUPPORTED }, { EW_ALPHA_MASK, 0, 0, EW_OK },
                  { EW_SHADED | EW_DOUBLE_SIDED, 0, 0, EW_OK } };
    static const uint16_t texels[4];
    static const uint8_t mask[2];
    const ew_texture texture = { .texels = texels, .width = 2, .height = 2, .mask = mask };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        *m = (ew_material){ .flags = table[i].flags, .blend = table[i].blend, .texture = table[i].textured ? &texture : NULL };
        test_context("row %zu", i);
        draw(&c);
        assert_int_equal(c.result, table[i].result);
        assert_int_equal(c.next_row, table[i].result ? 0 : c.picture.height);
    }
    *m = before;
    c.picture.visibility = EW_DEPTH_SPANS + 1;
    assert_int_equal(least(&c.picture), 0);
}

int main(void)
{
    const struct CMUnitTest left_out[] = { TEST(refusals) };
    if (!EW_WITH_SPANS) return cmocka_run_group_tests(left_out, NULL, NULL);
    const struct CMUnitTest tests[] = { TEST(nearest_is_seen), TEST(depth_buffer_agrees), TEST(standard_scenes), TEST(two_threads),
                                        TEST(crossings_are_counted), TEST(refusals) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
