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

static int draw_whole(void)
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
        mesh.screen = scene.screen[i];
        assert_int_equal(ew_raster_set_material(&raster, &scene.object[i].material), EW_OK);
        geometry.transform = scene.object[i].transform;
        const int32_t result = ew_draw_triangles(&geometry, &mesh);
        assert_true(result >= 0);
        drawn += (int)result;
    }
    return drawn;
}

/* ---- the same in bands ---- */

static const uint8_t bits_of[] = { 16, 16, 8, 8, 4, 1 };

/* What a callback finds; the first pixel that differs. */
typedef struct seen {
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
    c->seen = (seen){ .next_row = c->picture.first_row, .buffers = c->picture.buffers };
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

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(any_band_any_memory), TEST(enough_memory), TEST(two_threads) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
