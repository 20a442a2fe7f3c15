/* Colours into a target (private to the raster layer). */
#ifndef EW_RASTER_TARGET_H
#define EW_RASTER_TARGET_H

#include "fill.h"
#include "pixel.h"

/* Whether the core can draw into it: EW_OK, EW_ERR_ARGUMENT or EW_ERR_UNSUPPORTED. */
int ew_target_check(const ew_target *target);

/* Thresholds of a row of the target, from column 0 on, repeated every 8 pixels; none without
 * dither: zeros. */
const uint8_t *ew_thresholds(const ew_target *target, uint32_t y);

/* RGB565 in the machine's order, which no conversion and no dither changes: what comes as a word of
 * it may be stored as it is. */
static inline int ew_target_takes_words(const ew_target *target)
{
    return !EW_WITH_TARGET_FORMATS || target->format == EW_TARGET_RGB565;
}

/* Such a target's row y. */
static inline uint16_t *ew_target_words(const ew_target *target, uint16_t y)
{
    return (uint16_t *)target->colour + ew_row_start(target, y);
}

/* Converts, dithers, blends and stores the live pixels of a piece. */
void ew_target_put(const ew_target *target, const ew_piece *piece, int blend);

/* Stores the piece's colours, which are all the same, from its x to below x1: an n of EW_PIECE
 * and all live are assumed and used up. */
void ew_target_fill(const ew_target *target, ew_piece *piece, uint16_t x1);

#endif
