/* The promise of docs/error-bound.md and of the depth in docs/conventions.md, on random
 * triangles: for each tolerance t, every drawn u and v is an exact one at most t + 1/256 px
 * away, widened by 1/64 texel; every depth is within 1 unit of an exact one at most
 * 1/256 px away. Of large triangles some fragments are judged. */
#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../reference/exact.h"
#include "../reference/scenes.h"
#include "edgewalk/geometry.h"
#include "triangles.h"

enum { PIXELS = 4096 * 4, JUDGED = 64, PX = 4096, TEXTURE_MOST = 2048 };

static const double E = 1.0 / 64, SNAP = 1.0 / 256;
static uint16_t colour[PIXELS], depth[PIXELS], texels[TEXTURE_MOST * TEXTURE_MOST];
static ew_raster raster;
static ew_texture texture;
static uint16_t width, height;

/* ---- what was drawn ---- */

typedef struct fragment {
    uint16_t x, y, depth;
    ew_q20_12 u, v;
} fragment;
static fragment drawn[2 * PIXELS]; /* clipped triangles may in theory overlap */
static int drawn_count, drawn_rung;

void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c, int rung)
{
    (void)a, (void)b, (void)c;
    drawn_rung = rung;
}

void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t d, ew_q20_12 u, ew_q20_12 v)
{
    if (drawn_count == 2 * PIXELS) return;
    fragment f = { x, y, d, u, v };
    drawn[drawn_count++] = f;
}

/* ---- ways to draw, and how they did ---- */

typedef struct way {
    const char *name;
    ew_rung rung;
    uint16_t tolerance;
    double reach; /* texels between corners up to which it promises something */
    /* figures */
    long triangles, judged, broken, depth_judged, broken_depth;
    long beyond, beyond_off; /* fragments of which u and v are not promised, and how many keep it not */
    double disp_max, depth_max;
    long shown; /* the last case of which a row was printed */
} way;

static way ways[] = {
    { "auto 1 px", EW_RUNG_AUTO, 16, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 },   { "auto 1/2 px", EW_RUNG_AUTO, 8, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 },
    { "auto 1/4 px", EW_RUNG_AUTO, 4, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 },  { "auto 1/8 px", EW_RUNG_AUTO, 2, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 },
    { "auto 1/16 px", EW_RUNG_AUTO, 1, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 }, { "auto 0", EW_RUNG_AUTO, 0, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 },
    { "runs 1/4 px", EW_RUNG_RUNS, 4, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 },  { "table", EW_RUNG_TABLE, 0, 512, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 },
    { "exact", EW_RUNG_EXACT, 0, 32768, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1 },
};
enum { WAYS = sizeof ways / sizeof *ways };

static long rows_shown;

/* The triangle at hand: as a row of a list of cases, and what its limits are made of. */
static struct {
    char row[400];
    double reach;  /* texels between its corners, the most       */
    double w_most; /* the largest near/z of its corners          */
} triangle;

/* The first broken promise of a case, ready for a list of cases. */
static void show(way *w, const char *what, long number, const fragment *f, double value, double exact, double off)
{
    if (w->shown == number || rows_shown++ >= 20) return;
    w->shown = number;
    printf("# %s\n", triangle.row);
    printf("# BROKEN EW_CASE=%ld %s, %s (rung drawn %d) %s: %d x %d, texture %d x %d, pixel %d %d: drawn %.5f, exact %.5f, "
           "radius or depth units %.5f\n", number, w->name, what, drawn_rung, what, width, height, texture.width,
           texture.height, f->x, f->y, value, exact, off);
}

/* docs/error-bound.md, "where it stops holding": 1/z has 31 fraction bits, u/z and v/z have
 * 29 at the nearest corner, for differences of 128 texels or more. */
static int promised(const exact_forms *at)
{
    double w = (double)at->w.at, g = triangle.w_most / w;
    return w >= 1.0 / 65536 && fmax(triangle.reach, 128) * ldexp(g, -27) + triangle.reach * ldexp(1 / w, -31) <= 1.0 / 128;
}

/* Judges one fragment. */
static void judge(way *w, long number, const fragment *f, const exact_forms *at)
{
    double limit = w->tolerance / 16.0 + SNAP, off = exact_depth_off(at, f->depth, SNAP);
    double ru = exact_radius(at, &at->u, f->u / 4096.0, texture.width, E);
    double rv = exact_radius(at, &at->v, f->v / 4096.0, texture.height, E), r = fmax(ru, rv);
    if (promised(at)) {
        w->judged++;
        w->disp_max = fmax(w->disp_max, r);
        if (r > limit) {
            w->broken++;
            if (ru >= rv) show(w, "u", number, f, f->u / 4096.0, exact_value(at, &at->u), ru);
            else show(w, "v", number, f, f->v / 4096.0, exact_value(at, &at->v), rv);
        }
    } else {
        w->beyond++;
        w->beyond_off += r > limit;
    }
    if (isnan(off)) return;
    w->depth_judged++;
    w->depth_max = fmax(w->depth_max, off);
    if (off > 1) {
        w->broken_depth++;
        show(w, "depth", number, f, f->depth + 0.5, (double)(65536 * at->w.at), off);
    }
}

static void use(const way *w)
{
    const ew_material material = { .texture = &texture, .tolerance = w->tolerance, .rung = (uint8_t)w->rung,
                                   .flags = EW_DOUBLE_SIDED };
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
    drawn_count = 0;
}

static void picture(uint16_t w, uint16_t h)
{
    const ew_target target = { .colour = colour, .depth = depth, .width = w, .height = h, .stride = w };
    static const uint16_t sizes[][2] = { { 256, 256 }, { 2048, 2048 }, { 2048, 32 }, { 64, 1024 }, { 256, 128 } };
    uint32_t size = pick(5);
    width = w, height = h;
    texture = (ew_texture){ .texels = texels, .width = sizes[size][0], .height = sizes[size][1] };
    memset(depth, 0, 2u * w * h);
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
}

/* ---- triangles of the raster layer ---- */

/* 1/z of the corners: far apart, alike, or a plane that the eye grazes. */
static void choose_depths(ew_raster_vertex v[3], double ratio)
{
    double w[3], nearest = pick(2) ? uniform(0.1, 1) : pow(2, uniform(-16, 0)), angle = uniform(0, 2 * acos(-1.0)), most = 0;
    double alike = pow(10, uniform(-4, 0));
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

static void remember(const ew_raster_vertex v[3])
{
    triangle.reach = triangle.w_most = 0;
    for (int i = 0; i < 3; i++) {
        double far = fmax(fabs((double)v[i].u - v[0].u), fabs((double)v[i].v - v[0].v)) / PX;
        triangle.reach = fmax(triangle.reach, far);
        triangle.w_most = fmax(triangle.w_most, ldexp(v[i].w, -31));
    }
    snprintf(triangle.row, sizeof triangle.row, "{ { %d, %d, %uu, %d, %d }, { %d, %d, %uu, %d, %d }, { %d, %d, %uu, %d, %d } }",
             v[0].x, v[0].y, v[0].w, v[0].u, v[0].v, v[1].x, v[1].y, v[1].w, v[1].u, v[1].v, v[2].x, v[2].y, v[2].w,
             v[2].u, v[2].v);
}

/* Judges what was drawn: all of a few fragments, some of many. */
static void judge_drawn(way *w, long number, const exact_corners *corners, const ref_triangle *truth)
{
    int all = drawn_count <= JUDGED;
    w->triangles++;
    for (int i = 0; i < (all ? drawn_count : JUDGED); i++) {
        const fragment *f = &drawn[all ? i : (int)pick((uint32_t)drawn_count)];
        exact_forms at = corners ? exact_from_corners(corners, f->x, f->y) : exact_from_truth(truth, f->x, f->y);
        judge(w, number, f, &at);
    }
}

/* Draws a triangle in every way and judges it. */
static void draw_and_judge(const ew_raster_vertex v[3], long number)
{
    exact_corners corners;
    if (!exact_corners_init(&corners, v)) return; /* only its snapped corners may have an area */
    remember(v);
    for (int k = 0; k < WAYS; k++) {
        if (triangle.reach > ways[k].reach) continue;
        use(&ways[k]);
        int result = ew_raster_triangle(&raster, &v[0], &v[1], &v[2]);
        assert_true(result >= 0);
        if (!result) return;
        judge_drawn(&ways[k], number, &corners, NULL);
    }
}

static void begin(void)
{
    rows_shown = 0;
    for (int k = 0; k < WAYS; k++) {
        way *w = &ways[k];
        w->triangles = w->judged = w->broken = w->depth_judged = w->broken_depth = w->beyond = w->beyond_off = 0;
        w->shown = -1;
        w->disp_max = w->depth_max = 0;
    }
}

static void end(const char *name)
{
    char text[64];
    long broken = 0, judged = 0;
    for (int k = 0; k < WAYS; k++) {
        const way *w = &ways[k];
        snprintf(text, sizeof text, "%s: %s", name, w->name);
        cases_figure("displacement", text, w->triangles, w->judged, w->broken, w->disp_max, "px");
        cases_figure("depth", text, w->triangles, w->depth_judged, w->broken_depth, w->depth_max, "units");
        if (w->beyond) cases_figure("not promised", text, w->triangles, w->beyond, 0, (double)w->beyond_off, "beyond the disc");
        broken += w->broken + w->broken_depth;
        judged += w->judged;
    }
    test_context("%s: %ld of %ld promises broken", name, broken, judged);
    assert_true(judged > 0);
    assert_int_equal(broken, 0);
}

/* Kinds of triangles crossed with depth ratios up to `ratio` and corners up to `reach` texels apart. */
static void run(const char *name, double ratio, double reach, long slice, long whole)
{
    static const triangle_kind kinds[] = { KIND_ORDINARY, KIND_ORDINARY, KIND_SLIVER, KIND_TINY, KIND_HUGE, KIND_AXIS, KIND_CENTRES };
    begin();
    for (cases c = cases_of(name, slice, whole); cases_next(&c);) {
        ew_raster_vertex v[3];
        memset(v, 0, sizeof v);
        if (pick(16) == 0) picture(4096, 4);
        else if (pick(16) == 0) picture(4, 4096);
        else picture(64, 48);
        triangle_place(v, kinds[pick(7)], width, height);
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

/* A triangle that grows by thousandths of a texel per pixel: the tangent's slope is
 * (du/z - u dw) / w, and u dw was rounded down to a whole unit of u/z, 1/1900 texel here, for
 * each of up to 32 pixels. */
static void slope_of_small_differences(void **state)
{
    (void)state;
    static const ew_raster_vertex v[3] = { { .x = -46211013, .y = -1337, .w = 417753, .u = -401734484, .v = -401728696 },
                                           { .x = 189745112, .y = -274, .w = 132550, .u = -401738610, .v = -401727967 },
                                           { .x = 536870912, .y = 536870912, .w = 1705226289, .u = -401727236, .v = -401736685 } };
    begin();
    picture(64, 48);
    draw_and_judge(v, 0);
    end("slope of small differences");
}

/* ---- triangles of the geometry layer ---- */

/* Corners near the eye, before and behind the near plane, and far away. */
static void through_the_near_plane(void **state)
{
    (void)state;
    const char *name = "through the near plane";
    const ew_projection projection = { 65536, 65536, { 1 << 29, -1 } }; /* near 0.25 */
    ew_mat34 model_view;
    double exact[3][4];
    long cut = 0;
    standard_model_view(&model_view, exact);
    begin();
    for (cases c = cases_of(name, 3000, 250000); cases_next(&c);) {
        const uint16_t corners[3] = { 0, 1, 2 };
        ew_geometry geometry;
        ew_vertex16 v[3];
        ew_screen_vertex screen[3];
        ref_corner corner[3];
        ref_triangle truth;
        picture(64, 48);
        const ew_viewport viewport = { 0, -8, 64, 64 };
        const ref_camera eye = { 1, 1, 0.25, 0, -8, 64, 64 };
        double size = pow(2, uniform(8, 14.9)), deep = pow(2, uniform(7, 14.9));
        int bits = 1 + (int)pick(8), behind = 0;
        triangle.reach = 0;
        for (int i = 0; i < 3; i++) {
            v[i].x = (int16_t)uniform(-size, size), v[i].y = (int16_t)uniform(-size, size);
            v[i].z = (int16_t)(uniform(-1, 0.3) * (pick(2) ? deep : 512));
            v[i].u = (int16_t)test_random(), v[i].v = (int16_t)test_random();
            corner[i] = (ref_corner){ v[i].x / 512.0, v[i].y / 512.0, -v[i].z / 512.0, ldexp(v[i].u, -bits), ldexp(v[i].v, -bits) };
            behind += corner[i].z < 0.25;
            triangle.reach = fmax(triangle.reach, fmax(fabs(corner[i].u - corner[0].u), fabs(corner[i].v - corner[0].v)));
        }
        triangle.w_most = 1;
        snprintf(triangle.row, sizeof triangle.row, "{ { %d, %d, %d, %d, %d }, { %d, %d, %d, %d, %d }, { %d, %d, %d, %d, %d } }, %d",
                 v[0].x, v[0].y, v[0].z, v[0].u, v[0].v, v[1].x, v[1].y, v[1].z, v[1].u, v[1].v, v[2].x, v[2].y, v[2].z,
                 v[2].u, v[2].v, bits);
        if (!ref_triangle_init(&truth, &eye, corner)) continue;
        ew_geometry_init(&geometry, &raster);
        assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
        ew_transform_vertices(&geometry.transform, v, 3, screen);
        const ew_mesh mesh = { .vertices = v, .screen = screen, .indices = corners, .index_count = 3,
                               .uv_fraction_bits = (uint8_t)bits };
        for (int k = 0; k < WAYS; k++) {
            if (triangle.reach > ways[k].reach) continue;
            use(&ways[k]);
            int32_t result = ew_draw_triangles(&geometry, &mesh);
            assert_true(result >= 0);
            if (result == 0) break;
            judge_drawn(&ways[k], c.number, NULL, &truth);
            cut += behind > 0;
        }
    }
    assert_true(cut > 0);
    end(name);
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(ordinary), TEST(any_ratio), TEST(any_reach),
                                        TEST(slope_of_small_differences), TEST(through_the_near_plane) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
