/* Targets: a colour of three 12-bit channels becomes a pixel. docs/fills.md has the formulas. */
#include "target.h"

#include "arch.h"
#include "pixel.h"

/* A pixel is `channels` channels, the first one highest. */
typedef struct layout {
    uint8_t channels;  /* 3, or 1: grey                                                   */
    uint8_t bits[3];
    uint8_t log2_bits; /* of a pixel                                                      */
} layout;

static const layout layouts[] EW_HOT_TABLE = {
    { 3, { 5, 6, 5 }, 4 },
#if EW_WITH_TARGET_FORMATS
    { 3, { 5, 6, 5 }, 4 }, /* swapped                                                     */
    { 3, { 3, 3, 2 }, 3 },
    { 1, { 8, 0, 0 }, 3 },
    { 1, { 4, 0, 0 }, 2 },
    { 1, { 1, 0, 0 }, 0 },
#endif
};

int ew_target_check(const ew_target *target)
{
    if (!target->colour || target->width < 1 || target->width > EW_TARGET_MAX || target->height < 1 ||
        target->height > EW_TARGET_MAX || target->first_row > EW_TARGET_MAX - target->height ||
        target->stride < target->width || target->dither > 1 ||
        target->format > EW_TARGET_MONO || !ew_is_aligned16(target->depth)) {
        return EW_ERR_ARGUMENT;
    }
    if (target->format >= sizeof layouts / sizeof *layouts || (!EW_WITH_DITHER && target->dither)) {
        return EW_ERR_UNSUPPORTED;
    }
    int log2_bits = layouts[target->format].log2_bits;
    int whole = log2_bits == 4 ? ew_is_aligned16(target->colour) : !(target->stride & ew_packed_low(log2_bits));
    return whole ? EW_OK : EW_ERR_ARGUMENT;
}

/* ---- dither ---- */

#if EW_WITH_DITHER
/* The 8 x 8 matrix of B. E. Bayer, "An optimum method for two-level rendition of
 * continuous-tone pictures", 1973: bits of y and of x ^ y in turn, the lowest ones highest. */
static const uint8_t bayer[8][8] EW_HOT_TABLE = {
    { 0, 32, 8, 40, 2, 34, 10, 42 },  { 48, 16, 56, 24, 50, 18, 58, 26 }, { 12, 44, 4, 36, 14, 46, 6, 38 },
    { 60, 28, 52, 20, 62, 30, 54, 22 }, { 3, 35, 11, 43, 1, 33, 9, 41 }, { 51, 19, 59, 27, 49, 17, 57, 25 },
    { 15, 47, 7, 39, 13, 45, 5, 37 }, { 63, 31, 55, 23, 61, 29, 53, 21 },
};
#endif

EW_HOT const uint8_t *ew_thresholds(const ew_target *target, uint32_t y)
{
    static const uint8_t none[8] = { 0 };
#if EW_WITH_DITHER
    if (target->dither) return bayer[y & 7u];
#endif
    (void)target, (void)y;
    return none;
}

/* 12 bits to `bits`; threshold is 0 to 63, or negative: no dither. */
static uint32_t reduce(uint32_t c, int bits, int threshold)
{
    if (!EW_WITH_DITHER || threshold < 0) return c >> (12 - bits);
    /* what was c (2^bits - 1) / 2^12 of a step is now whole steps of 2^(12 - bits) */
    uint32_t t = bits <= 6 ? (uint32_t)threshold << (6 - bits) : (uint32_t)threshold >> (bits - 6);
    return (c - (c >> bits) + t) >> (12 - bits);
}

/* ---- blend ---- */

/* `up` rounds the half upwards. */
static uint32_t mixed(uint32_t value, uint32_t old, int bits, int blend, uint32_t up)
{
    uint32_t top = ((uint32_t)1 << bits) - 1u, sum = value + old;
    if (blend == EW_BLEND_HALF) return (sum + up) >> 1;
    return sum > top ? top : sum;
}

/* ---- pixels ---- */

static uint32_t swapped(uint32_t p) { return (p >> 8 & 0xFFu) | (p & 0xFFu) << 8; }

static uint32_t read_pixel(const ew_target *target, const uint8_t *row, uint32_t x, int log2_bits)
{
    if (!EW_WITH_TARGET_FORMATS || log2_bits == 4) {
        uint32_t p = ((const uint16_t *)(const void *)row)[x];
        return EW_WITH_TARGET_FORMATS && target->format == EW_TARGET_RGB565_SWAPPED ? swapped(p) : p;
    }
    return ew_packed_get(row, x, log2_bits);
}

static void write_pixel(const ew_target *target, uint8_t *row, uint32_t x, int log2_bits, uint32_t p)
{
    if (!EW_WITH_TARGET_FORMATS || log2_bits == 4) {
        int swap = EW_WITH_TARGET_FORMATS && target->format == EW_TARGET_RGB565_SWAPPED;
        ((uint16_t *)(void *)row)[x] = (uint16_t)(swap ? swapped(p) : p);
    } else {
        ew_packed_set(row, x, log2_bits, p);
    }
}

/* RGB565 without dither and blend. */
EW_NOINLINE void put_565(const ew_target *target, const ew_piece *piece)
{
    uint16_t *to = (uint16_t *)target->colour + ew_row_start(target, piece->y) + piece->x;
    const uint16_t *c = piece->colour[0];
    const int swap = EW_WITH_TARGET_FORMATS && target->format == EW_TARGET_RGB565_SWAPPED;
    //@ loop unroll 8;
    for (uint32_t live = piece->live & 0xFFu >> (EW_PIECE - piece->n); live; live >>= 1, to++, c += 3) {
        const uint32_t p = (uint32_t)(c[0] >> 7) << 11 | (uint32_t)(c[1] >> 6) << 5 | c[2] >> 7;
        if (live & 1u) *to = (uint16_t)(swap ? swapped(p) : p);
    }
}

EW_HOT void ew_target_put(const ew_target *target, const ew_piece *piece, int blend)
{
    if ((!EW_WITH_TARGET_FORMATS || target->format <= EW_TARGET_RGB565_SWAPPED) && !(EW_WITH_DITHER && target->dither) &&
        !(EW_WITH_BLENDS && blend)) {
        put_565(target, piece);
        return;
    }

    const layout *form = &layouts[EW_WITH_TARGET_FORMATS ? target->format : 0];
    const int log2_bits = form->log2_bits;
    /* whole bytes: a stride of packed pixels is a multiple of what a byte holds */
    uint8_t *row = (uint8_t *)target->colour + (ew_row_start(target, piece->y) << log2_bits >> 3);
    const int dither = EW_WITH_DITHER && target->dither;
    const uint32_t y = piece->y;
#if EW_WITH_DITHER
    const uint8_t *thresholds = ew_thresholds(target, y);
#endif
    for (int i = 0; i < piece->n; i++) {
        if (!(piece->live >> i & 1)) continue;
        const uint32_t x = (uint32_t)piece->x + (uint32_t)i;
        const uint32_t old = EW_WITH_BLENDS && blend ? read_pixel(target, row, x, log2_bits) : 0;
        int threshold = -1;
#if EW_WITH_DITHER
        if (dither) threshold = thresholds[x & 7u];
#endif
        uint32_t pixel = 0;
        int below = 1 << log2_bits; /* bits of the channels still to come */
        for (int k = 0; k < form->channels; k++) {
            const int bits = form->bits[k];
            uint32_t c = form->channels == 1 ? ew_grey_of(piece->colour[i]) : piece->colour[i][k];
            uint32_t value = reduce(c, bits, threshold);
            below -= bits;
            if (EW_WITH_BLENDS && blend) {
                uint32_t before = old >> below & (((uint32_t)1 << bits) - 1u);
                value = mixed(value, before, bits, blend, dither ? (x ^ y) & 1u : 0);
            }
            pixel |= value << below;
        }
        write_pixel(target, row, x, log2_bits, pixel);
    }
}

#if EW_WITH_TARGET_FORMATS
EW_HOT void ew_target_fill(const ew_target *target, ew_piece *piece, uint16_t x1)
{
    /* dither comes again after 8 pixels, and those are whole bytes */
    const uint32_t bytes = (uint32_t)1 << layouts[target->format].log2_bits;
    const uint8_t *pattern = NULL;
    for (uint32_t x = piece->x; x < x1; x += (uint32_t)piece->n) {
        const uint32_t room = 8u - (x & 7u), left = x1 - x;
        uint8_t *to = (uint8_t *)target->colour + ((ew_row_start(target, piece->y) + x) * bytes >> 3);
        piece->n = (int)(room < left ? room : left);
        if (piece->n < 8 || !pattern) {
            piece->x = (uint16_t)x;
            ew_target_put(target, piece, EW_BLEND_NONE);
            if (piece->n == 8) pattern = to;
        } else {
            for (uint32_t i = 0; i < bytes; i++) to[i] = pattern[i];
        }
    }
}
#endif
