/* The promise of docs/error-bound.md and of the depth in docs/conventions.md, on random
 * triangles: for each tolerance t, every drawn u and v is an exact one at most t + 1/256 px
 * away, widened by 1/64 texel; every depth is within 1 unit of an exact one at most
 * 1/256 px away. Of large triangles some fragments are judged. */
#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../reference/scenes.h"
#include "edgewalk/geometry.h"
#include "promise.h"
#include "triangles.h"

enum { JUDGED = 64, PX = 4096 };

static const double E = PROMISE_E, SNAP = PROMISE_SNAP, NEAR = 0.25;

/* ---- ways to draw, and how they did ---- */

typedef struct figures {
    long triangles, judged, broken, depth_judged, broken_depth;
    long beyond, beyond_off; /* fragments of which u and v are not promised, and how many do not keep it */
    double disp_max, depth_max;
    long shown; /* the last case of which a row was printed */
} figures;

static figures seen[PROMISE_WAYS];
/* Beyond these the ways are bounded by the triangle itself, as the raster layer takes it. */
enum { MESH_WAYS = 11 };

static long rows_shown;

/* The triangle at hand, as a row of a list of cases too. */
static promise_triangle triangle;
static char row[400];

/* The first broken promise of a case, ready for a list of cases. */
static void show(int way, const char *what, long number, const promise_fragment *f, double value, double exact, double off)
{
    if (seen[way].shown == number || rows_shown++ >= 20) return;
    seen[way].shown = number;
    printf("# %s\n", row);
    printf("# BROKEN EW_CASE=%ld %s, %s: rung drawn %d, %d x %d, texture %d x %d, pixel %d %d: drawn %.5f, exact %.5f, "
           "off by %.5f px or units\n", number, promise_ways[way].name, what, promise_rung, promise_raster.target.width,
           promise_raster.target.height, promise_raster.texture.width, promise_raster.texture.height, f->x, f->y, value, exact, off);
}

/* Judges one fragment. */
static void judge(int way, long number, const promise_fragment *f, const exact_forms *at)
{
    figures *s = &seen[way];
    double limit = promise_limit(&promise_ways[way], &triangle, at), off = exact_depth_off(at, f->depth, SNAP);
    double ru = exact_radius(at, &at->u, f->u / 4096.0, promise_raster.texture.width, E);
    double rv = exact_radius(at, &at->v, f->v / 4096.0, promise_raster.texture.height, E), r = fmax(ru, rv);
    if (promise_given(&triangle, at) && !isinf(limit)) {
        s->judged++;
        s->disp_max = fmax(s->disp_max, r);
        if (r > limit) {
            s->broken++;
            if (ru >= rv) show(way, "u", number, f, f->u / 4096.0, exact_value(at, &at->u), ru);
            else show(way, "v", number, f, f->v / 4096.0, exact_value(at, &at->v), rv);
        }
    } else {
        s->beyond++;
        s->beyond_off += r > limit;
    }
    if (isnan(off)) return;
    s->depth_judged++;
    s->depth_max = fmax(s->depth_max, off);
    if (off > 1) {
        s->broken_depth++;
        show(way, "depth", number, f, f->depth + 0.5, (double)(65536 * at->w.at), off);
    }
}

static void picture(uint16_t width, uint16_t height)
{
    static const uint16_t sizes[5][2] = { { 256, 256 }, { 2048, 2048 }, { 2048, 32 }, { 64, 1024 }, { 256, 128 } };
    uint32_t size = pick(5);
    promise_picture(width, height, sizes[size][0], sizes[size][1]);
}

/* ---- triangles of the raster layer ---- */

/* 1/z of the corners: far apart, alike, or a plane that the eye grazes. */
static void choose_depths(ew_raster_vertex v[3], double ratio)
{
    double w[3], most = 0, nearest = pick(2) ? uniform(0.1, 1) : pow(2, uniform(-16, 0));
    double angle = uniform(0, 2 * acos(-1.0)), alike = pow(10, uniform(-4, 0));
    int kind = (int)pick(3);
    for (int i = 0; i < 3; i++) {
        w[i] = kind == 0 ? pow(ratio, -uniform(0, 1)) : 1 - alike * uniform(0, 1);
        if (kind == 2) w[i] = 1e-9 + fabs(cos(angle) * v[i].x + sin(angle) * v[i].y); /* 0 at the horizon */
        most = fmax(most, w[i]);
    }
    for (int i = 0; i < 3; i++) v[i].w = (uint32_t)fmax(1, floor(ldexp(w[i] / most * nearest, 31)));
}

/* u and v of the corners, up to `reach` texels apart, near 0 or far from it. */
static void choose_texels(ew_raster_vertex v[3], double reach)
{
    double far_off = pick(4) ? 0 : uniform(-1, 1) * (262143 - reach); /* |u| < 2^18 texels */
    int only = (int)pick(8);
    for (int i = 0; i < 3; i++) {
        double u = uniform(0, reach), t = uniform(0, reach);
        if (only < 3) u = i == only ? reach : 0, t = 0;
        v[i].u = (int32_t)(PX * (u + far_off)), v[i].v = (int32_t)(PX * (t + far_off));
    }
}

/* Judges what was drawn: all of a few fragments, some of many. */
static void judge_drawn(int way, long number, const exact_corners *corners, const ref_triangle *truth)
{
    int all = promise_count <= JUDGED;
    seen[way].triangles++;
    for (int i = 0; i < (all ? promise_count : JUDGED); i++) {
        const promise_fragment *f = &promise_drawn[all ? i : (int)pick((uint32_t)promise_count)];
        exact_forms at = corners ? exact_from_corners(corners, f->x, f->y) : exact_from_truth(truth, f->x, f->y);
        judge(way, number, f, &at);
    }
}

/* Draws a triangle in every way and judges it. */
static void draw_and_judge(const ew_raster_vertex v[3], long number)
{
    exact_corners corners;
    if (!exact_corners_init(&corners, v)) return; /* only its snapped corners may have an area */
    triangle = promise_of(v);
    snprintf(row, sizeof row, "%s", triangle_row(v));
    for (int k = 0; k < PROMISE_WAYS; k++) {
        if (triangle.reach > promise_ways[k].reach) continue;
        promise_use(&promise_ways[k], number);
        int result = ew_raster_triangle(&promise_raster, &v[0], &v[1], &v[2]);
        assert_true(result >= 0);
        if (!result) return;
        judge_drawn(k, number, &corners, NULL);
    }
}

static void begin(void)
{
    rows_shown = 0;
    for (int k = 0; k < PROMISE_WAYS; k++) seen[k] = (figures){ .shown = -1 };
}

static void end(const char *name)
{
    char text[64];
    long broken = 0, judged = 0;
    for (int k = 0; k < PROMISE_WAYS; k++) {
        const figures *s = &seen[k];
        if (!s->triangles) continue;
        broken += s->broken + s->broken_depth;
        judged += s->judged;
        snprintf(text, sizeof text, "%s: %s", name, promise_ways[k].name);
        cases_figure("displacement", text, s->triangles, s->judged, s->broken, s->disp_max, "px");
        cases_figure("depth", text, s->triangles, s->depth_judged, s->broken_depth, s->depth_max, "units");
        if (!s->beyond) continue;
        cases_figure("not promised", text, s->triangles, s->beyond, 0, (double)s->beyond_off, "beyond the disc");
    }
    test_context("%s: %ld of %ld promises broken", name, broken, judged);
    assert_true(judged > 0 || cases_alone());
    assert_int_equal(broken, 0);
}

/* Kinds of triangles crossed with depth ratios up to `ratio` and corners up to `reach` texels apart. */
static void run(const char *name, double ratio, double reach, long slice, long whole)
{
    static const triangle_kind kinds[7] = { KIND_ORDINARY, KIND_ORDINARY, KIND_SLIVER, KIND_TINY,
                                            KIND_HUGE, KIND_AXIS, KIND_CENTRES };
    begin();
    for (cases c = cases_of(name, slice, whole); cases_next(&c);) {
        ew_raster_vertex v[3];
        memset(v, 0, sizeof v);
        if (pick(16) == 0) picture(4096, 4);
        else if (pick(16) == 0) picture(4, 4096);
        else picture(64, 48);
        triangle_place(v, kinds[pick(7)], promise_raster.target.width, promise_raster.target.height);
        choose_depths(v, pow(ratio, uniform(0, 1)));
        choose_texels(v, pow(reach, uniform(0, 1)));
        triangle_context(name, c.number, v);
        draw_and_judge(v, c.number);
    }
    end(name);
}

static void ordinary(void **state)
{
    (void)state;
    run("ratio to 100, 512 texels", 100, 512, 3000, 250000);
}

static void any_ratio(void **state)
{
    (void)state;
    run("ratio to 10^6, 512 texels", 1e6, 512, 3000, 250000);
}

static void any_reach(void **state)
{
    (void)state;
    run("ratio to 10^6, 32767 texels", 1e6, 32767, 3000, 250000);
}

/* 1/z of three corners such that linear attributes are displaced by about `px`, or less where 1/z would have to
 * fall to a half. */
static void choose_displacement(ew_raster_vertex v[3], double px)
{
    const double near = pow(2, uniform(-16, 0));
    double x[3] = { uniform(0, 1), uniform(0, 1), uniform(0, 1) }, most = 1e-9;
    if (pick(4) == 0) x[1 + pick(2)] = x[0];
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3;
        most = fmax(most, fabs(x[i] - x[k]) * hypot(v[i].x - v[k].x, v[i].y - v[k].y) / PX);
    }
    for (int i = 0; i < 3; i++) v[i].w = (uint32_t)fmax(1, floor(ldexp(near * (1 - fmin(4 * px / most, 0.5) * x[i]), 31)));
}

/* Triangles small and alike enough in depth to be drawn linearly, moved or not, and those that just are not. */
static void nearly_affine(void **state)
{
    (void)state;
    const char *name = "nearly affine";
    begin();
    for (cases c = cases_of(name, 10000, 250000); cases_next(&c);) {
        ew_raster_vertex v[3];
        const double share = pow(2, uniform(-3, 0));
        memset(v, 0, sizeof v);
        picture(64, 48);
        triangle_place(v, KIND_ORDINARY, 64, 48);
        for (int i = 1; i < 3; i++) {
            v[i].x = (int32_t)(v[0].x + share * (v[i].x - v[0].x));
            v[i].y = (int32_t)(v[0].y + share * (v[i].y - v[0].y));
        }
        choose_displacement(v, pow(2, -(double)pick(5)) * uniform(0.9, 2));
        choose_texels(v, pow(pick(2) ? 512 : 32767, uniform(0.5, 1)));
        triangle_context(name, c.number, v);
        draw_and_judge(v, c.number);
    }
    end(name);
}

/* A triangle that grows by thousandths of a texel per pixel: the tangent's slope was
 * (du/z - u dw) / w with u dw rounded down to a whole unit of u/z, 1/1900 texel here, for each of up
 * to 32 pixels. */
static void slope_of_small_differences(void **state)
{
    (void)state;
    static const ew_raster_vertex v[3] = {
        { .x = -46211013, .y = -1337, .w = 417753, .u = -401734484, .v = -401728696 },
        { .x = 189745112, .y = -274, .w = 132550, .u = -401738610, .v = -401727967 },
        { .x = 536870912, .y = 536870912, .w = 1705226289, .u = -401727236, .v = -401736685 }
    };
    begin();
    picture(64, 48);
    draw_and_judge(v, 0);
    end("slope of small differences");
}

/* ---- triangles of the geometry layer ---- */

/* Corners near the eye, before and behind the near plane, and far away, in 1/512 unit; u and v
 * with `bits` fraction bits. Returns how many are behind. */
static int choose_corners(ew_vertex16 v[3], ref_corner exact[3], int bits)
{
    double size = pow(2, uniform(8, 14.9)), deep = pow(2, uniform(7, 14.9));
    int behind = 0, at = 0;
    triangle = (promise_triangle){ 0, 1, HUGE_VAL };
    for (int i = 0; i < 3; i++) {
        v[i].x = (int16_t)uniform(-size, size), v[i].y = (int16_t)uniform(-size, size);
        v[i].z = (int16_t)(uniform(-1, 0.3) * (pick(2) ? deep : 512));
        v[i].u = (int16_t)test_random(), v[i].v = (int16_t)test_random();
        exact[i].x = v[i].x / 512.0, exact[i].y = v[i].y / 512.0, exact[i].z = -v[i].z / 512.0;
        exact[i].u = ldexp(v[i].u, -bits), exact[i].v = ldexp(v[i].v, -bits);
        behind += exact[i].z < NEAR;
        triangle.reach = fmax(triangle.reach, fabs(exact[i].u - exact[0].u));
        triangle.reach = fmax(triangle.reach, fabs(exact[i].v - exact[0].v));
        at += snprintf(row + at, sizeof row - (size_t)at, "{ %d, %d, %d, %d, %d }, ", v[i].x, v[i].y,
                       v[i].z, v[i].u, v[i].v);
    }
    snprintf(row + at, sizeof row - (size_t)at, "uv fraction bits %d", bits);
    return behind;
}

/* Draws in every way and judges. Returns how many ways reached a pixel. */
static int draw_and_judge_mesh(ew_geometry *geometry, const ew_mesh *mesh, const ref_triangle *truth, long number)
{
    int drawn_ways = 0;
    for (int k = 0; k < MESH_WAYS; k++) {
        if (triangle.reach > promise_ways[k].reach) continue;
        promise_use(&promise_ways[k], number);
        int32_t result = ew_draw_triangles(geometry, mesh);
        assert_true(result >= 0);
        if (result == 0) break;
        judge_drawn(k, number, NULL, truth);
        drawn_ways++;
    }
    return drawn_ways;
}

static void through_the_near_plane(void **state)
{
    (void)state;
    const char *name = "through the near plane";
    const ew_projection projection = { 65536, 65536, { 1 << 29, -1 } };
    const ew_viewport viewport = { 0, -8, 64, 64 };
    const ref_camera eye = { 1, 1, NEAR, 0, -8, 64, 64 };
    static const uint16_t indices[3] = { 0, 1, 2 };
    ew_mat34 model_view;
    double exact[3][4];
    long cut = 0;
    standard_model_view(&model_view, exact);
    begin();
    for (cases c = cases_of(name, 3000, 250000); cases_next(&c);) {
        ew_geometry geometry;
        ew_vertex16 v[3];
        ew_screen_vertex screen[3];
        ref_corner corner[3];
        ref_triangle truth;
        int bits = 1 + (int)pick(8), behind = choose_corners(v, corner, bits);
        const ew_mesh mesh = { .vertices = v, .screen = screen, .indices = indices, .index_count = 3,
                               .uv_fraction_bits = (uint8_t)bits };
        picture(64, 48);
        if (!ref_triangle_init(&truth, &eye, corner)) continue;
        ew_geometry_init(&geometry, &promise_raster);
        assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
        ew_transform_vertices(&geometry.transform, v, 3, screen);
        test_context("EW_CASE=%ld %s: %s", c.number, name, row);
        if (draw_and_judge_mesh(&geometry, &mesh, &truth, c.number) && behind) cut++;
    }
    assert_true(cut > 0 || cases_alone());
    end(name);
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(ordinary), TEST(any_ratio), TEST(any_reach), TEST(nearly_affine),
                                        TEST(slope_of_small_differences), TEST(through_the_near_plane) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
