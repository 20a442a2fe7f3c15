/* Vertex lighting.
 *
 * A normal goes to the lights' space by the inverse transpose of the model's matrix M, so
 * n' . l = n . (M^-1 l): it is enough to take each light to the model. M^-1 is C^T / det M with
 * the cofactors C, whose rows are cross products of M's rows: no division is needed where only
 * the direction counts, just the sign of det M.
 */
#include "edgewalk/light.h"

/* Three numbers m * 2^(e - 30). */
typedef struct block3 {
    int32_t m[3];
    int32_t e;
} block3;

/* Sums in units of 2^(e - 60) to mantissas of 30 bits, nearest below. */
static void block3_from(block3 *out, const int64_t sum[3], int32_t e)
{
    uint64_t all = 0;
    for (int j = 0; j < 3; j++) all |= ew_abs64(sum[j]);
    int shift = 34 - ew_clz64(all); /* to the right; -30 to 34 */
    for (int j = 0; j < 3; j++) {
        out->m[j] = (int32_t)(shift > 0 ? EW_ASR(sum[j], shift) : sum[j] * ((int64_t)1 << -shift));
    }
    out->e = all ? e + shift - 30 : 0;
}

/* |products| <= 2^60 */
static void cross(block3 *out, const ew_row *a, const ew_row *b)
{
    static const uint8_t next[3] = { 1, 2, 0 };
    int64_t sum[3];
    for (int i = 0; i < 3; i++) {
        int j = next[i], k = next[j];
        sum[i] = ew_mul_s32(a->m[j], b->m[k]) - ew_mul_s32(a->m[k], b->m[j]);
    }
    block3_from(out, sum, (int32_t)a->e + b->e);
}

static int is_null(const block3 *a) { return !(a->m[0] | a->m[1] | a->m[2]); }

/* The cofactors of M with the sign of det M, all in one unit, |.| <= 2^30. */
static void cofactors(int32_t out[3][3], const ew_mat34 *matrix)
{
    block3 c[3];
    int32_t e = INT32_MIN;
    for (int i = 0; i < 3; i++) {
        static const uint8_t next[3] = { 1, 2, 0 };
        cross(&c[i], &matrix->row[next[i]], &matrix->row[next[next[i]]]);
        if (!is_null(&c[i]) && c[i].e > e) e = c[i].e;
    }
    const ew_row *first = &matrix->row[0];
    int64_t det = 0; /* <= 3 2^60 */
    for (int j = 0; j < 3; j++) det += ew_mul_s32(first->m[j], c[0].m[j]);
    for (int i = 0; i < 3; i++) {
        int32_t down = is_null(&c[i]) || e - c[i].e > 31 ? 31 : e - c[i].e;
        for (int j = 0; j < 3; j++) {
            int32_t m = EW_ASR(c[i].m[j], down);
            out[i][j] = det < 0 ? -m : m;
        }
    }
}

/* Unit directions from q16.16 to units of 127 / 2^21, nearest: 65536 becomes 16513. */
static int16_t direction_unit(ew_q16_16 a)
{
    return (int16_t)EW_ASR(a * INT32_C(16513) + 32768, 16); /* |a| <= 65540 */
}

/* The direction of C^T l. A null vector stays. */
static void to_model(ew_vec3 *direction, int32_t c[3][3], const ew_vec3 *l)
{
    int64_t sum[3];
    for (int j = 0; j < 3; j++) { /* 3 2^30 2^17 */
        sum[j] = ew_mul_s32(c[0][j], l->x) + ew_mul_s32(c[1][j], l->y) + ew_mul_s32(c[2][j], l->z);
    }
    block3 v;
    block3_from(&v, sum, 0);
    direction->x = v.m[0], direction->y = v.m[1], direction->z = v.m[2];
    (void)ew_vec3_normalise(direction, direction);
}

/* a b / 255 in uq8.8, nearest */
static uint16_t product88(uint8_t a, uint8_t b) { return (uint16_t)(((uint32_t)a * b * 256u + 127u) / 255u); }

static void product888(uint16_t out[3], ew_colour888 a, ew_colour888 b)
{
    out[0] = product88(a.r, b.r);
    out[1] = product88(a.g, b.g);
    out[2] = product88(a.b, b.b);
}

int ew_lighting_set(ew_lighting *lighting, const ew_mat34 *model_to_lights, ew_colour888 ambient,
                    const ew_light *lights, uint32_t count, ew_colour888 material, int renormalise)
{
    if (count > EW_LIGHTS_MAX) return EW_ERR_ARGUMENT;
    ew_lighting made;
    cofactors(made.normal, model_to_lights);
    for (uint32_t i = 0; i < count; i++) {
        ew_vec3 l;
        int error = ew_vec3_normalise(&l, &lights[i].direction);
        if (error) return error;
        if (!renormalise) to_model(&l, made.normal, &l);
        made.direction[i][0] = direction_unit(l.x);
        made.direction[i][1] = direction_unit(l.y);
        made.direction[i][2] = direction_unit(l.z);
        product888(made.colour[i], lights[i].colour, material);
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) made.normal[i][j] = EW_ASR(EW_ASR(made.normal[i][j], 7) + 1, 1);
    }
    product888(made.ambient, ambient, material);
    made.count = (uint8_t)count;
    made.renormalise = renormalise != 0;
    *lighting = made;
    return EW_OK;
}

/* The normal in the lights' space, 127 2^7 long. */
static void turned(int32_t out[3], const ew_lighting *lighting, const ew_normal8 *n)
{
    uint32_t largest = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        const int32_t *c = lighting->normal[i];
        out[i] = c[0] * n->x + c[1] * n->y + c[2] * n->z; /* <= 3 2^22 2^7 */
        if (ew_abs32(out[i]) > largest) largest = ew_abs32(out[i]);
    }
    if (largest == 0) return;
    int up = ew_clz32(largest) - 17; /* largest to [2^14, 2^15) */
    for (int i = 0; i < 3; i++) {
        out[i] = up >= 0 ? out[i] * ((int32_t)1 << up) : EW_ASR(out[i], -up);
        square += (uint32_t)(out[i] * out[i]); /* 3 2^30 */
    }
    int32_t factor = (int32_t)((UINT32_C(127) << 22) / ew_sqrt32(square)); /* < 2^15 */
    for (int i = 0; i < 3; i++) out[i] = EW_ASR(out[i] * factor, 15);
}

/* A channel, in uq8.8 times 255 where the vertex has a colour of its own. */
static uint8_t channel(uint32_t sum, uint8_t own)
{
    if (own == 255) {
        sum = (sum + 128u) >> 8;
        return (uint8_t)(sum > 255u ? 255u : sum);
    }
    uint32_t t = (sum * own + 32640u) >> 8; /* sum < 2^20: below 2^28; 255 times the result */
    if (t >= 65280u) return 255;
    return (uint8_t)((t + 1u + (t >> 8)) >> 8); /* floor(t / 255) for t below 65535 */
}

void ew_light_vertices(const ew_lighting *lighting, const ew_normal8 *normals, const ew_colour888 *own,
                       uint32_t count, ew_colour888 *out)
{
    const ew_colour888 white = { 255, 255, 255 };
    for (uint32_t i = 0; i < count; i++) {
        int32_t n[3];
        if (lighting->renormalise) turned(n, lighting, &normals[i]);
        else n[0] = normals[i].x * 128, n[1] = normals[i].y * 128, n[2] = normals[i].z * 128;

        uint32_t r = lighting->ambient[0], g = lighting->ambient[1], b = lighting->ambient[2];
        for (unsigned k = 0; k < lighting->count; k++) {
            const int16_t *l = lighting->direction[k];
            const uint16_t *colour = lighting->colour[k];
            int32_t dot = n[0] * l[0] + n[1] * l[1] + n[2] * l[2]; /* 2^28 is 1; <= sqrt(3) of it */
            if (dot <= 0) continue;
            uint32_t d = ((uint32_t)dot + 4096u) >> 13; /* <= sqrt(3) 2^15, times 2^16 below 2^32 */
            r += (d * colour[0] + 16384u) >> 15;
            g += (d * colour[1] + 16384u) >> 15;
            b += (d * colour[2] + 16384u) >> 15;
        }
        const ew_colour888 *c = own ? &own[i] : &white;
        ew_colour888 lit = { channel(r, c->r), channel(g, c->g), channel(b, c->b) };
        out[i] = lit;
    }
}
