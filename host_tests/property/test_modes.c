/* The memory modes: bands of any height, in any memory from the least on, are one picture. */
#include "cases.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "random_scene.h"

static random_scene scene;
static picture whole;

/* ---- the picture at once, by the layers below ---- */

static uint32_t stride(void) { return random_scene_stride(&scene); }

static int draw_whole_of(ew_screen_vertex *const screen[])
{
    static ew_raster raster;
    static ew_geometry geometry;
    const ew_picture *p = &scene.picture;
    const ew_target target = { .colour = whole.colour, .depth = p->visibility == EW_DEPTH_BUFFER ? whole.depth : NULL,
                               .width = p->width, .height = p->height, .stride = (uint16_t)stride(), .format = p->format,
                               .dither = p->dither };
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    if (p->cost) assert_int_equal(ew_raster_set_cost(&raster, p->cost), EW_OK);
    if (p->fog_near) assert_int_equal(ew_raster_set_fog(&raster, p->fog_colour, p->fog_near, p->fog_far), EW_OK);
    memset(&whole, 0, sizeof whole);
    ew_raster_clear(&raster, p->background);
    assert_int_equal(ew_raster_set_scissor(&raster, &p->scissor), EW_OK);
    ew_geometry_init(&geometry, &raster);
    int drawn = 0;
    for (uint32_t i = 0; i < scene.count; i++) {
        ew_mesh mesh = scene.object[i].mesh;
        mesh.screen = screen[i];
        assert_int_equal(ew_raster_set_material(&raster, &scene.object[i].material), EW_OK);
        geometry.transform = scene.object[i].transform;
        const int32_t result = ew_draw_triangles(&geometry, &mesh);
        assert_true(result >= 0);
        drawn += (int)result;
    }
    return drawn;
}

static int draw_whole(void)
{
    ew_screen_vertex *screen[SCENE_OBJECTS];
    for (int i = 0; i < SCENE_OBJECTS; i++) screen[i] = scene.screen[i];
    return draw_whole_of(screen);
}

/* ---- the same in bands ---- */

static const uint8_t bits_of[] = { 16, 16, 8, 8, 4, 1 };

/* What a callback finds; the first pixel that differs. */
typedef struct seen {
    ew_raster *raster;
    int next_row, wrong_x, wrong_y, wrong; /* -1: none */
    void *last;
    int buffers;
} seen;

static unsigned pixel_at(const void *memory, uint32_t row_pixels, uint32_t x, uint32_t y)
{
    const uint32_t bits = bits_of[scene.picture.format], at = (y * row_pixels + x) * bits;
    const uint8_t *byte = (const uint8_t *)memory + at / 8;
    if (bits == 16) return byte[0] | (unsigned)byte[1] << 8;
    return (unsigned)(byte[0] >> (8 - bits - at % 8) & ((1 << bits) - 1));
}

static void compare(void *user, const ew_target *band)
{
    seen *s = user;
    if (band->first_row != s->next_row) s->wrong = 2;
    if (s->last && (s->buffers == 2) != (s->last != band->colour)) s->wrong = 3;
    s->last = band->colour;
    s->next_row = band->first_row + band->height;
    for (uint32_t y = 0; y < band->height; y++) {
        for (uint32_t x = 0; x < band->width; x++) {
            const uint32_t in_whole = band->first_row + y;
            int same = pixel_at(band->colour, band->stride, x, y) == pixel_at(whole.colour, stride(), x, in_whole);
            if (band->depth) same &= band->depth[y * band->stride + x] == whole.depth[in_whole * stride() + x];
            if (!same && !s->wrong) s->wrong = 1, s->wrong_x = (int)x, s->wrong_y = (int)in_whole;
        }
    }
    /* a callback may draw, and leave its scissor behind */
    const ew_rect scissor = { (uint16_t)(band->width / 3), band->first_row, (uint16_t)((band->width + 1) / 2), (uint16_t)(band->first_row + 1) };
    if (ew_raster_set_scissor(s->raster, &scissor) != EW_OK) s->wrong = 5;
    ew_raster_clear(s->raster, 0x1234);
}

typedef struct context {
    ew_raster raster;
    ew_geometry geometry;
    seen seen;
    ew_picture picture;
    ew_picture_counts counts;
    size_t bytes;
    int result;
} context;

/* Draws into memory of just that size, at any address. */
static void *draw(void *user)
{
    context *c = user;
    uint8_t *const all = malloc(c->bytes + 8), *const memory = all ? all + c->bytes % 8 : NULL;
    if (!memory) abort();
    memset(all, 0x5A, c->bytes + 8);
    c->seen = (seen){ .raster = &c->raster, .next_row = c->picture.first_row, .buffers = c->picture.buffers };
    c->picture.band = compare;
    c->picture.user = &c->seen;
    ew_geometry_init(&c->geometry, &c->raster);
    c->result = ew_picture_draw(&c->picture, scene.object, scene.count, &c->geometry, memory, c->bytes, &c->counts);
    for (size_t i = 0; i < c->bytes % 8; i++) c->seen.wrong = all[i] == 0x5A ? c->seen.wrong : 4;
    for (size_t i = c->bytes % 8; i < 8; i++) c->seen.wrong = all[c->bytes + i] == 0x5A ? c->seen.wrong : 4;
    free(all);
    return NULL;
}

static void check(const context *c)
{
    assert_int_equal(c->result, EW_OK);
    assert_int_equal(c->seen.next_row, c->picture.end_row);
    if (c->seen.wrong) fail_msg("kind %d, pixel %d,%d", c->seen.wrong, c->seen.wrong_x, c->seen.wrong_y);
}

static void random_memory(context *c)
{
    const size_t least = ew_picture_least(&c->picture, scene.object, scene.count);
    assert_true(least > 0);
    c->bytes = least + (pick(3) == 0 ? 0 : pick(3) ? pick(3000) : pick(60000));
}

static void any_band_any_memory(void **state)
{
    (void)state;
    static context c;
    long drawn = 0, count = 0, again = 0, active = 0, refused = 0;
    for (cases k = cases_of("modes", 6000, 300000); cases_next(&k); count++) {
        random_scene_init(&scene);
        c.picture = scene.picture;
        c.picture.buffers = (uint8_t)(1 + pick(2));
        c.picture.rows = (uint16_t)(pick(2) ? 1 : 1 + pick(c.picture.height));
        random_memory(&c);
        test_context("EW_CASE=%ld, %dx%d, bands of %d, %zu bytes", k.number, c.picture.width, c.picture.height, c.picture.rows, c.bytes);
        drawn += draw_whole();
        draw(&c);
        check(&c);
        again += c.counts.again, active += c.counts.most_active;
        c.bytes = ew_picture_least(&c.picture, scene.object, scene.count) - 1;
        draw(&c);
        refused += c.result == EW_ERR_ROOM;
        assert_int_equal(c.result, EW_ERR_ROOM);
    }
    cases_figure("modes", "one picture", count, drawn, 0, (double)again, "set-ups for want of room");
    assert_true((drawn > 4 * count && again > drawn && active > count && refused == count) || cases_alone());
}

/* With room for all no triangle is set up twice, and no vertex transformed more than twice. */
static void enough_memory(void **state)
{
    (void)state;
    static context c;
    long set_up = 0;
    for (cases k = cases_of("modes, enough", 1000, 50000); cases_next(&k);) {
        random_scene_init(&scene);
        c.picture = scene.picture;
        c.picture.buffers = 1;
        c.picture.rows = (uint16_t)(1 + pick(c.picture.height));
        c.bytes = ew_picture_least(&c.picture, scene.object, scene.count) + 400000;
        test_context("EW_CASE=%ld, bands of %d", k.number, c.picture.rows);
        draw_whole();
        draw(&c);
        check(&c);
        assert_int_equal(c.counts.again, 0);
        uint32_t vertices = 0;
        for (uint32_t i = 0; i < scene.count; i++) vertices += scene.object[i].mesh.screen ? 0 : scene.object[i].vertex_count;
        assert_true(c.counts.transformed <= 2 * vertices);
        set_up += c.counts.set_up;
    }
    assert_true(set_up > 5000 || cases_alone());
}

/* Triangles of three rows, one below the other: none is kept longer than it has rows. */
static void kept_no_longer(void **state)
{
    enum { COUNT = 12, PITCH = 4 };
    (void)state;
    static context c;
    static ew_screen_vertex screen[3 * COUNT];
    static ew_vertex16 vertex[3 * COUNT];
    static uint16_t index[3 * COUNT], texels[16];
    memset(&scene, 0, sizeof scene);
    for (int i = 0; i < 3 * COUNT; i++) {
        const int32_t x = i % 3 == 1 ? 12 : 1, y = i / 3 * PITCH + (i % 3 == 2 ? 3 : 0);
        screen[i] = (ew_screen_vertex){ .x = x * 4096, .y = y * 4096, .w = UINT32_C(1) << 30 };
        index[i] = (uint16_t)i;
    }
    scene.picture = (ew_picture){ .width = 16, .height = COUNT * PITCH, .end_row = COUNT * PITCH, .buffers = 1,
                                  .scissor = { 0, 0, 16, COUNT * PITCH } };
    scene.object[0].mesh = (ew_mesh){ .vertices = vertex, .screen = screen, .indices = index, .index_count = 3 * COUNT };
    scene.object[0].vertex_count = 3 * COUNT;
    scene.object[0].texture = (ew_texture){ .texels = texels, .width = 4, .height = 4 };
    scene.object[0].material = (ew_material){ .texture = &scene.object[0].texture, .tolerance = 4, .flags = EW_DOUBLE_SIDED };
    memcpy(scene.screen[0], screen, sizeof screen);
    scene.count = 1;
    assert_int_equal(draw_whole(), COUNT);
    for (uint16_t rows = 1; rows <= PITCH; rows++) {
        c.picture = scene.picture;
        c.picture.rows = rows;
        c.bytes = ew_picture_least(&c.picture, scene.object, scene.count) + 400000;
        test_context("bands of %d", rows);
        draw(&c);
        check(&c);
        assert_int_equal(c.counts.set_up, COUNT);
        assert_int_equal(c.counts.again, 0);
        assert_int_equal(c.counts.most_active, rows == 1 ? 1 : rows == PITCH ? 0 : 1);
    }
}

/* More vertices than there are slots in what triangles are listed with, and than map has room for slots. */
static void many_vertices(void **state)
{
    enum { SIDE = 150, COUNT = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };
    (void)state;
    static context c;
    ew_vertex16 *vertex = calloc(COUNT, sizeof *vertex);
    uint16_t *index = calloc(3 * TRIANGLES, sizeof *index);
    ew_screen_vertex *screen = calloc(COUNT, sizeof *screen);
    if (!vertex || !index || !screen) abort();
    const ew_projection projection = { 65536, 65536, { INT32_C(1) << 29, -1 } };
    const ew_viewport viewport = { 0, 0, 40, 40 };
    ew_mat34 m;
    ew_row_from_q16_16(&m.row[0], 65536, 0, 0, 0);
    ew_row_from_q16_16(&m.row[1], 0, 65536, 0, 0);
    ew_row_from_q16_16(&m.row[2], 0, 20000, 0, -98304);
    random_scene_init(&scene);
    scene.picture = (ew_picture){ .width = 40, .height = 40, .end_row = 40, .buffers = 1, .scissor = { 0, 0, 40, 40 } };
    ew_object *o = &scene.object[0];
    assert_int_equal(ew_transform_set(&o->transform, &projection, &m, &viewport), EW_OK);
    for (uint32_t i = 0; i < COUNT; i++) { /* rows of the grid in an order that visits them over and over */
        vertex[i].x = (int16_t)((int32_t)(i % SIDE) * 400 - 30000);
        vertex[i].y = (int16_t)((int32_t)(i / SIDE * 37 % SIDE) * 400 - 30000);
    }
    uint32_t n = 0;
    for (uint32_t y = 0; y + 1 < SIDE; y++) {
        for (uint32_t x = 0; x + 1 < SIDE; x++) {
            const uint32_t a = y * SIDE + x, other = (a * 7919u) % COUNT;
            index[n++] = (uint16_t)a, index[n++] = (uint16_t)(a + 1), index[n++] = (uint16_t)(a + SIDE);
            index[n++] = (uint16_t)other, index[n++] = (uint16_t)(a + 1), index[n++] = (uint16_t)(a + SIDE);
        }
    }
    ew_transform_vertices(&o->transform, vertex, COUNT, screen);
    o->mesh = (ew_mesh){ .vertices = vertex, .indices = index, .index_count = n };
    o->vertex_count = COUNT;
    o->material = (ew_material){ .colour = 0x1234, .flags = EW_DOUBLE_SIDED };
    scene.object[1] = *o; /* twice: slots of more than 15 bits */
    scene.count = 2;
    draw_whole_of((ew_screen_vertex *const[]){ screen, screen });
    static const size_t spare[] = { 0, 100000, 2000000 };
    for (int i = 0; i < 3; i++) {
        c.picture = scene.picture;
        c.picture.rows = 8;
        c.bytes = ew_picture_least(&c.picture, scene.object, scene.count) + spare[i];
        test_context("%zu bytes to spare", spare[i]);
        draw(&c);
        check(&c);
    }
    free(vertex), free(index), free(screen);
}

/* Two contexts, two threads, different bands of the same objects. */
static void two_threads(void **state)
{
    (void)state;
    static context c[2];
    for (cases k = cases_of("modes, threads", 1000, 30000); cases_next(&k);) {
        random_scene_init(&scene);
        if (scene.picture.height < 2) continue;
        const uint16_t border = (uint16_t)(1 + pick(scene.picture.height - 1u));
        for (int i = 0; i < 2; i++) {
            random_half(&c[i].picture, &scene.picture, border, i);
            random_memory(&c[i]);
        }
        test_context("EW_CASE=%ld, border %d, bands of %d and %d", k.number, border, c[0].picture.rows, c[1].picture.rows);
        draw_whole();
        pthread_t thread[2];
        for (int i = 0; i < 2; i++) assert_int_equal(pthread_create(&thread[i], NULL, draw, &c[i]), 0);
        for (int i = 0; i < 2; i++) assert_int_equal(pthread_join(thread[i], NULL), 0);
        for (int i = 0; i < 2; i++) check(&c[i]);
    }
}

static void whatever(void *user, const ew_target *band) { (void)user, (void)band; }

/* Texture coordinates that lie too far apart are an error of the whole picture, at once as in bands. */
static void refused_triangles(void **state)
{
    (void)state;
    static context c;
    static uint8_t memory[1 << 20];
    long count = 0, refused = 0;
    for (cases k = cases_of("modes, refused", 2000, 50000); cases_next(&k); count++) {
        int result[2];
        random_scene_init(&scene);
        for (uint32_t i = 0; i < scene.count; i++) {
            scene.object[i].mesh.uv_fraction_bits = 0;
            for (int j = 0; j < SCENE_VERTICES; j++) scene.vertex[i][j].u = j % 2 ? INT16_MAX : INT16_MIN;
        }
        c.picture = scene.picture;
        c.picture.band = whatever;
        c.picture.buffers = 1;
        for (int banded = 0; banded < 2; banded++) {
            c.picture.rows = (uint16_t)(banded ? 1 + pick(c.picture.height) : c.picture.height);
            test_context("EW_CASE=%ld, bands of %d", k.number, c.picture.rows);
            ew_geometry_init(&c.geometry, &c.raster);
            result[banded] = ew_picture_draw(&c.picture, scene.object, scene.count, &c.geometry, memory, sizeof memory, &c.counts);
        }
        assert_int_equal(result[0], result[1]);
        assert_true(result[0] == EW_OK || result[0] == EW_ERR_RANGE);
        refused += result[0] < 0;
    }
    cases_figure("modes", "refused", count, refused, 0, 0, "");
    assert_true((refused > count / 4 && refused < count) || cases_alone());
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(any_band_any_memory), TEST(enough_memory), TEST(kept_no_longer), TEST(many_vertices),
                                        TEST(two_threads), TEST(refused_triangles) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
