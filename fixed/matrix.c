/* Matrices of block numbers.
 *
 * A row keeps the exponent that its largest element needs, and another for its
 * translation, so products neither overflow nor lose what a scale of 10^-4 or 10^4 would
 * lose in one fixed format. Every product goes through one function, row_combine: a row
 * is a weighted sum of rows.
 */
#include "edgewalk/fixed.h"

enum { EXPONENT_LIMIT = 1000 };

/* Brings `count` sums, in units of 2^(e - 60), to mantissas with one exponent. */
static int normalise(int32_t *m, int16_t *exponent, const int64_t *sum, int count, int32_t e)
{
    uint64_t largest = 0;
    for (int j = 0; j < count; j++) {
        uint64_t a = ew_abs64(sum[j]);
        if (a > largest) largest = a;
    }
    /* The largest becomes [2^29, 2^30]; 2^30 only through rounding. */
    int shift = 34 - ew_clz64(largest); /* to the right; -29 to 34 */
    int32_t result = largest ? e + shift - 30 : 0;
    if (result < -EXPONENT_LIMIT || result > EXPONENT_LIMIT) return EW_ERR_RANGE;
    for (int j = 0; j < count; j++) {
        if (shift > 0) m[j] = (int32_t)EW_ASR(EW_ASR(sum[j], shift - 1) + 1, 1);
        else m[j] = (int32_t)(sum[j] * ((int64_t)1 << -shift));
    }
    *exponent = (int16_t)result;
    return EW_OK;
}

/* A row from sums; the three in units of 2^(e - 60), the fourth of 2^(e_last - 60). */
static EW_OWN_FRAME int row_normalise(ew_row *out, const int64_t sum[4], int32_t e, int32_t e_last)
{
    int error = normalise(out->m, &out->e, sum, 3, e);
    return error ? error : normalise(out->m + 3, &out->e_last, sum + 3, 1, e_last);
}

/* A product's part: a[k] times elements first .. first + count - 1 of row k, b[k] or `last`,
 * summed over k. Each row gives the elements' common exponent; where all of them are 0 it does
 * not count. Returns the exponent of the sums' unit, 2^(e - 60). */
static EW_OWN_FRAME int32_t sum_products(int64_t *sum, const ew_row *a, const ew_row b[3], const ew_row *last,
                                         int first, int count)
{
    int32_t e[4], top = 0;
    int any = 0;
    for (int k = 0; k < 4; k++) {
        const ew_row *row = k < 3 ? &b[k] : last;
        uint32_t bits = 0;
        for (int j = first; j < first + count; j++) bits |= (uint32_t)row->m[j];
        e[k] = (k < 3 ? a->e : a->e_last) + (first < 3 ? row->e : row->e_last);
        if (a->m[k] != 0 && bits != 0 && (!any || e[k] > top)) top = e[k], any = 1;
    }
    for (int j = 0; j < count; j++) {
        sum[j] = 0;
        for (int k = 0; k < 4; k++) {
            /* four products of at most 2^60; what is shifted out is below the last bit */
            int64_t product = ew_mul_s32(a->m[k], (k < 3 ? &b[k] : last)->m[first + j]);
            if (product != 0 && top - e[k] <= 62) sum[j] += EW_ASR(product, top - e[k]);
        }
    }
    return top;
}

/* out = a (b[0] b[1] b[2] last). out may be a. */
static EW_OWN_FRAME int row_combine(ew_row *out, const ew_row *a, const ew_row b[3], const ew_row *last)
{
    int64_t sum[4];
    int32_t e = sum_products(sum, a, b, last, 0, 3), e_last = sum_products(sum + 3, a, b, last, 3, 1);
    return row_normalise(out, sum, e, e_last);
}

static const ew_row last_affine_row = { { 0, 0, 0, (int32_t)1 << 29 }, 0, 1 };

int ew_row_mul_mat34(ew_row *out, const ew_row *a, const ew_mat34 *b)
{
    return row_combine(out, a, b->row, &last_affine_row);
}

int ew_row_mul_mat44(ew_row *out, const ew_row *a, const ew_mat44 *b)
{
    return row_combine(out, a, b->row, &b->row[3]);
}

EW_OWN_FRAME void ew_row_from_q16_16(ew_row *row, ew_q16_16 a, ew_q16_16 b, ew_q16_16 c, ew_q16_16 d)
{
    int64_t sum[4];
    sum[0] = a, sum[1] = b, sum[2] = c, sum[3] = d;
    (void)row_normalise(row, sum, 60 - 16, 60 - 16); /* the exponents are far from the limit */
}

void ew_mat34_identity(ew_mat34 *out)
{
    ew_row_from_q16_16(&out->row[0], 65536, 0, 0, 0);
    ew_row_from_q16_16(&out->row[1], 0, 65536, 0, 0);
    ew_row_from_q16_16(&out->row[2], 0, 0, 65536, 0);
}

int ew_mat34_mul(ew_mat34 *out, const ew_mat34 *a, const ew_mat34 *b)
{
    ew_mat34 r;
    for (int i = 0; i < 3; i++) {
        int error = ew_row_mul_mat34(&r.row[i], &a->row[i], b);
        if (error) return error;
    }
    *out = r;
    return EW_OK;
}

int ew_mat44_mul_mat34(ew_mat44 *out, const ew_mat44 *a, const ew_mat34 *b)
{
    ew_mat44 r;
    for (int i = 0; i < 4; i++) {
        int error = ew_row_mul_mat34(&r.row[i], &a->row[i], b);
        if (error) return error;
    }
    *out = r;
    return EW_OK;
}

/* The rotation matrix of a quaternion of any length but 0, without a square root: with
 * n = |q|^2 the elements are 1 - 2 (y^2 + z^2) / n, 2 (x y - w z) / n and so on. */
static EW_OWN_FRAME int rotation_rows(int32_t m[3][3], const ew_quat *q)
{
    int32_t c[4];
    c[0] = q->x, c[1] = q->y, c[2] = q->z, c[3] = q->w;
    uint32_t largest = 0;
    for (int i = 0; i < 4; i++) {
        if (ew_abs32(c[i]) > largest) largest = ew_abs32(c[i]);
    }
    if (largest == 0) return EW_ERR_ARGUMENT;
    int up = ew_clz32(largest) - 2; /* largest to [2^29, 2^30) */
    for (int i = 0; i < 4; i++) c[i] = up >= 0 ? c[i] * ((int32_t)1 << up) : EW_ASR(c[i], -up);

    uint64_t n = 0; /* [2^58, 2^62) */
    for (int i = 0; i < 4; i++) n += (uint64_t)ew_mul_s32(c[i], c[i]);
    int lead = ew_clz64(n);
    uint32_t r = ew_recip_newton((uint32_t)((n << lead) >> 32)); /* 1/n = r 2^(lead - 94) */
    static const uint8_t next[3] = { 1, 2, 0 };
    for (int i = 0; i < 3; i++) {
        int j = next[i], k = next[j];
        int64_t square = ew_mul_s32(c[j], c[j]) + ew_mul_s32(c[k], c[k]);
        int64_t a = ew_mul_s32(c[i], c[j]), b = ew_mul_s32(c[3], c[k]);
        /* Each sum is at most n < 2^(64 - lead) in magnitude. Times 2/n, to q2.30: take 31
         * bits of the sum, so that the product with r stays below 2^62:
         * sum 2^-(33-lead) * r * 2^(33-lead) * 2^(lead-94) * 2 * 2^30 = product * 2^-30 */
        int down = 33 - lead;
        int64_t s0 = EW_ASR(square, down), s1 = EW_ASR(a - b, down), s2 = EW_ASR(a + b, down);
        m[i][i] = (int32_t)(((int64_t)1 << 30) - EW_ASR(s0 * (int64_t)r, 30));
        m[i][j] = (int32_t)EW_ASR(s1 * (int64_t)r, 30);
        m[j][i] = (int32_t)EW_ASR(s2 * (int64_t)r, 30);
    }
    return EW_OK;
}

int ew_mat34_from_trs(ew_mat34 *out, const int32_t t[3], int16_t t_exponent, const ew_quat *q,
                      const int32_t s[3], int16_t s_exponent)
{
    int32_t rotation[3][3];
    int error = rotation_rows(rotation, q);
    if (error) return error;
    ew_mat34 r;
    for (int i = 0; i < 3; i++) {
        /* |rotation scale| <= 2^30 2^30 */
        int64_t sum[4];
        for (int j = 0; j < 3; j++) sum[j] = ew_mul_s32(rotation[i][j], s[j]);
        sum[3] = (int64_t)t[i] * ((int64_t)1 << 30);
        error = row_normalise(&r.row[i], sum, s_exponent, t_exponent);
        if (error) return error;
    }
    *out = r;
    return EW_OK;
}

/* 0 0 -1 -2n */
static EW_OWN_FRAME int depth_row(ew_row *out, ew_block near_z)
{
    int64_t sum[4];
    sum[0] = sum[1] = 0;
    sum[2] = -((int64_t)1 << 60);
    sum[3] = -(int64_t)near_z.m * ((int64_t)1 << 30);
    return row_normalise(out, sum, 0, near_z.e + 1);
}

int ew_mat44_perspective(ew_mat44 *out, const ew_projection *p)
{
    const ew_block near_z = p->near_z;
    if (p->focal_x <= 0 || p->focal_y <= 0 || near_z.m <= 0) return EW_ERR_ARGUMENT;
    ew_row_from_q16_16(&out->row[0], p->focal_x, 0, 0, 0);
    ew_row_from_q16_16(&out->row[1], 0, p->focal_y, 0, 0);
    ew_row_from_q16_16(&out->row[3], 0, 0, -65536, 0);
    return depth_row(&out->row[2], near_z);
}
