/* Vertex lighting against the formula in double. */
#include "unit.h"

#include <math.h>
#include <string.h>

#include "edgewalk/light.h"

static double uniform(double low, double high) { return low + (high - low) * (test_random() / 4294967296.0); }

static ew_colour888 random_colour(void)
{
    uint32_t r = test_random();
    ew_colour888 c = { (uint8_t)r, (uint8_t)(r >> 8), (uint8_t)(r >> 16) };
    if (r >> 30 == 0) c.r = c.g = c.b = 255;
    return c;
}

static double channel_of(ew_colour888 c, int i) { return i == 0 ? c.r : i == 1 ? c.g : c.b; }

/* A model's matrix: rotation, then scales along its own axes, some of them mirrored. */
static void random_matrix(ew_mat34 *fixed, double m[3][3], double spread, int uniform_scale)
{
    ew_quat q = { (int32_t)test_random() >> 1, (int32_t)test_random() >> 1, (int32_t)test_random() >> 1,
                  ((int32_t)test_random() >> 1) | 1 };
    int32_t t[3], s[3];
    for (int i = 0; i < 3; i++) {
        t[i] = (int32_t)test_random() >> 1;
        s[i] = (int32_t)(ldexp(1, 29) * pow(spread, uniform(-1, 0)));
        if (uniform_scale) s[i] = i ? (s[0] < 0 ? -s[0] : s[0]) : s[i];
        if (test_random() & 1) s[i] = -s[i];
    }
    int16_t e = (int16_t)((int)(test_random() % 60) - 30);
    assert_int_equal(ew_mat34_from_trs(fixed, t, 3, &q, s, e), EW_OK);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) m[i][j] = ldexp(fixed->row[i].m[j], fixed->row[i].e - 30);
    }
}

/* n times the inverse transpose of m, made one again as long as n was if asked. */
static void turn(double out[3], double m[3][3], const ew_normal8 *n)
{
    double v[3] = { n->x / 127.0, n->y / 127.0, n->z / 127.0 }, det = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = 0;
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            double cofactor = m[j][b] * m[k][c] - m[j][c] * m[k][b];
            out[i] += cofactor * v[a];
            if (i == 0) det += m[0][a] * cofactor;
        }
    }
    for (int i = 0; i < 3; i++) out[i] /= det;
}

static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* How far the result is from the formula, in units of 8 bits; n is the normal in the lights' space. */
static double worst_channel(ew_colour888 lit, const double n[3], ew_colour888 ambient, const ew_light *lights, uint32_t count,
                            ew_colour888 material, ew_colour888 own)
{
    double worst = 0;
    for (int i = 0; i < 3; i++) {
        double sum = channel_of(ambient, i);
        for (uint32_t k = 0; k < count; k++) {
            double l[3] = { lights[k].direction.x, lights[k].direction.y, lights[k].direction.z };
            double dot = (n[0] * l[0] + n[1] * l[1] + n[2] * l[2]) / length(l);
            sum += channel_of(lights[k].colour, i) * fmax(0, dot);
        }
        double exact = fmin(255, sum * channel_of(material, i) / 255 * channel_of(own, i) / 255);
        worst = fmax(worst, fabs(channel_of(lit, i) - exact));
    }
    return worst;
}

static ew_normal8 random_normal(void)
{
    double v[3] = { uniform(-1, 1), uniform(-1, 1), uniform(-1, 1) }, r = 127 / fmax(length(v), 1e-6);
    ew_normal8 n = { (int8_t)lrint(fmin(127, v[0] * r)), (int8_t)lrint(fmin(127, v[1] * r)), (int8_t)lrint(fmin(127, v[2] * r)) };
    if (test_random() % 16 == 0) n.y = n.z = 0, n.x = test_random() & 1 ? 127 : -127;
    return n;
}

static void random_lights(ew_light *lights)
{
    for (int k = 0; k < EW_LIGHTS_MAX; k++) {
        int down = (int)(test_random() % 24);
        lights[k].direction.x = (int32_t)test_random() >> down;
        lights[k].direction.y = (int32_t)test_random() >> down;
        lights[k].direction.z = ((int32_t)test_random() >> down) | 1;
        lights[k].colour = random_colour();
    }
}

static void hold_random(int renormalise)
{
    double most[EW_LIGHTS_MAX + 1] = { 0 };
    for (int k = 0; k < 20000; k++) {
        ew_light lights[EW_LIGHTS_MAX];
        ew_lighting lighting;
        ew_mat34 fixed;
        double m[3][3];
        uint32_t count = test_random() % (EW_LIGHTS_MAX + 1);
        ew_colour888 ambient = random_colour(), material = random_colour();
        random_lights(lights);
        random_matrix(&fixed, m, 1000, !renormalise);
        assert_int_equal(ew_lighting_set(&lighting, &fixed, ambient, lights, count, material, renormalise), EW_OK);
        ew_normal8 n[16];
        ew_colour888 own[16], lit[16];
        for (int i = 0; i < 16; i++) n[i] = random_normal(), own[i] = random_colour();
        ew_light_vertices(&lighting, n, k & 1 ? own : NULL, 16, lit);
        for (int i = 0; i < 16; i++) {
            const ew_colour888 white = { 255, 255, 255 };
            double turned[3], size = length((double[3]){ n[i].x / 127.0, n[i].y / 127.0, n[i].z / 127.0 });
            turn(turned, m, &n[i]);
            double by = (renormalise ? 1 : size) / length(turned);
            for (int j = 0; j < 3; j++) turned[j] *= by;
            double off = worst_channel(lit[i], turned, ambient, lights, count, material, k & 1 ? own[i] : white);
            test_context("case %d: normal %d %d %d, %u lights, off by %.4f", k, n[i].x, n[i].y, n[i].z, count, off);
            assert_true(off <= 0.5 + 1.0 / 256 + count / (renormalise ? 32.0 : 64.0));
            most[count] = fmax(most[count], off);
        }
    }
    test_context("worst %.4f %.4f %.4f %.4f %.4f", most[0], most[1], most[2], most[3], most[4]);
}

static void turned_and_scaled_models(void **state)
{
    (void)state;
    hold_random(0);
}

static void stretched_models_renormalised(void **state)
{
    (void)state;
    hold_random(1);
}

/* Without renormalising, a stretched model is still lit on the right side. */
static void stretched_models_have_the_right_border(void **state)
{
    (void)state;
    long lit_ones = 0, dark = 0;
    for (int k = 0; k < 50000; k++) {
        const ew_colour888 none = { 0, 0, 0 }, white = { 255, 255, 255 };
        ew_light light[EW_LIGHTS_MAX];
        ew_lighting lighting;
        ew_mat34 fixed;
        ew_colour888 lit;
        double m[3][3], n[3];
        ew_normal8 normal = random_normal();
        random_lights(light);
        light[0].colour = white;
        random_matrix(&fixed, m, 20, 0);
        assert_int_equal(ew_lighting_set(&lighting, &fixed, none, light, 1, white, 0), EW_OK);
        ew_light_vertices(&lighting, &normal, NULL, 1, &lit);
        turn(n, m, &normal);
        double l[3] = { light[0].direction.x, light[0].direction.y, light[0].direction.z };
        double dot = (n[0] * l[0] + n[1] * l[1] + n[2] * l[2]) / length(l) / length(n);
        test_context("case %d: cosine %.4f, lit %d", k, dot, lit.r);
        if (dot > 0.1) assert_true(lit.r > 0), lit_ones++;
        if (dot < 0) assert_int_equal(lit.r, 0), dark++;
    }
    assert_true(lit_ones > 10000 && dark > 10000);
}

/* Every normal that three bytes can hold. */
static void all_normals(void **state)
{
    (void)state;
    const ew_colour888 ambient = { 7, 0, 200 }, material = { 255, 255, 255 };
    ew_light light = { { 12345, -54321, 33333 }, { 200, 255, 64 } };
    ew_lighting lighting;
    ew_mat34 one;
    static ew_normal8 n[256];
    static ew_colour888 lit[256];
    ew_mat34_identity(&one);
    assert_int_equal(ew_lighting_set(&lighting, &one, ambient, &light, 1, material, 0), EW_OK);
    for (int x = -128; x < 128; x++) {
        for (int y = -128; y < 128; y++) {
            for (int z = 0; z < 256; z++) n[z].x = (int8_t)x, n[z].y = (int8_t)y, n[z].z = (int8_t)(z - 128);
            ew_light_vertices(&lighting, n, NULL, 256, lit);
            for (int z = 0; z < 256; z++) {
                double v[3] = { x / 127.0, y / 127.0, (z - 128) / 127.0 };
                test_context("normal %d %d %d: %d %d %d", x, y, z - 128, lit[z].r, lit[z].g, lit[z].b);
                assert_true(worst_channel(lit[z], v, ambient, &light, 1, material, material) <= 0.5 + 1.0 / 32);
            }
        }
    }
}

/* Products of colours without a light: every pair, to the nearest. */
static void all_products_of_colours(void **state)
{
    (void)state;
    const ew_normal8 up = { 0, 0, 127 };
    ew_mat34 one;
    ew_mat34_identity(&one);
    for (unsigned a = 0; a < 256; a++) {
        for (unsigned b = 0; b < 256; b++) {
            const ew_colour888 ambient = { (uint8_t)a, (uint8_t)a, 255 }, material = { 255, (uint8_t)b, (uint8_t)b };
            ew_colour888 colour = { (uint8_t)b, 255, (uint8_t)a };
            ew_lighting lighting;
            assert_int_equal(ew_lighting_set(&lighting, &one, ambient, NULL, 0, material, 0), EW_OK);
            ew_light_vertices(&lighting, &up, &colour, 1, &colour); /* in place */
            test_context("%u * %u: %d %d %d", a, b, colour.r, colour.g, colour.b);
            assert_int_equal(colour.r, (a * b + 127) / 255); /* no ties: 255 is odd */
            assert_true(fabs(colour.g - a * b / 255.0) <= 0.5 + 1.0 / 256);
            assert_true(fabs(colour.b - a * b / 255.0) <= 0.5 + 1.0 / 256);
        }
    }
}

static void light_is_cut_at_full(void **state)
{
    (void)state;
    const ew_colour888 bright = { 255, 200, 10 }, half = { 128, 255, 255 };
    const ew_light lights[4] = { { { 0, 0, 65536 }, bright }, { { 0, 0, 3 }, bright }, { { 0, 0, 1 << 30 }, bright }, { { 0, 0, 1 }, bright } };
    const ew_normal8 up = { 0, 0, 127 };
    const ew_colour888 own = { 255, 100, 255 };
    ew_colour888 lit;
    ew_lighting lighting;
    ew_mat34 one;
    ew_mat34_identity(&one);
    assert_int_equal(ew_lighting_set(&lighting, &one, bright, lights, 4, half, 0), EW_OK);
    ew_light_vertices(&lighting, &up, &own, 1, &lit);
    assert_int_equal(lit.r, 255);  /* 5 * 255 * 128/255 */
    assert_int_equal(lit.g, 255);  /* 5 * 200 * 100/255 */
    assert_int_equal(lit.b, 50);
}

static void what_has_no_direction(void **state)
{
    (void)state;
    const ew_colour888 ambient = { 10, 20, 30 }, white = { 255, 255, 255 };
    ew_light lights[5] = { { { 0, 0, 65536 }, white }, { { 0, 0, 1 }, white }, { { 1, 0, 0 }, white }, { { 1, 0, 0 }, white }, { { 1, 0, 0 }, white } };
    ew_lighting lighting, kept;
    ew_mat34 m;
    const ew_normal8 normals[2] = { { 0, 0, 127 }, { 0, 0, 0 } };
    ew_colour888 lit[2];
    ew_mat34_identity(&m);
    memset(&lighting, 0, sizeof lighting);
    kept = lighting;
    assert_int_equal(ew_lighting_set(&lighting, &m, ambient, lights, 5, white, 0), EW_ERR_ARGUMENT);
    lights[1].direction.z = 0;
    assert_int_equal(ew_lighting_set(&lighting, &m, ambient, lights, 2, white, 0), EW_ERR_ARGUMENT);
    assert_memory_equal(&lighting, &kept, sizeof kept);
    for (int renormalise = 0; renormalise < 2; renormalise++) {
        ew_mat34_identity(&m);
        assert_int_equal(ew_lighting_set(&lighting, &m, ambient, lights, 1, white, renormalise), EW_OK);
        ew_light_vertices(&lighting, normals, NULL, 2, lit);
        assert_int_equal(lit[0].g, 255);
        assert_int_equal(lit[1].g, 20); /* a null normal */
        /* flattened along z: normals along z keep their direction, all others are lost */
        ew_row_from_q16_16(&m.row[2], 0, 0, 0, 0);
        const ew_normal8 side = { 127, 0, 0 };
        assert_int_equal(ew_lighting_set(&lighting, &m, ambient, lights, 1, white, renormalise), EW_OK);
        ew_light_vertices(&lighting, &side, NULL, 1, lit);
        assert_int_equal(lit[0].g, 20);
        ew_row_from_q16_16(&m.row[1], 0, 0, 0, 0); /* to a line: nothing is left */
        assert_int_equal(ew_lighting_set(&lighting, &m, ambient, lights, 1, white, renormalise), EW_OK);
        ew_light_vertices(&lighting, normals, NULL, 1, lit);
        assert_int_equal(lit[0].g, 20);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(turned_and_scaled_models),
        TEST(stretched_models_renormalised),
        TEST(stretched_models_have_the_right_border),
        TEST(all_normals),
        TEST(all_products_of_colours),
        TEST(light_is_cut_at_full),
        TEST(what_has_no_direction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
