/* Matrices of block numbers.
 *
 * A row keeps the exponent that its largest element needs, so products neither overflow
 * nor lose what a scale of 10^-4 or 10^4 would lose in one fixed format. Every product
 * goes through one function, row_combine: a row is a weighted sum of rows.
 */
#include "edgewalk/fixed.h"

enum { EXPONENT_LIMIT = 1000 };

/* Brings four sums, in units of 2^(e - 60), into a row. */
static int row_normalise(ew_row *out, const int64_t sum[4], int32_t e)
{
    uint64_t largest = 0;
    for (int j = 0; j < 4; j++) {
        uint64_t a = ew_abs64(sum[j]);
        if (a > largest) largest = a;
    }
    if (largest == 0) {
        for (int j = 0; j < 4; j++) out->m[j] = 0;
        out->e = 0;
        return EW_OK;
    }
    /* The largest becomes [2^29, 2^30]; 2^30 only through rounding. */
    int shift = 34 - ew_clz64(largest); /* to the right; -29 to 34 */
    int32_t exponent = e + shift - 30;
    if (exponent < -EXPONENT_LIMIT || exponent > EXPONENT_LIMIT) return EW_ERR_RANGE;
    for (int j = 0; j < 4; j++) {
        if (shift > 0) out->m[j] = (int32_t)EW_ASR(EW_ASR(sum[j], shift - 1) + 1, 1);
        else out->m[j] = (int32_t)(sum[j] * ((int64_t)1 << -shift));
    }
    out->e = (int16_t)exponent;
    return EW_OK;
}

/* out = sum over k of a[k] * b[k]; b[3] is 0 0 0 1 where `affine`. out may be a. */
static int row_combine(ew_row *out, const ew_row *a, const ew_row *b, int affine)
{
    int32_t top = -EXPONENT_LIMIT - 1;
    for (int k = 0; k < 4; k++) {
        int32_t e = affine && k == 3 ? 0 : b[k].e;
        if (a->m[k] != 0 && e > top) top = e;
    }
    int64_t sum[4] = { 0, 0, 0, 0 };
    for (int k = 0; k < 4; k++) {
        if (a->m[k] == 0) continue;
        if (affine && k == 3) {
            if (top < 63) sum[3] += EW_ASR((int64_t)a->m[3] * ((int64_t)1 << 30), top);
            continue;
        }
        int32_t shift = top - b[k].e;
        if (shift > 62) continue; /* below the last bit of the result */
        for (int j = 0; j < 4; j++) sum[j] += EW_ASR(ew_mul_s32(a->m[k], b[k].m[j]), shift);
    }
    /* four products of at most 2^60: |sum| <= 2^62 */
    return row_normalise(out, sum, a->e + top);
}

void ew_row_from_q16_16(ew_row *row, ew_q16_16 a, ew_q16_16 b, ew_q16_16 c, ew_q16_16 d)
{
    int64_t sum[4];
    sum[0] = a, sum[1] = b, sum[2] = c, sum[3] = d;
    (void)row_normalise(row, sum, 60 - 16); /* the exponents are far from the limit */
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
        int error = row_combine(&r.row[i], &a->row[i], b->row, 1);
        if (error) return error;
    }
    *out = r;
    return EW_OK;
}

int ew_mat44_mul_mat34(ew_mat44 *out, const ew_mat44 *a, const ew_mat34 *b)
{
    ew_mat44 r;
    for (int i = 0; i < 4; i++) {
        int error = row_combine(&r.row[i], &a->row[i], b->row, 1);
        if (error) return error;
    }
    *out = r;
    return EW_OK;
}

int ew_mat44_mul(ew_mat44 *out, const ew_mat44 *a, const ew_mat44 *b)
{
    ew_mat44 r;
    for (int i = 0; i < 4; i++) {
        int error = row_combine(&r.row[i], &a->row[i], b->row, 0);
        if (error) return error;
    }
    *out = r;
    return EW_OK;
}

/* The rotation matrix of a quaternion of any length but 0, without a square root: with
 * n = |q|^2 the elements are 1 - 2 (y^2 + z^2) / n, 2 (x y - w z) / n and so on. */
static int rotation_rows(int32_t m[3][3], const ew_quat *q)
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
        /* rotation * scale has exponent s_exponent, |product| <= 2^30 2^30; the
         * translation is brought to the larger of the two. */
        int32_t top = t[i] != 0 && t_exponent > s_exponent ? t_exponent : s_exponent;
        int32_t down = top - s_exponent, t_down = top - t_exponent;
        int64_t sum[4];
        for (int j = 0; j < 3; j++) {
            sum[j] = down > 62 ? 0 : EW_ASR(ew_mul_s32(rotation[i][j], s[j]), down);
        }
        sum[3] = t[i] == 0 || t_down > 62 ? 0 : EW_ASR((int64_t)t[i] * ((int64_t)1 << 30), t_down);
        error = row_normalise(&r.row[i], sum, top);
        if (error) return error;
    }
    *out = r;
    return EW_OK;
}

int ew_mat44_perspective(ew_mat44 *out, const ew_projection *p)
{
    ew_block near_z = p->near_z;
    if (p->focal_x <= 0 || p->focal_y <= 0 || near_z.m <= 0) return EW_ERR_ARGUMENT;
    ew_row_from_q16_16(&out->row[0], p->focal_x, 0, 0, 0);
    ew_row_from_q16_16(&out->row[1], 0, p->focal_y, 0, 0);
    ew_row_from_q16_16(&out->row[3], 0, 0, -65536, 0);
    /* -1 and -2n in one row: as a sum of units 2^(top - 60) */
    int32_t near_e = near_z.e + 1, top = near_e > 0 ? near_e : 0;
    int64_t sum[4] = { 0, 0, 0, 0 };
    sum[2] = top > 62 ? 0 : -EW_ASR((int64_t)1 << 60, top);
    sum[3] = top - near_e > 62 ? 0 : -EW_ASR((int64_t)near_z.m * ((int64_t)1 << 30), top - near_e);
    return row_normalise(&out->row[2], sum, top);
}
