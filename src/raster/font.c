/* The font of the 2D layer: drawn by hand in font.txt. */
#include "edgewalk/draw2d.h"

static const uint8_t glyphs[] = {
#include "font_table.inc"
};

const ew_font ew_font_small = { .glyphs = glyphs, .width = 5, .height = 8, .gap = 1, .line = 9,
                                .first = 32, .last = 126, .unknown = '?' };
