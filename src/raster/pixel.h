/* Colours between their stored forms and 12 bits per channel, and packed pixels and texels
 * (private to the raster layer). Formulas and their proofs: docs/fills.md. */
#ifndef EW_RASTER_PIXEL_H
#define EW_RASTER_PIXEL_H

#include <stddef.h>

#include "edgewalk/raster.h"

/* Whether 16-bit items may lie there: 8-bit machines take them at odd addresses, too. */
static inline int ew_is_aligned16(const void *p)
{
    struct probe { char before; uint16_t item; };
    return (uintptr_t)p % offsetof(struct probe, item) == 0;
}

/* Pixels of the target's memory before those of the picture's row y. */
static inline size_t ew_row_start(const ew_target *target, uint32_t y)
{
    return (size_t)(y - target->first_row) * target->stride;
}

/* ---- packed rows: 2^log2_bits bits per item, up to 8, the left one in the high bits ---- */

/* Items per byte less one. */
static inline uint32_t ew_packed_low(int log2_bits) { return ((uint32_t)8 >> log2_bits) - 1u; }

/* How far item i is shifted in its byte. */
static inline int ew_packed_shift(uint32_t i, int log2_bits)
{
    return (int)((~i & ew_packed_low(log2_bits)) << log2_bits);
}
static inline uint32_t ew_packed_get(const uint8_t *row, uint32_t i, int log2_bits)
{
    uint32_t mask = ((uint32_t)1 << (1 << log2_bits)) - 1u;
    return (uint32_t)row[i >> (3 - log2_bits)] >> ew_packed_shift(i, log2_bits) & mask;
}
static inline void ew_packed_set(uint8_t *row, uint32_t i, int log2_bits, uint32_t value)
{
    uint8_t *byte = &row[i >> (3 - log2_bits)];
    uint32_t mask = ((uint32_t)1 << (1 << log2_bits)) - 1u;
    int shift = ew_packed_shift(i, log2_bits);
    *byte = (uint8_t)((*byte & ~(mask << shift)) | value << shift);
}

/* ---- to 12 bits ---- */

/* `wide` is 0 for 132 c, 3 for 132 c + floor(c / 8), which reaches 4095: ew_wide. */
static inline void ew_decode_565(uint16_t out[3], uint32_t p, uint32_t wide)
{
    uint32_t r = p >> 11 & 31u, g = p >> 5 & 63u, b = p & 31u;
    out[0] = (uint16_t)(132u * r + (r >> 3 & wide));
    out[1] = (uint16_t)(65u * g);
    out[2] = (uint16_t)(132u * b + (b >> 3 & wide));
}
static inline void ew_decode_332(uint16_t out[3], uint32_t p)
{
    out[0] = (uint16_t)(585u * (p >> 5 & 7u));
    out[1] = (uint16_t)(585u * (p >> 2 & 7u));
    out[2] = (uint16_t)(1365u * (p & 3u));
}
static inline void ew_decode_grey(uint16_t out[3], uint32_t p)
{
    out[0] = out[1] = out[2] = (uint16_t)(16u * p + (p >> 4));
}

/* RGB565 stays RGB565 with one multiplication per channel; everything that dithers, or makes
 * a grey of three channels, needs white to be white. */
static inline uint8_t ew_wide(const ew_target *target)
{
    return (EW_WITH_TARGET_FORMATS && target->format > EW_TARGET_RGB565_SWAPPED) || (EW_WITH_DITHER && target->dither) ?
               3 : 0;
}

/* a towards b by share / 256, rounded down; share <= 256, a and b <= 4095. */
static inline uint16_t ew_mix256(uint32_t a, uint32_t b, uint32_t share)
{
    return (uint16_t)((a * (256u - share) + b * share) >> 8);
}

/* ITU-R BT.601-7, 2.5.1: 0.299, 0.587 and 0.114, in 1/256. */
static inline uint32_t ew_grey_of(const uint16_t c[3])
{
    return ((uint32_t)77 * c[0] + (uint32_t)150 * c[1] + (uint32_t)29 * c[2]) >> 8;
}

#endif
