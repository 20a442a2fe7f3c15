/* Depth, u and v of single triangles, given as the raster layer takes them: every fragment
 * against the exact value of the triangle's planes, in double. */
#include "unit.h"

#include <math.h>

#include "edgewalk/raster.h"

enum { W = 64, H = 48, LOG2_SIZE = 11 };

static uint16_t colour[W * H], depth[W * H], texels[1 << 2 * LOG2_SIZE];
static const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };
static const ew_texture texture = { .texels = texels, .width = 1 << LOG2_SIZE, .height = 1 << LOG2_SIZE };
static ew_raster raster;

/* The triangle at hand, and what its fragments showed. */
static struct {
    ew_raster_vertex v[3];
    double radius;
    int rung;
    long fragments;
    double depth_low, depth_high; /* stored                                                   */
    double uv_off;                /* texels outside of the exact values over the disc           */
} now;

static void exact(double px, double py, double *u, double *v)
{
    double x[3], y[3], b[3], sum = 0;
    for (int i = 0; i < 3; i++) x[i] = now.v[i].x / 4096.0 - px, y[i] = now.v[i].y / 4096.0 - py;
    *u = *v = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        b[i] = (x[j] * y[k] - x[k] * y[j]) * now.v[i].w;
        sum += b[i];
        *u += b[i] * (now.v[i].u / 4096.0);
        *v += b[i] * (now.v[i].v / 4096.0);
    }
    *u /= sum;
    *v /= sum;
}

void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c, int rung)
{
    (void)a, (void)b, (void)c;
    now.rung = rung;
}

void ew_trace_fragment(uint16_t px, uint16_t py, uint16_t d, ew_q20_12 u, ew_q20_12 v)
{
    double got[2] = { u / 4096.0, v / 4096.0 }, low[2] = { HUGE_VAL, HUGE_VAL }, high[2] = { -HUGE_VAL, -HUGE_VAL };
    now.fragments++;
    now.depth_low = fmin(now.depth_low, d);
    now.depth_high = fmax(now.depth_high, d);
    for (int k = 0; k <= 32; k++) {
        double angle = k * acos(-1.0) / 16, r = k < 32 ? now.radius : 0, at[2];
        exact(px + 0.5 + r * cos(angle), py + 0.5 + r * sin(angle), &at[0], &at[1]);
        for (int i = 0; i < 2; i++) low[i] = fmin(low[i], at[i]), high[i] = fmax(high[i], at[i]);
    }
    for (int i = 0; i < 2; i++) {
        /* the core's is modulo the texture's size */
        double middle = (low[i] + high[i]) / 2, value = middle + remainder(got[i] - middle, 1 << LOG2_SIZE);
        now.uv_off = fmax(now.uv_off, fmax(value - high[i], low[i] - value));
    }
}

static double uniform(double low, double high) { return low + (high - low) * (test_random() / 4294967296.0); }

static ew_raster_vertex corner(double x, double y, double w, double u, double v)
{
    ew_raster_vertex r = { .x = (int32_t)lrint(4096 * x), .y = (int32_t)lrint(4096 * y), .w = (uint32_t)lrint(ldexp(w, 31)), .u = (int32_t)lrint(4096 * u), .v = (int32_t)lrint(4096 * v) };
    return r;
}

static void draw(ew_rung rung, uint16_t tolerance)
{
    const ew_material material = { .texture = &texture, .tolerance = tolerance, .rung = (uint8_t)rung, .flags = EW_DOUBLE_SIDED };
    now.radius = tolerance / 16.0 + 1.0 / 256;
    now.fragments = 0;
    now.depth_low = HUGE_VAL, now.depth_high = -HUGE_VAL, now.uv_off = 0;
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    ew_raster_clear(&raster, 0);
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
    const ew_raster_vertex *v = now.v;
    test_context("rung %d tolerance %d/16: %d %d %u %d %d, %d %d %u %d %d, %d %d %u %d %d", rung, tolerance, v[0].x, v[0].y,
                 v[0].w, v[0].u, v[0].v, v[1].x, v[1].y, v[1].w, v[1].u, v[1].v, v[2].x, v[2].y, v[2].w, v[2].u, v[2].v);
    assert_true(ew_raster_triangle(&raster, &v[0], &v[1], &v[2]) >= 0);
}

/* Slivers down to thousandths of a pixel, whose planes rise without limit: no covered pixel
 * leaves the corners' depths by more than a quarter of the least, nor - linear - their u
 * and v by more than the whole of their difference. */
static void slivers_stay_between_their_corners(void **state)
{
    (void)state;
    long fragments = 0;
    for (int n = 0; n < 60000; n++) {
        double x = uniform(2, 62), y = uniform(2, 46), angle = uniform(0, 2 * acos(-1.0)), length = uniform(1, 60);
        double along = uniform(0, 1) * length, aside = uniform(-1, 1) * pow(10, uniform(-4, -0.5));
        double c = cos(angle), s = sin(angle), w[3], u[3];
        for (int i = 0; i < 3; i++) w[i] = 0.9 * pow(10, uniform(-2, 0)), u[i] = uniform(0, 900);
        now.v[0] = corner(x, y, w[0], u[0], u[1]);
        now.v[1] = corner(x + length * c, y + length * s, w[1], u[1], u[2]);
        now.v[2] = corner(x + along * c - aside * s, y + along * s + aside * c, w[2], u[2], u[0]);
        double w_min = fmin(w[0], fmin(w[1], w[2])), w_max = fmax(w[0], fmax(w[1], w[2]));
        draw(n & 1 ? EW_RUNG_AFFINE : EW_RUNG_EXACT, 0);
        fragments += now.fragments;
        if (!now.fragments) continue;
        assert_true(now.depth_low >= 65536 * 0.75 * w_min - 2);
        assert_true(now.depth_high <= 65536 * (w_max + w_min / 4) + 2);
    }
    assert_true(fragments > 2000);
}

/* Corners up to 4,096 texels apart, on every rung that promises something. */
static void far_corners_keep_the_promise(void **state)
{
    (void)state;
    const struct {
        ew_rung rung;
        uint16_t tolerance;
    } ways[] = { { EW_RUNG_EXACT, 0 }, { EW_RUNG_AUTO, 0 }, { EW_RUNG_AUTO, 1 }, { EW_RUNG_AUTO, 4 }, { EW_RUNG_AUTO, 16 } };
    long fragments = 0;
    for (int n = 0; n < 5000; n++) {
        double reach = pow(2, uniform(0, 12)), least = pow(10, uniform(-1.5, 0)), deep = pow(10, uniform(-4.4, 0));
        int only = (int)(test_random() % 8); /* now and then one difference alone is large */
        for (int i = 0; i < 3; i++) {
            double x = 32 + 30 * cos(2.1 * i + uniform(-0.6, 0.6)), y = 24 + 22 * sin(2.1 * i + uniform(-0.6, 0.6));
            double u = uniform(0, reach), v = uniform(0, reach);
            if (only < 3) u = 1, v = i == only ? reach : 1;
            now.v[i] = corner(x, y, 0.95 * deep * uniform(least, 1), u - reach / 2, v + 100);
        }
        int way = (int)(test_random() % 5);
        draw(ways[way].rung, ways[way].tolerance);
        fragments += now.fragments;
        assert_true(now.uv_off <= 1.0 / 64);
    }
    assert_true(fragments > 1000000);
}

/* Triangles about as steep as the affine bound allows, on both sides of it. */
static void the_affine_bound_holds(void **state)
{
    (void)state;
    enum { TOLERANCE = 32 };
    const double t = TOLERANCE / 16.0;
    long affine = 0, runs = 0;
    double nearest = 0;
    for (int n = 0; n < 5000; n++) {
        double x[3], y[3], dw[3], most = 0, base = uniform(0.1, 0.5), ratio = uniform(0.3, 2.5);
        for (int i = 0; i < 3; i++) {
            x[i] = 32 + 30 * cos(2.1 * i + uniform(-0.9, 0.9)), y[i] = 24 + 22 * sin(2.1 * i + uniform(-0.9, 0.9));
            dw[i] = n & 1 ? uniform(0, 1) : i == n / 2 % 3;
        }
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3;
            most = fmax(most, hypot(x[i] - x[j], y[i] - y[j]) * fabs(dw[i] - dw[j]));
        }
        double scale = ratio * 3 * t * base / most;
        if (base + scale > 0.98) continue; /* nearer than the near plane */
        for (int i = 0; i < 3; i++) now.v[i] = corner(x[i], y[i], base + dw[i] * scale, 15 * x[i], 15 * y[i]);
        draw(EW_RUNG_AUTO, TOLERANCE);
        if (now.rung == EW_RUNG_AFFINE) affine++, nearest = fmax(nearest, ratio);
        else runs++;
        assert_true(now.uv_off <= 1.0 / 64);
    }
    test_context("%ld affine, up to %.3f of the bound, %ld in runs", affine, nearest, runs);
    assert_true(affine > 500 && runs > 500);
    assert_true(nearest > 0.9); /* it is used nearly to its end */
}

/* Far away 1/z has few bits left, and 32-bit steps would be felt: two cases of a wide
 * picture, 0.18 and 0.34 texel off before such triangles took the exact rung. */
static void far_triangles_of_wide_pictures(void **state)
{
    (void)state;
    static uint16_t wide_colour[1024 * 24], wide_depth[1024 * 24];
    const struct {
        uint16_t width;
        ew_raster_vertex v[3];
    } cases[] = { { 320, { { -554040, 53335, 35946, 645320, 626286, { 0, 0, 0 } }, { 1544286, 62644, 38742, 8816, 638647, { 0, 0, 0 } },
                           { 410428, -310981, 31727, 533096, 773063, { 0, 0, 0 } } } },
                  { 1024, { { -1772930, 36951, 92942, 645320, 626286, { 0, 0, 0 } }, { 4941717, 46260, 107961, 8816, 638647, { 0, 0, 0 } },
                            { 1852220, -327365, 72405, 533096, 773063, { 0, 0, 0 } } } } };
    for (int k = 0; k < 2; k++) {
        const ew_target wide = { .colour = wide_colour, .depth = wide_depth, .width = cases[k].width, .height = 24, .stride = cases[k].width };
        const ew_material material = { .texture = &texture, .tolerance = 1, .rung = EW_RUNG_AUTO, .flags = EW_DOUBLE_SIDED };
        for (int i = 0; i < 3; i++) now.v[i] = cases[k].v[i];
        now.radius = 1.0 / 16 + 1.0 / 256, now.uv_off = 0, now.fragments = 0;
        assert_int_equal(ew_raster_init(&raster, &wide), EW_OK);
        ew_raster_clear(&raster, 0);
        assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
        assert_int_equal(ew_raster_triangle(&raster, &now.v[0], &now.v[1], &now.v[2]), 1);
        test_context("width %d: %.4f texel beyond the tolerance", cases[k].width, now.uv_off);
        assert_true(now.fragments > 1000 && now.uv_off <= 1.0 / 64);
    }
}

/* Gouraud shading on a grey target: each value within those of the exact shade over the disc,
 * widened by the rounding of 256 shades and of the target's 255 steps. */
static void shades_keep_the_promise(void **state)
{
    (void)state;
    static uint8_t grey[W * H];
    static uint16_t far[W * H];
    const ew_target grey_target = { .colour = grey, .depth = far, .width = W, .height = H, .stride = W, .format = EW_TARGET_GREY8 };
    const uint16_t tolerances[4] = { 0, 1, 4, 16 };
    long fragments = 0, curved = 0;
    for (int n = 0; n < 4000; n++) {
        const ew_material material = { .colour = 0xFFFF, .tolerance = tolerances[n & 3], .flags = EW_DOUBLE_SIDED | EW_SHADED };
        int corner_shade[3];
        assert_int_equal(ew_raster_init(&raster, &grey_target), EW_OK);
        ew_raster_clear(&raster, 0);
        assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
        for (int i = 0; i < 3; i++) {
            uint8_t c = (uint8_t)(n % 7 == i ? 255 * (int)(test_random() & 1) : (int)(test_random() & 255));
            corner_shade[i] = c + (c >> 7); /* 256 is all */
            now.v[i] = corner(uniform(-20, 84), uniform(-20, 68), 0.9 * pow(10, uniform(-1.5, 0)), corner_shade[i], 0);
            now.v[i].colour = (ew_colour888){ c, c, c };
        }
        assert_true(ew_raster_triangle(&raster, &now.v[0], &now.v[1], &now.v[2]) >= 0);
        double radius = tolerances[n & 3] / 16.0 + 1.0 / 256;
        for (int p = 0; p < W * H; p++) {
            if (!far[p]) continue;
            double low = HUGE_VAL, high = -HUGE_VAL, u, v;
            for (int k = 0; k <= 16; k++) {
                double r = k < 16 ? radius : 0;
                exact(p % W + 0.5 + r * cos(k * acos(-1.0) / 8), p / W + 0.5 + r * sin(k * acos(-1.0) / 8), &u, &v);
                low = fmin(low, u), high = fmax(high, u);
            }
            test_context("triangle %d pixel %d %d: %d, exact %.3f to %.3f of 256", n, p % W, p / W, grey[p], low, high);
            assert_true(grey[p] <= high + 0.6 && grey[p] >= fmin(low, 256) - 1.6);
            fragments++;
            curved += high - low < 1;
        }
    }
    assert_true(fragments > 500000 && curved > 100000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(slivers_stay_between_their_corners),
        TEST(far_corners_keep_the_promise),
        TEST(the_affine_bound_holds),
        TEST(far_triangles_of_wide_pictures),
        TEST(shades_keep_the_promise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
