/* edgewalk/draw2d.h - rectangles, lines, sprites and text over a picture: HUDs.
 *
 * Everything goes into the target of a raster context, in any of its formats, clipped to the
 * context's scissor and converted and dithered as fills are (docs/fills.md, docs/draw2d.md).
 * Depth is neither tested nor written; the context's material and fog play no part. A context
 * whose target has no dither keeps thin text readable where the scene has one.
 *
 * Positions are pixels of the target, x to the right, y downwards, and may lie anywhere.
 * Colours are RGB565. Nothing here is linked into a program that does not call it.
 */
#ifndef EW_DRAW2D_H
#define EW_DRAW2D_H

#include "raster.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fills `width` x `height` pixels from (x, y) on, with `blend` of ew_blend. Returns EW_OK,
 * EW_ERR_ARGUMENT for an unknown blend, or EW_ERR_UNSUPPORTED for one that the build leaves out. */
int ew_draw_rect(ew_raster *raster, int16_t x, int16_t y, uint16_t width, uint16_t height, uint16_t rgb565,
                 uint8_t blend);

/* Draws the line between two pixels, both included, in either direction the same: one pixel in
 * each column where |x1 - x0| >= |y1 - y0|, in each row otherwise, the one whose centre is
 * nearest to the line between the two centres; of two equally near ones the lower, or the
 * right one (J. E. Bresenham, "Algorithm for computer control of a digital plotter", IBM
 * Systems Journal 4, 1965; the rule for ties is ours). Clipping leaves pixels out, and moves
 * none. */
void ew_draw_line(ew_raster *raster, int16_t x0, int16_t y0, int16_t x1, int16_t y1, uint16_t rgb565);

/* A texture's first level, or a part of it, texel for pixel. Its levels and wraps mean nothing
 * here, and its size is any. */
typedef struct ew_sprite {
    const ew_texture *texture;
    ew_rect part;  /* texels, inside the texture; all zero: the whole of it                */
    uint8_t flags; /* EW_COLOUR_KEY, EW_ALPHA_MASK: which texels are left out              */
    uint8_t blend; /* ew_blend                                                             */
} ew_sprite;

/* Draws a sprite with the upper left texel of its part at (x, y). Returns EW_OK, EW_ERR_ARGUMENT
 * or EW_ERR_UNSUPPORTED; with an error nothing is drawn. */
int ew_draw_sprite(ew_raster *raster, const ew_sprite *sprite, int16_t x, int16_t y);

/* Glyphs of one bit per pixel. A glyph is a byte with its width in pixels, then its rows from
 * the top, ceil(ew_font.width / 8) bytes each, the left pixel in the high bit; glyphs lie one
 * behind the other in the order of their codes. */
typedef struct ew_font {
    const uint8_t *glyphs;
    uint8_t width, height; /* of the widest glyph and of all of them, px, 1 to 255; a glyph that
                              says it is wider is drawn that wide                          */
    uint8_t gap;           /* columns between glyphs                                       */
    uint8_t line;          /* rows from the top of a line to that of the next              */
    uint8_t first, last;   /* codes that there are glyphs for, first <= last               */
    uint8_t unknown;       /* the code whose glyph stands for all others: first to last    */
} ew_font;

/* Codes 32 to 126 of ASCII, capitals and digits 7 rows high, up to 5 columns wide, digits all
 * 5; '?' stands for all others. src/raster/font.txt shows it. 855 bytes. */
extern const ew_font ew_font_small;

/* Draws text with the upper left corner of its first glyph at (x, y); pixels that glyphs leave
 * out stay as they are. `text` ends with a 0; its bytes are codes of one glyph each, '\n'
 * begins a new line below the first glyph. Returns EW_OK, or EW_ERR_ARGUMENT for a font that
 * is none, and then nothing is drawn. */
int ew_draw_text(ew_raster *raster, const ew_font *font, int16_t x, int16_t y, const char *text, uint16_t rgb565);

/* Columns that the widest line of a text takes, without a gap behind it, at most INT32_MAX, or
 * EW_ERR_ARGUMENT for a font that is none. */
int32_t ew_text_width(const ew_font *font, const char *text);

#ifdef __cplusplus
}
#endif

#endif
