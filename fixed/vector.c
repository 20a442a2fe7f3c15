/* Three-component vectors in q16.16. */
#include "edgewalk/fixed.h"

int64_t ew_vec3_dot(const ew_vec3 *a, const ew_vec3 *b)
{
    return ew_mul_s32(a->x, b->x) + ew_mul_s32(a->y, b->y) + ew_mul_s32(a->z, b->z);
}

/* a b - c d, nearest, saturating. |a b - c d| can reach 2^63, so halves are taken first. */
static ew_q16_16 difference_of_products(int32_t a, int32_t b, int32_t c, int32_t d)
{
    int64_t half = EW_ASR(ew_mul_s32(a, b), 1) - EW_ASR(ew_mul_s32(c, d), 1);
    /* the two dropped bits can make 1/2 unit of 2^-32: far below the rounding to 2^-16 */
    int64_t r = EW_ASR(half + 0x4000, 15);
    return r > INT32_MAX ? INT32_MAX : r < INT32_MIN ? INT32_MIN : (int32_t)r;
}

void ew_vec3_cross(ew_vec3 *out, const ew_vec3 *a, const ew_vec3 *b)
{
    ew_vec3 r;
    r.x = difference_of_products(a->y, b->z, a->z, b->y);
    r.y = difference_of_products(a->z, b->x, a->x, b->z);
    r.z = difference_of_products(a->x, b->y, a->y, b->x);
    *out = r;
}

int ew_vec3_normalise(ew_vec3 *out, const ew_vec3 *a)
{
    uint32_t largest = ew_abs32(a->x);
    if (ew_abs32(a->y) > largest) largest = ew_abs32(a->y);
    if (ew_abs32(a->z) > largest) largest = ew_abs32(a->z);
    if (largest == 0) return EW_ERR_ARGUMENT;

    /* Scaled so that the largest component is in [2^29, 2^30): squares sum to below 2^62,
     * the length is below 2^31. */
    int shift = ew_clz32(largest) - 2;
    int32_t c[3];
    c[0] = a->x, c[1] = a->y, c[2] = a->z;
    uint64_t sum = 0;
    for (int i = 0; i < 3; i++) {
        c[i] = shift >= 0 ? c[i] * ((int32_t)1 << shift) : EW_ASR(c[i], -shift);
        sum += (uint64_t)ew_mul_s32(c[i], c[i]);
    }
    uint32_t length = ew_sqrt64(sum); /* [2^29, 2^31) */
    int lead = ew_clz32(length);
    uint32_t r = ew_recip_newton(length << lead); /* 1/length = r 2^(lead - 62) */
    for (int i = 0; i < 3; i++) {
        /* c r <= 2^61; result times 2^16 */
        c[i] = (int32_t)EW_ASR((int64_t)c[i] * (int64_t)r + ((int64_t)1 << (45 - lead)), 46 - lead);
    }
    out->x = c[0], out->y = c[1], out->z = c[2];
    return EW_OK;
}
