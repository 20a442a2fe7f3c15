/* The 2D layer on a 64x48 picture in four bands, in every target format; packing; changed rows. */
#include "same_bits.h"

#include "../../examples/firmware/picture_hash.h"
#include "edgewalk/draw2d.h"
#include "edgewalk/panel.h"

enum { WIDTH = 64, BAND_ROWS = 12, BANDS = 4, SHAPES = 12, TEXTURE = 8 };

/* There is no depth here: its memory has the texture, and a row's packed pixels. */
static uint16_t *const texels = same_picture.depth, *const row = same_picture.depth + TEXTURE * TEXTURE;

static int16_t any_position(generator *g) { return (int16_t)random_between(g, -24, 88); }

/* The ends of the range among them: there, 16 bits are not enough for a difference. */
static int16_t far_position(generator *g)
{
    return (int16_t)(random32(g) % 2 ? random_between(g, -32768, 32767) : random_between(g, 0, 1) ? 32767 : -32768);
}

/* Returns what went wrong. */
static int draw_shapes(ew_raster *raster)
{
    generator g = { 88675123u };
    int wrong = 0;
    for (int i = 0; i < SHAPES; i++) {
        const uint16_t colour = (uint16_t)random32(&g);
        const int16_t x = any_position(&g), y = any_position(&g), far_x = far_position(&g), far_y = far_position(&g);
        const uint16_t width = (uint16_t)random_between(&g, 0, 30), height = (uint16_t)random_between(&g, 0, 30);
        const ew_texture texture = { .texels = texels, .palette = texels, .mask = (const uint8_t *)texels, .width = TEXTURE,
                                     .height = TEXTURE, .key = texels[0], .format = (uint8_t)(i % 6) };
        const ew_sprite sprite = { .texture = &texture, .flags = (uint8_t)(i % 4 * EW_COLOUR_KEY), .blend = (uint8_t)(i % 3) };
        wrong |= ew_draw_rect(raster, x, y, width, height, colour, (uint8_t)(i % 3));
        ew_draw_line(raster, x, y, far_x, far_y, (uint16_t)~colour);
        ew_draw_line(raster, far_y, far_x, far_x, y, colour);
        wrong |= ew_draw_sprite(raster, &sprite, y, x);
        wrong |= ew_draw_text(raster, &ew_font_small, (int16_t)(x / 2), (int16_t)(y / 2), "0 HUD\n {y}", colour);
    }
    return wrong;
}

static uint32_t draw(uint8_t format, uint8_t dither)
{
    static const uint8_t bits[] = { 16, 16, 8, 8, 4, 1 }; /* of a pixel, by ew_target_format */
    const uint32_t units = WIDTH * BAND_ROWS / 16 * bits[format];
    uint32_t hash = PICTURE_HASH_START;
    ew_target target = { .colour = same_picture.colour, .width = WIDTH, .height = BAND_ROWS, .stride = WIDTH, .format = format,
                         .dither = dither };
    for (int band = 0; band < BANDS; band++) {
        target.first_row = (uint16_t)(band * BAND_ROWS);
        int error = ew_raster_init(&same_raster, &target);
        if (!error) {
            ew_raster_clear(&same_raster, 0x18E3);
            error = draw_shapes(&same_raster);
        }
        if (error) print_failure("hud", ew_error_text(error));
        hash = picture_hash(hash, same_picture.colour, units);
    }
    return hash;
}

/* Rows of the picture as it is, packed one after the other. */
static uint32_t pack(size_t (*function)(const uint16_t *, size_t, uint8_t *))
{
    uint32_t hash = PICTURE_HASH_START;
    for (int i = 0; i < BAND_ROWS; i++) {
        size_t bytes = function(same_picture.colour + i * WIDTH, WIDTH, (uint8_t *)row);
        uint8_t *end = (uint8_t *)row + bytes;
        for (uint8_t *at = (uint8_t *)row; at < end; at += 2) { /* one order of bytes for all */
            const uint16_t unit = (uint16_t)((uint16_t)at[0] << 8 | at[1]);
            hash = picture_hash(hash, &unit, 1);
        }
    }
    return hash;
}

/* The hashes of rows. */
static uint32_t hash_rows(void)
{
    uint32_t hashes[BAND_ROWS] = { 0 };
    const ew_frame_rows frame = { .pixels = same_picture.colour, .hashes = hashes, .stride = 2 * WIDTH, .columns = WIDTH,
                                  .rows = BAND_ROWS, .column_bytes = 2 };
    ew_changed found;
    uint32_t hash = PICTURE_HASH_START;
    if (ew_changed_next(&frame, 0, &found) != 1 || found.y1 != BAND_ROWS || ew_changed_next(&frame, 0, &found) != 0) {
        print_failure("hud", "changed rows");
    }
    for (int i = 0; i < BAND_ROWS; i++) {
        const uint16_t halves[2] = { (uint16_t)(hashes[i] >> 16), (uint16_t)hashes[i] };
        hash = picture_hash(hash, halves, 2);
    }
    return hash;
}

void hud_bits(void)
{
    static const char *const formats[] = { "rgb565", "swapped", "rgb332", "grey8", "grey4", "mono" };
    generator g = { 7 };
    for (unsigned i = 0; i < TEXTURE * TEXTURE; i++) texels[i] = (uint16_t)random32(&g);
    for (uint8_t format = EW_TARGET_MONO; format > 0; format--) print_hash("hud", formats[format], -1, "64x48", draw(format, format % 2));
    print_hash("hud", formats[0], -1, "64x48", draw(EW_TARGET_RGB565, 0)); /* the last: its lowest band is there to be packed */
    print_hash("hud", "rgb666", -1, "64x48", pack(ew_pack_rgb666));
    print_hash("hud", "rgb444", -1, "64x48", pack(ew_pack_rgb444));
    print_hash("hud", "row-hashes", -1, "64x48", hash_rows());
}
