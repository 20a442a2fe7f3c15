/* What the clipper makes of corners: their colours, and where the borders of the outcodes are. */
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "edgewalk/geometry.h"

enum { W = 64, H = 48, MOST = 32, FOCAL_Y = 65536 * W / H };

static uint16_t colour[W * H], depth[W * H];
static const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };
static ew_raster raster;
static ew_geometry geometry;

static ew_raster_vertex traced[MOST];
static int traced_count;

void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c, int rung)
{
    (void)rung;
    assert_true(traced_count + 3 <= MOST);
    traced[traced_count++] = *a;
    traced[traced_count++] = *b;
    traced[traced_count++] = *c;
}

void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t d, ew_q20_12 u, ew_q20_12 v)
{
    (void)x, (void)y, (void)d, (void)u, (void)v;
}

/* ---- colours at cuts ---- */

/* A box of half-width 2 around the eye, so that a vertex lies at (2 x, 2 y, 2 z); near is 1/4 or
 * 2^-12, where cuts reach the guard band. */
static void around_the_eye(int close)
{
    const ew_viewport viewport = { 0, 0, W, H };
    const ew_projection projection = { 65536, FOCAL_Y, { 1 << 29, close ? -11 : -1 } };
    const ew_material material = { .rung = EW_RUNG_CONSTANT, .flags = EW_DOUBLE_SIDED | EW_SHADED };
    ew_mat34 model_view;
    for (int i = 0; i < 3; i++) {
        ew_row_from_q16_16(&model_view.row[i], i == 0 ? 131072 : 0, i == 1 ? 131072 : 0, i == 2 ? 131072 : 0, 0);
    }
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
    ew_raster_clear(&raster, 0);
    ew_geometry_init(&geometry, &raster);
    assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
}

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* The weights of three vertices where the ray through a pixel meets their plane. */
static void weights(double b[3], const ew_vertex16 *const v[3], double px, double py)
{
    double p[3][3], ray[3] = { px / (W / 2) - 1, (1 - py / (H / 2)) * 65536 / FOCAL_Y, -1 };
    for (int i = 0; i < 3; i++) p[i][0] = v[i]->x, p[i][1] = v[i]->y, p[i][2] = v[i]->z;
    b[0] = determinant(ray, p[1], p[2]);
    b[1] = determinant(p[0], ray, p[2]);
    b[2] = determinant(p[0], p[1], ray);
    double sum = b[0] + b[1] + b[2];
    for (int i = 0; i < 3; i++) b[i] /= sum;
}

static double channel(const ew_colour888 *c, int i) { return i == 0 ? c->r : i == 1 ? c->g : c->b; }

/* A channel at a place on the screen, and how much it changes within 1/4096 px. */
static double exact_channel(const ew_vertex16 *const v[3], const ew_colour888 *const c[3], int i, const ew_raster_vertex *at,
                            double *change)
{
    double value = 0;
    *change = 0;
    for (int k = 0; k < 5; k++) {
        static const int to[5][2] = { { 0, 0 }, { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 } };
        double b[3], sum = 0;
        weights(b, v, (at->x + to[k][0]) / 4096.0, (at->y + to[k][1]) / 4096.0);
        for (int j = 0; j < 3; j++) sum += b[j] * channel(c[j], i);
        if (k == 0) value = sum;
        else *change += fabs(sum - value);
    }
    return value;
}

static int is_cut(const ew_raster_vertex *r, const ew_screen_vertex screen[], int count)
{
    for (int i = 0; i < count; i++) {
        if (!(screen[i].outcode & (EW_OUT_NEAR | EW_OUT_GUARD)) && r->x == screen[i].x && r->y == screen[i].y) return 0;
    }
    return 1;
}

static void random_corners(ew_vertex16 *v, ew_colour888 *c, int count)
{
    for (int i = 0; i < count; i++) {
        v[i].x = (int16_t)test_random(), v[i].y = (int16_t)test_random(), v[i].z = (int16_t)test_random();
        v[i].u = (int16_t)test_random(), v[i].v = (int16_t)test_random();
        c[i].r = (uint8_t)test_random(), c[i].g = (uint8_t)test_random(), c[i].b = test_random() & 1 ? 255 : 0;
    }
}

/* Draws a triangle of `count` vertices; the corners of what the clipper made of it are in `traced`. */
static void draw_triangle(const ew_vertex16 *v, ew_screen_vertex *screen, const ew_colour888 *c, int count, int i0, int i1, int i2)
{
    const uint16_t index[3] = { (uint16_t)i0, (uint16_t)i1, (uint16_t)i2 };
    const ew_mesh mesh = { v, screen, c, index, 3, 8 };
    ew_transform_vertices(&geometry.transform, v, (uint32_t)count, screen);
    traced_count = 0;
    assert_true(ew_draw_triangles(&geometry, &mesh) >= 0);
}

static void colours_at_cuts(void **state)
{
    (void)state;
    long cuts = 0, guard = 0, sharp = 0;
    double worst = 0;
    for (int k = 0; k < 60000; k++) {
        ew_vertex16 v[3];
        ew_colour888 c[3];
        ew_screen_vertex screen[3];
        const ew_vertex16 *const corner[3] = { &v[0], &v[1], &v[2] };
        const ew_colour888 *const paint[3] = { &c[0], &c[1], &c[2] };
        around_the_eye(k & 1);
        random_corners(v, c, 3);
        if (k & 1) v[0].z = (int16_t)-(int)(test_random() % 9); /* at the near plane, far beside */
        draw_triangle(v, screen, c, 3, 0, 1, 2);
        for (int i = 0; i < traced_count; i++) {
            const ew_raster_vertex *r = &traced[i];
            if (!is_cut(r, screen, 3)) {
                int at = 0;
                while (screen[at].x != r->x || screen[at].y != r->y) at++;
                assert_memory_equal(&r->colour, &c[at], sizeof *c);
                continue;
            }
            cuts++;
            if (abs(r->x) > 130000 * 4096 || abs(r->y) > 130000 * 4096) guard++;
            for (int j = 0; j < 3; j++) {
                double change, e = exact_channel(corner, paint, j, r, &change), off = fabs(channel(&r->colour, j) - e);
                test_context("case %d corner %d channel %d at %d %d: %.0f, exactly %.4f, changes by %.4f", k, i, j, r->x,
                             r->y, channel(&r->colour, j), e, change);
                assert_true(off <= 0.5 + 1.0 / 50 + change);
                if (change < 0.01) sharp++, worst = fmax(worst, off);
            }
        }
    }
    test_context("%ld cut corners, %ld at the guard band, %ld channels off by up to %.4f", cuts, guard, sharp, worst);
    assert_true(cuts > 10000 && guard > 100 && sharp > 10000);
}

/* White where the mesh has no colours, also at cuts and after a mesh that had some. */
static void without_colours_all_is_white(void **state)
{
    (void)state;
    long corners = 0;
    for (int k = 0; k < 2000; k++) {
        ew_vertex16 v[3];
        ew_colour888 c[3];
        ew_screen_vertex screen[3];
        around_the_eye(k & 1);
        random_corners(v, c, 3);
        draw_triangle(v, screen, c, 3, 0, 1, 2);
        draw_triangle(v, screen, NULL, 3, 0, 1, 2);
        for (int i = 0; i < traced_count; i++, corners++) {
            assert_true(traced[i].colour.r == 255 && traced[i].colour.g == 255 && traced[i].colour.b == 255);
        }
    }
    assert_true(corners > 1000);
}

/* Where two triangles share an edge that is cut, both have the very same new corner. */
static void shared_edges_are_cut_alike(void **state)
{
    (void)state;
    long shared = 0;
    for (int k = 0; k < 40000; k++) {
        ew_vertex16 v[4];
        ew_colour888 c[4];
        ew_screen_vertex screen[4];
        ew_raster_vertex first[MOST];
        around_the_eye(k & 1);
        random_corners(v, c, 4);
        draw_triangle(v, screen, c, 4, 0, 1, 2);
        int count = traced_count;
        memcpy(first, traced, sizeof first);
        draw_triangle(v, screen, c, 4, 2, 1, 3);
        if (!count || !traced_count) continue;
        const ew_vertex16 *const corner[3] = { &v[0], &v[1], &v[2] };
        for (int i = 0; i < count; i++) {
            double b[3];
            weights(b, corner, first[i].x / 4096.0, first[i].y / 4096.0);
            if (!is_cut(&first[i], screen, 4) || fabs(b[0]) > 1e-6) continue;
            int found = 0;
            for (int j = 0; j < traced_count; j++) {
                if (abs(traced[j].x - first[i].x) > 2 || abs(traced[j].y - first[i].y) > 2) continue;
                found = 1;
                test_context("case %d: corner %d at %d %d and %d %d", k, i, first[i].x, first[i].y, traced[j].x, traced[j].y);
                assert_true(traced[j].x == first[i].x && traced[j].y == first[i].y && traced[j].w == first[i].w);
                assert_true(traced[j].u == first[i].u && traced[j].v == first[i].v);
                assert_memory_equal(&traced[j].colour, &first[i].colour, sizeof(ew_colour888));
            }
            shared += found;
        }
    }
    test_context("%ld shared corners", shared);
    assert_true(shared > 2000);
}

/* ---- borders of the outcodes ---- */

/* Both ways of ew_transform_vertices must agree with `code`. */
static void hold_code(const ew_transform *t, int16_t x, int16_t y, int16_t z, int code)
{
    const ew_vertex16 v = { x, y, z, 0, 0 };
    ew_transform careful = *t;
    ew_screen_vertex s;
    careful.w_hidden = INT32_MIN, careful.w_safe = INT32_MAX;
    ew_transform_vertices(t, &v, 1, &s);
    test_context("vertex %d %d %d at %d %d, w %u: code %d, not %d", x, y, z, s.x, s.y, s.w, s.outcode, code);
    assert_int_equal(s.outcode, code);
    ew_transform_vertices(&careful, &v, 1, &s);
    test_context("vertex %d %d %d at %d %d, w %u: code %d, not %d, in 64 bits", x, y, z, s.x, s.y, s.w, s.outcode, code);
    assert_int_equal(s.outcode, code);
}

/* One unit in front of the eye; `scale` times a vertex (as q1.15) across and up. */
static void board(ew_transform *t, const ew_viewport *viewport, int32_t scale)
{
    const ew_projection projection = { 65536, 65536, { 1 << 29, -3 } };
    ew_mat34 model_view;
    ew_row_from_q16_16(&model_view.row[0], scale, 0, 0, 0);
    ew_row_from_q16_16(&model_view.row[1], 0, scale, 0, 0);
    ew_row_from_q16_16(&model_view.row[2], 0, 0, 0, -65536);
    assert_int_equal(ew_transform_set(t, &projection, &model_view, viewport), EW_OK);
}

static void borders_of_the_viewport(void **state)
{
    (void)state;
    for (int k = 0; k < 200; k++) { /* twice the viewport's half-width: 16384 is its border */
        ew_viewport viewport = { (int16_t)((int)(test_random() % 400) - 200), (int16_t)((int)(test_random() % 400) - 200), 16, 16 };
        if (k == 0) viewport.x = viewport.y = -8192;
        if (k == 1) viewport.x = viewport.y = 8191;
        ew_transform t;
        board(&t, &viewport, 2 * 65536);
        hold_code(&t, 0, 0, 0, 0);
        hold_code(&t, -16384, 0, 0, 0), hold_code(&t, -16385, 0, 0, EW_OUT_LEFT);
        hold_code(&t, 16384, 0, 0, 0), hold_code(&t, 16385, 0, 0, EW_OUT_RIGHT);
        hold_code(&t, 0, 16384, 0, 0), hold_code(&t, 0, 16385, 0, EW_OUT_TOP);
        hold_code(&t, 0, -16384, 0, 0), hold_code(&t, 0, -16385, 0, EW_OUT_BOTTOM);
        hold_code(&t, -32768, -32768, 0, EW_OUT_LEFT | EW_OUT_BOTTOM);
        hold_code(&t, 32767, 32767, 0, EW_OUT_RIGHT | EW_OUT_TOP);
    }
}

static void borders_of_the_guard_band(void **state)
{
    (void)state;
    const ew_viewport viewport = { -256, -256, 512, 512 }; /* its centre is 0, 0 */
    ew_transform t;
    board(&t, &viewport, 1024 * 65536); /* 8 px to a vertex unit */
    hold_code(&t, 16384, 0, 0, EW_OUT_RIGHT), hold_code(&t, 16385, 0, 0, EW_OUT_RIGHT | EW_OUT_GUARD);
    hold_code(&t, -16384, 0, 0, EW_OUT_LEFT), hold_code(&t, -16385, 0, 0, EW_OUT_LEFT | EW_OUT_GUARD);
    hold_code(&t, 0, -16384, 0, EW_OUT_BOTTOM), hold_code(&t, 0, -16385, 0, EW_OUT_BOTTOM | EW_OUT_GUARD);
    hold_code(&t, 0, 16384, 0, EW_OUT_TOP), hold_code(&t, 0, 16385, 0, EW_OUT_TOP | EW_OUT_GUARD);
}

static void the_near_plane_itself_is_seen(void **state)
{
    (void)state;
    const ew_viewport viewport = { 0, 0, W, H };
    for (int e = -12; e <= 0; e++) { /* near distances of 8 units of a vertex and more */
        const ew_projection projection = { 65536, 65536, { 1 << 29, (int16_t)e } };
        const int16_t at = (int16_t)-(1 << (14 + e));
        ew_mat34 model_view;
        ew_transform t;
        ew_mat34_identity(&model_view);
        assert_int_equal(ew_transform_set(&t, &projection, &model_view, &viewport), EW_OK);
        hold_code(&t, 0, 0, at, 0);
        hold_code(&t, 0, 0, (int16_t)(at - 1), 0);
        hold_code(&t, 0, 0, (int16_t)(at + 1), EW_OUT_NEAR);
        hold_code(&t, 0, 0, 0, EW_OUT_NEAR);
        hold_code(&t, 100, -100, 32767, EW_OUT_NEAR);
        const ew_vertex16 v = { 0, 0, at, 0, 0 };
        ew_screen_vertex s;
        ew_transform_vertices(&t, &v, 1, &s);
        assert_true(s.w >= 0x7FFFFFFFu && s.w <= 0x80000000u);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(colours_at_cuts),
        TEST(without_colours_all_is_white),
        TEST(shared_edges_are_cut_alike),
        TEST(borders_of_the_viewport),
        TEST(borders_of_the_guard_band),
        TEST(the_near_plane_itself_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
