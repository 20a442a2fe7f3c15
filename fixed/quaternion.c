/* Quaternions: product, length, interpolation.
 *
 * Interpolation is along the arc: q(t) = sin((1-t) a)/sin a q1 + sin(t a)/sin a q2 with
 * cos a = q1 . q2 (K. Bala, CS 4620 notes, 2012). Neither the angle nor a sine is needed:
 * sin(t a)/sin a is a power series in 1 - cos a whose coefficients are polynomials in t
 * (D. Eberly, "A Fast and Accurate Algorithm for Computing SLERP", Journal of Graphics, GPU
 * and Game Tools 15, 2011). Nothing is divided, so a -> 0 needs no branch of its own: the
 * series is then its first term t, the straight line. As the shorter of the two arcs is taken,
 * a is at most a right angle; above half of that the arc is halved first at its middle
 * (q1 + q2)/|q1 + q2|, and the series converges fast.
 */
#include "edgewalk/fixed.h"

static int32_t saturate_q2_30(int64_t a)
{
    if (a > INT32_MAX) return INT32_MAX;
    if (a < INT32_MIN) return INT32_MIN;
    return (int32_t)a;
}

/* A quarter of a product, so that four of them stay inside 64 bits whatever their factors. */
static int64_t quarter(int32_t a, int32_t b) { return EW_ASR(ew_mul_s32(a, b), 2); }

static int32_t from_quarters(int64_t sum) { return saturate_q2_30(EW_ASR(EW_ASR(sum, 27) + 1, 1)); }

void ew_quat_mul(ew_quat *out, const ew_quat *a, const ew_quat *b)
{
    const int32_t x = a->x, y = a->y, z = a->z, w = a->w;
    ew_quat r;
    r.x = from_quarters(quarter(w, b->x) + quarter(x, b->w) + quarter(y, b->z) - quarter(z, b->y));
    r.y = from_quarters(quarter(w, b->y) - quarter(x, b->z) + quarter(y, b->w) + quarter(z, b->x));
    r.z = from_quarters(quarter(w, b->z) + quarter(x, b->y) - quarter(y, b->x) + quarter(z, b->w));
    r.w = from_quarters(quarter(w, b->w) - quarter(x, b->x) - quarter(y, b->y) - quarter(z, b->z));
    *out = r;
}

int ew_quat_normalise(ew_quat *out, const ew_quat *a)
{
    int32_t c[4];
    c[0] = a->x, c[1] = a->y, c[2] = a->z, c[3] = a->w;
    uint32_t largest = 0;
    for (int i = 0; i < 4; i++) {
        if (ew_abs32(c[i]) > largest) largest = ew_abs32(c[i]);
    }
    if (largest == 0) return EW_ERR_ARGUMENT;
    int up = ew_clz32(largest) - 2; /* largest to [2^29, 2^30) */
    uint64_t n = 0;                 /* [2^58, 2^62) */
    for (int i = 0; i < 4; i++) {
        c[i] = up >= 0 ? c[i] * ((int32_t)1 << up) : EW_ASR(c[i], -up);
        n += (uint64_t)ew_mul_s32(c[i], c[i]);
    }
    int half = ew_clz64(n) / 2;                /* 1 or 2 */
    uint32_t root = ew_sqrt64(n << 2 * half);  /* |c| 2^half, [2^31, 2^32) */
    uint32_t r = ew_recip_newton(root);        /* 1/root = r 2^-62 */
    int down = 32 - half;                      /* c 2^half r 2^-62 2^30 */
    for (int i = 0; i < 4; i++) { /* |c r| < 2^61 */
        c[i] = (int32_t)EW_ASR(c[i] * (int64_t)r + ((int64_t)1 << (down - 1)), down);
    }
    out->x = c[0], out->y = c[1], out->z = c[2], out->w = c[3];
    return EW_OK;
}

/* In units of 2^-60; both of length 1. */
static EW_OWN_FRAME int64_t dot(const ew_quat *a, const ew_quat *b)
{
    return ew_mul_s32(a->x, b->x) + ew_mul_s32(a->y, b->y) + ew_mul_s32(a->z, b->z) + ew_mul_s32(a->w, b->w);
}

static ew_quat negated(const ew_quat *a)
{
    ew_quat r = { -a->x, -a->y, -a->z, -a->w }; /* of length 1: no component is -2^31 */
    return r;
}

/* 1 - a . b in units of 2^-32, not negative; at most 1 - cos 45 degrees is asked for. */
static uint32_t versine(const ew_quat *a, const ew_quat *b)
{
    int64_t y = EW_ASR(((int64_t)1 << 60) - dot(a, b) + ((int64_t)1 << 27), 28);
    return y < 0 ? 0 : y > UINT32_MAX ? UINT32_MAX : (uint32_t)y;
}

/* sin(t a)/sin a for 0 < t < 1 in units of 2^-32, a at most 45 degrees, as a fraction of 2^31:
 * t (1 + b1 (1 + b2 (1 + ...))), b_i = (v_i - u_i t^2)(1 - cos a), u_i = 1/(i (2 i + 1)),
 * v_i = i/(2 i + 1). Ten terms leave out less than 2^-32. */
static uint32_t share(uint32_t t, uint32_t y)
{
    enum { TERMS = 10 };
    /* round(2^32 u_i), round(2^32 v_i): fixed/quaternion_table.py */
    static const uint32_t table[TERMS][2] = {
#include "quaternion_table.inc"
    };
    uint32_t square = ew_mulh_u32(t, t), sum = UINT32_C(0x80000000);
    for (int i = TERMS - 1; i >= 0; i--) {
        /* u_i t^2 < u_i <= v_i, and b_i is at most 0.293/2; the sum stays below 1.2 */
        uint32_t b = ew_mulh_u32(table[i][1] - ew_mulh_u32(table[i][0], square), y);
        sum = UINT32_C(0x80000000) + ew_mulh_u32(b, sum);
    }
    return ew_mulh_u32(t, sum);
}

static int32_t blend(int32_t a, int32_t b, uint32_t ka, uint32_t kb)
{
    /* |products| <= 2^61 */
    int64_t sum = (int64_t)a * (int64_t)ka + (int64_t)b * (int64_t)kb;
    return (int32_t)EW_ASR(sum + ((int64_t)1 << 30), 31);
}

/* For 0 < t < 2^31 and an arc of at most 45 degrees. */
static EW_OWN_FRAME void along_arc(ew_quat *out, const ew_quat *from, const ew_quat *to, uint32_t t)
{
    const uint32_t y = versine(from, to), ka = share(0u - (t << 1), y), kb = share(t << 1, y);
    out->x = blend(from->x, to->x, ka, kb);
    out->y = blend(from->y, to->y, ka, kb);
    out->z = blend(from->z, to->z, ka, kb);
    out->w = blend(from->w, to->w, ka, kb);
}

int ew_quat_slerp(ew_quat *out, const ew_quat *a, const ew_quat *b, uint32_t t)
{
    EW_ASSERT(t <= UINT32_C(0x80000000));
    ew_quat from, to;
    int error = ew_quat_normalise(&from, a);
    if (!error) error = ew_quat_normalise(&to, b);
    if (error) return error;
    if (dot(&from, &to) < 0) to = negated(&to);
    const uint32_t forty_five = UINT32_C(1257966797); /* 2^32 (1 - cos 45 degrees) */
    if (t > 0 && t < UINT32_C(0x80000000) && versine(&from, &to) > forty_five) {
        /* components below 2 cos(45 degrees / 2) in magnitude: the sums fit */
        ew_quat middle = { from.x + to.x, from.y + to.y, from.z + to.z, from.w + to.w };
        (void)ew_quat_normalise(&middle, &middle); /* at least sqrt 2 long */
        if (t < UINT32_C(0x40000000)) to = middle;
        else from = middle;
        t = (t << 1) & UINT32_C(0x7FFFFFFF);
    }
    if (t == 0) {
        *out = from;
    } else if (t == UINT32_C(0x80000000)) {
        *out = to;
    } else {
        along_arc(out, &from, &to, t);
    }
    return EW_OK;
}
