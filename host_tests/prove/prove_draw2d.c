/* src/raster/draw2d.c: rectangles, sprites and glyphs at every place where they reach a small target, or
 * beside it, whatever they are made of. Memory ends where the last pixel, texel, entry and row does. */
#include "edgewalk/draw2d.h"

#include "unknown.h"

#ifdef EW_PROVE_SHORT
enum { FIRST_FORMAT = 4 };
#else
enum { FIRST_FORMAT = 0 };
#endif
enum { WIDTH = 9, STRIDE = 16, HEIGHT = 2, ACROSS = 5, DOWN = 2, GLYPH = 9 };

static const uint8_t bits_of[] = { 16, 16, 8, 8, 4, 1 }; /* of a pixel, by ew_target_format */
static const uint8_t texel_bits_of[] = { 16, 8, 8, 8, 4, 1 };
static const uint16_t entries_of[] = { 0, 0, 0, 256, 16, 2 };
static uint16_t colour[STRIDE * HEIGHT], texels[16], palette[256];
static uint8_t mask[DOWN], glyphs[2 * (1 + 2 * DOWN)];
static ew_raster raster;

static void target_is(uint8_t format)
{
    const size_t bytes = (((size_t)STRIDE * (HEIGHT - 1) + WIDTH) * bits_of[format] + 7) / 8;
    const ew_target target = { (uint8_t *)colour + ((sizeof colour - bytes) & ~(size_t)1), NULL, WIDTH, HEIGHT, STRIDE,
                               format, (uint8_t)any_of(2), 7 };
    const ew_rect scissor = { 1, 7, WIDTH, 7 + HEIGHT };
    any_bytes(colour, sizeof colour);
    any_bytes(&raster, sizeof raster);
    raster.target = target, raster.scissor = scissor;
}

static void rectangles(int16_t x, int16_t y)
{
    (void)ew_draw_rect(&raster, x, y, 1, 1, any16(), any8());
    (void)ew_draw_rect(&raster, x, y, 9, 3, any16(), any8());
    (void)ew_draw_rect(&raster, x, y, UINT16_MAX, UINT16_MAX, any16(), any8());
}

/* `flags` is known: Eva does not relate a mask that is not there to what asks for it. */
static void sprite_with(int16_t x, int16_t y, uint8_t format, uint8_t flags)
{
    const size_t bytes = (ACROSS * texel_bits_of[format] + 7u) / 8u * DOWN;
    const ew_texture texture = { .texels = (uint8_t *)texels + ((sizeof texels - bytes) & ~(size_t)1), .width = ACROSS,
                                 .height = DOWN, .palette = palette + 256 - entries_of[format], .mask = mask,
                                 .key = any16(), .format = format, .wrap_u = any8(), .wrap_v = any8(), .levels = any8() };
    const ew_sprite whole = { .texture = &texture, .flags = flags, .blend = any8() };
    (void)ew_draw_sprite(&raster, &whole, x, y);
}

static void sprite(int16_t x, int16_t y, uint8_t format)
{
    sprite_with(x, y, format, 0);
    sprite_with(x, y, format, EW_COLOUR_KEY | EW_ALPHA_MASK);
}

static void glyph(int16_t x, int16_t y)
{
    const ew_font font = { glyphs, GLYPH, DOWN, any8(), any8(), 'a', 'b', 'b' };
    char text[2] = { 0, 0 };
    any_bytes(glyphs, sizeof glyphs);
    glyphs[0] = 4, glyphs[1 + 2 * DOWN] = 255;
    text[0] = 'a';
    (void)ew_draw_text(&raster, &font, x, y, text, any16());
    text[0] = (char)between('b', 127);
    (void)ew_draw_text(&raster, &font, x, y, text, any16());
}

/* Rows or columns before the target's, or behind them. */
static int16_t before(int16_t first) { return (int16_t)between(INT16_MIN, first); }
static int16_t behind(int16_t last) { return (int16_t)between(last, INT16_MAX); }

void prove_draw2d(void)
{
    any_bytes(texels, sizeof texels), any_bytes(palette, sizeof palette), any_bytes(mask, sizeof mask);
    //@ loop unroll 2;
    for (uint8_t format = FIRST_FORMAT; format <= 4; format += 4) { /* words, and two pixels to a byte */
        target_is(format);
        //@ loop unroll 64;
        for (int16_t y = 7 - DOWN; y <= 7 + HEIGHT; y++) {
            rectangles(before(-GLYPH), y), rectangles(behind(WIDTH), y);
            //@ loop unroll 64;
            for (int16_t x = 1 - GLYPH; x <= WIDTH; x++) {
                rectangles(x, y), sprite(x, y, format), glyph(x, y);
            }
        }
        sprite(before(-ACROSS), any_s16(), format), glyph(before(-GLYPH), any_s16());
        sprite(behind(WIDTH), any_s16(), format), glyph(behind(WIDTH), any_s16());
        sprite(any_s16(), before(7 - DOWN), format), glyph(any_s16(), before(7 - DOWN));
        sprite(any_s16(), behind(7 + HEIGHT), format), glyph(any_s16(), behind(7 + HEIGHT));
    }
}
