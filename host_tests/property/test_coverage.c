/* Which pixels a triangle covers, against exact coverage counted in two ways. Built twice:
 * with the core as it is shipped, where a pixel tells only that it was drawn, and with its
 * trace, where it tells how often. */
#include "cases.h"

#include <math.h>
#include <string.h>

#include "../reference/coverage.h"
#include "triangles.h"

enum { PIXELS = 4096 * 16, GUARD = 4096 };

static uint16_t colour_memory[PIXELS + 2 * GUARD], depth[PIXELS];
static uint16_t *const colour = colour_memory + GUARD;
static cover by_edges, by_rows, drawn;
static ew_raster raster;
static uint16_t width, height, tag;
static uint32_t deepest; /* least near/z of a corner, uq1.31 */
static long doubles;

#if EW_TRACE
static uint8_t hits[PIXELS];

void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c, int rung)
{
    (void)a, (void)b, (void)c, (void)rung;
}

void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t d, ew_q20_12 u, ew_q20_12 v)
{
    (void)d, (void)u, (void)v;
    doubles += hits[y * width + x]++;
}
#endif

/* Ways to draw that go through different loops; `tag` is what they leave. */
static const struct {
    ew_rung rung;
    uint16_t tolerance;
    uint8_t flags, with_depth;
} ways[] = { { EW_RUNG_CONSTANT, 0, 0, 0 }, { EW_RUNG_CONSTANT, 0, 0, 1 },  { EW_RUNG_AUTO, 4, 0, 1 },
             { EW_RUNG_AUTO, 16, 0, 0 },    { EW_RUNG_AFFINE, 0, 0, 1 },    { EW_RUNG_RUNS, 8, 0, 1 },
             { EW_RUNG_TABLE, 0, 0, 1 },    { EW_RUNG_EXACT, 0, EW_NO_DEPTH_TEST, 1 } };
enum { WAYS = sizeof ways / sizeof *ways };

/* A way, a scissor now and then, sides; a colour that no pixel has. */
static void choose(uint16_t texels[4], ew_rect *scissor, int *sides)
{
    int way = (int)pick(WAYS);
    const ew_texture texture = { .texels = texels, .width = 2, .height = 2 };
    const ew_target target = { .colour = colour, .depth = ways[way].with_depth ? depth : NULL, .width = width,
                               .height = height, .stride = width };
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    if (++tag == 0) {
        memset(colour_memory, 0, sizeof colour_memory);
        tag = 1;
    }
    if (target.depth) memset(depth, 0, 2u * width * height);
    for (int i = 0; i < 4; i++) texels[i] = tag;
    *sides = pick(8) ? EW_DOUBLE_SIDED : 0;
    const ew_material material = { .texture = &texture, .colour = tag, .tolerance = ways[way].tolerance,
                                   .rung = (uint8_t)ways[way].rung, .flags = (uint8_t)(ways[way].flags | *sides) };
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
    *scissor = raster.scissor;
    if (pick(8)) return;
    scissor->x0 = (uint16_t)pick(width + 1u);
    scissor->y0 = (uint16_t)pick(height + 1u);
    scissor->x1 = (uint16_t)(scissor->x0 + pick(width + 1u - scissor->x0));
    scissor->y1 = (uint16_t)(scissor->y0 + pick(height + 1u - scissor->y0));
    assert_int_equal(ew_raster_set_scissor(&raster, scissor), EW_OK);
}

static void read_drawn(void)
{
    cover_begin(&drawn, width, height);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x += 64) {
            int n = width - x < 64 ? width - x : 64;
            const uint16_t *p = &colour[y * width + x];
            uint64_t word = 0;
            for (int k = 0; k < n; k++) word |= (uint64_t)(p[k] == tag) << k;
            drawn.bits[y * drawn.words + x / 64] = word;
        }
    }
}

/* Takes the pixels outside of the scissor out of the exact picture. */
static void cut(cover *c, const ew_rect *r)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            if (x >= r->x0 && x < r->x1 && y >= r->y0 && y < r->y1) continue;
            c->bits[y * c->words + x / 64] &= ~(UINT64_C(1) << (x & 63));
        }
    }
}

static long differing(const cover *a, const cover *b)
{
    long n = 0;
    for (int i = 0; i < a->words * a->height; i++) n += __builtin_popcountll(a->bits[i] ^ b->bits[i]);
    return n;
}

/* Draws one triangle of a kind. Returns the covered pixels. */
static long one(triangle_kind kind, long number)
{
    uint16_t texels[4];
    ew_rect scissor;
    ew_raster_vertex v[3];
    int64_t sx[3], sy[3];
    int sides;
    choose(texels, &scissor, &sides);
    memset(v, 0, sizeof v);
    triangle_place(v, kind, width, height);
    for (int i = 0; i < 3; i++) {
        v[i].w = (test_random() >> 1) >> pick(31);
        if (v[i].w < deepest) v[i].w = deepest;
        v[i].u = (int32_t)pick(1u << 24) - (1 << 23), v[i].v = (int32_t)pick(1u << 24) - (1 << 23);
    }
    triangle_context(triangle_kind_name[kind], number, v);
    triangle_snapped(sx, sy, v);
    cover_begin(&by_edges, width, height);
    cover_begin(&by_rows, width, height);
    int64_t area = (sx[1] - sx[0]) * (sy[2] - sy[0]) - (sx[2] - sx[0]) * (sy[1] - sy[0]);
    if (area < 0 || sides) {
        cover_by_edges(&by_edges, sx, sy);
        cover_by_rows(&by_rows, sx, sy, 3);
    }
    assert_int_equal(differing(&by_edges, &by_rows), 0); /* or the referees are wrong */
    if (kind == KIND_ZERO_AREA) assert_int_equal(area, 0);
    if (scissor.x0 || scissor.y0 || scissor.x1 != width || scissor.y1 != height) cut(&by_edges, &scissor);
#if EW_TRACE
    memset(hits, 0, (size_t)width * height);
#endif
    int result = ew_raster_triangle(&raster, &v[0], &v[1], &v[2]);
    read_drawn();
    long covered = cover_count(&by_edges), wrong = differing(&by_edges, &drawn);
    if (wrong || doubles) fail_msg("of %ld pixels %ld are wrong, %ld hit twice", covered, wrong, doubles);
    assert_int_equal(result, covered > 0);
    return covered;
}

/* Counting hits is slower: a tenth of the triangles. */
enum { SHARE = EW_TRACE ? 10 : 1 };
/* a depth of 4 and more */
enum { LEAST_W = 1 << 17 };

/* All kinds by turns, in pictures of w x h pixels. */
static void run(const char *name, uint16_t w, uint16_t h, uint32_t least_w, long slice, long whole)
{
    long judged[KIND_COUNT] = { 0 }, count[KIND_COUNT] = { 0 };
    width = w, height = h, deepest = least_w;
    doubles = 0;
    tag = 0;
    memset(colour_memory, 0, sizeof colour_memory);
    for (cases c = cases_of(name, slice / SHARE, whole / SHARE); cases_next(&c);) {
        triangle_kind kind = (triangle_kind)(c.number % KIND_COUNT);
        count[kind]++;
        judged[kind] += one(kind, c.number);
    }
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        cases_figure(name, triangle_kind_name[kind], count[kind], judged[kind], 0, NAN, "");
    }
    for (int i = 0; i < GUARD; i++) assert_true(colour_memory[i] == 0 && colour[(int)width * height + i] == 0);
}

static void small_pictures(void **state)
{
    (void)state;
    run(EW_TRACE ? "coverage, hits counted" : "coverage", 32, 32, LEAST_W, 400000, 9650000);
}

static void odd_size(void **state)
{
    (void)state;
    run("coverage 61 x 23", 61, 23, LEAST_W, 10000, 250000);
}

/* Depth ends at 1: a pixel behind that is drawn all the same. */
static void beyond_the_horizon(void **state)
{
    (void)state;
    run("coverage, 1/z down to 2^-31", 32, 32, 1, 200000, 1000000);
}

static void wide_pictures(void **state)
{
    (void)state;
    run("coverage 4096 x 3", 4096, 3, LEAST_W, 2000, 50000);
}

static void tall_pictures(void **state)
{
    (void)state;
    run("coverage 3 x 4096", 3, 4096, LEAST_W, 2000, 50000);
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(small_pictures), TEST(odd_size), TEST(wide_pictures),
                                        TEST(tall_pictures), TEST(beyond_the_horizon) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
