/* fixed/: conversions, wrapping, divisions, roots, vectors, matrices. */
#include "unit.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "edgewalk/fixed.h"

static void shifts_copy_the_sign(void **state)
{
    (void)state;
    assert_int_equal(EW_ASR((int32_t)-1, 31), -1);
    assert_int_equal(EW_ASR(INT32_MIN, 31), -1);
    assert_int_equal(EW_ASR((int32_t)-5, 1), -3);
    assert_true(EW_ASR(INT64_MIN, 63) == -1);
    assert_true(EW_ASR((int64_t)-5 * 4294967296, 33) == -3);
}

static void wrapping_is_modulo(void **state)
{
    (void)state;
    assert_int_equal(ew_wrap_add32(INT32_MAX, 1), INT32_MIN);
    assert_int_equal(ew_wrap_sub32(INT32_MIN, 1), INT32_MAX);
    assert_true(ew_wrap_mul64(UINT64_MAX, -1) == 1);
    assert_true(ew_wrap_mul64((uint64_t)1 << 63, 3) == (uint64_t)1 << 63);
}

static void products_are_exact(void **state)
{
    (void)state;
    assert_true(ew_mul_s32(INT32_MIN, INT32_MIN) == (int64_t)1 << 62);
    assert_true(ew_mul_u32(UINT32_MAX, UINT32_MAX) == UINT64_C(0xFFFFFFFE00000001));
    assert_int_equal(ew_mulh_s32(-1, 1), -1); /* floor */
    assert_true(ew_mulh_u32(UINT32_MAX, UINT32_MAX) == UINT32_C(0xFFFFFFFE));
    assert_true(ew_abs32(INT32_MIN) == UINT32_C(0x80000000));
    assert_true(ew_abs64(INT64_MIN) == UINT64_C(1) << 63);
}

static void high_words_of_pieces(void **state)
{
    (void)state;
    for (int i = 0; i < 3000000; i++) {
        int32_t a = test_awkward(), b = test_awkward();
        test_context("%d * %d", a, b);
        assert_int_equal(ew_mulh_s32_pieces(a, b), (int32_t)(((int64_t)a * b) >> 32));
        assert_true(ew_mulh_u32_pieces((uint32_t)a, (uint32_t)b) == (uint32_t)((uint64_t)(uint32_t)a * (uint32_t)b >> 32));
        const uint32_t u = (uint32_t)a, half = (uint32_t)b & 0xFFFFu;
        assert_true(ew_mul_u32_u16_pieces(u, half) == (uint64_t)u * half);
        assert_true(ew_mul_u32_u16(u, half) == (uint64_t)u * half);
        const uint64_t wide = (uint64_t)(uint32_t)test_awkward() << 32 | u;
        test_context("%08lx%08lx * %u", (unsigned long)(wide >> 32), (unsigned long)u, (unsigned)half);
        assert_true(ew_wrap_mul64_u16_pieces(wide, half) == wide * half);
        assert_true(ew_wrap_mul64_u16(wide, half) == wide * half);
    }
}

static void products_are_compared(void **state)
{
    (void)state;
    for (int i = 0; i < 3000000; i++) {
        int32_t v[4];
        for (int k = 0; k < 4; k++) { /* within 2^31 - 2^15 */
            v[k] = test_awkward() >> (i & 1 ? 1 : 16);
            if (i % 7 == 0) v[k] = (int32_t)(test_random() & 1 ? 32768 : 32767) * (test_random() & 1 ? 1 : -1);
        }
        if (i % 3 == 0) v[2] = v[1], v[3] = v[0] + (int)(test_random() % 3) - 1; /* equal, or nearly */
        int less = (__int128)v[0] * v[1] < (__int128)v[2] * v[3];
        test_context("%d * %d < %d * %d", v[0], v[1], v[2], v[3]);
        assert_int_equal(ew_product_less_long(v[0], v[1], v[2], v[3]), less);
        assert_int_equal(ew_product_less_pieces(v[0], v[1], v[2], v[3]), less);
    }
}

static void leading_zeros(void **state)
{
    (void)state;
    assert_int_equal(ew_clz32(0), 32);
    assert_int_equal(ew_clz64(0), 64);
    for (int i = 0; i < 32; i++) {
        uint32_t high = UINT32_C(0x80000000) >> i;
        for (int k = 0; k < 100; k++) {
            uint32_t x = high | (k == 0 ? 0 : k == 1 ? high - 1 : test_random() & (high - 1));
            assert_int_equal(ew_clz32(x), i);
            assert_int_equal(ew_clz32_portable(x), i);
            assert_int_equal(ew_clz64(x), 32 + i);
            assert_int_equal(ew_clz64((uint64_t)x << 32 | test_random()), i);
        }
    }
    assert_int_equal(ew_clz32_portable(0), 32);
}

static void conversions_round_as_stated(void **state)
{
    (void)state;
    /* snapping: every subpixel position around zero and at the guard band */
    const double step = ldexp(1, -EW_SUBPIXEL_BITS);
    for (int32_t x = -5000; x <= 5000; x++) {
        assert_int_equal(ew_snapped_from_q20_12(x), (int)floor(x / 4096.0 / step + 0.5));
        assert_int_equal(ew_snapped_from_q20_12(x + (1 << 29)),
                         (int)floor((x + (1 << 29)) / 4096.0 / step + 0.5));
    }
    for (int32_t s = -70000; s < 70000; s += 7) {
        assert_int_equal(ew_snapped_from_q20_12(ew_q20_12_from_snapped(s)), s);
    }
    for (int64_t a = INT32_MIN; a <= INT32_MAX; a += 12345) {
        assert_int_equal(ew_int_from_q16_16_floor((int32_t)a), (int)floor((double)a / 65536));
        assert_int_equal(ew_int_from_q16_16((int32_t)a), (int)floor((double)a / 65536 + 0.5));
    }
    assert_int_equal(ew_int_from_q16_16(INT32_MAX), 32768);
    assert_int_equal(ew_q16_16_from_int(32767), 32767 * 65536);
    assert_int_equal(ew_q16_16_from_int(32768), INT32_MAX);
    assert_int_equal(ew_q16_16_from_int(-32768), INT32_MIN);
    assert_int_equal(ew_q16_16_from_int(-32769), INT32_MIN);
    for (int32_t a = -32768; a <= 32767; a++) { /* whole domain */
        assert_int_equal(ew_q2_14_from_q2_30(ew_q2_30_from_q2_14((int16_t)a)), a);
    }
    assert_int_equal(ew_q2_14_from_q2_30(INT32_MAX), 32767);
    assert_int_equal(ew_q2_14_from_q2_30(32767), 0);
    assert_int_equal(ew_q2_14_from_q2_30(32768), 1); /* a tie goes up */
    assert_int_equal(ew_q2_14_from_q2_30(-32768), 0);
}

static int32_t clamp32(long double a)
{
    return a >= INT32_MAX ? INT32_MAX : a <= INT32_MIN ? INT32_MIN : (int32_t)a;
}

static void product_and_quotient_saturate(void **state)
{
    (void)state;
    for (int i = 0; i < 2000000; i++) {
        int32_t a = test_awkward(), b = test_awkward();
        long double product = floorl((long double)a * b / 65536 + 0.5L);
        test_context("%d * %d", a, b);
        assert_int_equal(ew_q16_16_mul(a, b), clamp32(product));
        test_context("%d / %d", a, b);
        if (b == 0) {
            assert_int_equal(ew_q16_16_div(a, b), a < 0 ? INT32_MIN : INT32_MAX);
            continue;
        }
        long double q = fabsl((long double)a * 65536 / b);
        q = floorl(q + 0.5L);
        assert_int_equal(ew_q16_16_div(a, b), clamp32((a < 0) != (b < 0) ? -q : q));
    }
}

static void divisions_are_exact(void **state)
{
    (void)state;
    for (int i = 0; i < 300000; i++) {
        uint32_t d = (test_random() >> (test_random() & 31)) | 1u, rest;
        uint64_t n = ((uint64_t)test_random() << 32 | test_random()) >> (test_random() & 63);
        if (n >> 32 >= d) n %= (uint64_t)d << 32;
        uint32_t q = ew_udiv64_32(n, d, &rest);
        test_context("%llu / %u", (unsigned long long)n, d);
        assert_true(q == n / d && rest == n % d);
    }
    for (int i = 0; i < 100000; i++) {
        uint64_t d = (((uint64_t)test_random() << 32 | test_random()) >> (test_random() & 63)) | 1u;
        uint64_t n = ((uint64_t)test_random() << 32 | test_random()) % d;
        unsigned __int128 exact = ((unsigned __int128)n << 64) / d;
        test_context("%llu 2^64 / %llu", (unsigned long long)n, (unsigned long long)d);
        assert_true(ew_fraction64(n, d) == (uint64_t)exact);
        int64_t a = (int64_t)(((uint64_t)test_random() << 32 | test_random()) >> 1) >> (test_random() & 63);
        if (test_random() & 1) a = -a;
        uint64_t f = i & 1 ? (uint64_t)exact : (uint64_t)test_random() << 32; /* also with zero low words */
        __int128 scaled = ((__int128)a * (__int128)f) >> 64;
        test_context("%lld %llu", (long long)a, (unsigned long long)f);
        assert_true(ew_scale64(a, f) == (int64_t)scaled);
    }
}

static void roots_are_floors(void **state)
{
    (void)state;
    for (uint64_t n = 0; n < 70000; n++) {
        uint64_t r = ew_sqrt64(n);
        assert_true(r * r <= n && (r + 1) * (r + 1) > n);
        assert_true(ew_sqrt32((uint32_t)n) == r);
    }
    for (uint64_t r = 1; r < 65536; r++) { /* all roots, at both ends */
        assert_true(ew_sqrt32((uint32_t)(r * r)) == r && ew_sqrt32((uint32_t)(r * r - 1)) == r - 1);
    }
    assert_true(ew_sqrt32(UINT32_MAX) == 65535);
    for (int i = 0; i < 200000; i++) {
        uint32_t r = test_random() >> (test_random() & 31);
        uint64_t square = (uint64_t)r * r;
        assert_true(ew_sqrt64(square) == r);
        if (square) assert_true(ew_sqrt64(square - 1) == r - 1);
        assert_true(ew_sqrt64(square + 2 * (uint64_t)r) == r);
    }
    assert_true(ew_sqrt64(UINT64_MAX) == UINT32_MAX);
}

static void vectors(void **state)
{
    (void)state;
    for (int i = 0; i < 100000; i++) {
        int bits = (int)(test_random() % 30);
        ew_vec3 a = { (int32_t)test_random() >> bits, (int32_t)test_random() >> bits, (int32_t)test_random() >> bits };
        ew_vec3 b = { (int32_t)test_random() >> 8, (int32_t)test_random() >> 8, (int32_t)test_random() >> 8 }, c;
        test_context("a %d %d %d b %d %d %d", a.x, a.y, a.z, b.x, b.y, b.z);
        ew_vec3_cross(&c, &a, &b);
        long double x = ((long double)a.y * b.z - (long double)a.z * b.y) / 65536;
        assert_true(fabsl(c.x - (x > INT32_MAX ? INT32_MAX : x < INT32_MIN ? INT32_MIN : x)) <= 0.51L);
        long double z = ((long double)a.x * b.y - (long double)a.y * b.x) / 65536;
        assert_true(fabsl(c.z - (z > INT32_MAX ? INT32_MAX : z < INT32_MIN ? INT32_MIN : z)) <= 0.51L);
        if (!a.x && !a.y && !a.z) continue;
        ew_vec3 n;
        assert_int_equal(ew_vec3_normalise(&n, &a), EW_OK);
        double length = sqrt((double)a.x * a.x + (double)a.y * a.y + (double)a.z * a.z);
        assert_true(fabs(n.x - 65536 * (a.x / length)) <= 4);
        assert_true(fabs(n.y - 65536 * (a.y / length)) <= 4);
        assert_true(fabs(n.z - 65536 * (a.z / length)) <= 4);
    }
    ew_vec3 p = { 3 * 65536, -2 * 65536, 5 * 65536 }, q = { 1 << 16, 4 << 16, 2 << 16 }, null = { 0, 0, 0 }, kept = p;
    assert_true(ew_vec3_dot(&p, &q) == (int64_t)5 * 65536 * 65536);
    assert_int_equal(ew_vec3_normalise(&kept, &null), EW_ERR_ARGUMENT);
    assert_memory_equal(&kept, &p, sizeof p);
}

/* ---- matrices ---- */

static double element(const ew_row *row, int j) { return ldexp(row->m[j], (j < 3 ? row->e : row->e_last) - 30); }

static double largest3(const ew_row *row)
{
    return fmax(fmax(fabs(element(row, 0)), fabs(element(row, 1))), fabs(element(row, 2)));
}

static void check_row_form(const ew_row *row)
{
    uint32_t largest = 0, last = ew_abs32(row->m[3]);
    for (int j = 0; j < 3; j++) largest = ew_abs32(row->m[j]) > largest ? ew_abs32(row->m[j]) : largest;
    assert_true(largest <= 1u << 30 && last <= 1u << 30);
    assert_true(largest == 0 ? row->e == 0 : largest >= 1u << 29);
    assert_true(last == 0 ? row->e_last == 0 : last >= 1u << 29);
}

static void random_matrix(ew_mat34 *m, int spread)
{
    for (int i = 0; i < 3; i++) {
        int64_t largest = 0;
        for (int j = 0; j < 4; j++) {
            /* the fourth is normalised alone */
            m->row[i].m[j] = (int32_t)(test_random() % ((1u << 31) - 1)) - (1 << 30) + 1;
            if (test_random() % 5 == 0) m->row[i].m[j] = 0;
            if (test_random() % 5 == 0) m->row[i].m[j] >>= test_random() & 31;
            if (j < 3 && (int64_t)ew_abs32(m->row[i].m[j]) > largest) largest = ew_abs32(m->row[i].m[j]);
        }
        if (largest < 1 << 29) m->row[i].m[test_random() % 3] = 1 << 29;
        if (m->row[i].m[3]) m->row[i].m[3] = (m->row[i].m[3] & ((1 << 29) - 1)) | 1 << 29;
        m->row[i].e = (int16_t)((int)(test_random() % (unsigned)(2 * spread + 1)) - spread);
        m->row[i].e_last = (int16_t)((int)(test_random() % (unsigned)(2 * spread + 1)) - spread);
    }
}

static void products_of_matrices(void **state)
{
    (void)state;
    for (int n = 0; n < 20000; n++) {
        ew_mat34 a, b, c;
        random_matrix(&a, 40);
        random_matrix(&b, 40);
        assert_int_equal(ew_mat34_mul(&c, &a, &b), EW_OK);
        for (int i = 0; i < 3; i++) {
            double exact[4], terms[4] = { 0, 0, 0, fabs(element(&a.row[i], 3)) };
            for (int j = 0; j < 4; j++) {
                exact[j] = j == 3 ? element(&a.row[i], 3) : 0;
                for (int k = 0; k < 3; k++) {
                    double term = element(&a.row[i], k) * element(&b.row[k], j);
                    exact[j] += term;
                    terms[j < 3 ? 0 : 3] = fmax(terms[j < 3 ? 0 : 3], largest3(&a.row[i]) *
                                                 (j < 3 ? largest3(&b.row[k]) : fabs(element(&b.row[k], 3))));
                }
            }
            check_row_form(&c.row[i]);
            for (int j = 0; j < 4; j++) {
                /* relative to the largest term: what cancels is gone in any arithmetic of 30 bits */
                test_context("product %d, element %d %d", n, i, j);
                assert_true(fabs(element(&c.row[i], j) - exact[j]) <= terms[j < 3 ? 0 : 3] * ldexp(1, -28));
            }
        }
        ew_mat34 in_place = a;
        ew_mat34_mul(&in_place, &in_place, &b);
        assert_memory_equal(in_place.row[2].m, c.row[2].m, sizeof c.row[2].m);
        in_place = b;
        ew_mat34_mul(&in_place, &a, &in_place);
        assert_memory_equal(in_place.row[0].m, c.row[0].m, sizeof c.row[0].m);
        ew_row row = a.row[1];
        assert_int_equal(ew_row_mul_mat34(&row, &row, &b), EW_OK);
        assert_memory_equal(&row, &c.row[1], sizeof row);
    }
    ew_mat34 huge, kept;
    random_matrix(&huge, 0);
    for (int i = 0; i < 3; i++) huge.row[i].e = 900;
    kept = huge;
    assert_int_equal(ew_mat34_mul(&huge, &huge, &huge), EW_ERR_RANGE);
    assert_memory_equal(&huge, &kept, sizeof kept);
}

static void long_chains_keep_their_precision(void **state)
{
    (void)state;
    /* 64 turns by 1/64 of a circle with scales that come back to 1: ends where it began */
    ew_mat34 all, step;
    ew_mat34_identity(&all);
    double angle = 2 * acos(-1.0) / 64;
    ew_quat q = { 0, (int32_t)lrint(ldexp(sin(angle / 2), 30)), 0, (int32_t)lrint(ldexp(cos(angle / 2), 30)) };
    int32_t t[3] = { 0, 0, 0 };
    for (int i = 0; i < 64; i++) {
        double scale = i & 1 ? 1e-4 : 1e4;
        int e;
        int32_t m = (int32_t)lrint(ldexp(frexp(scale, &e), 30));
        int32_t s[3] = { m, m, m };
        assert_int_equal(ew_mat34_from_trs(&step, t, 0, &q, s, (int16_t)e), EW_OK);
        assert_int_equal(ew_mat34_mul(&all, &all, &step), EW_OK);
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            /* 1/16 px across 4,096 px is 2^-16 */
            assert_true(fabs(element(&all.row[i], j) - (i == j)) < ldexp(1, -22));
        }
    }
}

/* 64 links of a chain - joints of an arm, nodes of a scene - with any turn, offsets, mirroring, and
 * scales that differ along the axes and reach from 10^-4 to 10^4 in all: against the product of the
 * same links in double. A point one unit from the last joint is off by less than 2^-24 of the
 * chain's reach; 2^-16 would be 1/16 px where it fills 4,096 px. */
static void chains_of_64_links(void **state)
{
    (void)state;
    double worst = 0;
    for (int n = 0; n < 3000; n++) {
        ew_mat34 all, link;
        double exact[3][4] = { { 1, 0, 0, 0 }, { 0, 1, 0, 0 }, { 0, 0, 1, 0 } }, reach = 0, size = 1, extent = 1;
        ew_mat34_identity(&all);
        for (int i = 0; i < 64; i++) {
            ew_quat q = { (int32_t)test_random() >> 1, (int32_t)test_random() >> 1, (int32_t)test_random() >> 1,
                          ((int32_t)test_random() >> 1) | 1 };
            double want = pow(10, (test_random() / 4294967296.0 * 2 - 1) * 0.5);
            if (size * want > 1e4 || size * want < 1e-4) want = 1 / want;
            size *= want;
            int e;
            int32_t m = (int32_t)lrint(ldexp(frexp(want, &e), 30)), s[3], t[3];
            for (int j = 0; j < 3; j++) {
                s[j] = m - (int32_t)(test_random() % (uint32_t)(m / 8)); /* up to an eighth apart */
                if (test_random() & 1) s[j] = -s[j];
                t[j] = (int32_t)test_random() >> 2;
            }
            assert_int_equal(ew_mat34_from_trs(&link, t, 0, &q, s, (int16_t)e), EW_OK);
            assert_int_equal(ew_mat34_mul(&all, &all, &link), EW_OK);
            double product[3][4];
            for (int r = 0; r < 3; r++) {
                for (int c = 0; c < 4; c++) {
                    product[r][c] = c == 3 ? exact[r][3] : 0;
                    for (int k = 0; k < 3; k++) product[r][c] += exact[r][k] * element(&link.row[k], c);
                }
            }
            memcpy(exact, product, sizeof exact);
            extent = fmax(extent, size);
        }
        for (int r = 0; r < 3; r++) reach = fmax(reach, fabs(exact[r][3]) + fabs(exact[r][0]) + fabs(exact[r][1]) + fabs(exact[r][2]));
        reach = fmax(reach, extent); /* offsets may have cancelled */
        for (int r = 0; r < 3; r++) {
            double off = 0;
            for (int c = 0; c < 4; c++) off += fabs(element(&all.row[r], c) - exact[r][c]);
            worst = fmax(worst, off / reach);
        }
        test_context("chain %d: off by up to 2^%.1f of its reach", n, log2(worst));
        assert_true(worst < ldexp(1, -24));
    }
}

static void rotation_from_any_quaternion(void **state)
{
    (void)state;
    for (int n = 0; n < 20000; n++) {
        double q[4], length = 0;
        ew_quat f;
        int32_t raw[4];
        int down = (int)(test_random() % 12);
        for (int i = 0; i < 4; i++) {
            raw[i] = (int32_t)test_random() >> (1 + down);
            if (test_random() % 6 == 0) raw[i] = 0;
            q[i] = raw[i];
            length += q[i] * q[i];
        }
        if (length == 0) continue;
        length = sqrt(length);
        for (int i = 0; i < 4; i++) q[i] /= length;
        f.x = raw[0], f.y = raw[1], f.z = raw[2], f.w = raw[3];
        int32_t t[3] = { 1 << 29, -(1 << 28), 3 }, s[3] = { 1 << 30, 1 << 29, -(1 << 30) };
        ew_mat34 m;
        assert_int_equal(ew_mat34_from_trs(&m, t, 5, &f, s, 1), EW_OK);
        double x = q[0], y = q[1], z = q[2], w = q[3];
        double r[3][3] = { { 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y) },
                           { 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x) },
                           { 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y) } };
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                double exact = r[i][j] * ldexp(s[j], 1 - 30);
                test_context("quaternion %d %d %d %d element %d %d", raw[0], raw[1], raw[2], raw[3], i, j);
                assert_true(fabs(element(&m.row[i], j) - exact) < ldexp(16, -27) + ldexp(1, -27));
            }
            assert_true(fabs(element(&m.row[i], 3) - ldexp(t[i], 5 - 30)) < ldexp(16, -40));
        }
    }
    ew_quat null = { 0, 0, 0, 0 };
    int32_t one[3] = { 1 << 30, 1 << 30, 1 << 30 };
    ew_mat34 m;
    assert_int_equal(ew_mat34_from_trs(&m, one, 0, &null, one, 0), EW_ERR_ARGUMENT);
}

static void transform4(double out[4], const ew_mat44 *m, const double v[4])
{
    for (int i = 0; i < 4; i++) {
        out[i] = 0;
        for (int j = 0; j < 4; j++) out[i] += element(&m->row[i], j) * v[j];
    }
}

/* The invariants of docs/conventions.md. */
static void perspective_invariants(void **state)
{
    (void)state;
    const double nears[] = { 0.25, 1, 3.7, 1000 };
    for (int k = 0; k < 4; k++) {
        int e;
        ew_block n = { (int32_t)lrint(ldexp(frexp(nears[k], &e), 30)), 0 };
        n.e = (int16_t)e;
        double near_z = ldexp(n.m, n.e - 30);
        ew_mat44 p;
        const ew_projection projection = { 98304, 131072, n };
        assert_int_equal(ew_mat44_perspective(&p, &projection), EW_OK);
        double before = -1;
        for (double z = near_z; z < near_z * 1e6; z *= 1.7) {
            double v[4] = { 0.5 * z, -0.25 * z, -z, 1 }, c[4];
            transform4(c, &p, v);
            assert_true(fabs(c[3] - z) <= 1e-9 * z);              /* w' = z       */
            assert_true(fabs(c[0] / c[3] - 0.75) < 1e-8 && fabs(c[1] / c[3] + 0.5) < 1e-8);
            double ndc = c[2] / c[3];
            assert_true(fabs(ndc - (1 - 2 * near_z / z)) < 1e-8);
            if (z == near_z) assert_true(fabs(ndc + 1) < 1e-8);   /* near to -1   */
            else assert_true(ndc > before);                       /* closer is lower */
            before = ndc;
        }
        assert_true(before < 1 && before > 1 - 1e-5);             /* infinity to 1 */
    }
    ew_mat44 p;
    const ew_projection bad[3] = { { 0, 1, { 1 << 29, 0 } }, { 1, -1, { 1 << 29, 0 } }, { 1, 1, { 0, 0 } } };
    for (int k = 0; k < 3; k++) assert_int_equal(ew_mat44_perspective(&p, &bad[k]), EW_ERR_ARGUMENT);
}

static void every_code_has_its_own_text(void **state)
{
    (void)state;
    for (int a = EW_ERR_ROOM; a <= EW_OK; a++) {
        assert_non_null(ew_error_text(a));
        for (int b = EW_ERR_ROOM; b < a; b++) assert_string_not_equal(ew_error_text(a), ew_error_text(b));
    }
    assert_string_equal(ew_error_text(-99), "unknown error");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(shifts_copy_the_sign),
        TEST(wrapping_is_modulo),
        TEST(products_are_exact),
        TEST(high_words_of_pieces),
        TEST(products_are_compared),
        TEST(leading_zeros),
        TEST(conversions_round_as_stated),
        TEST(product_and_quotient_saturate),
        TEST(divisions_are_exact),
        TEST(roots_are_floors),
        TEST(vectors),
        TEST(products_of_matrices),
        TEST(long_chains_keep_their_precision),
        TEST(chains_of_64_links),
        TEST(rotation_from_any_quaternion),
        TEST(perspective_invariants),
        TEST(every_code_has_its_own_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
