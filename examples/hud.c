/* A HUD over a baked scene: hud SCENE.ewb FILE.png. Text, rectangles, lines and sprites of
 * edgewalk/draw2d.h, drawn into the picture when the scene is in it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edgewalk/draw2d.h"
#include "tools/common/image.h"
#include "tools/common/player.h"

enum { WIDTH = 320, HEIGHT = 240, FRAME = 25, FRAMES = 100, HUD = 0x07E6, WARNING = 0xFD20, WHITE = 0xFFFF, BLACK = 0 };

/* ---- a sprite of four colours, drawn by hand; 0 is left out ---- */

enum { HEART = 11, HEARTS = 3 };
static const char drawing[HEART][HEART + 1] = {
    "...........", "..111.111..", ".1222132221", "12332122221", "12322222221", "12222222221",
    ".122222221.", "..1222221..", "...12221...", "....121....", ".....1.....",
};
static const uint16_t palette[16] = { 0xF81F, 0x2000, 0xE8E4, 0xFE79 };
static uint8_t texels[HEART][(HEART + 1) / 2]; /* two to a byte */

static void make_sprite(void)
{
    for (int y = 0; y < HEART; y++) {
        for (int x = 0; x < HEART; x++) {
            const int number = drawing[y][x] == '.' ? 0 : drawing[y][x] - '0';
            texels[y][x / 2] = (uint8_t)(texels[y][x / 2] | number << (x % 2 ? 0 : 4));
        }
    }
}

/* ---- parts of the HUD ---- */

static int failures;

static void hold(int error)
{
    if (error) failures++;
}

static void text_at(ew_raster *raster, int x, int y, const char *text, uint16_t colour)
{
    hold(ew_draw_text(raster, &ew_font_small, (int16_t)(x + 1), (int16_t)(y + 1), text, BLACK)); /* its shadow */
    hold(ew_draw_text(raster, &ew_font_small, (int16_t)x, (int16_t)y, text, colour));
}

/* Darkens what is below it to a half, with a border. */
static void panel(ew_raster *raster, int x, int y, int width, int height)
{
    const int16_t x0 = (int16_t)x, y0 = (int16_t)y, x1 = (int16_t)(x + width - 1), y1 = (int16_t)(y + height - 1);
    hold(ew_draw_rect(raster, x0, y0, (uint16_t)width, (uint16_t)height, BLACK, EW_BLEND_HALF));
    ew_draw_line(raster, x0, y0, x1, y0, HUD);
    ew_draw_line(raster, x1, y0, x1, y1, HUD);
    ew_draw_line(raster, x1, y1, x0, y1, HUD);
    ew_draw_line(raster, x0, y1, x0, y0, HUD);
}

static void sights(ew_raster *raster, int x, int y)
{
    static const int8_t ring[][2] = { { 30, 0 }, { 26, 15 }, { 15, 26 }, { 0, 30 }, { -15, 26 }, { -26, 15 },
                                      { -30, 0 }, { -26, -15 }, { -15, -26 }, { 0, -30 }, { 15, -26 }, { 26, -15 } };
    for (int i = 0; i < 12; i++) {
        const int8_t *a = ring[i], *b = ring[(i + 1) % 12];
        ew_draw_line(raster, (int16_t)(x + a[0]), (int16_t)(y + a[1]), (int16_t)(x + b[0]), (int16_t)(y + b[1]), HUD);
        if (i % 3 == 0) ew_draw_line(raster, (int16_t)(x + a[0] * 3 / 2), (int16_t)(y + a[1] * 3 / 2), (int16_t)(x + a[0] / 2), (int16_t)(y + a[1] / 2), HUD);
    }
}

/* Lines at the angles of a fan, most of which leave the scissor. */
static void fan(ew_raster *raster, int x, int y, int size)
{
    const ew_rect inside = { (uint16_t)x, (uint16_t)y, (uint16_t)(x + size), (uint16_t)(y + size) };
    const ew_rect whole = { 0, 0, WIDTH, HEIGHT };
    panel(raster, x - 1, y - 1, size + 2, size + 2);
    hold(ew_raster_set_scissor(raster, &inside));
    for (int i = 0; i <= 12; i++) {
        ew_draw_line(raster, (int16_t)x, (int16_t)(y + size), (int16_t)(x + 100 * i), (int16_t)(y + size - 100 * (12 - i)), i % 3 ? HUD : WARNING);
    }
    hold(ew_raster_set_scissor(raster, &whole));
}

static void draw_hud(ew_raster *raster, const char *figures)
{
    const ew_texture heart = { .texels = texels, .width = HEART, .height = HEART, .palette = palette, .format = EW_TEXTURE_PALETTE4 };
    const ew_sprite sprite = { .texture = &heart, .flags = EW_COLOUR_KEY };
    char all[96];
    panel(raster, 4, 4, WIDTH - 8, 16);
    text_at(raster, 10, 8, "EDGEWALK", WARNING);
    text_at(raster, WIDTH - 10 - ew_text_width(&ew_font_small, figures), 8, figures, WHITE);
    sights(raster, WIDTH / 2, HEIGHT / 2);
    fan(raster, 9, 30, 48);
    for (int i = 0; i < HEARTS; i++) hold(ew_draw_sprite(raster, &sprite, (int16_t)(WIDTH - 24 - 14 * i), 30));
    hold(ew_draw_sprite(raster, &sprite, WIDTH - 6, 50));  /* and three that the picture's borders cut */
    hold(ew_draw_sprite(raster, &sprite, -5, 100));
    hold(ew_draw_sprite(raster, &sprite, 40, HEIGHT - 5));
    panel(raster, 4, HEIGHT - 44, WIDTH - 8, 34);
    for (int line = 0; line < 2; line++) {
        for (int i = 0; i < 48; i++) all[i] = (char)(32 + 48 * line + i);
        all[line ? 47 : 48] = 0;
        text_at(raster, 10, HEIGHT - 39 + 10 * line, all, WHITE);
    }
    text_at(raster, 10, HEIGHT - 19, "what it has no glyph for: \t \xFF", HUD);
}

int main(int argc, char **argv)
{
    static uint16_t pixels[WIDTH * HEIGHT];
    const ew_target target = { .colour = pixels, .width = WIDTH, .height = HEIGHT, .stride = WIDTH };
    char figures[64];
    ew_raster raster;
    if (argc != 3) {
        fprintf(stderr, "usage: hud SCENE.ewb FILE.png\n");
        return 2;
    }
    ew_player *player = ew_player_open("hud", argv[1], WIDTH, HEIGHT);
    if (!player) return 1;
    int failed = ew_player_draw(player, FRAME, FRAMES, 30);
    memcpy(pixels, ew_player_pixels(player), sizeof pixels);
    snprintf(figures, sizeof figures, "frame %d of %d, %d triangles", FRAME, FRAMES, (int)ew_player_drawn(player));
    ew_player_close(player);
    if (failed) return 1;
    make_sprite();
    hold(ew_raster_init(&raster, &target));
    draw_hud(&raster, figures);
    if (failures) {
        fprintf(stderr, "hud: %s: not written: %d calls were refused\n", argv[2], failures);
        return 1;
    }
    return ew_image_write_png("hud", argv[2], pixels, WIDTH, HEIGHT) ? 1 : 0;
}
