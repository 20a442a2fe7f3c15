/* The geometry layer: transform, near plane and guard band, against the referee. */
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../accuracy/measure.h"
#include "../reference/scenes.h"
#include "../../src/geometry/project.h"

enum { W = 96, H = 72, MESH = 24 };

static uint16_t colour[W * H], depth[W * H], texels[16 * 16];
static ew_raster raster;
static ew_geometry geometry;
static const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };

static double uniform(double low, double high) { return low + (high - low) * (test_random() / 4294967296.0); }

static ew_block block(double a)
{
    int e;
    ew_block b = { (int32_t)lrint(ldexp(frexp(a, &e), 30)), 0 };
    b.e = (int16_t)e;
    if (b.m == 1 << 30) b.m >>= 1, b.e++;
    return b;
}

static double value(int32_t m, int e) { return ldexp(m, e - 30); }

/* A random rotation, a scale and a place in front of the camera, both as the core's matrix
 * and as the double that the core's numbers stand for. */
static void random_model_view(ew_mat34 *fixed, double exact[3][4], double size, double distance)
{
    int32_t s[3], t[3];
    ew_quat q = { (int32_t)test_random() >> 1, (int32_t)test_random() >> 1, (int32_t)test_random() >> 1,
                  ((int32_t)test_random() >> 1) | 1 };
    ew_block scale = block(size), far_end = block(distance);
    for (int i = 0; i < 3; i++) s[i] = scale.m, t[i] = 0;
    t[2] = -far_end.m;
    t[0] = (int32_t)(far_end.m * uniform(-0.5, 0.5));
    assert_int_equal(ew_mat34_from_trs(fixed, t, far_end.e, &q, s, scale.e), EW_OK);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) exact[i][j] = value(fixed->row[i].m[j], j < 3 ? fixed->row[i].e : fixed->row[i].e_last);
    }
}

typedef struct picture {
    double near_z, size, distance, focal;
    int triangles;
} picture;

/* Draws random triangles and judges them. */
static measures draw_random(const picture *p)
{
    ew_vertex16 v[3 * MESH];
    ew_screen_vertex screen[3 * MESH];
    uint16_t index[3 * MESH];
    ew_mat34 model_view;
    double exact[3][4];
    measures m;
    ew_block n = block(p->near_z);
    int32_t fx = (int32_t)lrint(p->focal * 65536), fy = fx * 4 / 3;
    const ew_viewport viewport = { 0, 0, W, H };
    const ref_camera eye = { fx / 65536.0, fy / 65536.0, value(n.m, n.e), 0, 0, W, H };
    const ew_texture texture = { .texels = texels, .width = 16, .height = 16 };
    static const uint16_t tolerances[4] = { 0, 1, 4, 16 };
    const ew_material material = { .texture = &texture, .tolerance = tolerances[test_random() & 3], .rung = EW_RUNG_AUTO, .flags = EW_DOUBLE_SIDED };

    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
    ew_raster_clear(&raster, 0);
    ew_geometry_init(&geometry, &raster);
    random_model_view(&model_view, exact, p->size, p->distance);
    const ew_projection projection = { fx, fy, n };
    assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
    for (int i = 0; i < 3 * p->triangles; i++) {
        index[i] = (uint16_t)i;
        v[i].x = (int16_t)test_random(), v[i].y = (int16_t)test_random(), v[i].z = (int16_t)test_random();
        v[i].u = (int16_t)test_random(), v[i].v = (int16_t)test_random();
        if (i % 9 > 5) { /* some small ones: beside the corner before */
            v[i] = v[i - 1];
            v[i].x = (int16_t)(v[i].x / 2 + (int)(test_random() % 2000) - 1000);
            v[i].y = (int16_t)(v[i].y / 2 + (int)(test_random() % 2000) - 1000);
        }
    }
    ew_transform_vertices(&geometry.transform, v, (uint32_t)(3 * p->triangles), screen);
    measure_begin(&target, &eye, 0);
    const ew_mesh mesh = { v, screen, NULL, index, (uint32_t)(3 * p->triangles), 8 };
    assert_int_equal(measure_mesh(&geometry, exact, &mesh), 0);
    measure_end(&m, 0.125);
    test_context("uv_off %g depth_off %g near %g size %g distance %g focal %g: %ld fragments, %ld wrong, %ld of the truth, vertex %.3f, depth %.3f, "
                 "u %.4f v %.4f", m.uv_off, m.depth_off, p->near_z, p->size, p->distance, p->focal, m.fragments, m.wrong_px, m.wrong_truth_px,
                 m.snapped_max, m.depth_max, m.u_rms, m.v_rms);
    return m;
}

static void triangles_in_front(void **state)
{
    (void)state;
    long fragments = 0, truth = 0, pixels = 0;
    for (int k = 0; k < 300; k++) {
        picture p = { uniform(0.01, 1), 0, 0, uniform(0.5, 4), 6 };
        p.size = pow(2, uniform(-10, 10));
        p.distance = p.size * uniform(2, 20);
        p.near_z = p.size * uniform(0.01, 0.2);
        measures m = draw_random(&p);
        assert_int_equal(m.wrong_px, 0);
        assert_true(m.snapped_max <= 0.75);
        assert_true(m.depth_off <= 1);
        assert_true(m.uv_off <= 1.0 / 64);
        fragments += m.fragments, truth += m.wrong_truth_px, pixels += m.covered_px;
    }
    test_context("%ld fragments, %ld of %ld pixels against the unsnapped outline", fragments, truth, pixels);
    assert_true(fragments > 50000);
    assert_true(truth * 1000 < pixels * 3); /* tiny pictures are nearly all outline */
}

/* Around and through the eye: every triangle crosses the near plane or lies behind it. */
static void triangles_through_the_near_plane(void **state)
{
    (void)state;
    long fragments = 0, truth = 0;
    for (int k = 0; k < 400; k++) {
        picture p = { 0, pow(2, uniform(-6, 6)), 0, uniform(0.5, 2), 4 };
        p.near_z = p.size * pow(10, uniform(-3, -0.5));
        p.distance = p.size * uniform(0, 1);
        measures m = draw_random(&p);
        assert_int_equal(m.wrong_px, 0);
        assert_true(m.depth_off <= 1);
        assert_true(m.uv_off <= 1.0 / 64);
        fragments += m.fragments, truth += m.wrong_truth_px;
    }
    test_context("%ld fragments, %ld pixels against the unsnapped outline", fragments, truth);
    assert_true(fragments > 500000);
    assert_true(truth * 1000 < fragments);
}

/* Two triangles that share an edge, of which only one leaves the guard band or crosses the
 * near plane: together they cover what the quadrilateral does, without a crack. */
static void cut_edges_stay_shut(void **state)
{
    (void)state;
    long together = 0;
    for (int k = 0; k < 3000; k++) {
        ew_vertex16 v[4];
        ew_screen_vertex screen[4];
        const uint16_t index[6] = { 0, 1, 2, 0, 2, 3 };
        ew_mat34 model_view;
            double exact[3][4];
        const ew_viewport viewport = { 0, 0, W, H };
        ew_block n = block(pow(10, uniform(-5, -1)));
        random_model_view(&model_view, exact, 1, uniform(0.2, 1.2));
        const ew_projection projection = { 65536, 87381, n };
        ew_geometry_init(&geometry, &raster);
        assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
        assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
        /* a plane parallelogram */
        int a[3], b[3];
        for (int i = 0; i < 3; i++) a[i] = (int)(test_random() % 32768) - 16384, b[i] = (int)(test_random() % 32768) - 16384;
        for (int i = 0; i < 4; i++) {
            int s = i == 1 || i == 2 ? 1 : -1, t = i >= 2 ? 1 : -1;
            v[i].x = (int16_t)(s * a[0] / 2 + t * b[0] / 2), v[i].y = (int16_t)(s * a[1] / 2 + t * b[1] / 2);
            v[i].z = (int16_t)(s * a[2] / 2 + t * b[2] / 2), v[i].u = v[i].v = 0;
        }
        ew_transform_vertices(&geometry.transform, v, 4, screen);
        static uint8_t hits[W * H];
        memset(hits, 0, sizeof hits);
        for (int t = 0; t < 2; t++) {
            const ew_material material = { .colour = 1, .rung = EW_RUNG_CONSTANT, .flags = EW_DOUBLE_SIDED };
            ew_raster_set_material(&raster, &material);
            ew_raster_clear(&raster, 0);
            const ew_mesh mesh = { v, screen, NULL, index + 3 * t, 3, 0 };
            assert_true(ew_draw_triangles(&geometry, &mesh) >= 0);
            for (int i = 0; i < W * H; i++) hits[i] = (uint8_t)(hits[i] + colour[i]);
        }
        /* in a row of the convex outline there is no gap, and nothing is hit twice */
        for (int y = 0; y < H; y++) {
            int first = -1, last = -1;
            for (int x = 0; x < W; x++) {
                test_context("case %d: pixel %d %d hit %d times", k, x, y, hits[y * W + x]);
                assert_true(hits[y * W + x] <= 1);
                if (hits[y * W + x]) last = x, first = first < 0 ? x : first;
            }
            for (int x = first; first >= 0 && x <= last; x++) {
                test_context("case %d: gap at pixel %d %d", k, x, y);
                assert_int_equal(hits[y * W + x], 1);
                together++;
            }
        }
    }
    assert_true(together > 500000);
}

/* A corner between the clipper's guard and the transform's, 131,071 < x <= 131,072 px: it kept
 * its place in one of its triangles and was cut in the other, and the shared edge opened. */
static void a_corner_at_the_guard_band_keeps_its_place(void **state)
{
    (void)state;
    enum { SIZE = 512 };
    static uint16_t large[SIZE * SIZE];
    static uint8_t hits[SIZE * SIZE];
    const ew_target square = { .colour = large, .width = SIZE, .height = SIZE, .stride = SIZE };
    const ew_viewport viewport = { 0, 0, SIZE, SIZE };
    const ew_projection projection = { 65536, 65536, { 1 << 29, -3 } };
    const ew_material material = { .colour = 1, .rung = EW_RUNG_CONSTANT, .flags = EW_DOUBLE_SIDED };
    const uint16_t index[6] = { 0, 1, 2, 0, 3, 1 };
    ew_mat34 model_view; /* one unit away, 8 px to a vertex unit */
    ew_row_from_q16_16(&model_view.row[0], 1024 * 65536, 0, 0, 0);
    ew_row_from_q16_16(&model_view.row[1], 0, 1024 * 65536, 0, 0);
    ew_row_from_q16_16(&model_view.row[2], 0, 0, 65536, -65536);
    for (int n = 0; n < 150; n++) {
        ew_vertex16 v[4] = { { 0 }, { 16352, 0, 0, 0, 0 }, { 0 }, { 0 } };
        int side = test_random() & 1 ? 1 : -1;
        v[0].x = (int16_t)(-(int)(test_random() % 16000) - 200), v[0].y = (int16_t)((int)(test_random() % 400) - 200);
        v[1].y = (int16_t)((int)(test_random() % 400) - 200);
        v[2].y = (int16_t)(side * (20000 + (int)(test_random() % 10000)));
        v[3].y = (int16_t)(-side * (2000 + (int)(test_random() % 10000)));
        ew_screen_vertex screen[4];
        assert_int_equal(ew_raster_init(&raster, &square), EW_OK);
        ew_raster_set_material(&raster, &material);
        ew_geometry_init(&geometry, &raster);
        assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
        ew_transform_vertices(&geometry.transform, v, 4, screen);
        assert_int_equal(screen[1].outcode & EW_OUT_GUARD, 0);
        assert_int_equal(screen[2].outcode & EW_OUT_GUARD, EW_OUT_GUARD);
        memset(hits, 0, sizeof hits);
        for (int t = 0; t < 2; t++) {
            ew_raster_clear(&raster, 0);
            const ew_mesh mesh = { v, screen, NULL, index + 3 * t, 3, 1 };
            assert_true(ew_draw_triangles(&geometry, &mesh) >= 0);
            for (int i = 0; i < SIZE * SIZE; i++) hits[i] = (uint8_t)(hits[i] + large[i]);
        }
        for (int x = 0; x < SIZE; x++) {
            double y0 = screen[0].y / 4096.0, x0 = screen[0].x / 4096.0;
            double y = y0 + (screen[1].y / 4096.0 - y0) * (x + 0.5 - x0) / (screen[1].x / 4096.0 - x0);
            for (int k = (int)floor(y) - 2; k <= (int)floor(y) + 2; k++) {
                test_context("case %d, pixel %d %d", n, x, k);
                if (k >= 0 && k < SIZE) assert_int_equal(hits[k * SIZE + x], 1);
            }
        }
    }
}

/* A floor 10^4 pictures wide fills everything below the horizon. */
static void guard_band_drops_nothing(void **state)
{
    (void)state;
    for (int k = 0; k < 40; k++) {
        double half = pow(2, uniform(2, 16));
        ew_mat34 model_view;
        ew_block size = block(half);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 4; j++) model_view.row[i].m[j] = i == j ? size.m : 0;
            model_view.row[i].e = model_view.row[i].e_last = size.e;
        }
        ew_row_from_q16_16(&model_view.row[1], 0, 0, 0, -65536); /* one unit below the eye */
        const ew_vertex16 v[4] = { { -32767, 0, -32767, 0, 0 }, { 32767, 0, -32767, 0, 0 },
                                   { 32767, 0, 32767, 0, 0 }, { -32767, 0, 32767, 0, 0 } };
        const uint16_t index[6] = { 0, 2, 1, 0, 3, 2 };
        const ew_viewport viewport = { 0, 0, W, H };
        const ew_material material = { .colour = 1, .rung = EW_RUNG_CONSTANT };
        ew_screen_vertex screen[4];
            assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
        ew_raster_clear(&raster, 0);
        ew_raster_set_material(&raster, &material);
        ew_geometry_init(&geometry, &raster);
        const ew_projection projection = { 65536, 87381, block(0.01) };
        assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
        ew_transform_vertices(&geometry.transform, v, 4, screen);
        const ew_mesh mesh = { v, screen, NULL, index, 6, 0 };
        assert_true(ew_draw_triangles(&geometry, &mesh) > 0);
        double horizon = H / 2 * (1 + 87381 / 65536.0 / (half * 32767 / 32768));
        for (int y = 0; y < H; y++) {
            for (int x = 0; x < W; x++) {
                /* inside the floor's own sides, which are seen up to the horizon's width */
                double z = 87381 / 65536.0 * H / 2 / (y + 0.5 - H / 2.0), x_on_floor = (x + 0.5 - W / 2.0) / (W / 2.0) * z;
                if (y + 0.5 > horizon && fabs(fabs(x_on_floor) - half) < 0.02 * half) continue;
                int inside = y + 0.5 > horizon && fabs(x_on_floor) < half;
                test_context("half %g pixel %d %d", half, x, y);
                assert_int_equal(colour[y * W + x], inside);
            }
        }
    }
}

static void projected_positions(void **state)
{
    (void)state;
    for (int k = 0; k < 2000; k++) {
        ew_mat34 model_view;
            double exact[3][4];
        const ew_viewport viewport = { -100, 50, 4096, 3000 };
        ew_block n = block(pow(2, uniform(-12, 3)));
        double near_z = value(n.m, n.e);
        double size = pow(2, uniform(-4, 8)), distance = near_z * pow(2, uniform(0, 14));
        random_model_view(&model_view, exact, size, distance);
        const ew_projection projection = { 65536, 89478, n };
        assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
        for (int i = 0; i < 50; i++) {
            ew_vertex16 v = { (int16_t)test_random(), (int16_t)test_random(), (int16_t)test_random(), 0, 0 };
            ew_screen_vertex s;
            ew_transform_vertices(&geometry.transform, &v, 1, &s);
            double c[3];
            for (int r = 0; r < 3; r++) {
                c[r] = (exact[r][0] * v.x + exact[r][1] * v.y + exact[r][2] * v.z) / 32768 + exact[r][3];
            }
            double z = -c[2], x = -100 + 2048 * (1 + c[0] / z), y = 50 + 1500 * (1 - 89478 / 65536.0 * c[1] / z);
            test_context("z %g near %g x %g y %g: %d %d %u code %d", z, near_z, x, y, s.x, s.y, s.w, s.outcode);
            if (fabs(z - near_z) < 1e-7 * near_z) continue;
            assert_int_equal((s.outcode & EW_OUT_NEAR) != 0, z < near_z);
            if (s.outcode & EW_OUT_NEAR) continue;
            double furthest = fmax(fabs(x), fabs(y));
            if (fabs(furthest - EW_GUARD_PX) < 1) continue;
            assert_int_equal((s.outcode & EW_OUT_GUARD) != 0, furthest > EW_GUARD_PX);
            if (s.outcode & EW_OUT_GUARD) continue;
            /* half a unit of rounding, the reciprocal's 2^-29 of the position, and the matrix's
             * 2^-28 of the model's size as it would be seen at this depth, in x and in w */
            double seen = 4096 * (4096 + furthest) * (size * 1.8 + distance) / z;
            double allowed = 0.5 + 0.02 + furthest * 4096 * ldexp(1, -28) + seen * ldexp(1, -28);
            assert_true(fabs(s.x - 4096 * x) <= allowed && fabs(s.y - 4096 * y) <= allowed);
            assert_true(fabs(s.w - ldexp(near_z / z, 31)) <=
                        0.5 + ldexp(near_z / z, 31 - 28) * (1 + (size * 1.8 + distance) / z));
            assert_int_equal((s.outcode & EW_OUT_LEFT) != 0, s.x < -100 * 4096);
            assert_int_equal((s.outcode & EW_OUT_BOTTOM) != 0, s.y > 3050 * 4096);
        }
    }
}

/* Sums from 16-bit pieces, for cores without a long multiply, are those of the others, also
 * where the row's numbers fill their range. */
static void sums_of_pieces(void **state)
{
    (void)state;
    for (int k = 0; k < 2000000; k++) {
        ew_row32 row = { { 0 }, 0 };
        ew_row_pieces pieces;
        int64_t left = 0x7FFC0000;
        int first = (int)(test_random() & 3);
        for (int i = 0; i < 4; i++) {
            int at = (first + i) & 3;
            int64_t a = (test_random() & 7) == 0 ? left : llabs((int64_t)test_awkward()) % (left + 1);
            left -= a;
            if (test_random() & 1) a = -a;
            if (at < 3) row.m[at] = (int32_t)a;
            else row.rest = a * ((int64_t)1 << 31);
        }
        int32_t v[3];
        for (int i = 0; i < 3; i++) v[i] = test_random() & 3 ? (int16_t)test_random() : test_random() & 1 ? -32768 : 32767;
        test_context("row %d %d %d %lld, vertex %d %d %d", row.m[0], row.m[1], row.m[2], (long long)row.rest, v[0], v[1], v[2]);
        ew_row_pieces_init(&pieces, &row);
        __int128 exact = row.rest;
        for (int i = 0; i < 3; i++) exact += (__int128)row.m[i] * v[i] * 65536;
        assert_int_equal(ew_sum32(&row, v[0] * 65536, v[1] * 65536, v[2] * 65536), (int32_t)(exact >> 32));
        assert_int_equal(ew_sum32_pieces(&pieces, v[0], v[1], v[2]), (int32_t)(exact >> 32));
    }
}

/* A vertex that took the quick way does not notice that near_w is out of reach. */
static int went_quickly(const ew_transform *t, const ew_vertex16 *v)
{
    ew_transform never = *t;
    ew_screen_vertex s;
    never.near_w = INT64_MAX;
    ew_transform_vertices(&never, v, 1, &s);
    return !(s.outcode & EW_OUT_NEAR);
}

/* Both ways agree: what the quick one adds is below an eighth of 1/256 px. */
static void both_ways_agree(void **state)
{
    (void)state;
    long quick = 0, all = 0;
    for (int k = 0; k < 4000; k++) {
        ew_mat34 model_view;
        double exact[3][4];
        ew_viewport viewport = { (int16_t)(int)uniform(-200, 200), (int16_t)(int)uniform(-200, 200),
                                 (uint16_t)pow(2, uniform(0, 12)), (uint16_t)pow(2, uniform(0, 12)) };
        if (k & 2) viewport.x = viewport.y = 0; /* a few pixels, and nothing beside them */
        double size = pow(2, uniform(-8, 8)), distance = size * pow(2, uniform(-3, 5));
        ew_block n = block(distance * pow(2, uniform(-16, 1)));
        random_model_view(&model_view, exact, size, distance);
        if (k & 1) { /* around the eye and not turned: vertices close to it can be in the middle of the picture */
            int32_t m = (1 << 29) + (int32_t)(test_random() >> 3);
            for (int i = 0; i < 3; i++) {
                for (int j = 0; j < 4; j++) model_view.row[i].m[j] = i == j ? m : j == 3 ? (int32_t)(test_random() >> 12) : 0;
                model_view.row[i].e = model_view.row[i].e_last = 0;
            }
            n = block(pow(2, uniform(-14, -9)));
        }
        const ew_projection projection = { (int32_t)(65536 * uniform(0.3, 5)), (int32_t)(65536 * uniform(0.3, 5)), n };
        ew_transform t, careful;
        assert_int_equal(ew_transform_set(&t, &projection, &model_view, &viewport), EW_OK);
        careful = t;
        careful.w_hidden = INT32_MIN, careful.w_safe = INT32_MAX;
        for (int i = 0; i < 50; i++) {
            ew_vertex16 v = { (int16_t)test_random(), (int16_t)test_random(), (int16_t)test_random(), 0, 0 };
            ew_screen_vertex a, b;
            if (k & 1) v.z = (int16_t)-(int)(test_random() % 4000), v.x = (int16_t)(v.x * v.z / 65536), v.y = (int16_t)(v.y * v.z / 65536);
            ew_transform_vertices(&t, &v, 1, &a);
            ew_transform_vertices(&careful, &v, 1, &b);
            all++;
            test_context("case %d: x %d %d y %d %d w %u %u code %d %d", k, a.x, b.x, a.y, b.y, a.w, b.w, a.outcode, b.outcode);
            if (!went_quickly(&t, &v)) { /* hidden or careful: the very same */
                assert_true(a.x == b.x && a.y == b.y && a.w == b.w && a.outcode == b.outcode);
                continue;
            }
            quick++;
            assert_int_equal(b.outcode & (EW_OUT_NEAR | EW_OUT_GUARD), 0);
            /* two units of 1/4096 px inside the viewport, in proportion outside, and both roundings */
            double size_x = fmax(abs(viewport.x), abs(viewport.x + viewport.width)) * 4096;
            double size_y = fmax(abs(viewport.y), abs(viewport.y + viewport.height)) * 4096;
            assert_true(abs(a.x - b.x) <= 1 + 2 * fmax(1, abs(b.x) / size_x));
            assert_true(abs(a.y - b.y) <= 1 + 2 * fmax(1, abs(b.y) / size_y));
            assert_true(fabs((double)a.w - b.w) <= 1 + b.w * ldexp(1.5, -20)); /* w is 2^20 units and more */
            if (a.x == b.x && a.y == b.y) assert_int_equal(a.outcode, b.outcode);
        }
    }
    test_context("%ld of %ld quickly", quick, all);
    assert_true(quick * 2 > all); /* the rest is hidden, or far beside a picture of a few pixels */
    assert_true(quick * 10 < all * 9);
}

/* The counted scenes are drawn by the quick way, every vertex. */
static void ordinary_scenes_take_the_quick_way(void **state)
{
    (void)state;
    static standard_scene scene;
    const ew_projection projection = { 65536, 65536, { 1 << 29, -1 } };
    const ew_viewport viewport = { 0, -40, 320, 320 };
    ew_mat34 model_view;
    double exact[3][4];
    ew_transform t;
    standard_model_view(&model_view, exact);
    standard_scene_init(&scene, 'B');
    assert_int_equal(ew_transform_set(&t, &projection, &model_view, &viewport), EW_OK);
    for (uint32_t i = 0; i < scene.vertex_count; i++) {
        test_context("vertex %u", i);
        assert_true(went_quickly(&t, &scene.vertices[i]));
    }
}

/* A matrix of any mantissas, sizes far apart; at times the third row fills its range, and the corner
 * of the box where all three are -32768 is the farthest. */
static void random_rows(ew_mat34 *fixed, double exact[3][4], int spread)
{
    for (int i = 0; i < 3; i++) {
        int full = i == 2 && test_random() % 4 == 0;
        ew_row *row = &fixed->row[i];
        row->e = (int16_t)((int)(test_random() % (unsigned)(2 * spread + 1)) - spread);
        row->e_last = (int16_t)(row->e - (int)(test_random() % 3));
        for (int j = 0; j < 4; j++) {
            int32_t m = full || test_random() & 1 ? (1 << 30) - 1 : (1 << 29) + (int32_t)(test_random() >> 3);
            row->m[j] = full ? (j < 3 ? m : -m) : test_random() & 1 ? m : -m;
        }
        if (full) row->e_last = row->e;
        for (int j = 0; j < 4; j++) exact[i][j] = value(row->m[j], j < 3 ? row->e : row->e_last);
    }
}

static int16_t extreme(void) { return (int16_t)(test_random() & 1 ? (test_random() & 1 ? 32767 : -32768) : (int)test_random()); }

/* Near plane and guard band where x, y and w differ in size by up to 2^20 and their sums by the
 * vertices' extremes: the clipper's one unit has to hold them all. */
static void units_of_every_size(void **state)
{
    (void)state;
    long fragments = 0, truth = 0, clipped = 0;
    for (int k = 0; k < 1500; k++) {
        ew_vertex16 v[3];
        ew_screen_vertex screen[3];
        const uint16_t index[3] = { 0, 1, 2 };
        const ew_mesh mesh = { v, screen, NULL, index, 3, 8 };
        ew_mat34 model_view;
        double exact[3][4];
        measures m;
        random_rows(&model_view, exact, 10);
        double largest = fabs(exact[2][0]) + fabs(exact[2][1]) + fabs(exact[2][2]) + fabs(exact[2][3]);
        ew_block n = block(largest * pow(2, uniform(-9, -1)));
        int32_t fx = (int32_t)(65536 * pow(2, uniform(-6, 9))), fy = (int32_t)(65536 * pow(2, uniform(-6, 9)));
        const ew_viewport viewport = { 0, 0, W, H };
        const ref_camera eye = { fx / 65536.0, fy / 65536.0, value(n.m, n.e), 0, 0, W, H };
        const ew_material material = { .rung = EW_RUNG_CONSTANT, .colour = 1, .flags = EW_DOUBLE_SIDED };
        assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
        assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
        ew_raster_clear(&raster, 0);
        ew_geometry_init(&geometry, &raster);
        const ew_projection projection = { fx, fy, n };
        if (ew_transform_set(&geometry.transform, &projection, &model_view, &viewport) != EW_OK) continue;
        for (int i = 0; i < 3; i++) v[i] = (ew_vertex16){ extreme(), extreme(), extreme(), 0, 0 };
        if (k & 2) v[0].x = v[0].y = v[0].z = -32768;
        ew_transform_vertices(&geometry.transform, v, 3, screen);
        int any = screen[0].outcode | screen[1].outcode | screen[2].outcode;
        measure_begin(&target, &eye, 0);
        assert_int_equal(measure_mesh(&geometry, exact, &mesh), 0);
        measure_end(&m, 0.125);
        test_context("case %d: %ld fragments, %ld wrong, %ld of the truth, depth %.3f, code %d", k, m.fragments, m.wrong_px,
                     m.wrong_truth_px, m.depth_off, any);
        assert_int_equal(m.wrong_px, 0);
        assert_true(m.depth_off <= 1);
        if (any & (EW_OUT_NEAR | EW_OUT_GUARD)) clipped++;
        fragments += m.fragments, truth += m.wrong_truth_px;
    }
    test_context("%ld fragments, %ld pixels against the unsnapped outline, %ld triangles clipped", fragments, truth, clipped);
    assert_true(fragments > 200000 && clipped > 500);
    assert_true(truth * 1000 < fragments);
}

/* A near distance that is a vertex's own, and a little more and less: the quick way leaves to
 * 64 bits what it cannot decide, also where the near distance is next to a power of two. */
static void the_near_plane_is_decided_in_64_bits(void **state)
{
    (void)state;
    long hidden = 0, seen = 0;
    for (int k = 0; k < 300000; k++) {
        ew_mat34 model_view;
        double exact[3][4];
        ew_homogeneous_vertex h;
        ew_transform t;
        ew_screen_vertex s;
        const ew_viewport viewport = { 0, 0, W, H };
        ew_projection projection = { 65536, 87381, { 1 << 29, 0 } };
        const ew_vertex16 v = { extreme(), extreme(), extreme(), 0, 0 };
        random_rows(&model_view, exact, 2);
        if (k & 1) { /* distances next to a power of two */
            for (int j = 0; j < 4; j++) model_view.row[2].m[j] = j == 2 ? -(1 << 30) : j == 3 ? (int)(test_random() % 9) - 4 : 0;
            model_view.row[2].e_last = model_view.row[2].e;
        }
        assert_int_equal(ew_transform_set(&t, &projection, &model_view, &viewport), EW_OK);
        ew_homogeneous(&h, &t, &v);
        if (h.w < (int64_t)1 << 32) continue;
        int down = 34 - ew_clz64((uint64_t)h.w); /* its upper 30 bits */
        int64_t m = (down > 0 ? h.w >> down : h.w << -down) + (int)(test_random() % 9) - 4;
        if (m < 1 << 29 || m >= 1 << 30) continue;
        projection.near_z.m = (int32_t)m;
        projection.near_z.e = (int16_t)(t.w.e - 15 + down);
        assert_int_equal(ew_transform_set(&t, &projection, &model_view, &viewport), EW_OK);
        ew_transform_vertices(&t, &v, 1, &s);
        test_context("case %d: w %lld, near %lld, code %d", k, (long long)h.w, (long long)t.near_w, s.outcode);
        assert_int_equal((s.outcode & EW_OUT_NEAR) != 0, h.w < t.near_w);
        if (s.outcode & EW_OUT_NEAR) hidden++;
        else seen++;
    }
    test_context("%ld hidden, %ld seen", hidden, seen);
    assert_true(hidden > 10000 && seen > 10000);
}

/* What is left out before the corners are snapped draws nothing: slivers along lines of pixel centres, which rounding
 * turns over. */
static void what_is_turned_away_draws_nothing(void **state)
{
    (void)state;
    static const int8_t direction[4][2] = { { 1, 0 }, { 0, 1 }, { 1, 1 }, { 1, -1 } };
    const ew_viewport viewport = { 0, 0, W, H };
    const ew_projection projection = { 65536, 65536, { 1 << 29, -3 } };
    const ew_material material = { .colour = 1, .rung = EW_RUNG_CONSTANT };
    const uint16_t index[3] = { 0, 1, 2 };
    const ew_vertex16 v[3] = { { 0 }, { 0 }, { 0 } };
    ew_mat34 model_view;
    long drawn = 0, turned = 0;
    ew_mat34_identity(&model_view);
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    ew_raster_set_material(&raster, &material);
    ew_geometry_init(&geometry, &raster);
    assert_int_equal(ew_transform_set(&geometry.transform, &projection, &model_view, &viewport), EW_OK);
    for (int n = 0; n < 200000; n++) {
        const int8_t *d = direction[test_random() % 4];
        const int32_t x = 4096 * (int32_t)(test_random() % (W / 3)) + 2048, y = 4096 * (int32_t)(H / 2) + 2048;
        const int32_t along[3] = { 0, 4096 * (int32_t)(1 + test_random() % (H / 2 - 2)), (int32_t)(test_random() % (4096 * (H / 2 - 2))) };
        ew_screen_vertex screen[3];
        ew_raster_vertex corner[3] = { { 0 } };
        const int first = (int)(test_random() % 3);
        for (int i = 0; i < 3; i++) {
            const int at = (i + first) % 3;
            screen[at] = (ew_screen_vertex){ .x = x + d[0] * along[i], .y = y + d[1] * along[i], .w = UINT32_C(1) << 30 };
            screen[at].x += (int32_t)(test_random() % 24) - 12;
            screen[at].y += (int32_t)(test_random() % 24) - 12;
            corner[at].x = screen[at].x, corner[at].y = screen[at].y, corner[at].w = screen[at].w;
        }
        const ew_mesh mesh = { v, screen, NULL, index, 3, 0 };
        ew_raster_clear(&raster, 0);
        const int expected = ew_raster_triangle(&raster, &corner[0], &corner[1], &corner[2]);
        ew_raster_clear(&raster, 0);
        test_context("case %d: %d %d, %d %d, %d %d", n, corner[0].x, corner[0].y, corner[1].x, corner[1].y, corner[2].x, corner[2].y);
        assert_int_equal(ew_draw_triangles(&geometry, &mesh), expected);
        const int64_t area = (int64_t)(corner[1].x - corner[0].x) * (corner[2].y - corner[0].y) -
                             (int64_t)(corner[2].x - corner[0].x) * (corner[1].y - corner[0].y);
        drawn += expected;
        turned += expected && area > 0;
    }
    test_context("%ld slivers reached a pixel, %ld of them away from the eye before snapping", drawn, turned);
    assert_true(drawn > 10000 && turned > 1000);
}

static void arguments_are_checked(void **state)
{
    (void)state;
    ew_mat34 one;
    const ew_projection p = { 65536, 65536, block(1) };
    ew_projection bad;
    ew_transform t;
    const ew_viewport good = { 0, 0, W, H }, empty = { 0, 0, 0, H }, wide = { 0, 0, 8193, H };
    ew_mat34_identity(&one);
    assert_int_equal(ew_transform_set(&t, &p, &one, &good), EW_OK);
    assert_int_equal(ew_transform_set(&t, &p, &one, &empty), EW_ERR_ARGUMENT);
    assert_int_equal(ew_transform_set(&t, &p, &one, &wide), EW_ERR_ARGUMENT);
    bad = p, bad.focal_x = 0;
    assert_int_equal(ew_transform_set(&t, &bad, &one, &good), EW_ERR_ARGUMENT);
    bad = p, bad.focal_y = -1;
    assert_int_equal(ew_transform_set(&t, &bad, &one, &good), EW_ERR_ARGUMENT);
    bad = p, bad.near_z.m = 0;
    assert_int_equal(ew_transform_set(&t, &bad, &one, &good), EW_ERR_ARGUMENT);
    for (int i = 0; i < 3; i++) one.row[i].e = 60;  /* 2^60 near distances large */
    assert_int_equal(ew_transform_set(&t, &p, &one, &good), EW_ERR_RANGE);
}

int main(void)
{
    for (int i = 0; i < 256; i++) texels[i] = (uint16_t)(0x1000 + 0x0101 * i);
    const struct CMUnitTest tests[] = {
        TEST(sums_of_pieces),
        TEST(both_ways_agree),
        TEST(ordinary_scenes_take_the_quick_way),
        TEST(projected_positions),
        TEST(triangles_in_front),
        TEST(triangles_through_the_near_plane),
        TEST(cut_edges_stay_shut),
        TEST(a_corner_at_the_guard_band_keeps_its_place),
        TEST(guard_band_drops_nothing),
        TEST(units_of_every_size),
        TEST(the_near_plane_is_decided_in_64_bits),
        TEST(what_is_turned_away_draws_nothing),
        TEST(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
