/* Vertices to the screen, by two ways.
 *
 * Most vertices take the quick one: sums of 31 bits, one reciprocal of 1/w, and shifts that
 * are the same for all vertices of a transform. The rows x and y are scaled so that every
 * position up to 2^(16 - shift) px, at least twice as far as the viewport's borders, fits.
 * What is farther away, or nearer than twice the near distance, or so near that 31 bits would
 * be felt, takes the way in 64 bits. Which way a vertex takes depends on numbers alone, so
 * every target gets the same bits.
 */
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

/* ---- rows for 32 bits ---- */

/* |m| and |rest| of a row add up to less than this: ew_row_pieces_init needs the room. */
static const int32_t ROW32_LIMIT = INT32_C(0x7FFC0000);

/* The fewest bits, -1 or more, that a row has to be shifted down by. */
static int32_t row32_down(const ew_row *row)
{
    uint64_t twice = 0; /* <= 2^33 */
    for (int j = 0; j < 4; j++) twice += 2u * (uint64_t)ew_abs32(row->m[j]);
    int32_t down = -1;
    for (; twice >= (uint32_t)ROW32_LIMIT - 8u; twice >>= 1) down++; /* 8: what rounding adds */
    return down;
}

static int32_t rounded_down(int32_t m, int32_t down)
{
    if (down <= 0) return m * ((int32_t)1 << -down);
    return down > 31 ? 0 : EW_ASR(EW_ASR(m, down - 1) + 1, 1);
}

static void quick_row_init(ew_quick_row *out, const ew_row *row, int32_t down)
{
    ew_row32 made;
    for (int j = 0; j < 3; j++) made.m[j] = rounded_down(row->m[j], down);
    made.rest = ((int64_t)rounded_down(row->m[3], down) + 1) * ((int64_t)1 << 31);
#if EW_LONG_MULTIPLY
    *out = made;
#else
    ew_row_pieces_init(out, &made);
#endif
}

/* Row x or y. A sum's unit is 2^exponent times that of quick_w's: then a position below
 * 2^(exponent + 1) px in magnitude fits. Returns EW_OK, or EW_ERR_RANGE when the row is so
 * much larger than w's that positions would leave the guard band. */
static int position_row(ew_quick_row *out, int8_t *shift, const ew_row *row, int32_t w_unit,
                        int32_t least_exponent)
{
    int32_t down = row32_down(row), exponent = row->e + down - w_unit;
    if (exponent < least_exponent) {
        down += least_exponent - exponent;
        exponent = least_exponent;
    }
    quick_row_init(out, row, down);
    *shift = (int8_t)(15 - exponent);
    return exponent <= 15 ? EW_OK : EW_ERR_RANGE;
}

/* How many bits a distance up to the viewport's farther border takes, 0 to 14. */
static int32_t bits_of_borders(int32_t from, uint32_t size)
{
    uint32_t farthest = ew_abs32(from), other = ew_abs32(from + (int32_t)size);
    if (other > farthest) farthest = other;
    return 32 - ew_clz32(farthest - 1u); /* not 0: size is not */
}

static EW_OWN_FRAME void choose_rows32(ew_transform *t, const ew_viewport *viewport)
{
    int32_t down = row32_down(&t->w);
    int32_t w_unit = t->w.e + down; /* sums of quick_w are in units of 2^(w_unit - 29) */
    quick_row_init(&t->quick_w, &t->w, down);
    int32_t least_x = bits_of_borders(viewport->x, viewport->width);
    int32_t least_y = bits_of_borders(viewport->y, viewport->height);
    int error = position_row(&t->quick_x, &t->shift_x, &t->x, w_unit, least_x);
    if (!error) error = position_row(&t->quick_y, &t->shift_y, &t->y, w_unit, least_y);
    /* near_w = near_m 2^(32 - zeros) in units of 2^(w.e - 45) */
    int zeros = ew_clz64((uint64_t)t->near_w);
    int32_t near_zeros = zeros - 16 + down;
    t->near_m = (uint32_t)(((uint64_t)t->near_w << zeros) >> 32);
    if (error || near_zeros < 3 || near_zeros > 27) { /* 31 bits never suffice */
        t->w_hidden = INT32_MIN;
        t->w_safe = INT32_MAX;
        t->near_shift = 0;
        return;
    }
    /* Sums are off by at most 1.5 units. Those of x and of w together move a position inside the
     * viewport by at most 3 2^exponent / w px: kept below an eighth of 2^-8 px. And from 2^20 on,
     * near/w <= 1/2 is off by 2^-20.4 of 1 at most, 1/20 of depth's unit. */
    int32_t least_shift = t->shift_x < t->shift_y ? t->shift_x : t->shift_y;
    int32_t precise = (int32_t)3 << (15 - least_shift + 11);
    t->near_shift = (int8_t)(near_zeros - 3);
    t->w_hidden = (int32_t)(t->near_m >> near_zeros) - 3;
    t->w_safe = ((int32_t)1 << (32 - near_zeros)) + 3;
    if (t->w_safe < precise) t->w_safe = precise;
    if (t->w_safe < (int32_t)1 << 20) t->w_safe = (int32_t)1 << 20;
}

/* The rows x, y and w of viewport, projection and model: the viewport as x = (x_ndc + 1) width/2 +
 * left, y = (1 - y_ndc) height/2 + top, so that after the division by w the screen position is
 * there without another sum. The row of z only has to be in range. */
static EW_OWN_FRAME int choose_rows(ew_transform *t, const ew_projection *projection,
                                    const ew_mat34 *model_view, const ew_viewport *viewport)
{
    const ew_q16_16 half_w = (int32_t)viewport->width * 32768, half_h = (int32_t)viewport->height * 32768;
    ew_row z;
    ew_row_from_q16_16(&t->x, half_w, 0, 0, half_w + (int32_t)viewport->x * 65536);
    ew_row_from_q16_16(&t->y, 0, -half_h, 0, half_h + (int32_t)viewport->y * 65536);
    ew_row_from_q16_16(&z, 0, 0, 65536, 0);
    ew_row_from_q16_16(&t->w, 0, 0, 0, 65536);
    ew_mat44 perspective;
    int error = ew_mat44_perspective(&perspective, projection);
    for (int i = 0; i < 4 && !error; i++) {
        ew_row *row = i == 0 ? &t->x : i == 1 ? &t->y : i == 2 ? &z : &t->w;
        error = ew_row_mul_mat44(row, row, &perspective);
        if (!error) error = ew_row_mul_mat34(row, row, model_view);
        if (!error) bring_to_one_exponent(row);
    }
    return error;
}

int ew_transform_set(ew_transform *transform, const ew_projection *projection, const ew_mat34 *model_view,
                     const ew_viewport *viewport)
{
    if (viewport->width < 1 || viewport->height < 1 || viewport->width > 8192 || viewport->height > 8192 ||
        viewport->x < -8192 || viewport->x > 8191 || viewport->y < -8192 || viewport->y > 8191) {
        return EW_ERR_ARGUMENT;
    }

    int error = choose_rows(transform, projection, model_view, viewport);
    if (error) return error;

    /* n = m 2^(e - 30) in units of 2^(w.e - 45). m < 2^31, so up to 2^31 more keeps it
     * inside 62 bits; a model that small beside the near distance is all clipped. */
    int32_t up = projection->near_z.e + 15 - transform->w.e;
    int64_t near_w = projection->near_z.m;
    if (up > 31) near_w = (int64_t)1 << 62;
    else if (up >= 0) near_w *= (int64_t)1 << up;
    else near_w = up < -62 ? 0 : EW_ASR(near_w, -up);
    if (near_w < (int64_t)1 << 16) return EW_ERR_RANGE; /* 1/z would keep fewer than 16 bits */

    transform->near_w = near_w;
    transform->left = (int32_t)viewport->x * 4096;
    transform->top = (int32_t)viewport->y * 4096;
    transform->across = (uint32_t)viewport->width * 4096u;
    transform->down = (uint32_t)viewport->height * 4096u;
    choose_rows32(transform, viewport);
    return EW_OK;
}

/* ---- in 64 bits ---- */

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

static void hide(ew_screen_vertex *out)
{
    out->x = out->y = 0;
    out->w = 0;
    out->outcode = EW_OUT_NEAR;
}

/* |x|, |y| <= 2^30; the viewport's borders are below 2^26. An unsigned comparison sees both
 * sides at once. */
static inline uint8_t outcode_of(const ew_transform *t, int32_t x, int32_t y)
{
    unsigned code = 0;
    x -= t->left;
    y -= t->top;
    if ((uint32_t)x > t->across) code = x < 0 ? EW_OUT_LEFT : EW_OUT_RIGHT;
    if ((uint32_t)y > t->down) code |= y < 0 ? EW_OUT_TOP : EW_OUT_BOTTOM;
    return (uint8_t)code;
}

void ew_project(ew_screen_vertex *out, const ew_transform *t, const ew_homogeneous_vertex *h, int32_t e_x,
                int32_t e_y, int64_t near_w)
{
    if (h->w < near_w) {
        hide(out);
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
    out->outcode = outcode_of(t, out->x, out->y);
    if (out->x > guard || out->x < -guard || out->y > guard || out->y < -guard) out->outcode |= EW_OUT_GUARD;
}

/* ---- every vertex ---- */

/* Sums to the screen; w >= t->w_safe. Returns 0, and has written nothing, when the position
 * does not fit. */
static inline int project_quickly(ew_screen_vertex *out, const ew_transform *t, int32_t x, int32_t y,
                                  int32_t w)
{
    /* 1/w = r 2^(up - 60). A position in units of 2^-12 px is
     * x 2^exponent 2^12 / w = (x 2^up) r 2^(exponent - 48), and shift = 15 - exponent: the
     * product's upper half, 2^(shift + 1) times too large. */
    const uint32_t wide_w = (uint32_t)w << 2; /* 2^20 <= w < 2^30 */
    const int up = ew_clz32(wide_w);
    uint32_t r = ew_recip_newton_inline(wide_w << up);
    int32_t wide_x = (int32_t)((uint32_t)x << up), wide_y = (int32_t)((uint32_t)y << up);
    if (EW_ASR(wide_x, up) != x || EW_ASR(wide_y, up) != y) return 0;
    x = EW_ASR(EW_ASR(ew_mulh_s32(wide_x, (int32_t)r), t->shift_x) + 1, 1);
    y = EW_ASR(EW_ASR(ew_mulh_s32(wide_y, (int32_t)r), t->shift_y) + 1, 1);
    out->x = x;
    out->y = y;
    /* near/w = near_m 2^-(near_shift + 3) r 2^(up - 60), times 2^31: the upper half is below
     * 2^31 and 2^(near_shift - up) times too large, w_safe sees to it that this is 1 at least */
    uint32_t near = ew_mulh_u32(t->near_m, r) << 1;
    out->w = ((near >> (t->near_shift - up)) + 1u) >> 1;
    out->outcode = outcode_of(t, x, y);
    return 1;
}

static EW_OWN_FRAME void project_carefully(ew_screen_vertex *out, const ew_transform *t, const ew_vertex16 *in, int32_t w)
{
    if (w < t->w_hidden) {
        hide(out);
        return;
    }
    ew_homogeneous_vertex h;
    ew_homogeneous(&h, t, in);
    ew_project(out, t, &h, t->x.e - t->w.e, t->y.e - t->w.e, t->near_w);
}

void ew_transform_vertices(const ew_transform *transform, const ew_vertex16 *in, uint32_t count,
                           ew_screen_vertex *out)
{
#if EW_LONG_MULTIPLY
    const int32_t unit = 65536; /* to q1.31 */
#define SUM(row) ew_sum32(&transform->row, x, y, z)
#else
    const int32_t unit = 1;
#define SUM(row) ew_sum32_pieces(&transform->row, x, y, z)
#endif
    for (const ew_vertex16 *end = in + count; in < end; in++, out++) {
        int32_t x = in->x * unit, y = in->y * unit, z = in->z * unit;
        int32_t w = SUM(quick_w);
        if (w < transform->w_safe || !project_quickly(out, transform, SUM(quick_x), SUM(quick_y), w)) {
            project_carefully(out, transform, in, w);
        }
    }
#undef SUM
}
