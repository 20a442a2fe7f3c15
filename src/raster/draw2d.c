/* The 2D layer. Everything is clipped to the scissor first, so that what is put is inside of it;
 * how rows lie is known to ew_target_put and ew_raster_fill alone. */
#include "edgewalk/draw2d.h"

#include "fill.h"
#include "pixel.h"
#include "target.h"
#include "texture.h"

static int32_t larger(int32_t a, int32_t b) { return a > b ? a : b; }
static int32_t smaller(int32_t a, int32_t b) { return a < b ? a : b; }

/* What of a box lies in the scissor. Returns whether anything does. |x|, |y| <= 2^30. */
static int clip(const ew_raster *raster, int32_t x, int32_t y, int32_t width, int32_t height, ew_rect *inside)
{
    const ew_rect *s = &raster->scissor;
    const int32_t x0 = larger(x, s->x0), x1 = smaller(x + width, s->x1);
    const int32_t y0 = larger(y, s->y0), y1 = smaller(y + height, s->y1);
    if (x0 >= x1 || y0 >= y1) return 0;
    inside->x0 = (uint16_t)x0, inside->x1 = (uint16_t)x1;
    inside->y0 = (uint16_t)y0, inside->y1 = (uint16_t)y1;
    return 1;
}

static ew_piece *piece_of(ew_raster *raster) { return &raster->work.now.span.fill.any.piece; }

/* A piece of one colour, all live, with no pixel yet. */
static ew_piece *paint(ew_raster *raster, uint16_t rgb565)
{
    ew_piece *piece = piece_of(raster);
    piece->n = EW_PIECE;
    ew_piece_paint(piece, &raster->target, rgb565);
    piece->live = 0xFF;
    piece->n = 0;
    piece->x = piece->y = 0;
    return piece;
}

/* Stores a piece whose colours are all `rgb565`. */
static void put_paint(const ew_raster *raster, const ew_piece *piece, uint16_t rgb565)
{
    const ew_target *target = &raster->target;
    if (!ew_target_takes_words(target)) {
        ew_target_put(target, piece, EW_BLEND_NONE);
        return;
    }
    uint16_t *words = ew_target_words(target, piece->y) + piece->x;
    for (int i = 0; i < piece->n; i++) {
        if (piece->live >> i & 1) words[i] = rgb565;
    }
}

/* Moves to the piece of a row that begins at x and ends before x1; n is EW_PIECE but for the last. */
static void move_to(ew_piece *piece, uint16_t x, uint16_t y, uint16_t x1)
{
    piece->x = x;
    piece->y = y;
    piece->n = (int)(x1 - x) < EW_PIECE ? (int)(x1 - x) : EW_PIECE;
}

static int check_blend(uint8_t blend)
{
    if (blend > EW_BLEND_ADD) return EW_ERR_ARGUMENT;
    return !EW_WITH_BLENDS && blend ? EW_ERR_UNSUPPORTED : EW_OK;
}

/* ---- rectangles ---- */

int ew_draw_rect(ew_raster *raster, int16_t x, int16_t y, uint16_t width, uint16_t height, uint16_t rgb565,
                 uint8_t blend)
{
    ew_rect r;
    const int error = check_blend(blend);
    if (error || !clip(raster, x, y, width, height, &r)) return error;
    if (!blend) {
        ew_raster_fill(raster, &r, rgb565, NULL);
        return EW_OK;
    }
    ew_piece *piece = paint(raster, rgb565);
    for (uint16_t row = r.y0; row < r.y1; row++) {
        for (uint16_t at = r.x0; at < r.x1; at = (uint16_t)(at + EW_PIECE)) {
            move_to(piece, at, row, r.x1);
            ew_target_put(&raster->target, piece, blend);
        }
    }
    return EW_OK;
}

/* ---- lines ---- */

/* A line is `length` steps along one axis, the major one, in its growing direction. After k of
 * them it has moved across by
 *
 *     offset(k) = floor((k rise + bias) / length),  bias = floor((length - 1) / 2) or floor(length / 2)
 *
 * pixels, where 0 <= rise <= length: k rise / length rounded to nearest. Of two equally near
 * pixels the one of the larger coordinate is wanted: the farther one where the line goes that
 * way, or else the nearer one, which is what the smaller bias is for.
 *
 * Lengths are 65,535 at most, so k rise + bias <= 65535^2 + 32767 < 2^32. */
typedef struct line {
    uint32_t length, rise, bias;
} line;

/* The first step with an offset of at least `offset`, which is 1 to rise:
 * k rise >= offset length - bias. The sum is at most 65535^2 + 65534 < 2^32. */
static int32_t step_of(const line *l, int32_t offset)
{
    return (int32_t)(((uint32_t)offset * l->length - l->bias + l->rise - 1u) / l->rise);
}

/* The next pixel of a line, which is put together with others to the left of it. */
static void plot(const ew_raster *raster, ew_piece *piece, int32_t x, int32_t y, uint16_t rgb565)
{
    if (piece->n == EW_PIECE || y != piece->y || x != (int32_t)piece->x + piece->n) {
        if (piece->n) put_paint(raster, piece, rgb565);
        piece->x = (uint16_t)x;
        piece->y = (uint16_t)y;
        piece->n = 0;
    }
    piece->n++;
}

void ew_draw_line(ew_raster *raster, int16_t x0, int16_t y0, int16_t x1, int16_t y1, uint16_t rgb565)
{
    const ew_rect *s = &raster->scissor;
    const int32_t dx = (int32_t)x1 - x0, dy = (int32_t)y1 - y0;
    const int steep = (dy < 0 ? -dy : dy) > (dx < 0 ? -dx : dx), back = steep ? dy < 0 : dx < 0;
    /* along the major axis, across it, and the scissor likewise */
    const int32_t along = steep ? (back ? y1 : y0) : (back ? x1 : x0), across = steep ? (back ? x1 : x0) : (back ? y1 : y0);
    const int32_t along_from = steep ? s->y0 : s->x0, along_to = steep ? s->y1 : s->x1;
    const int32_t across_from = steep ? s->x0 : s->y0, across_to = steep ? s->x1 : s->y1;
    const int32_t length = steep ? (back ? -dy : dy) : (back ? -dx : dx);
    const int32_t risen = steep ? (back ? -dx : dx) : (back ? -dy : dy), turn = risen < 0 ? -1 : 1;
    const line l = { (uint32_t)length, (uint32_t)(risen * turn), (uint32_t)(length - (risen < 0)) / 2u };

    /* steps and offsets inside the scissor */
    int32_t first = larger(0, along_from - along), last = smaller(length, along_to - 1 - along);
    const int32_t enter = turn > 0 ? across_from - across : across - across_to + 1;
    const int32_t leave = turn > 0 ? across_to - 1 - across : across - across_from;
    if (enter > (int32_t)l.rise || leave < 0) return;
    if (enter > 0) first = larger(first, step_of(&l, enter));
    if (leave < (int32_t)l.rise) last = smaller(last, step_of(&l, leave + 1) - 1);
    if (first > last) return;

    ew_piece *piece = paint(raster, rgb565);
    const uint32_t sum = (uint32_t)first * l.rise + l.bias;
    uint32_t offset = length ? sum / l.length : 0, rest = sum - offset * l.length;
    for (int32_t k = first; k <= last; k++) {
        const int32_t a = along + k, b = across + turn * (int32_t)offset;
        plot(raster, piece, steep ? b : a, steep ? a : b, rgb565);
        rest += l.rise; /* below 2 length */
        if (rest >= l.length) rest -= l.length, offset++;
    }
    put_paint(raster, piece, rgb565);
}

/* ---- sprites ---- */

static int check_sprite(const ew_sprite *sprite, ew_rect *part)
{
    const ew_texture *t = sprite->texture;
    *part = sprite->part;
    if (!t || (sprite->flags & ~(EW_COLOUR_KEY | EW_ALPHA_MASK))) return EW_ERR_ARGUMENT;
    int error = ew_texture_check_stored(t, sprite->flags);
    if (error) return error;
    if (!(part->x0 | part->y0 | part->x1 | part->y1)) {
        part->x1 = t->width;
        part->y1 = t->height;
    }
    if (part->x0 > part->x1 || part->y0 > part->y1 || part->x1 > t->width || part->y1 > t->height) return EW_ERR_ARGUMENT;
    return check_blend(sprite->blend);
}

/* The piece's colours from texels of one row, the first one of `column`. */
static void fetch_piece(const ew_sampler *s, ew_piece *piece, uint32_t column, uint32_t row)
{
    unsigned live = 0;
    for (int i = 0; i < piece->n; i++, column++) {
        if (ew_texture_texel(s, column, row, piece->colour[i])) live |= 1u << i;
    }
    piece->live = (uint8_t)live;
}

/* Texels of RGB565 into a target of the same, from the texel at (column, row) on. */
static void copy_words(const ew_target *target, const ew_rect *r, const ew_sprite *sprite, uint32_t column, uint32_t row)
{
    const ew_texture *t = sprite->texture;
    const int keyed = sprite->flags & EW_COLOUR_KEY;
    const uint16_t *from = (const uint16_t *)t->texels + (size_t)row * t->width + column;
    const int n = (int)(r->x1 - r->x0);
    for (uint16_t y = r->y0; y < r->y1; y++, from += t->width) {
        uint16_t *to = ew_target_words(target, y) + r->x0;
        for (int i = 0; i < n; i++) {
            if (!keyed || from[i] != t->key) to[i] = from[i];
        }
    }
}

int ew_draw_sprite(ew_raster *raster, const ew_sprite *sprite, int16_t x, int16_t y)
{
    ew_rect part, r;
    const int error = check_sprite(sprite, &part);
    if (error || !clip(raster, x, y, part.x1 - part.x0, part.y1 - part.y0, &r)) return error;
    const uint32_t column = (uint32_t)((int32_t)part.x0 + r.x0 - x);
    uint32_t row = (uint32_t)((int32_t)part.y0 + r.y0 - y);
    if (ew_target_takes_words(&raster->target) && sprite->texture->format == EW_TEXTURE_RGB565 &&
        !(sprite->flags & EW_ALPHA_MASK) && !sprite->blend) {
        copy_words(&raster->target, &r, sprite, column, row);
        return EW_OK;
    }
    ew_piece *piece = piece_of(raster);
    ew_sampler *s = &raster->work.now.span.fill.any.sampler;
    ew_texture_open(s, sprite->texture, sprite->flags, ew_wide(&raster->target));
    for (uint16_t down = r.y0; down < r.y1; down++, row++) {
        for (uint16_t at = r.x0; at < r.x1; at = (uint16_t)(at + EW_PIECE)) {
            move_to(piece, at, down, r.x1);
            fetch_piece(s, piece, column + at - r.x0, row);
            ew_target_put(&raster->target, piece, sprite->blend);
        }
    }
    return EW_OK;
}

/* ---- text ---- */

static int check_font(const ew_font *font)
{
    return font->glyphs && font->width && font->height && font->first <= font->unknown && font->unknown <= font->last ?
               EW_OK : EW_ERR_ARGUMENT;
}

static uint32_t row_bytes_of(const ew_font *font) { return ((uint32_t)font->width + 7u) >> 3; }

static const uint8_t *glyph_of(const ew_font *font, char c)
{
    uint8_t code = (uint8_t)c;
    if (code < font->first || code > font->last) code = font->unknown;
    return font->glyphs + (size_t)(code - font->first) * (1u + font->height * row_bytes_of(font));
}

static int32_t width_of(const ew_font *font, const uint8_t *glyph) { return smaller(*glyph, font->width); }

static void draw_glyph(ew_raster *raster, const ew_font *font, const uint8_t *glyph, int32_t x, int32_t y, uint16_t rgb565)
{
    ew_rect r;
    if (!clip(raster, x, y, width_of(font, glyph), font->height, &r)) return;
    ew_piece *piece = piece_of(raster);
    for (uint16_t row = r.y0; row < r.y1; row++) {
        const uint8_t *bits = glyph + 1 + (uint32_t)(row - y) * row_bytes_of(font);
        for (uint16_t at = r.x0; at < r.x1; at = (uint16_t)(at + EW_PIECE)) {
            unsigned live = 0;
            move_to(piece, at, row, r.x1);
            for (int i = 0; i < piece->n; i++) live |= (unsigned)ew_packed_get(bits, (uint32_t)(at - x + i), 0) << i;
            piece->live = (uint8_t)live;
            if (live) put_paint(raster, piece, rgb565);
        }
    }
}

int ew_draw_text(ew_raster *raster, const ew_font *font, int16_t x, int16_t y, const char *text, uint16_t rgb565)
{
    const int error = check_font(font);
    if (error) return error;
    paint(raster, rgb565);
    int32_t at_x = x, at_y = y;
    for (; *text && at_y < raster->scissor.y1; text++) {
        if (*text == '\n') {
            at_x = x;
            at_y += font->line;
        } else if (at_x < raster->scissor.x1) { /* what lies beyond is not counted on: no sum grows for ever */
            const uint8_t *glyph = glyph_of(font, *text);
            draw_glyph(raster, font, glyph, at_x, at_y, rgb565);
            at_x += width_of(font, glyph) + font->gap;
        }
    }
    return EW_OK;
}

int32_t ew_text_width(const ew_font *font, const char *text)
{
    const int error = check_font(font);
    if (error) return error;
    uint32_t widest = 0, at = 0;
    for (; *text; text++) {
        if (*text == '\n') {
            at = 0;
        } else {
            at += (uint32_t)width_of(font, glyph_of(font, *text));
            if (at > INT32_MAX) return INT32_MAX;
            if (at > widest) widest = at;
            at += font->gap;
        }
    }
    return (int32_t)widest;
}
