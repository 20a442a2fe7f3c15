/* fixed/quaternion.c: products, lengths, interpolation along the arc, in double. */
#include "unit.h"

#include <math.h>
#include <string.h>

#include "edgewalk/fixed.h"

static const double UNIT = 1.0 / (1 << 30);
#define ONE (UINT32_C(1) << 31)

typedef struct quat {
    double c[4]; /* x, y, z, w */
} quat;

static double uniform(double low, double high) { return low + (high - low) * (test_random() / 4294967296.0); }

static quat in_double(const ew_quat *q)
{
    quat r = { { q->x * UNIT, q->y * UNIT, q->z * UNIT, q->w * UNIT } };
    return r;
}

static double dot(const quat *a, const quat *b)
{
    return a->c[0] * b->c[0] + a->c[1] * b->c[1] + a->c[2] * b->c[2] + a->c[3] * b->c[3];
}

static quat unit(quat a)
{
    double length = sqrt(dot(&a, &a));
    for (int i = 0; i < 4; i++) a.c[i] /= length;
    return a;
}

/* Of the arc between two unit quaternions, by the chord, which stays exact where the cosine
 * does not. */
static double angle(const quat *a, const quat *b)
{
    double chord = 0;
    for (int i = 0; i < 4; i++) chord += (a->c[i] - b->c[i]) * (a->c[i] - b->c[i]);
    return 2 * asin(fmin(1, sqrt(chord) / 2));
}

static ew_quat rounded(const quat *a, double length)
{
    ew_quat r = { (int32_t)lrint(a->c[0] * length / UNIT), (int32_t)lrint(a->c[1] * length / UNIT),
                  (int32_t)lrint(a->c[2] * length / UNIT), (int32_t)lrint(a->c[3] * length / UNIT) };
    return r;
}

static quat random_unit(void)
{
    for (;;) {
        quat q = { { uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1) } };
        double square = dot(&q, &q);
        if (test_random() % 32 == 0) { /* on an axis */
            memset(&q, 0, sizeof q);
            q.c[test_random() & 3] = test_random() & 1 ? 1 : -1;
            return q;
        }
        if (square > 0.01 && square < 1) return unit(q);
    }
}

/* `by` radians away from q on the sphere of unit quaternions, in a random direction. */
static quat beside(const quat *q, double by)
{
    quat away = random_unit();
    double along = dot(&away, q);
    for (int i = 0; i < 4; i++) away.c[i] -= along * q->c[i];
    if (dot(&away, &away) < 1e-6) return beside(q, by);
    away = unit(away);
    quat r;
    for (int i = 0; i < 4; i++) r.c[i] = cos(by) * q->c[i] + sin(by) * away.c[i];
    return r;
}

/* The arc itself: q1 turned towards q2's part at a right angle to it. */
static quat exact_slerp(const quat *a, const quat *b, double t)
{
    double along = dot(a, b);
    quat side, r;
    for (int i = 0; i < 4; i++) side.c[i] = b->c[i] - along * a->c[i];
    double sine = sqrt(dot(&side, &side)), arc = atan2(sine, along);
    for (int i = 0; i < 4; i++) r.c[i] = cos(t * arc) * a->c[i] + (sine > 0 ? sin(t * arc) / sine * side.c[i] : 0);
    return r;
}

static int same(const ew_quat *a, const ew_quat *b) { return a->x == b->x && a->y == b->y && a->z == b->z && a->w == b->w; }

static void products(void **state)
{
    (void)state;
    for (int k = 0; k < 300000; k++) {
        int32_t v[8];
        for (int i = 0; i < 8; i++) v[i] = k & 1 ? test_awkward() : (int32_t)test_random() >> 1;
        ew_quat a = { v[0], v[1], v[2], v[3] }, b = { v[4], v[5], v[6], v[7] }, r, in_place = a;
        ew_quat_mul(&r, &a, &b);
        const __int128 exact[4] = { /* i j = k and so on */
            (__int128)v[3] * v[4] + (__int128)v[0] * v[7] + (__int128)v[1] * v[6] - (__int128)v[2] * v[5],
            (__int128)v[3] * v[5] - (__int128)v[0] * v[6] + (__int128)v[1] * v[7] + (__int128)v[2] * v[4],
            (__int128)v[3] * v[6] + (__int128)v[0] * v[5] - (__int128)v[1] * v[4] + (__int128)v[2] * v[7],
            (__int128)v[3] * v[7] - (__int128)v[0] * v[4] - (__int128)v[1] * v[5] - (__int128)v[2] * v[6] };
        const int32_t got[4] = { r.x, r.y, r.z, r.w };
        for (int i = 0; i < 4; i++) {
            double e = fmin(INT32_MAX, fmax(INT32_MIN, (double)exact[i] * UNIT));
            test_context("component %d of %d %d %d %d times %d %d %d %d", i, v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]);
            assert_true(fabs(got[i] - e) <= 0.5 + ldexp(1, -25));
        }
        ew_quat_mul(&in_place, &in_place, &b);
        assert_true(same(&in_place, &r));
    }
    ew_quat one = { 0, 0, 0, 1 << 30 }, q = { 123456789, -987654321, 5, -7 }, r, back = ew_quat_conjugate(&q);
    ew_quat_mul(&r, &q, &one);
    assert_true(same(&r, &q));
    assert_true(back.x == -123456789 && back.y == 987654321 && back.z == -5 && back.w == -7);
}

static void lengths(void **state)
{
    (void)state;
    double worst = 0;
    for (int k = 0; k < 300000; k++) {
        int down = (int)(test_random() % 31);
        ew_quat a = { (int32_t)test_random() >> down, (int32_t)test_random() >> down, test_awkward() >> down,
                      (int32_t)test_random() >> down }, r;
        if (k % 8 == 0) a.x = a.y = a.z = 0, a.w = test_awkward(); /* one component alone */
        if (!(a.x | a.y | a.z | a.w)) continue;
        assert_int_equal(ew_quat_normalise(&r, &a), EW_OK);
        quat got = in_double(&r), exact = unit(in_double(&a));
        for (int i = 0; i < 4; i++) worst = fmax(worst, fabs(got.c[i] - exact.c[i]) / UNIT);
        test_context("%d %d %d %d: off by up to %.3f units", a.x, a.y, a.z, a.w, worst);
        assert_true(worst <= 2);
        ew_quat_normalise(&a, &a); /* in place */
        assert_true(same(&a, &r));
    }
    ew_quat null = { 0, 0, 0, 0 }, kept = { 1, 2, 3, 4 };
    assert_int_equal(ew_quat_normalise(&kept, &null), EW_ERR_ARGUMENT);
    assert_int_equal(kept.x, 1);
    assert_int_equal(kept.w, 4);
}

static const double angles[] = { 0, 1e-9, 1e-6, 1e-4, 0.01, 0.5, 0.78, 0.785398, 0.7854, 0.79, 1, 1.5, 1.57, 1.5707963, 1.5707964,
                                 1.58, 2, 3, 3.14, 3.1415926, 3.14159265358979 };
enum { ANGLES = sizeof angles / sizeof *angles };

/* Against the arc in double between the same numbers, all angles on the sphere of quaternions up to
 * half a circle (a whole turn), any lengths. */
static void arcs(void **state)
{
    (void)state;
    double worst = 0, worst_length = 0;
    for (int k = 0; k < 300000; k++) {
        double by = k & 1 ? uniform(0, 3.14159265) : angles[test_random() % ANGLES];
        quat a = random_unit(), b = beside(&a, by);
        double size_a = k & 2 ? 1 : pow(2, uniform(-10, 0.99)), size_b = k & 2 ? 1 : pow(2, uniform(-10, 0.99));
        ew_quat fa = rounded(&a, size_a), fb = rounded(&b, size_b), r;
        uint32_t t = test_random() >> 1;
        if (k % 16 == 0) t = (uint32_t[4]){ 1, ONE / 2, ONE / 2 - 1, ONE - 1 }[test_random() & 3];
        assert_int_equal(ew_quat_slerp(&r, &fa, &fb, t), EW_OK);
        a = unit(in_double(&fa)), b = unit(in_double(&fb));
        double cosine = dot(&a, &b);
        if (fabs(cosine) < 1e-8) continue; /* either way is as short */
        if (cosine < 0) {
            for (int i = 0; i < 4; i++) b.c[i] = -b.c[i];
        }
        quat exact = exact_slerp(&a, &b, ldexp(t, -31)), got = in_double(&r);
        worst_length = fmax(worst_length, fabs(sqrt(dot(&got, &got)) - 1));
        got = unit(got);
        worst = fmax(worst, 2 * angle(&exact, &got)); /* of the rotation: twice that of the arc */
        test_context("case %d: arc %.9f, t %u: rotation off by up to 2^%.2f, length 2^%.2f", k, by, t, log2(worst), log2(worst_length));
        assert_true(worst <= ldexp(1, -27));
        assert_true(worst_length <= ldexp(1, -28));
    }
}

static void ends_are_exact(void **state)
{
    (void)state;
    for (int k = 0; k < 100000; k++) {
        quat a = random_unit(), b = beside(&a, angles[test_random() % ANGLES]);
        ew_quat fa = rounded(&a, pow(2, uniform(-8, 0.99))), fb = rounded(&b, 1), first, last, from, to;
        assert_int_equal(ew_quat_slerp(&first, &fa, &fb, 0), EW_OK);
        assert_int_equal(ew_quat_slerp(&last, &fa, &fb, ONE), EW_OK);
        ew_quat_normalise(&from, &fa);
        ew_quat_normalise(&to, &fb);
        test_context("case %d", k);
        assert_true(same(&first, &from));
        ew_quat back = { -to.x, -to.y, -to.z, -to.w };
        assert_true(same(&last, &to) || same(&last, &back));
        if (k & 1) { /* a itself, and its other sign: stays where it is */
            ew_quat other = { -fa.x, -fa.y, -fa.z, -fa.w }, r;
            assert_int_equal(ew_quat_slerp(&r, &fa, k & 2 ? &other : &fa, test_random() >> 1), EW_OK);
            assert_true(ew_abs32(r.x - from.x) <= 2 && ew_abs32(r.y - from.y) <= 2 && ew_abs32(r.z - from.z) <= 2 &&
                        ew_abs32(r.w - from.w) <= 2);
        }
        ew_quat in_place = fb; /* `out` may be b */
        ew_quat_slerp(&in_place, &fa, &in_place, ONE / 3);
        ew_quat_slerp(&first, &fa, &fb, ONE / 3);
        assert_true(same(&in_place, &first));
    }
}

/* Exactly half a turn apart: b as it is. */
static void half_a_turn(void **state)
{
    (void)state;
    const ew_quat a = { 0, 0, 0, 1 << 30 }, b = { 1 << 30, 0, 0, 0 };
    ew_quat r;
    for (int k = 1; k < 64; k++) {
        assert_int_equal(ew_quat_slerp(&r, &a, &b, (uint32_t)k << 25), EW_OK);
        test_context("%d/64: %d %d %d %d", k, r.x, r.y, r.z, r.w);
        assert_true(fabs(r.x * UNIT - sin(k / 64.0 * acos(0))) < ldexp(1, -28));
        assert_true(fabs(r.w * UNIT - cos(k / 64.0 * acos(0))) < ldexp(1, -28));
        assert_true(r.y == 0 && r.z == 0);
    }
}

/* The angle from the start grows with t, and evenly. */
static void the_angle_is_monotonic(void **state)
{
    (void)state;
    enum { STEPS = 500 };
    for (int k = 0; k < 400; k++) {
        double by = k < ANGLES ? angles[k] : uniform(0, 3.1);
        quat a = random_unit(), b = beside(&a, by);
        ew_quat fa = rounded(&a, 1), fb = rounded(&b, 1), r;
        a = unit(in_double(&fa)), b = unit(in_double(&fb));
        double whole = acos(fmin(1, fabs(dot(&a, &b)))), before = -1;
        for (int i = 0; i <= STEPS; i++) {
            assert_int_equal(ew_quat_slerp(&r, &fa, &fb, (uint32_t)(((uint64_t)i << 31) / STEPS)), EW_OK);
            quat q = in_double(&r);
            double now = angle(&a, &q), slack = ldexp(1, -28);
            test_context("arc %.9f, step %d: %.10f after %.10f", whole, i, now, before);
            assert_true(now > before - slack);
            if (whole / STEPS > slack) assert_true(now > before);
            assert_true(fabs(now - whole * i / STEPS) < 1e-7);
            before = now;
        }
    }
}

static void null_is_refused(void **state)
{
    (void)state;
    const ew_quat null = { 0, 0, 0, 0 }, one = { 0, 0, 0, 1 << 30 };
    ew_quat r = { 1, 2, 3, 4 };
    assert_int_equal(ew_quat_slerp(&r, &null, &one, 5), EW_ERR_ARGUMENT);
    assert_int_equal(ew_quat_slerp(&r, &one, &null, 5), EW_ERR_ARGUMENT);
    assert_int_equal(r.x, 1);
    assert_int_equal(r.w, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(products),       TEST(lengths),     TEST(arcs),
        TEST(ends_are_exact), TEST(half_a_turn), TEST(the_angle_is_monotonic),
        TEST(null_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
