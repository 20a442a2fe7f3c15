/* Vertices to the screen. */
#include "project.h"

/* For sums with q1.15 vertices: the smaller of the two parts loses bits that the sum could
 * not keep. */
static void bring_to_one_exponent(ew_row *row)
{
    int32_t down = row->e_last - row->e;
    if (row->m[3] == 0) down = 0;
    else if (!row->m[0] && !row->m[1] && !row->m[2]) row->e = row->e_last, down = 0;
    if (down > 31) down = 31; /* rounds to 0 */
    if (down < -31) down = -31;
    if (down > 0) {
        for (int j = 0; j < 3; j++) row->m[j] = EW_ASR(EW_ASR(row->m[j], down - 1) + 1, 1);
        row->e = row->e_last;
    } else if (down < 0) {
        row->m[3] = EW_ASR(EW_ASR(row->m[3], -down - 1) + 1, 1);
    }
    row->e_last = row->e;
}

int ew_transform_set(ew_transform *transform, const ew_projection *projection, const ew_mat34 *model_view,
                     const ew_viewport *viewport)
{
    if (viewport->width < 1 || viewport->height < 1 || viewport->width > 8192 || viewport->height > 8192 ||
        viewport->x < -8192 || viewport->x > 8191 || viewport->y < -8192 || viewport->y > 8191) {
        return EW_ERR_ARGUMENT;
    }

    /* Viewport: x = (x_ndc + 1) width/2 + left, y = (1 - y_ndc) height/2 + top, so that
     * after the division by w the screen position is there without another sum. */
    ew_mat44 screen, all;
    ew_q16_16 half_w = (int32_t)viewport->width * 32768, half_h = (int32_t)viewport->height * 32768;
    ew_row_from_q16_16(&screen.row[0], half_w, 0, 0, half_w + (int32_t)viewport->x * 65536);
    ew_row_from_q16_16(&screen.row[1], 0, -half_h, 0, half_h + (int32_t)viewport->y * 65536);
    ew_row_from_q16_16(&screen.row[2], 0, 0, 65536, 0);
    ew_row_from_q16_16(&screen.row[3], 0, 0, 0, 65536);
    int error = ew_mat44_perspective(&all, projection);
    if (!error) error = ew_mat44_mul(&all, &screen, &all);
    if (!error) error = ew_mat44_mul_mat34(&all, &all, model_view);
    if (error) return error;

    bring_to_one_exponent(&all.row[0]);
    bring_to_one_exponent(&all.row[1]);
    bring_to_one_exponent(&all.row[3]);

    /* n = m 2^(e - 30) in units of 2^(w.e - 45). m < 2^31, so up to 2^31 more keeps it
     * inside 62 bits; a model that small beside the near distance is all clipped. */
    int32_t up = projection->near_z.e + 15 - all.row[3].e;
    int64_t near_w = projection->near_z.m;
    if (up > 31) near_w = (int64_t)1 << 62;
    else if (up >= 0) near_w *= (int64_t)1 << up;
    else near_w = up < -62 ? 0 : EW_ASR(near_w, -up);
    if (near_w < (int64_t)1 << 16) return EW_ERR_RANGE; /* 1/z would keep fewer than 16 bits */

    transform->x = all.row[0];
    transform->y = all.row[1];
    transform->w = all.row[3];
    transform->near_w = near_w;
    transform->viewport = *viewport;
    return EW_OK;
}

/* |sum| <= 4 2^30 2^15 = 2^47, in units of 2^(e - 45). */
static int64_t row_times(const ew_row *row, const ew_vertex16 *v)
{
    return ew_mul_s32(row->m[0], v->x) + ew_mul_s32(row->m[1], v->y) + ew_mul_s32(row->m[2], v->z) +
           (int64_t)row->m[3] * 32768;
}

void ew_homogeneous(ew_homogeneous_vertex *out, const ew_transform *transform, const ew_vertex16 *v)
{
    out->x = row_times(&transform->x, v);
    out->y = row_times(&transform->y, v);
    out->w = row_times(&transform->w, v);
}

/* A signed value with its leading zeros taken out: a = m 2^(33 - zeros), |m| < 2^31. */
static int32_t mantissa(int64_t a, int *zeros)
{
    *zeros = ew_clz64(ew_abs64(a));
    if (*zeros == 64) return 0;
    return (int32_t)EW_ASR(a * ((int64_t)1 << (*zeros - 1)), 32);
}

/* a/w to q20.12, nearest; 2^30 or more in magnitude is returned as +-2^30. 1/w =
 * r 2^(w_zeros - 94); a is in units 2^e times those of w. */
static int32_t quotient(int64_t a, uint32_t r, int w_zeros, int32_t e)
{
    int zeros;
    int32_t m = mantissa(a, &zeros);
    int64_t product = (int64_t)m * (int64_t)r; /* <= 2^62 */
    int32_t shift = 94 - 33 - 12 + zeros - w_zeros - e;
    if (shift > 62) return 0;
    if (shift < 1 || ew_abs64(product) >> shift >= (uint64_t)1 << 30) {
        return m == 0 ? 0 : m > 0 ? (int32_t)1 << 30 : -((int32_t)1 << 30);
    }
    return (int32_t)EW_ASR(product + ((int64_t)1 << (shift - 1)), shift);
}

void ew_project(ew_screen_vertex *out, const ew_transform *t, const ew_homogeneous_vertex *h, int32_t e_x,
                int32_t e_y, int64_t near_w)
{
    out->x = out->y = 0;
    out->w = 0;
    if (h->w < near_w) {
        out->outcode = EW_OUT_NEAR;
        return;
    }
    int w_zeros = ew_clz64((uint64_t)h->w), near_zeros = ew_clz64((uint64_t)near_w);
    uint32_t r = ew_recip_newton((uint32_t)(((uint64_t)h->w << w_zeros) >> 32));
    out->x = quotient(h->x, r, w_zeros, e_x);
    out->y = quotient(h->y, r, w_zeros, e_y);

    /* near/w <= 1, in uq1.31: near_m 2^(32 - near_zeros) r 2^(w_zeros - 94) 2^31, rounded */
    uint32_t near_m = (uint32_t)(((uint64_t)near_w << near_zeros) >> 32);
    int shift = 31 + near_zeros - w_zeros; /* near_w <= w: at least 31 */
    uint64_t product = ew_mul_u32(near_m, r); /* < 2^63 */
    uint64_t w = shift > 62 ? 0 : (product + ((uint64_t)1 << (shift - 1))) >> shift;
    out->w = w < 1 ? 1 : w > 0x80000000u ? 0x80000000u : (uint32_t)w;

    const int32_t guard = EW_GUARD_PX * 4096;
    uint8_t code = 0;
    if (out->x > guard || out->x < -guard || out->y > guard || out->y < -guard) code |= EW_OUT_GUARD;
    const ew_viewport *view = &t->viewport;
    if (out->x < (int32_t)view->x * 4096) code |= EW_OUT_LEFT;
    if (out->x > ((int32_t)view->x + view->width) * 4096) code |= EW_OUT_RIGHT;
    if (out->y < (int32_t)view->y * 4096) code |= EW_OUT_TOP;
    if (out->y > ((int32_t)view->y + view->height) * 4096) code |= EW_OUT_BOTTOM;
    out->outcode = code;
}

void ew_transform_vertices(const ew_transform *transform, const ew_vertex16 *in, uint32_t count,
                           ew_screen_vertex *out)
{
    int32_t e_x = transform->x.e - transform->w.e, e_y = transform->y.e - transform->w.e;
    for (uint32_t i = 0; i < count; i++) {
        ew_homogeneous_vertex h;
        ew_homogeneous(&h, transform, &in[i]);
        ew_project(&out[i], transform, &h, e_x, e_y, transform->near_w);
    }
}
