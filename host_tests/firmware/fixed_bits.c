/* The functions of fixed/, each over pseudo-random arguments of all magnitudes. */
#include "same_bits.h"

#include "edgewalk/fixed.h"

enum { CALLS = 250 };

static uint32_t hash;
static generator g;

static void add32(uint32_t a)
{
    for (int i = 0; i < 4; i++, a >>= 8) hash = (hash ^ (a & 0xFFu)) * UINT32_C(0x01000193); /* FNV-1a */
}
static void add64(uint64_t a)
{
    add32((uint32_t)a);
    add32((uint32_t)(a >> 32));
}

/* Numbers of all magnitudes. One draw to a statement: C leaves the order within one open. */
static uint32_t any32(void)
{
    uint32_t a = random32(&g);
    return a >> (random32(&g) & 31u);
}
static int32_t any_signed(void)
{
    uint32_t a = any32();
    return random32(&g) & 1u ? (int32_t)(a >> 1) : -(int32_t)(a >> 1);
}
static uint64_t any64(void)
{
    uint64_t a = random32(&g);
    a = a << 32 | random32(&g);
    return a >> (random32(&g) & 63u);
}

static void one_recip_table(void) { add32(ew_recip_table(random32(&g) | UINT32_C(0x80000000))); }
static void one_recip_newton(void) { add32(ew_recip_newton(random32(&g) | UINT32_C(0x80000000))); }
static void one_sqrt(void) { add32(ew_sqrt64(any64())); }
static void one_clz(void)
{
    add32((uint32_t)ew_clz32(any32()));
    add32((uint32_t)ew_clz64(any64()));
}
static void one_q16_16(void)
{
    int32_t a = any_signed(), b = any_signed();
    add32((uint32_t)ew_q16_16_mul(a, b));
    add32((uint32_t)ew_q16_16_div(a, b));
    add32((uint32_t)ew_int_from_q16_16(a));
    add32((uint32_t)ew_int_from_q16_16_floor(b));
    add32((uint32_t)ew_mulh_s32(a, b));
    add32(ew_mulh_u32((uint32_t)a, (uint32_t)b));
}
static void one_division(void)
{
    uint64_t n = any64();
    uint32_t d = (uint32_t)(n >> 32), rest;
    if (d == UINT32_MAX) return;
    d += random32(&g) % (UINT32_MAX - d) + 1u; /* d > n / 2^32: the quotient fits */
    add32(ew_udiv64_32(n, d, &rest));
    add32(rest);
    uint64_t whole = any64() | 1u;
    uint64_t f = ew_fraction64(any64() % whole, whole);
    add64(f);
    add64((uint64_t)ew_scale64((int64_t)(any64() >> 1), f));
}
static void one_vector(void)
{
    ew_vec3 a, b;
    int32_t *p[6] = { &a.x, &a.y, &a.z, &b.x, &b.y, &b.z };
    for (int i = 0; i < 6; i++) *p[i] = any_signed() / 4;
    add64((uint64_t)ew_vec3_dot(&a, &b));
    ew_vec3_cross(&b, &a, &b);
    add32((uint32_t)ew_vec3_normalise(&a, &a));
    for (int i = 0; i < 6; i++) add32((uint32_t)*p[i]);
}

static void add_quat(const ew_quat *q)
{
    add32((uint32_t)q->x);
    add32((uint32_t)q->y);
    add32((uint32_t)q->z);
    add32((uint32_t)q->w);
}
static void one_quaternion(void)
{
    ew_quat a, b, c;
    int32_t *p[8] = { &a.x, &a.y, &a.z, &a.w, &b.x, &b.y, &b.z, &b.w };
    for (int i = 0; i < 8; i++) *p[i] = any_signed();
    add32((uint32_t)ew_quat_normalise(&a, &a));
    add32((uint32_t)ew_quat_slerp(&c, &a, &b, random32(&g) >> 1));
    add_quat(&c);
    ew_quat_mul(&a, &a, &c);
    add_quat(&a);
}

static void add_row(const ew_row *row)
{
    for (int i = 0; i < 4; i++) add32((uint32_t)row->m[i]);
    add32((uint32_t)row->e);
    add32((uint32_t)row->e_last);
}
static void any_placement(ew_mat34 *out)
{
    const int32_t half = INT32_C(1) << 29;
    int32_t t[3], s[3], q[4];
    for (int i = 0; i < 3; i++) {
        t[i] = random_between(&g, -2 * half, 2 * half);
        s[i] = random_between(&g, INT32_C(1) << 20, 2 * half);
    }
    for (int i = 0; i < 4; i++) q[i] = random_between(&g, i == 3 ? half : -half, i == 3 ? 2 * half : half);
    const ew_quat r = { q[0], q[1], q[2], q[3] };
    int16_t e = (int16_t)random_between(&g, -8, 8);
    add32((uint32_t)ew_mat34_from_trs(out, t, e, &r, s, (int16_t)random_between(&g, -8, 8)));
}
static void one_matrix(void)
{
    ew_mat34 a, b;
    ew_mat34_identity(&a);
    ew_mat34_identity(&b);
    any_placement(&a);
    any_placement(&b);
    add32((uint32_t)ew_mat34_mul(&a, &a, &b));
    for (int i = 0; i < 3; i++) add_row(&a.row[i]);
    ew_mat44 m;
    ew_projection projection;
    projection.focal_x = random_between(&g, 1000, INT32_C(1000000));
    projection.focal_y = random_between(&g, 1000, INT32_C(1000000));
    projection.near_z.m = random_between(&g, 1 << 10, INT32_C(1) << 30);
    projection.near_z.e = -2;
    add32((uint32_t)ew_mat44_perspective(&m, &projection));
    add32((uint32_t)ew_mat44_mul_mat34(&m, &m, &b));
    for (int i = 0; i < 4; i++) add_row(&m.row[i]);
}

void fixed_bits(void)
{
    static const struct {
        const char *name;
        void (*once)(void);
    } groups[] = {
        { "recip_table", one_recip_table }, { "recip_newton", one_recip_newton }, { "sqrt64", one_sqrt },
        { "clz", one_clz }, { "q16_16", one_q16_16 }, { "division", one_division }, { "vector", one_vector },
        { "quaternion", one_quaternion }, { "matrix", one_matrix },
    };
    for (unsigned i = 0; i < sizeof groups / sizeof *groups; i++) {
        hash = UINT32_C(0x811C9DC5);
        g.state = 1;
        for (int k = 0; k < CALLS; k++) groups[i].once();
        print_hash("fixed", groups[i].name, -1, "-", hash);
    }
}
