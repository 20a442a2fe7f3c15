/* A sheet of all fills, as docs/fills.md lists them: fills FILE.png. Each cell is a floor in
 * perspective, or two, drawn by the core into a target of its own format. */
#include <stdio.h>
#include <string.h>

#include "edgewalk/raster.h"
#include "tools/common/image.h"

enum { CELL = 80, COLUMNS = 6, ROWS = 6, SIZE = 32 };

static uint16_t sheet[ROWS * CELL * COLUMNS * CELL];
static uint16_t memory[CELL * CELL], depth[CELL * CELL];

/* One picture in all formats: a red and blue slope, a yellow frame, a white disc. */
static uint16_t rgb565[SIZE * SIZE * 2], palette[256];
static uint8_t rgb332[SIZE * SIZE], grey8[SIZE * SIZE], palette4[SIZE * SIZE / 2], palette1[SIZE * SIZE / 8], mask[SIZE * SIZE / 8];

static uint16_t colour_at(int x, int y)
{
    int dx = 2 * x - SIZE + 1, dy = 2 * y - SIZE + 1, square = dx * dx + dy * dy;
    if (x < 2 || y < 2 || x >= SIZE - 2 || y >= SIZE - 2) return 0xFFE0;
    if (square < SIZE * SIZE / 4) return 0xFFFF;
    return (uint16_t)(x * 31 / (SIZE - 1) << 11 | 8 << 5 | y * 31 / (SIZE - 1));
}

static void make_textures(void)
{
    static const uint16_t sixteen[16] = { 0x0000, 0xFFFF, 0xFFE0, 0x0107, 0x010F, 0x011F, 0x4107, 0x410F,
                                          0x411F, 0x8107, 0x810F, 0x811F, 0xF907, 0xF90F, 0xF91F, 0x07E0 };
    memcpy(palette, sixteen, sizeof sixteen);
    /* 8-bit numbers: RGB332 again, looked up */
    for (int i = 16; i < 256; i++) palette[i] = (uint16_t)((i >> 5) << 13 | (i >> 2 & 7) << 8 | (i & 3) << 3);
    for (int y = 0; y < SIZE; y++) {
        for (int x = 0; x < SIZE; x++) {
            const int i = y * SIZE + x, r = colour_at(x, y) >> 11, g = colour_at(x, y) >> 5 & 63, b = colour_at(x, y) & 31;
            int nearest = 0, least = 1 << 30;
            rgb565[i] = colour_at(x, y);
            rgb332[i] = (uint8_t)(r >> 2 << 5 | g >> 3 << 2 | b >> 3);
            grey8[i] = (uint8_t)((r * 77 * 8 + g * 150 * 4 + b * 29 * 8) >> 8);
            for (int k = 0; k < 16; k++) {
                int er = r - (sixteen[k] >> 11), eg = g / 2 - (sixteen[k] >> 6 & 31), eb = b - (sixteen[k] & 31);
                if (er * er + eg * eg + eb * eb < least) nearest = k, least = er * er + eg * eg + eb * eb;
            }
            palette4[i / 2] = (uint8_t)(x & 1 ? palette4[i / 2] | nearest : nearest << 4);
            if (grey8[i] > 150) palette1[i / 8] |= (uint8_t)(0x80 >> x % 8);
            if (nearest != 1) mask[i / 8] |= (uint8_t)(0x80 >> x % 8); /* a hole for the disc */
        }
    }
    /* one tint per level, to tell them apart */
    static const uint16_t tints[] = { 0xF800, 0x07E0, 0x001F, 0xFFE0, 0xF81F };
    uint16_t *level = rgb565 + SIZE * SIZE;
    for (int k = 0, size = SIZE / 2; size > 0; level += size * size, size /= 2, k++) {
        for (int i = 0; i < size * size; i++) level[i] = tints[k];
    }
}

/* A floor from near/z = 0.9 below to 0.243, as its width tells; u and v run over `texels`. */
static void draw_floor(ew_raster *raster, int top, int32_t texels, int32_t from)
{
    static const ew_colour888 light[4] = { { 255, 255, 255 }, { 255, 40, 40 }, { 40, 255, 40 }, { 30, 30, 120 } };
    ew_raster_vertex v[4];
    for (int i = 0; i < 4; i++) { /* left far, left near, right near, right far */
        const int near = i == 1 || i == 2, right = i >= 2;
        v[i] = (ew_raster_vertex){
            .x = (right ? 1 : -1) * (near ? 50 * 4096 : 27 * 2048) + CELL / 2 * 4096,
            .y = (near ? CELL - 4 : top) * 4096,
            .w = (uint32_t)((near ? 0.9 : 0.243) * 2147483648.0),
            .u = (from + (right ? texels : 0)) * 4096, .v = (from + (near ? texels : 0)) * 4096,
            .colour = light[i],
        };
    }
    ew_raster_triangle(raster, &v[0], &v[1], &v[2]);
    ew_raster_triangle(raster, &v[0], &v[2], &v[3]);
}

/* What a panel of the target's format shows, as RGB565. */
static uint16_t shown(const ew_target *t, int x, int y)
{
    const uint8_t *bytes = (const uint8_t *)memory;
    const int i = y * CELL + x;
    unsigned v;
    switch (t->format) {
    case EW_TARGET_RGB565: return memory[i];
    case EW_TARGET_RGB565_SWAPPED: return (uint16_t)(memory[i] >> 8 | memory[i] << 8);
    case EW_TARGET_RGB332: v = bytes[i]; return (uint16_t)((v >> 5) * 31 / 7 << 11 | (v >> 2 & 7) * 63 / 7 << 5 | (v & 3) * 31 / 3);
    case EW_TARGET_GREY8: v = bytes[i]; break;
    case EW_TARGET_GREY4: v = (bytes[i / 2] >> (x & 1 ? 0 : 4) & 15u) * 17; break;
    default: v = bytes[i / 8] >> (7 - x % 8) & 1 ? 255 : 0; break;
    }
    return (uint16_t)(v >> 3 << 11 | v >> 2 << 5 | v >> 3);
}

static int failures;

/* Cell n. `second`: a plain floor below, drawn first. */
static void cell(int n, uint8_t format, uint8_t dither, const ew_material *material, int second, int32_t texels, int32_t from)
{
    const ew_target target = { .colour = memory, .depth = depth, .width = CELL, .height = CELL, .stride = CELL, .format = format, .dither = dither };
    const ew_material below = { .colour = 0x4A5F, .rung = EW_RUNG_CONSTANT, .flags = EW_NO_DEPTH_WRITE };
    ew_raster raster;
    const ew_rect inside = { 2, 2, CELL - 2, CELL - 2 };
    if (ew_raster_init(&raster, &target)) failures++;
    ew_raster_clear(&raster, 0xFFFF);
    ew_raster_set_scissor(&raster, &inside);
    ew_raster_clear(&raster, 0x2124);
    if (second) {
        ew_raster_set_material(&raster, &below);
        draw_floor(&raster, CELL / 2, 1, 0);
    }
    if (ew_raster_set_fog(&raster, 0xBDF7, 0x70000000, 0x18000000)) failures++;
    if (ew_raster_set_material(&raster, material)) failures++;
    draw_floor(&raster, 10, texels, from);
    for (int y = 0; y < CELL; y++) {
        for (int x = 0; x < CELL; x++) sheet[(n / COLUMNS * CELL + y) * COLUMNS * CELL + n % COLUMNS * CELL + x] = shown(&target, x, y);
    }
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: fills FILE.png\n");
        return 2;
    }
    make_textures();
    ew_texture t = { .texels = rgb565, .width = SIZE, .height = SIZE, .palette = palette, .mask = mask, .key = 0xFFFF };
    ew_material m = { .texture = &t, .colour = 0xFFFF, .tolerance = 4 }, plain = { .colour = 0xFD20 };
    int n = 0;

    /* light: flat, Gouraud, vertex colour times colour, texture, texture times light, fog */
    cell(n++, 0, 0, &plain, 0, SIZE, 0);
    plain.flags = EW_SHADED, plain.colour = 0xFFFF;
    cell(n++, 0, 0, &plain, 0, SIZE, 0);
    plain.colour = 0xFD20;
    cell(n++, 0, 0, &plain, 0, SIZE, 0);
    cell(n++, 0, 0, &m, 0, SIZE, 0);
    m.flags = EW_SHADED;
    cell(n++, 0, 0, &m, 0, SIZE, 0);
    m.flags = EW_FOG;
    cell(n++, 0, 0, &m, 0, SIZE, 0);

    /* over a blue floor: half, half with dither, additive, key, mask, mask and bilinear */
    m.flags = 0, m.blend = EW_BLEND_HALF;
    cell(n++, 0, 0, &m, 1, SIZE, 0);
    cell(n++, EW_TARGET_GREY4, 1, &m, 1, SIZE, 0);
    m.blend = EW_BLEND_ADD;
    cell(n++, 0, 0, &m, 1, SIZE, 0);
    m.blend = 0, m.flags = EW_COLOUR_KEY;
    cell(n++, 0, 0, &m, 1, SIZE, 0);
    m.flags = EW_ALPHA_MASK;
    cell(n++, 0, 0, &m, 1, SIZE, 0);
    m.filter = EW_FILTER_BILINEAR;
    cell(n++, 0, 0, &m, 1, SIZE, 0);

    /* texture formats */
    const void *const texels[6] = { rgb565, rgb332, grey8, rgb332, palette4, palette1 };
    m.flags = 0, m.filter = 0;
    for (uint8_t format = 0; format < 6; format++) {
        t.format = format, t.texels = texels[format];
        cell(n++, 0, 0, &m, 0, SIZE, 0);
    }
    t.format = 0, t.texels = rgb565;

    /* repeat, clamp, mirror; bilinear; the nearest of tinted levels, and two of them */
    for (uint8_t wrap = 0; wrap < 3; wrap++) {
        t.wrap_u = t.wrap_v = wrap;
        cell(n++, 0, 0, &m, 0, 3 * SIZE, -SIZE);
    }
    t.wrap_u = t.wrap_v = 0, m.filter = EW_FILTER_BILINEAR;
    cell(n++, 0, 0, &m, 0, 12, 0);
    t.levels = 6;
    cell(n++, 0, 0, &m, 0, 6 * SIZE, 0);
    m.filter = EW_FILTER_TRILINEAR;
    cell(n++, 0, 0, &m, 0, 6 * SIZE, 0);

    /* target formats, without and with dither */
    t.levels = 0, m.filter = EW_FILTER_BILINEAR, m.flags = EW_SHADED;
    for (uint8_t dither = 0; dither < 2; dither++) {
        for (uint8_t format = 0; format < 6; format++) cell(n++, format, dither, &m, 0, SIZE, 0);
    }
    if (failures) {
        fprintf(stderr, "fills: %s: not written: %d settings were refused\n", argv[1], failures);
        return 1;
    }
    return ew_image_write_png("fills", argv[1], sheet, COLUMNS * CELL, ROWS * CELL) ? 1 : 0;
}
