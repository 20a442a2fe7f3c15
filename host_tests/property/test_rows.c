/* The raster layer some rows at a time: however a picture is cut into bands, and a triangle into
 * rows, every pixel is the one of a picture drawn at once. */
#include "cases.h"

#include <stdio.h>
#include <string.h>

#include "pictures.h"
#include "triangles.h"

enum { TRIANGLES = 6 };

static picture whole, cut;
static ew_raster raster;

static struct {
    ew_target target;
    ew_rect scissor;
    ew_material material[TRIANGLES];
    ew_texture texture[TRIANGLES];
    ew_raster_vertex corner[TRIANGLES][3];
} scene;

static void random_scene(void)
{
    random_target(&scene.target);
    random_scissor(&scene.scissor, &scene.target);
    for (int i = 0; i < TRIANGLES; i++) {
        random_material(&scene.material[i], &scene.texture[i]);
        triangle_place(scene.corner[i], pick(3) ? KIND_ORDINARY : (triangle_kind)pick(KIND_COUNT), scene.target.width,
                       scene.target.height);
        random_attributes(scene.corner[i]);
    }
}

static void use(int i)
{
    assert_int_equal(ew_raster_set_material(&raster, &scene.material[i]), EW_OK);
}

static void begin(picture *p, uint16_t first, uint16_t rows)
{
    ew_target target = scene.target;
    target_rows(&target, p, first, rows);
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    assert_int_equal(ew_raster_set_fog(&raster, 0x1234, UINT32_C(1) << 31, UINT32_C(1) << 26), EW_OK);
}

/* Goes to a band and the scissor's part of it, which may be empty. */
static void go_to(uint16_t first, uint16_t rows)
{
    ew_target target = scene.target;
    target_rows(&target, &cut, first, rows);
    assert_int_equal(ew_raster_set_rows(&raster, target.colour, target.depth, first, rows), EW_OK);
    const uint16_t end = (uint16_t)(first + rows);
    ew_rect r = scene.scissor;
    if (r.y0 < first) r.y0 = first;
    if (r.y1 > end) r.y1 = end;
    if (r.y0 >= r.y1) r.y0 = r.y1 = first;
    assert_int_equal(ew_raster_set_scissor(&raster, &r), EW_OK);
}

static int draw_whole(int reached[TRIANGLES])
{
    begin(&whole, 0, scene.target.height);
    assert_int_equal(ew_raster_set_scissor(&raster, &scene.scissor), EW_OK);
    int drawn = 0;
    for (int i = 0; i < TRIANGLES; i++) {
        use(i);
        reached[i] = ew_raster_triangle(&raster, &scene.corner[i][0], &scene.corner[i][1], &scene.corner[i][2]);
        drawn += reached[i] > 0;
    }
    return drawn;
}

static void same(void)
{
    for (int i = 0; i < PICTURE_WIDTH * PICTURE_HEIGHT + 64; i++) {
        if (whole.colour[i] == cut.colour[i] && whole.depth[i] == cut.depth[i]) continue;
        const int at = i; /* right for 16-bit formats */
        fail_msg("pixel %d,%d: colour %x, whole %x; depth %x, whole %x", at % scene.target.stride, at / scene.target.stride,
                 cut.colour[i], whole.colour[i], cut.depth[i], whole.depth[i]);
    }
}

/* Each band anew: set-up must not see where it lies. */
static void bands_anew(void **state)
{
    (void)state;
    long drawn = 0, count = 0;
    for (cases c = cases_of("bands", 20000, 1000000); cases_next(&c); count++) {
        random_scene();
        const uint32_t seed = test_random();
        int reached[TRIANGLES];
        const uint16_t rows = (uint16_t)(1 + pick(scene.target.height));
        test_context("EW_CASE=%ld, bands of %d", c.number, rows);
        picture_fill(&whole, seed);
        picture_fill(&cut, seed);
        drawn += draw_whole(reached);
        begin(&cut, 0, scene.target.height);
        for (uint16_t first = 0; first < scene.target.height; first = (uint16_t)(first + rows)) {
            const int left = scene.target.height - first;
            go_to(first, (uint16_t)(rows < left ? rows : left));
            for (int i = 0; i < TRIANGLES; i++) {
                use(i);
                int result = ew_raster_triangle(&raster, &scene.corner[i][0], &scene.corner[i][1], &scene.corner[i][2]);
                assert_true(result < 0 ? result == reached[i] : 1);
            }
        }
        same();
    }
    cases_figure("rows", "bands anew", count, drawn, 0, 0, "");
    assert_true(drawn > count || cases_alone());
}

/* Set up once, drawn in parts, the order among triangles kept. */
static void kept(void **state)
{
    (void)state;
    static ew_active active[TRIANGLES];
    long drawn = 0, count = 0, parts = 0;
    for (cases c = cases_of("kept", 20000, 1000000); cases_next(&c); count++) {
        random_scene();
        const uint32_t seed = test_random();
        int reached[TRIANGLES], now[TRIANGLES] = { 0 };
        uint8_t begun[TRIANGLES] = { 0 };
        const uint32_t most = 1 + pick(scene.target.height);
        test_context("EW_CASE=%ld, bands of up to %u", c.number, most);
        picture_fill(&whole, seed);
        picture_fill(&cut, seed);
        drawn += draw_whole(reached);
        begin(&cut, 0, scene.target.height);
        for (uint16_t first = 0, rows; first < scene.target.height; first = (uint16_t)(first + rows)) {
            const uint32_t left = (uint32_t)(scene.target.height - first);
            rows = (uint16_t)(1 + pick(most < left ? most : left));
            go_to(first, rows);
            if (raster.scissor.y0 == raster.scissor.y1) continue;
            for (int i = 0; i < TRIANGLES; i++) {
                const ew_raster_vertex *v = scene.corner[i];
                use(i);
                if (!begun[i]) {
                    const int result = ew_raster_begin(&raster, &v[0], &v[1], &v[2], scene.scissor.y1);
                    assert_true(result == (reached[i] < 0 ? reached[i] : result) && result <= 1);
                    begun[i] = result == 1 ? 1 : 2;
                    if (result <= 0) continue;
                    assert_true(ew_active_bytes(&raster.work.triangle) <= sizeof(ew_active));
                    if (ew_raster_begun_end(&raster) <= first + rows || pick(8) == 0) {
                        now[i] |= ew_raster_draw_begun(&raster);
                        begun[i] = ew_raster_begun_end(&raster) <= first + rows ? 2 : 0; /* else anew next time */
                        continue;
                    }
                    /* what follows its bytes is somebody else's */
                    memset(&active[i], 0x5A, sizeof active[i]);
                    ew_raster_keep(&raster, &active[i]);
                    const uint8_t *end = (const uint8_t *)&active[i] + ew_active_bytes(&active[i].triangle);
                    for (const uint8_t *p = end; p < (const uint8_t *)(&active[i] + 1); p++) assert_int_equal(*p, 0x5A);
                }
                if (begun[i] == 1 && active[i].row < active[i].end) {
                    now[i] |= ew_raster_draw_active(&raster, &active[i]);
                    parts++;
                }
            }
        }
        same();
        for (int i = 0; i < TRIANGLES; i++) assert_int_equal(now[i], reached[i] < 0 ? 0 : reached[i]);
    }
    cases_figure("rows", "kept", count, drawn, 0, (double)parts, "parts");
    assert_true((drawn > count && parts > 4 * drawn) || cases_alone());
}

/* A list of kept triangles, drawn up to a number and then on, with empty scissors in between: they once made
 * machine code draw 2^32 rows. */
static void listed(void **state)
{
    (void)state;
    static ew_active active[TRIANGLES];
    const uint16_t places = sizeof(ew_active) / EW_PLACE_BYTES;
    long drawn = 0, count = 0, parts = 0;
    for (cases c = cases_of("listed", 20000, 1000000); cases_next(&c); count++) {
        random_scene();
        for (int i = 1; i < TRIANGLES; i++) scene.material[i] = scene.material[0];
        const uint32_t seed = test_random();
        int reached[TRIANGLES], is_begun = 0;
        uint16_t head = EW_NO_PLACE;
        const uint32_t most = 1 + pick(scene.target.height);
        test_context("EW_CASE=%ld, bands of up to %u", c.number, most);
        picture_fill(&whole, seed);
        picture_fill(&cut, seed);
        drawn += draw_whole(reached);
        begin(&cut, 0, scene.target.height);
        use(0);
        for (uint16_t first = 0, rows; first < scene.target.height; first = (uint16_t)(first + rows)) {
            const uint32_t left = (uint32_t)(scene.target.height - first);
            rows = (uint16_t)(1 + pick(most < left ? most : left));
            go_to(first, rows);
            if (!is_begun && raster.scissor.y0 == raster.scissor.y1) continue;
            uint16_t *link = &head;
            for (uint16_t i = 0; i < TRIANGLES && !is_begun; i++) {
                const ew_raster_vertex *v = scene.corner[i];
                if (ew_raster_begin(&raster, &v[0], &v[1], &v[2], scene.scissor.y1) <= 0) continue;
                ew_raster_keep(&raster, &active[i]);
                active[i].number = i;
                active[i].next = EW_NO_PLACE;
                *link = (uint16_t)(i * places);
                link = &active[i].next;
            }
            is_begun = 1;
            for (uint32_t empty = pick(3); empty <= 2; empty++) { /* the last one is not */
                const ew_rect whole_band = raster.scissor;
                if (empty < 2) raster.scissor.y1 = raster.scissor.y0;
                ew_active_list list = { .places = (uint8_t *)active, .link = &head, .ended = EW_NO_PLACE };
                const uint32_t number = pick(TRIANGLES);
                ew_raster_draw_list(&raster, &list, number);
                if (*list.link != EW_NO_PLACE) assert_true(ew_active_in(&list, *list.link)->number >= number);
                ew_raster_draw_list(&raster, &list, TRIANGLES);
                assert_int_equal(*list.link, EW_NO_PLACE);
                for (uint16_t at = list.ended; at != EW_NO_PLACE; at = ew_active_in(&list, at)->next) parts++;
                raster.scissor = whole_band;
            }
        }
        same();
    }
    cases_figure("rows", "listed", count, drawn, 0, (double)parts, "ended");
    assert_true((drawn > count && parts >= drawn) || cases_alone());
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(bands_anew), TEST(kept), TEST(listed) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
