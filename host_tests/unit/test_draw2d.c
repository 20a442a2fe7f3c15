/* The 2D layer against a referee that asks of each pixel of the target whether it is drawn, and of
 * docs/fills.md's referee what it becomes then. All memory is compared, borders included. Built
 * once more with all parts of fills left out. */
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edgewalk/draw2d.h"
#include "../reference/ref_fill.h"

enum { W = 40, H = 24, STRIDE_MOST = W + 16, GUARD = 16, SPRITE = 20 };

typedef struct pixels {
    _Alignas(8) uint8_t colour[2 * STRIDE_MOST * H + 2 * GUARD];
    uint16_t depth[STRIDE_MOST * H + 2 * GUARD];
} pixels;

static pixels before, drawn, expected;
static _Alignas(8) uint8_t texels[2 * SPRITE * SPRITE], mask[SPRITE * SPRITE];
static uint16_t palette[256];

static int any(int n) { return (int)(test_random() % (uint32_t)n); }

static void random_bytes(void *memory, size_t n)
{
    for (size_t i = 0; i < n; i++) ((uint8_t *)memory)[i] = (uint8_t)test_random();
}

/* ---- a context and its twin for the referee ---- */

static ew_raster raster;
static ew_target right; /* raster.target, in `expected` */

static void random_context(void)
{
    const int format = EW_WITH_TARGET_FORMATS ? any(6) : 0, per_byte = format == EW_TARGET_GREY4 ? 2 : format == EW_TARGET_MONO ? 8 : 1;
    const int width = 1 + any(W), height = 1 + any(H);
    right = (ew_target){ .colour = expected.colour + GUARD, .depth = any(2) ? expected.depth + GUARD : NULL, .width = (uint16_t)width,
                         .height = (uint16_t)height, .stride = (uint16_t)((width + any(9) + per_byte - 1) / per_byte * per_byte),
                         .format = (uint8_t)format, .dither = (uint8_t)(EW_WITH_DITHER && any(2)), .first_row = (uint16_t)(any(2) ? any(20) : 0) };
    ew_target mine = right;
    mine.colour = drawn.colour + GUARD;
    mine.depth = right.depth ? drawn.depth + GUARD : NULL;
    memset(&raster, 0xA5, sizeof raster);
    assert_int_equal(ew_raster_init(&raster, &mine), EW_OK);
    if (any(2)) {
        const int x0 = any(width + 1), from = any(height + 1), y0 = right.first_row + from;
        const ew_rect scissor = { (uint16_t)x0, (uint16_t)y0, (uint16_t)(x0 + any(width - x0 + 1)), (uint16_t)(y0 + any(height - from + 1)) };
        assert_int_equal(ew_raster_set_scissor(&raster, &scissor), EW_OK);
    }
    const ew_rect *s = &raster.scissor;
    test_context("format %d dither %d of %dx%d from row %d stride %d scissor %d,%d to %d,%d", format, right.dither, width, height,
                 right.first_row, right.stride, s->x0, s->y0, s->x1, s->y1);
}

/* One with room for something, the scissor the whole of it. */
static void roomy_context(void)
{
    do random_context();
    while (right.width < 10 || right.height < 10 || right.first_row);
    const ew_rect whole = { 0, 0, right.width, right.height };
    assert_int_equal(ew_raster_set_scissor(&raster, &whole), EW_OK);
}

static void hold(int error) { assert_int_equal(error, EW_OK); }

static void start(void)
{
    drawn = before;
    expected = before;
}

/* One pixel by the referee of fills, out of a texel where the material has a texture. */
static void put(const ew_material *material, int x, int y, int column, int row)
{
    const ref_fog fog = { 0, 0, 0 };
    ew_material m = *material;
    m.flags |= EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE;
    const ref_run run = { .x = x, .y = y, .n = 1, .u = (int64_t)column << 32, .v = (int64_t)row << 32 };
    ref_fill(&right, &m, &fog, &run, 0);
}

static ew_material plain(uint16_t colour, int blend)
{
    return (ew_material){ .colour = colour, .rung = EW_RUNG_CONSTANT, .blend = (uint8_t)blend };
}

static void compare(void)
{
    if (memcmp(&drawn, &expected, sizeof drawn) == 0) return;
    for (int y = right.first_row; y < right.first_row + right.height; y++) {
        for (int x = 0; x < right.width; x++) {
            unsigned value = ref_read(&raster.target, x, y), wanted = ref_read(&right, x, y);
            if (value != wanted) printf("# pixel %d,%d: %x, expected %x\n", x, y, value, wanted);
        }
    }
    fail_msg("differs from the referee");
}

#define EACH_PIXEL(x, y) \
    for (int y = raster.scissor.y0; y < raster.scissor.y1; y++) \
        for (int x = raster.scissor.x0; x < raster.scissor.x1; x++)

/* A coordinate: mostly near the target, now and then anywhere. */
static int16_t near(int size)
{
    switch (any(16)) {
    case 0: return (int16_t)test_random();
    case 1: return (int16_t)(test_awkward() >> 16);
    case 2: return (int16_t)(any(2) ? INT16_MAX - any(3) : INT16_MIN + any(3));
    default: return (int16_t)(any(3 * size) - size);
    }
}

/* ---- rectangles ---- */

static uint16_t extent(int size) { return (uint16_t)(any(8) ? any(2 * size) : any(2) ? 65535 - any(3) : any(65536)); }

static void rectangles(void **state)
{
    (void)state;
    for (int n = 0; n < 20000; n++) {
        if (n % 500 == 0) random_bytes(&before, sizeof before);
        random_context();
        start();
        const int x = near(right.width), y = near(right.height), blend = EW_WITH_BLENDS ? any(3) : 0;
        const int width = extent(right.width), height = extent(right.height);
        const uint16_t colour = (uint16_t)test_random();
        assert_int_equal(ew_draw_rect(&raster, (int16_t)x, (int16_t)y, (uint16_t)width, (uint16_t)height, colour, (uint8_t)blend), EW_OK);
        const ew_material m = plain(colour, blend);
        EACH_PIXEL(i, j) {
            if (i >= x && i - x < width && j >= y && j - y < height) put(&m, i, j, 0, 0);
        }
        compare();
    }
    for (int blend = 0; blend < 256; blend++) {
        start();
        const int known = blend <= EW_BLEND_ADD, error = known && (!blend || EW_WITH_BLENDS) ? EW_OK : known ? EW_ERR_UNSUPPORTED : EW_ERR_ARGUMENT;
        assert_int_equal(ew_draw_rect(&raster, 0, 0, 5, 5, 0x1234, (uint8_t)blend), error);
        if (error) compare();
    }
}

/* ---- lines ---- */

/* b > 0 */
static int64_t floor_div(int64_t a, int64_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/* The rule as draw2d.h has it: whether (x, y) is the pixel of its column, or of its row, in exact
 * rational numbers: floor(exact + 1/2). */
static int on_line(int64_t x0, int64_t y0, int64_t x1, int64_t y1, int64_t x, int64_t y)
{
    if (llabs(y1 - y0) > llabs(x1 - x0)) return on_line(y0, x0, y1, x1, y, x);
    if (x1 < x0) return on_line(x1, y1, x0, y0, x, y);
    if (x < x0 || x > x1) return 0;
    if (x0 == x1) return y == y0;
    return y == y0 + floor_div(2 * (x - x0) * (y1 - y0) + (x1 - x0), 2 * (x1 - x0));
}

static void check_line(int x0, int y0, int x1, int y1)
{
    const ew_material m = plain((uint16_t)test_random(), 0);
    start();
    ew_draw_line(&raster, (int16_t)x0, (int16_t)y0, (int16_t)x1, (int16_t)y1, m.colour);
    EACH_PIXEL(x, y) {
        if (on_line(x0, y0, x1, y1, x, y)) put(&m, x, y, 0, 0);
    }
    if (memcmp(&drawn, &expected, sizeof drawn)) printf("# line %d,%d to %d,%d\n", x0, y0, x1, y1);
    compare();
}

static void short_lines_exhaustively(void **state)
{
    (void)state;
    random_bytes(&before, sizeof before);
    roomy_context();
    const ew_rect scissor = { 2, 1, 7, 6 };
    assert_int_equal(ew_raster_set_scissor(&raster, &scissor), EW_OK);
    for (int k = 0; k < 12 * 12 * 12 * 12; k++) check_line(k % 12 - 2, k / 12 % 12 - 3, k / 144 % 12 - 2, k / 1728 - 3);
}

static void lines_of_all_lengths(void **state)
{
    (void)state;
    for (int n = 0; n < 20000; n++) {
        if (n % 500 == 0) random_bytes(&before, sizeof before);
        random_context();
        int p[4] = { near(W), near(H), near(W), near(H) };
        if (any(2)) { /* through the picture, from far away to far away */
            const int x = any(W), y = any(H), dx = any(2001) - 1000, dy = any(2001) - 1000, k = any(31), l = any(31);
            p[0] = x - k * dx, p[1] = y - k * dy, p[2] = x + l * dx + any(3), p[3] = y + l * dy + any(3);
        }
        check_line(p[0], p[1], p[2], p[3]);
    }
}

/* The ends of the range, where products are largest. */
static void longest_lines(void **state)
{
    (void)state;
    static const int ends[] = { INT16_MIN, INT16_MIN + 1, -1, 0, 1, W - 1, INT16_MAX - 1, INT16_MAX };
    enum { N = sizeof ends / sizeof *ends };
    random_bytes(&before, sizeof before);
    roomy_context();
    for (int k = 0; k < N * N * N * N; k++) check_line(ends[k % N], ends[k / N % N], ends[k / N / N % N], ends[k / N / N / N]);
}

/* ---- sprites ---- */

static void random_sprite(ew_sprite *sprite, ew_texture *t)
{
    memset(sprite, 0, sizeof *sprite);
    memset(t, 0, sizeof *t);
    t->width = (uint16_t)(1 + any(SPRITE)), t->height = (uint16_t)(1 + any(SPRITE));
    t->format = (uint8_t)(EW_WITH_TEXTURE_FORMATS ? any(6) : 0);
    t->texels = texels, t->mask = mask, t->palette = palette;
    t->key = (uint16_t)(t->format == EW_TEXTURE_RGB565 ? ((const uint16_t *)(const void *)texels)[any(16)] : any(4));
    t->wrap_u = (uint8_t)test_random(), t->wrap_v = (uint8_t)test_random(), t->levels = (uint8_t)test_random(); /* no matter */
    sprite->texture = t;
    sprite->flags = (uint8_t)(EW_WITH_CUTOUTS ? any(4) * EW_COLOUR_KEY : 0);
    sprite->blend = (uint8_t)(EW_WITH_BLENDS ? any(3) : 0);
    if (any(2)) {
        const int x0 = any(t->width + 1), y0 = any(t->height + 1);
        sprite->part = (ew_rect){ (uint16_t)x0, (uint16_t)y0, (uint16_t)(x0 + any(t->width - x0 + 1)), (uint16_t)(y0 + any(t->height - y0 + 1)) };
    }
}

static void sprites(void **state)
{
    (void)state;
    for (int n = 0; n < 20000; n++) {
        if (n % 500 == 0) {
            random_bytes(&before, sizeof before);
            random_bytes(texels, sizeof texels), random_bytes(mask, sizeof mask), random_bytes(palette, sizeof palette);
            for (int i = 0; i < 40; i++) texels[any(sizeof texels)] = (uint8_t)any(4); /* keys that are met */
        }
        ew_sprite sprite;
        ew_texture t;
        random_context();
        random_sprite(&sprite, &t);
        start();
        const int x = near(right.width), y = near(right.height);
        assert_int_equal(ew_draw_sprite(&raster, &sprite, (int16_t)x, (int16_t)y), EW_OK);
        ew_texture clean = t;
        clean.wrap_u = clean.wrap_v = clean.levels = 0;
        const ew_material m = { .texture = &clean, .flags = sprite.flags, .blend = sprite.blend, .rung = EW_RUNG_AFFINE };
        ew_rect part = sprite.part;
        if (!part.x0 && !part.y0 && !part.x1 && !part.y1) part = (ew_rect){ 0, 0, t.width, t.height };
        EACH_PIXEL(i, j) {
            const int column = i - x + part.x0, row = j - y + part.y0;
            if (column >= part.x0 && column < part.x1 && row >= part.y0 && row < part.y1) put(&m, i, j, column, row);
        }
        compare();
    }
}

static void bad_sprites(void **state)
{
    (void)state;
    roomy_context();
    start();
    const ew_texture good = { .texels = texels, .mask = mask, .palette = palette, .width = 8, .height = 8 };
    const ew_sprite whole = { .texture = &good };
    assert_int_equal(ew_draw_sprite(&raster, &whole, INT16_MAX, 0), EW_OK); /* nothing of it is in sight */
    compare();
#define REFUSED(code, ...) \
    do { \
        ew_texture t = good; \
        ew_sprite s = { .texture = &t }; \
        __VA_ARGS__; \
        assert_int_equal(ew_draw_sprite(&raster, &s, 0, 0), code); \
        compare(); \
    } while (0)
    REFUSED(EW_ERR_ARGUMENT, s.texture = NULL);
    REFUSED(EW_ERR_ARGUMENT, t.texels = NULL);
    REFUSED(EW_ERR_ARGUMENT, t.texels = texels + 1);
    REFUSED(EW_ERR_ARGUMENT, t.width = 0);
    REFUSED(EW_ERR_ARGUMENT, t.height = EW_TEXTURE_MAX + 1);
    REFUSED(EW_ERR_ARGUMENT, t.format = 6);
    REFUSED(EW_ERR_ARGUMENT, t.format = EW_TEXTURE_PALETTE4, t.palette = NULL);
    REFUSED(EW_ERR_ARGUMENT, t.mask = NULL, s.flags = EW_ALPHA_MASK);
    REFUSED(EW_ERR_ARGUMENT, s.flags = EW_FOG);
    REFUSED(EW_ERR_ARGUMENT, s.blend = EW_BLEND_ADD + 1);
    REFUSED(EW_ERR_ARGUMENT, s.part = ((ew_rect){ 0, 0, 9, 8 }));
    REFUSED(EW_ERR_ARGUMENT, s.part = ((ew_rect){ 0, 0, 8, 9 }));
    REFUSED(EW_ERR_ARGUMENT, s.part = ((ew_rect){ 5, 0, 4, 8 }));
    REFUSED(EW_ERR_ARGUMENT, s.part = ((ew_rect){ 0, 5, 8, 4 }));
    if (!EW_WITH_TEXTURE_FORMATS) REFUSED(EW_ERR_UNSUPPORTED, t.format = EW_TEXTURE_GREY8);
    if (!EW_WITH_CUTOUTS) REFUSED(EW_ERR_UNSUPPORTED, s.flags = EW_COLOUR_KEY);
    if (!EW_WITH_BLENDS) REFUSED(EW_ERR_UNSUPPORTED, s.blend = EW_BLEND_HALF);
#undef REFUSED
}

/* ---- text ---- */

/* Bit `column` of row `row` of a glyph that begins at `glyph`. */
static int glyph_bit(const ew_font *f, const uint8_t *glyph, int column, int row)
{
    const int bit = 8 + 8 * ((f->width + 7) / 8) * row + column;
    return glyph[bit / 8] >> (7 - bit % 8) & 1;
}

static const uint8_t *glyph_at(const ew_font *f, char c)
{
    const int code = (unsigned char)c, known = code >= f->first && code <= f->last;
    return f->glyphs + ((known ? code : f->unknown) - f->first) * (1 + (f->width + 7) / 8 * f->height);
}

/* Puts all of a text's pixels, those outside of the scissor left out. Returns its width. */
static long expect_text(const ew_font *f, int x, int y, const char *text, uint16_t colour)
{
    const ew_material m = plain(colour, 0);
    const ew_rect *s = &raster.scissor;
    long at_x = x, at_y = y, widest = 0;
    for (; *text; text++) {
        if (*text == '\n') {
            at_x = x, at_y += f->line;
            continue;
        }
        const uint8_t *glyph = glyph_at(f, *text);
        const int width = glyph[0] < f->width ? glyph[0] : f->width;
        for (int row = 0; row < f->height; row++) {
            for (int column = 0; column < width; column++) {
                const long px = at_x + column, py = at_y + row;
                if (px < s->x0 || px >= s->x1 || py < s->y0 || py >= s->y1 || !glyph_bit(f, glyph, column, row)) continue;
                put(&m, (int)px, (int)py, 0, 0);
            }
        }
        if (at_x + width - x > widest) widest = at_x + width - x;
        at_x += width + f->gap;
    }
    return widest;
}

static void check_text(const ew_font *font, int x, int y, const char *text)
{
    const uint16_t colour = (uint16_t)test_random();
    start();
    assert_int_equal(ew_draw_text(&raster, font, (int16_t)x, (int16_t)y, text, colour), EW_OK);
    assert_int_equal(ew_text_width(font, text), expect_text(font, x, y, text, colour));
    compare();
}

static void texts(void **state)
{
    (void)state;
    static uint8_t glyphs[64 * 200];
    char text[48];
    for (int n = 0; n < 20000; n++) {
        if (n % 500 == 0) random_bytes(&before, sizeof before), random_bytes(glyphs, sizeof glyphs);
        random_context();
        ew_font font = ew_font_small;
        if (any(2)) {
            font = (ew_font){ .glyphs = glyphs, .width = (uint8_t)(1 + any(30)), .height = (uint8_t)(1 + any(40)),
                              .gap = (uint8_t)(any(20) ? any(4) : any(256)), .line = (uint8_t)any(50), .first = (uint8_t)any(256) };
            font.last = (uint8_t)(font.first + any(256 - font.first > 60 ? 60 : 256 - font.first));
            font.unknown = (uint8_t)(font.first + any(font.last - font.first + 1));
            for (int i = 0; i <= font.last - font.first; i++) { /* most of them not too wide */
                if (any(8)) glyphs[i * (1 + (font.width + 7) / 8 * font.height)] = (uint8_t)any(font.width + 1);
            }
        }
        const int length = any((int)sizeof text);
        for (int i = 0; i < length; i++) text[i] = (char)(any(12) ? 1 + any(255) : '\n');
        if (any(2)) for (int i = 0; i < length; i++) text[i] = (char)(32 + any(95));
        text[length] = 0;
        check_text(&font, near(right.width), near(right.height), text);
    }
}

/* A text of 2^17 glyphs of 255 columns is 2^25 wide; one of 2^24 is wider than a number. */
static void endless_text(void **state)
{
    (void)state;
    enum { LENGTH = 1 << 24 };
    static uint8_t glyph[1 + 32] = { 255, 0xFF };
    const ew_font font = { .glyphs = glyph, .width = 255, .height = 1, .gap = 255, .line = 255, .first = 7, .last = 7, .unknown = 7 };
    char *text = malloc(LENGTH + 1);
    assert_non_null(text);
    memset(text, 7, LENGTH);
    text[LENGTH] = 0;
    roomy_context();
    start();
    assert_int_equal(ew_text_width(&font, text), INT32_MAX);
    assert_int_equal(ew_draw_text(&raster, &font, INT16_MIN, 0, text, 0), EW_OK);
    memset(text, '\n', LENGTH);
    assert_int_equal(ew_draw_text(&raster, &font, INT16_MIN, INT16_MIN, text, 0), EW_OK);
    text[1 << 17] = 0;
    memset(text, 7, 1 << 17);
    assert_int_equal(ew_text_width(&font, text), (1 << 17) * 510 - 255);
    free(text);
}

static void bad_fonts(void **state)
{
    (void)state;
    roomy_context();
    start();
#define REFUSED(...) \
    do { \
        ew_font f = ew_font_small; \
        __VA_ARGS__; \
        assert_int_equal(ew_draw_text(&raster, &f, 0, 0, "A", 0), EW_ERR_ARGUMENT); \
        assert_int_equal(ew_text_width(&f, "A"), EW_ERR_ARGUMENT); \
        compare(); \
    } while (0)
    REFUSED(f.glyphs = NULL);
    REFUSED(f.width = 0);
    REFUSED(f.height = 0);
    REFUSED(f.first = 127);
    REFUSED(f.unknown = 31);
    REFUSED(f.unknown = 127);
#undef REFUSED
}

/* The drawing of the small font, read here once more: glyph i of a band stands between blanks. */
static void small_font_is_as_drawn(void **state)
{
    (void)state;
    static char rows[8][256];
    FILE *file = fopen("src/raster/font.txt", "r");
    assert_non_null(file);
    char line[256];
    int glyphs = 0;
    while (fgets(line, sizeof line, file)) {
        char *end;
        long code = strtol(line, &end, 10);
        if (end == line || *end != '\n') continue;
        for (int r = 0; r < 8; r++) assert_non_null(fgets(rows[r], sizeof rows[r], file));
        for (char *at = rows[0]; *at != '\n' && *at; code++, glyphs++) {
            const int from = (int)(at - rows[0]), width = (int)strcspn(at, " \n");
            const uint8_t *glyph = glyph_at(&ew_font_small, (char)code);
            test_context("code %ld", code);
            assert_int_equal(glyph[0], width);
            for (int r = 0; r < 8; r++) {
                for (int c = 0; c < 8; c++) assert_int_equal(glyph_bit(&ew_font_small, glyph, c, r), c < width && rows[r][from + c] == '#');
            }
            at += width + (at[width] == ' ');
        }
    }
    fclose(file);
    assert_int_equal(glyphs, 95);
    for (int code = '0'; code <= '9'; code++) assert_int_equal(glyph_at(&ew_font_small, (char)code)[0], 5);
}

/* ---- bands ---- */

/* A little of everything, the same for each seed. */
static void some_hud(uint64_t seed)
{
    ew_sprite sprite;
    ew_texture t;
    test_restart(seed);
    for (int i = 0; i < 6; i++) {
        const int16_t x = (int16_t)(any(2 * W) - W / 2), y = (int16_t)(any(2 * H) - H / 2);
        const uint16_t colour = (uint16_t)test_random();
        random_sprite(&sprite, &t);
        hold(ew_draw_rect(&raster, x, y, (uint16_t)any(W), (uint16_t)any(H), colour, EW_WITH_BLENDS ? (uint8_t)any(3) : 0));
        ew_draw_line(&raster, x, y, (int16_t)any(2 * W), (int16_t)any(H), (uint16_t)~colour);
        hold(ew_draw_sprite(&raster, &sprite, y, x));
        hold(ew_draw_text(&raster, &ew_font_small, (int16_t)(x / 2), (int16_t)(y / 2), "a\nHUD 123", colour));
    }
}

/* Drawn once for each band of a picture, a HUD is the same as drawn once. */
static void bands(void **state)
{
    (void)state;
    int empty = 0;
    for (uint64_t n = 0; n < 2000; n++) {
        test_restart(n);
        random_bytes(&before, sizeof before);
        roomy_context();
        start();
        const int rows = 1 + any(right.height);
        const size_t row_bytes = ref_row_bytes(right.stride, ref_target_bits(right.format));
        some_hud(n);
        expected = drawn;
        drawn = before;
        for (int row = 0; row < right.height; row += rows) {
            const int height = row + rows < right.height ? rows : right.height - row;
            uint16_t *depth = right.depth ? drawn.depth + GUARD + row * right.stride : NULL;
            hold(ew_raster_set_rows(&raster, drawn.colour + GUARD + (size_t)row * row_bytes, depth, (uint16_t)row, (uint16_t)height));
            some_hud(n);
        }
        assert_memory_equal(&drawn, &expected, sizeof drawn);
        empty += memcmp(&drawn, &before, sizeof drawn) == 0;
    }
    assert_true(empty < 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(rectangles), TEST(short_lines_exhaustively), TEST(lines_of_all_lengths), TEST(longest_lines),
        TEST(sprites), TEST(bad_sprites), TEST(texts), TEST(endless_text), TEST(bad_fonts), TEST(small_font_is_as_drawn), TEST(bands),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
