/* The raster layer: coverage against the referee's exact edge functions, depth rules,
 * ranges, borders. */
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "edgewalk/raster.h"
#include "../../src/raster/edge.h"
#include "../reference/referee.h"

enum { W = 64, H = 48, STRIDE = 70, GUARD = 64, MARK = 0x1234 };

static uint16_t colour_memory[2 * GUARD + STRIDE * H], depth_memory[2 * GUARD + STRIDE * H];
static uint16_t *const colour = colour_memory + GUARD, *const depth = depth_memory + GUARD;
static ew_raster raster;

static void start(int with_depth)
{
    const ew_target target = { .colour = colour, .depth = with_depth ? depth : NULL, .width = W, .height = H, .stride = STRIDE };
    for (size_t i = 0; i < sizeof colour_memory / sizeof *colour_memory; i++) colour_memory[i] = depth_memory[i] = MARK;
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    ew_raster_clear(&raster, 0);
}

static void use(uint16_t rgb565, uint8_t flags)
{
    const ew_material m = { .colour = rgb565, .rung = EW_RUNG_CONSTANT, .flags = flags };
    assert_int_equal(ew_raster_set_material(&raster, &m), EW_OK);
}

/* Nothing outside of the picture was written. */
static void check_borders(void)
{
    for (size_t i = 0; i < sizeof colour_memory / sizeof *colour_memory; i++) {
        long at = (long)i - GUARD;
        if (at >= 0 && at < (long)STRIDE * H && at % STRIDE < W) continue;
        assert_int_equal(colour_memory[i], MARK);
        assert_int_equal(depth_memory[i], MARK);
    }
}

static ew_raster_vertex corner(int32_t x, int32_t y, uint32_t w)
{
    ew_raster_vertex v = { .x = x, .y = y, .w = w };
    return v;
}

static int32_t px(double a) { return (int32_t)lrint(a * 4096); }

/* Draws and compares each pixel of the picture with exact coverage. Returns the covered. */
static int compare(const ew_raster_vertex v[3])
{
    int64_t sx[3], sy[3];
    for (int i = 0; i < 3; i++) {
        sx[i] = ref_snap(v[i].x / 4096.0, EW_SUBPIXEL_BITS);
        sy[i] = ref_snap(v[i].y / 4096.0, EW_SUBPIXEL_BITS);
    }
    test_context("%d %d, %d %d, %d %d (1/4096 px)", v[0].x, v[0].y, v[1].x, v[1].y, v[2].x, v[2].y);
    ew_raster_clear(&raster, 0);
    int result = ew_raster_triangle(&raster, &v[0], &v[1], &v[2]), covered = 0;
    assert_true(result == 0 || result == 1);
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) {
            int exact = ref_covers(sx, sy, EW_SUBPIXEL_BITS, x, y);
            covered += exact;
            if ((colour[y * STRIDE + x] != 0) != exact) fail_msg("pixel %d %d: exact %d", x, y, exact);
        }
    }
    assert_int_equal(result, covered > 0);
    return covered;
}

/* A coordinate of one of several kinds: whole pixels, centres, eighths, any; near the
 * picture, far outside, at the guard band. */
static int32_t coordinate(int size)
{
    uint32_t r = test_random();
    int32_t base;
    switch (r >> 4 & 7) {
    case 0: base = (int32_t)(test_random() % (unsigned)(EW_GUARD_PX * 2)) * 4096 - EW_GUARD_PX * 4096; break;
    case 1: base = (int32_t)(test_random() % 8192u) * 4096 - 4096 * 4096; break;
    default: base = ((int32_t)(test_random() % (unsigned)(size + 20)) - 10) * 4096; break;
    }
    switch (r & 7) {
    case 0: break;
    case 1:
    case 2:
    case 3: base += 2048; break;
    case 4: base += (int32_t)(test_random() & 7) * 512; break;
    default: base += (int32_t)(test_random() & 4095); break;
    }
    const int32_t guard = EW_GUARD_PX * 4096;
    return base > guard ? guard : base < -guard ? -guard : base;
}

static void random_triangles_are_covered_exactly(void **state)
{
    (void)state;
    long covered = 0;
    start(0);
    use(0xFFFF, EW_DOUBLE_SIDED);
    for (int n = 0; n < 60000; n++) {
        ew_raster_vertex v[3];
        for (int i = 0; i < 3; i++) v[i] = corner(coordinate(W), coordinate(H), 1 + (test_random() >> 1));
        if (n % 3 == 0) { /* slivers and tiny ones: two corners close together */
            v[1] = v[0];
            v[1].x += (int32_t)(test_random() % 2048) - 1024;
            v[1].y += (int32_t)(test_random() % 2048) - 1024;
            if (n % 6 == 0) {
                v[2] = v[0];
                v[2].x += (int32_t)(test_random() % 8192) - 4096;
                v[2].y += (int32_t)(test_random() % 8192) - 4096;
            }
            for (int i = 1; i < 3; i++) {
                const int32_t guard = EW_GUARD_PX * 4096;
                v[i].x = v[i].x > guard ? guard : v[i].x < -guard ? -guard : v[i].x;
                v[i].y = v[i].y > guard ? guard : v[i].y < -guard ? -guard : v[i].y;
            }
        }
        covered += compare(v);
    }
    assert_true(covered > 1000000);
    check_borders();
}

/* Every triangle of a net whose corners were shaken: the net covers each pixel inside it
 * exactly once. Additive counting through a depth-less target needs one draw per triangle. */
static void nets_cover_each_pixel_once(void **state)
{
    (void)state;
    enum { N = 8 };
    start(0);
    use(1, 0);
    for (int n = 0; n < 300; n++) {
        static ew_raster_vertex net[N + 1][N + 1];
        static uint8_t hits[H][W];
        memset(hits, 0, sizeof hits);
        for (int j = 0; j <= N; j++) {
            for (int i = 0; i <= N; i++) {
                int inner = i > 0 && i < N && j > 0 && j < N;
                int32_t x = i * W * 4096 / N, y = j * H * 4096 / N;
                /* up to 40 % of a cell, so no triangle turns over */
                int32_t shake = inner ? (int32_t)(test_random() % 13107) - 6553 : 0;
                net[j][i] = corner(x + shake * 2, y + (inner ? (int32_t)(test_random() % 9000) - 4500 : 0), 1u << 30);
                if (n & 1) { /* on half pixels */
                    net[j][i].x = EW_ASR(net[j][i].x, 11) * 2048;
                    net[j][i].y = EW_ASR(net[j][i].y, 11) * 2048;
                }
            }
        }
        for (int t = 0; t < 2 * N * N; t++) {
            int i = t / 2 % N, j = t / 2 / N;
            const ew_raster_vertex *a = &net[j][i], *b = &net[j + 1][i], *c = &net[j + 1][i + 1], *d = &net[j][i + 1];
            ew_raster_clear(&raster, 0);
            if (t & 1) ew_raster_triangle(&raster, a, c, d);
            else ew_raster_triangle(&raster, a, b, c);
            for (int y = 0; y < H; y++) {
                for (int x = 0; x < W; x++) hits[y][x] = (uint8_t)(hits[y][x] + colour[y * STRIDE + x]);
            }
        }
        for (int y = 0; y < H; y++) {
            for (int x = 0; x < W; x++) {
                test_context("net %d, pixel %d %d: %d hits", n, x, y, hits[y][x]);
                assert_int_equal(hits[y][x], 1);
            }
        }
    }
}

static void fan_of_a_thousand(void **state)
{
    (void)state;
    enum { SPOKES = 1000 };
    static uint16_t hits[H][W];
    start(0);
    use(1, 0);
    memset(hits, 0, sizeof hits);
    const double pi = acos(-1.0);
    ew_raster_vertex hub = corner(px(31.37), px(24.61), 1u << 30), rim[SPOKES];
    for (int i = 0; i < SPOKES; i++) {
        rim[i] = corner(px(31.37 + 200 * cos(2 * pi * i / SPOKES)), px(24.61 - 200 * sin(2 * pi * i / SPOKES)), 1u << 29);
    }
    for (int i = 0; i < SPOKES; i++) {
        ew_raster_clear(&raster, 0);
        ew_raster_triangle(&raster, &hub, &rim[i], &rim[(i + 1) % SPOKES]);
        for (int y = 0; y < H; y++) {
            for (int x = 0; x < W; x++) hits[y][x] = (uint16_t)(hits[y][x] + colour[y * STRIDE + x]);
        }
    }
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) assert_int_equal(hits[y][x], 1);
    }
}

/* A hand-drawn picture of the rule: the square from (2, 1) to (5, 3), whose edges go
 * through no centre, and the one from centre to centre, which keeps its left and top. */
static void hand_drawn(void **state)
{
    (void)state;
    static const char *const expected[8] = { "................", "..aaa...........", "..aaa...bbb.....",
                                             "........bbb.....", "................", "............c...",
                                             "...........cc...", "................" };
    const double square[2][4] = { { 2, 1, 5, 3 }, { 8.5, 2.5, 11.5, 4.5 } };
    start(0);
    for (int k = 0; k < 2; k++) {
        ew_raster_vertex a = corner(px(square[k][0]), px(square[k][1]), 1u << 30),
                         b = corner(px(square[k][0]), px(square[k][3]), 1u << 30),
                         c = corner(px(square[k][2]), px(square[k][3]), 1u << 30),
                         d = corner(px(square[k][2]), px(square[k][1]), 1u << 30);
        use((uint16_t)('a' + k), 0);
        ew_raster_triangle(&raster, &a, &b, &c);
        ew_raster_triangle(&raster, &a, &c, &d);
    }
    use('c', 0);
    /* its left edge runs through the centres (12.5, 5.5) and (11.5, 6.5), its right one through
     * (13.5, ...): left centres belong, right ones do not; the bottom row's do not */
    ew_raster_vertex a = corner(px(13.5), px(4.5), 1u << 30), b = corner(px(10.5), px(7.5), 1u << 30),
                     c = corner(px(13.5), px(7.5), 1u << 30);
    ew_raster_triangle(&raster, &a, &b, &c);
    for (int y = 0; y < 8; y++) {
        for (int x = 0; x < 16; x++) {
            test_context("pixel %d %d", x, y);
            assert_int_equal(colour[y * STRIDE + x], expected[y][x] == '.' ? 0 : expected[y][x]);
        }
    }
}

static void only_fronts_are_drawn(void **state)
{
    (void)state;
    ew_raster_vertex a = corner(px(1), px(1), 1u << 30), b = corner(px(1), px(20), 1u << 30),
                     c = corner(px(20), px(20), 1u << 30), same = a;
    start(1);
    use(7, 0);
    assert_int_equal(ew_raster_triangle(&raster, &a, &b, &c), 1); /* counter-clockwise to the viewer */
    assert_int_equal(ew_raster_triangle(&raster, &a, &c, &b), 0);
    assert_int_equal(ew_raster_triangle(&raster, &a, &b, &same), 0);
    use(7, EW_DOUBLE_SIDED);
    assert_int_equal(ew_raster_triangle(&raster, &a, &c, &b), 1);
    assert_int_equal(ew_raster_triangle(&raster, &a, &b, &b), 0);
}

static void draw_square(uint16_t rgb565, uint32_t w, uint8_t flags)
{
    ew_raster_vertex a = corner(0, 0, w), b = corner(0, px(H), w), c = corner(px(W), px(H), w), d = corner(px(W), 0, w);
    use(rgb565, flags);
    assert_int_equal(ew_raster_triangle(&raster, &a, &b, &c), 1);
    assert_int_equal(ew_raster_triangle(&raster, &a, &c, &d), 1);
}

/* The constant rung is the material's colour, even beside a texture. */
static void constant_rung_beside_a_texture(void **state)
{
    (void)state;
    static const uint16_t texels[4] = { 1, 2, 3, 4 };
    const ew_texture texture = { .texels = texels, .width = 2, .height = 2 };
    const ew_material m = { .texture = &texture, .colour = 0xBEEF, .rung = EW_RUNG_CONSTANT };
    ew_raster_vertex a = corner(0, 0, 1u << 30), b = corner(0, px(H), 1u << 30), c = corner(px(W), px(H), 1u << 30);
    start(1);
    assert_int_equal(ew_raster_set_material(&raster, &m), EW_OK);
    assert_int_equal(ew_raster_triangle(&raster, &a, &b, &c), 1);
    assert_int_equal(colour[(H - 1) * STRIDE], 0xBEEF);
}

static void depth_rules(void **state)
{
    (void)state;
    start(1);
    draw_square(1, 100u << 15, 0);
    assert_int_equal(depth[0], 100);
    draw_square(2, 100u << 15, 0); /* equal: the first stays */
    assert_int_equal(colour[STRIDE + 1], 1);
    draw_square(3, (100u << 15) + 32767, 0); /* still unit 100 */
    assert_int_equal(colour[STRIDE + 1], 1);
    draw_square(4, 101u << 15, 0);
    assert_int_equal(colour[STRIDE + 1], 4);
    draw_square(5, 99u << 15, 0);
    assert_int_equal(colour[STRIDE + 1], 4);
    draw_square(6, 99u << 15, EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE);
    assert_int_equal(colour[STRIDE + 1], 6);
    assert_int_equal(depth[STRIDE + 1], 101);
    draw_square(7, 200u << 15, EW_NO_DEPTH_WRITE);
    assert_int_equal(colour[STRIDE + 1], 7);
    assert_int_equal(depth[STRIDE + 1], 101);
    draw_square(8, 50u << 15, EW_NO_DEPTH_TEST);
    assert_int_equal(depth[STRIDE + 1], 50);
    ew_raster_clear(&raster, 0);
    draw_square(9, 1, 0); /* the far horizon is 1, nearer than the cleared buffer */
    assert_int_equal(depth[0], 1);
    assert_int_equal(colour[0], 9);
    draw_square(10, 0x80000000u, 0); /* the near plane is 65535 */
    assert_int_equal(depth[0], 65535);
    assert_int_equal(colour[0], 10);
    check_borders();
}

static void scissor_cuts_exactly(void **state)
{
    (void)state;
    static uint16_t whole[STRIDE * H];
    for (int n = 0; n < 3000; n++) {
        ew_raster_vertex v[3];
        for (int i = 0; i < 3; i++) v[i] = corner(coordinate(W), coordinate(H), 1 + (test_random() >> 1));
        start(1);
        use(0xABCD, EW_DOUBLE_SIDED);
        ew_raster_triangle(&raster, &v[0], &v[1], &v[2]);
        memcpy(whole, depth, sizeof whole);
        ew_rect r;
        r.x0 = (uint16_t)(test_random() % (W + 1)), r.x1 = (uint16_t)(r.x0 + test_random() % (unsigned)(W + 1 - r.x0));
        r.y0 = (uint16_t)(test_random() % (H + 1)), r.y1 = (uint16_t)(r.y0 + test_random() % (unsigned)(H + 1 - r.y0));
        ew_raster_clear(&raster, 0);
        assert_int_equal(ew_raster_set_scissor(&raster, &r), EW_OK);
        ew_raster_triangle(&raster, &v[0], &v[1], &v[2]);
        for (int y = 0; y < H; y++) {
            for (int x = 0; x < W; x++) {
                int inside = x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1;
                test_context("rect %d %d %d %d pixel %d %d, triangle %d %d, %d %d, %d %d", r.x0, r.y0, r.x1, r.y1, x, y,
                             v[0].x, v[0].y, v[1].x, v[1].y, v[2].x, v[2].y);
                uint16_t here = depth[y * STRIDE + x], there = whole[y * STRIDE + x];
                if (!inside) assert_int_equal(here, 0);
                else assert_true((here != 0) == (there != 0) && abs(here - there) <= 1);
            }
        }
    }
    check_borders();
}

/* Where an edge meets the current row's centre line, in pixels from the first centre: the
 * walker keeps the first pixel at or right of it and how far it is behind (edge.h). */
static double edge_position(const ew_edge *e) { return e->x - 1 + (e->remainder + e->dy + 1.0) / e->dy; }

/* J. Kautz, "Coping with Depth" (after A. Steed and C. Loscos): polygon a = (3, 1, 1),
 * b = (7, 4, 2), c = (4, 7, 4), sampled at whole numbers; ours are at halves, so 1/2 is
 * added. Edges ac, ab, cb with dx/dy = 1/6, 4/3, -3/3. */
static void worked_example(void **state)
{
    (void)state;
    const double corner_at[3][3] = { { 3, 1, 1 }, { 7, 4, 2 }, { 4, 7, 4 } };
    ew_snapped sx[3], sy[3];
    ew_raster_vertex v[3];
    for (int i = 0; i < 3; i++) {
        sx[i] = (int32_t)((corner_at[i][0] + 0.5) * EW_ONE), sy[i] = (int32_t)((corner_at[i][1] + 0.5) * EW_ONE);
        /* the example's own z, linear on the screen, an eighth of it as what is stored */
        v[i] = corner(px(corner_at[i][0] + 0.5), px(corner_at[i][1] + 0.5), (uint32_t)(corner_at[i][2] * (1u << 28)));
    }
    ew_edge ac, ab, cb;
    ew_edge_start(&ac, sx[0], sy[0], sx[2], sy[2], 1);
    ew_edge_start(&ab, sx[0], sy[0], sx[1], sy[1], 1);
    ew_edge_start(&cb, sx[1], sy[1], sx[2], sy[2], 4);
    const double left[6] = { 3, 3.1667, 3.3333, 3.5, 3.6667, 3.8333 }, right[6] = { 3, 4.3333, 5.6667, 7, 6, 5 };
    const double z_left[6] = { 1, 1.5, 2, 2.5, 3, 3.5 }, z_right[6] = { 1, 1.3333, 1.6667, 2, 2.6667, 3.3333 };
    start(1);
    use(1, EW_DOUBLE_SIDED);
    assert_int_equal(ew_raster_triangle(&raster, &v[0], &v[1], &v[2]), 1);
    for (int row = 1; row <= 6; row++) {
        const ew_edge *r = row < 4 ? &ab : &cb;
        test_context("line y = %d: x %.4f to %.4f", row, edge_position(&ac), edge_position(r));
        assert_true(fabs(edge_position(&ac) - left[row - 1]) < 0.002);
        assert_true(fabs(edge_position(r) - right[row - 1]) < 0.002);
        for (int x = 0; x < 10; x++) {
            int inside = x >= left[row - 1] - 1e-4 && x < right[row - 1] - 1e-3;
            uint16_t d = depth[row * STRIDE + x];
            test_context("line y = %d, x = %d: stored %d", row, x, d);
            assert_int_equal(d != 0, inside);
            if (!inside) continue;
            double q = (x - left[row - 1]) / (right[row - 1] - left[row - 1]);
            double z = z_left[row - 1] + q * (z_right[row - 1] - z_left[row - 1]);
            assert_true(fabs(d + 0.5 - 8192 * z) <= 1);
        }
        ew_edge_step(&ac);
        if (row < 3) ew_edge_step(&ab);
        if (row >= 4) ew_edge_step(&cb);
    }
}

/* Half way on the screen between z = 1 and z = 4 one sees z = 1 / ((1 + 1/4) / 2) = 1.6
 * (Low, equation 12), not 2.5: what the core interpolates is 1/z. */
static void linear_z_is_wrong_where_linear_1_over_z_is_right(void **state)
{
    (void)state;
    ew_raster_vertex a = corner(0, 0, 0x80000000u), b = corner(0, px(H), 0x80000000u),
                     c = corner(px(W), px(H), 0x20000000u), d = corner(px(W), 0, 0x20000000u);
    start(1);
    use(1, 0);
    ew_raster_triangle(&raster, &a, &b, &c);
    ew_raster_triangle(&raster, &a, &c, &d);
    for (int x = 1; x < W; x++) {
        double q = (x + 0.5) / W, z = 1 / (1 + q * (1.0 / 4 - 1)), linear = 1 + 3 * q;
        double seen = 65536 / (depth[5 * STRIDE + x] + 0.5);
        test_context("x %d: 1/z gives %.4f, z would give %.4f, drawn %.4f", x, z, linear, seen);
        assert_true(fabs(seen - z) < 0.0003);
        if (x > 3 && x < W - 4) assert_true(fabs(linear - z) > 0.1);
    }
}

/* Spans and columns of 4,096 pixels: exact to the last one, and depth does not drift. */
static void the_largest_target(void **state)
{
    (void)state;
    enum { SIZE = EW_TARGET_MAX };
    uint16_t *c = calloc(SIZE * 8, 2), *d = calloc(SIZE * 8, 2);
    assert_true(c && d);
    for (int turned = 0; turned < 2; turned++) {
        ew_target target = { .colour = c, .depth = d, .width = (uint16_t)(turned ? 8 : SIZE), .height = (uint16_t)(turned ? SIZE : 8), .stride = (uint16_t)(turned ? 8 : SIZE) };
        assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
        ew_raster_clear(&raster, 0);
        use(1, EW_DOUBLE_SIDED);
        double far_w = 0.001, near_w = 0.999;
        ew_raster_vertex a = corner(0, 0, (uint32_t)lrint(ldexp(near_w, 31))), b = corner(px(8), px(8), 0), e = b;
        b.x = turned ? px(8) : 0, b.y = turned ? 0 : px(8), b.w = a.w;
        e.x = turned ? 0 : px(SIZE), e.y = turned ? px(SIZE) : 0, e.w = (uint32_t)lrint(ldexp(far_w, 31));
        assert_int_equal(ew_raster_triangle(&raster, &a, &b, &e), 1);
        enum { DOWN = 12 - EW_SUBPIXEL_BITS }; /* the corners are whole pixels */
        int64_t sx[3] = { a.x >> DOWN, b.x >> DOWN, e.x >> DOWN }, sy[3] = { a.y >> DOWN, b.y >> DOWN, e.y >> DOWN };
        for (int i = 0; i < SIZE; i++) {
            for (int k = 0; k < 8; k++) {
                int x = turned ? k : i, y = turned ? i : k;
                test_context("turned %d pixel %d %d", turned, x, y);
                int exact = ref_covers(sx, sy, EW_SUBPIXEL_BITS, x, y);
                assert_int_equal(c[y * target.stride + x], exact);
                double w = near_w + (far_w - near_w) * (i + 0.5) / SIZE;
                if (exact) assert_true(fabs(d[y * target.stride + x] + 0.5 - 65536 * w) < 0.6);
            }
        }
    }
    free(c);
    free(d);
}

static void arguments_are_checked(void **state)
{
    (void)state;
    ew_raster r;
    uint16_t pixels[4];
    ew_target good = { .colour = pixels, .width = 2, .height = 2, .stride = 2 }, t;
    assert_int_equal(ew_raster_init(&r, &good), EW_OK);
    t = good, t.colour = NULL;
    assert_int_equal(ew_raster_init(&r, &t), EW_ERR_ARGUMENT);
    t = good, t.width = 0;
    assert_int_equal(ew_raster_init(&r, &t), EW_ERR_ARGUMENT);
    t = good, t.height = 4097;
    assert_int_equal(ew_raster_init(&r, &t), EW_ERR_ARGUMENT);
    t = good, t.stride = 1;
    assert_int_equal(ew_raster_init(&r, &t), EW_ERR_ARGUMENT);
    ew_raster_init(&r, &good);

    const ew_rect rects[4] = { { 0, 0, 3, 2 }, { 0, 0, 2, 3 }, { 1, 0, 0, 2 }, { 0, 2, 2, 1 } };
    for (int i = 0; i < 4; i++) assert_int_equal(ew_raster_set_scissor(&r, &rects[i]), EW_ERR_ARGUMENT);

    ew_texture texture = { .texels = pixels, .width = 2, .height = 2 };
    ew_material material = { .texture = &texture, .tolerance = 4, .rung = EW_RUNG_AUTO }, m;
    assert_int_equal(ew_raster_set_material(&r, &material), EW_OK);
    m = material, m.rung = EW_RUNG_COUNT;
    assert_int_equal(ew_raster_set_material(&r, &m), EW_ERR_ARGUMENT);
    m = material, m.tolerance = EW_TOLERANCE_MAX + 1;
    assert_int_equal(ew_raster_set_material(&r, &m), EW_ERR_ARGUMENT);
    m = material, m.flags = 128;
    assert_int_equal(ew_raster_set_material(&r, &m), EW_ERR_ARGUMENT);
    texture.width = 4096;
    assert_int_equal(ew_raster_set_material(&r, &material), EW_ERR_ARGUMENT);
    texture.width = 2, texture.texels = NULL;
    assert_int_equal(ew_raster_set_material(&r, &material), EW_ERR_ARGUMENT);
    texture.texels = pixels;
    assert_int_equal(ew_raster_set_material(&r, &material), EW_OK);

    const int32_t guard = EW_GUARD_PX * 4096;
    ew_raster_vertex a = { .w = 1u << 30 }, b = { .y = guard, .w = 1u << 30 }, c = { .x = guard, .y = guard, .w = 1u << 30 }, v;
    assert_int_equal(ew_raster_triangle(&r, &a, &b, &c), 1);
    v = c, v.x = guard + 1;
    assert_int_equal(ew_raster_triangle(&r, &a, &b, &v), EW_ERR_RANGE);
    v = c, v.y = -guard - 1;
    assert_int_equal(ew_raster_triangle(&r, &v, &b, &a), EW_ERR_RANGE);
    v = c, v.w = 0;
    assert_int_equal(ew_raster_triangle(&r, &a, &v, &b), EW_ERR_RANGE);
    v = c, v.w = 0x80000001u;
    assert_int_equal(ew_raster_triangle(&r, &a, &v, &b), EW_ERR_RANGE);
    v = c, v.u = INT32_MIN;
    assert_int_equal(ew_raster_triangle(&r, &a, &b, &v), EW_ERR_RANGE);
    v = c, v.v = INT32_MIN;
    assert_int_equal(ew_raster_triangle(&r, &a, &b, &v), EW_ERR_RANGE);
    v = c, v.u = 32768 * 4096;
    assert_int_equal(ew_raster_triangle(&r, &a, &b, &v), EW_ERR_RANGE); /* 32,768 texels apart */
    v.u -= 1;
    assert_int_equal(ew_raster_triangle(&r, &a, &b, &v), 1);
    v = c, v.u = 1 << 30; /* two of them would differ by 2^31 */
    assert_int_equal(ew_raster_triangle(&r, &a, &b, &v), EW_ERR_RANGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(hand_drawn),
        TEST(worked_example),
        TEST(linear_z_is_wrong_where_linear_1_over_z_is_right),
        TEST(random_triangles_are_covered_exactly),
        TEST(nets_cover_each_pixel_once),
        TEST(fan_of_a_thousand),
        TEST(only_fronts_are_drawn),
        TEST(constant_rung_beside_a_texture),
        TEST(depth_rules),
        TEST(scissor_cuts_exactly),
        TEST(the_largest_target),
        TEST(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
