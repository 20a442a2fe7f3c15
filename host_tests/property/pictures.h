/* What a random picture is drawn with, and two memories of it to compare. */
#ifndef EW_TEST_PICTURES_H
#define EW_TEST_PICTURES_H

#include "edgewalk/raster.h"

enum { PICTURE_WIDTH = 96, PICTURE_HEIGHT = 64 };

/* Colour in any format and depth, with room around that must stay as it is. */
typedef struct picture {
    uint16_t colour[PICTURE_WIDTH * PICTURE_HEIGHT + 64], depth[PICTURE_WIDTH * PICTURE_HEIGHT + 64];
} picture;

/* Any format, dither, a size up to the largest, with depth or none; no memory yet. */
void random_target(ew_target *target);

/* Points a target of random_target at rows of a picture's memory, a stride of which is that of
 * the target: the whole of it, or from one row on. */
void target_rows(ew_target *target, picture *p, uint16_t first_row, uint16_t rows);

/* Any rung, blend, filter and flags with any texture; half of them what most firmware draws. The
 * texture's texels, palette and mask are random and static. */
void random_material(ew_material *material, ew_texture *texture);

/* w, u, v and colour of three corners. */
void random_attributes(ew_raster_vertex v[3]);

/* Any rectangle of the target, often all of it. */
void random_scissor(ew_rect *rect, const ew_target *target);

/* Fills a memory with the same random bytes each time within a case. */
void picture_fill(picture *p, uint32_t seed);

#endif
