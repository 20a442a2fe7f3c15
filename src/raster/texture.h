/* Colours out of textures (private to the raster layer). */
#ifndef EW_RASTER_TEXTURE_H
#define EW_RASTER_TEXTURE_H

#include "fill.h"

/* Whether the core can draw it with a filter and flags: EW_OK, EW_ERR_ARGUMENT or
 * EW_ERR_UNSUPPORTED. */
int ew_texture_check(const ew_texture *texture, int filter, int flags);

/* The same of what lies in memory alone: of one texel at a time, of any size, whatever the wraps. */
int ew_texture_check_stored(const ew_texture *texture, int flags);

/* Makes ready for ew_texture_texel on the first level; `cuts` and `wide` as in ew_sampler. */
void ew_texture_open(ew_sampler *s, const ew_texture *texture, int cuts, uint8_t wide);

/* A texel's colour. Returns 0 if it is left out. */
int ew_texture_texel(const ew_sampler *s, uint32_t column, uint32_t row, uint16_t colour[3]);

/* floor(2^32 / size); 0 for a size of 1. */
uint32_t ew_texture_inverse(uint32_t size);

/* Makes ready for a piece's first level; it begins at the run's first pixel. Without mip levels
 * the next piece goes on where ew_texture_sample has come to. */
void ew_texture_start(ew_sampler *s, const ew_raster *raster, const ew_run *run);

/* The colours of the piece. Pixels whose texel is left out are no longer live. */
void ew_texture_sample(ew_sampler *s, ew_piece *piece);

/* Goes to the level behind. Returns 0 where none is wanted. */
int ew_texture_next(ew_sampler *s, const ew_raster *raster, const ew_run *run);

/* log2 of the texels per pixel, in 1/256, at most 1/150 off; 0 where it is below 0. Steps are
 * those of ew_run. */
uint32_t ew_texture_level(const ew_run *run);

#endif
