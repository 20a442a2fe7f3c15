/* A set of triangles on a 64x48 picture with a 16x16 texture, small enough for 8 KB of RAM:
 * four bands of twelve rows. */
#include "same_bits.h"

#include "../../examples/firmware/picture_hash.h"
#include "edgewalk/raster.h"

enum { WIDTH = 64, BAND_ROWS = 12, BANDS = 4, TRIANGLES = 8, TEXTURE = 16, LEVELS = 5 };

/* The texture with its mip levels; its first 256 entries serve as palette and mask, too. */
static uint16_t texels[256 + 64 + 16 + 4 + 1];

/* One way to draw the set. Zeros: the rung is chosen, everything is RGB565, nothing else happens. */
typedef struct triangle_case {
    const char *method;
    uint8_t rung, tolerance;
    uint8_t flags, blend, filter;
    uint8_t texture_format, wrap, levels;
    uint8_t target_format;
    uint8_t dither : 1;
    uint8_t small : 1; /* many of a few pixels, in a scissor that cuts them on all sides */
    uint8_t large : 1; /* many in a picture of 320 x 240, which reach far over its borders */
    uint8_t dear : 1;  /* runs are: short ones are drawn pixel by pixel */
} triangle_case;

/* More than 1 is a failure: machine code once returned how many rows it had drawn. */
static int checked(int result)
{
    return result > 1 ? -result : result;
}

/* Most are of the picture's size and many reach over its borders; near/z over a range of 32. */
static void any_corner(generator *g, ew_raster_vertex *corner)
{
    corner->x = random_between(g, -20 * INT32_C(4096), 84 * INT32_C(4096));
    corner->y = random_between(g, -20 * INT32_C(4096), 68 * INT32_C(4096));
    corner->w = (UINT32_C(1) << 31) >> random_between(g, 0, 4);
    corner->w -= random32(g) % (corner->w / 2u);
    corner->u = random_between(g, -64 * INT32_C(4096), 64 * INT32_C(4096));
    corner->v = random_between(g, -64 * INT32_C(4096), 64 * INT32_C(4096));
    uint32_t colour = random32(g);
    corner->colour.r = (uint8_t)colour;
    corner->colour.g = (uint8_t)(colour >> 8);
    corner->colour.b = (uint8_t)(colour >> 16);
}

/* Up to 16 px a side, near/z over a factor of 2. */
static void any_small(generator *g, ew_raster_vertex corner[3])
{
    const int32_t x = random_between(g, 0, 64 * INT32_C(4096)), y = random_between(g, 0, 48 * INT32_C(4096));
    for (int k = 0; k < 3; k++) {
        any_corner(g, &corner[k]);
        corner[k].x = x + random_between(g, -8 * INT32_C(4096), 8 * INT32_C(4096));
        corner[k].y = y + random_between(g, -8 * INT32_C(4096), 8 * INT32_C(4096));
        corner[k].w = (UINT32_C(1) << 29) + random32(g) % (UINT32_C(1) << 29);
    }
}

static int draw_small(uint16_t row)
{
    enum { COUNT = 300 };
    const ew_rect scissor = { 5, (uint16_t)(row + 1), WIDTH - 7, (uint16_t)(row + BAND_ROWS - 2) };
    generator g = { 88675123u };
    int drawn = 0, result = ew_raster_set_scissor(&same_raster, &scissor);
    for (int i = 0; i < COUNT && result >= 0; i++) {
        ew_raster_vertex corner[3];
        any_small(&g, corner);
        result = checked(ew_raster_triangle(&same_raster, &corner[0], &corner[1], &corner[2]));
        drawn += result > 0;
    }
    return result < 0 || drawn < TRIANGLES ? -1 : 0;
}

#if SAME_BITS_ROOM >= 3
/* In front of each other, as they come: with u and v over few, some and many texels, of which the last need the better
 * reciprocal; or smaller ones whose 1/z nearly runs out at the far end. */
static uint32_t draw_large(const ew_material *material, int dear)
{
    enum { COUNT = 300 };
    static const ew_cost dear_runs = { .run = 2000, .run_pixel = 15, .pixel = 100 };
    const ew_target target = { .colour = same_picture.colour, .depth = same_picture.depth, .width = 320, .height = 240,
                               .stride = 320 };
    /* in its lowest rows 1/z is so small at the left that runs may not be moved, unlike those above */
    static const ew_raster_vertex steep[3] = {
        { .x = 18 * INT32_C(4096), .y = 10 * INT32_C(4096), .w = UINT32_C(1) << 27 },
        { .x = 10 * INT32_C(4096), .y = 60 * INT32_C(4096), .w = UINT32_C(1) << 20, .u = 100 * INT32_C(4096) },
        { .x = 26 * INT32_C(4096), .y = 60 * INT32_C(4096), .w = UINT32_C(1) << 27, .v = 100 * INT32_C(4096) },
    };
    /* on the affine rung some of its spans are just as long as one run may be: once that was another number here and there */
    static const ew_raster_vertex cut[3] = {
        { .w = UINT32_C(1) << 29 },
        { .x = 257 * INT32_C(4096), .w = UINT32_C(1) << 29, .u = 2125 * INT32_C(4096), .v = 333 * INT32_C(4096) },
        { .x = 100 * INT32_C(4096), .y = 3000 * INT32_C(4096), .w = UINT32_C(1) << 29, .u = 555 * INT32_C(4096),
          .v = 999 * INT32_C(4096) },
    };
    generator g = { 362436069u };
    int drawn = 0, result = ew_raster_init(&same_raster, &target);
    if (!result) result = ew_raster_set_material(&same_raster, material);
    if (!result && dear) result = ew_raster_set_cost(&same_raster, &dear_runs);
    ew_raster_clear(&same_raster, 0x18E3);
    if (!result) result = checked(ew_raster_triangle(&same_raster, &steep[0], &steep[1], &steep[2]));
    if (result >= 0) result = checked(ew_raster_triangle(&same_raster, &cut[0], &cut[1], &cut[2]));
    const uint32_t hash = picture_hash(PICTURE_HASH_START, same_picture.colour, 320 * 240); /* others will lie in front */
    for (int i = 0; i < COUNT && result >= 0; i++) {
        ew_raster_vertex corner[3];
        const int32_t texels_more = i % 3 == 2 ? 16 : 1 + i % 3 * 5;
        const int32_t x = random_between(&g, 0, 320 * INT32_C(4096)), y = random_between(&g, 0, 240 * INT32_C(4096));
        for (int k = 0; k < 3; k++) {
            any_corner(&g, &corner[k]);
            corner[k].w >>= 1; /* depth stays inside its range, as special loops want it */
            if (i % 4 == 3) {
                corner[k].x = x + random_between(&g, -40 * INT32_C(4096), 40 * INT32_C(4096));
                corner[k].y = y + random_between(&g, -40 * INT32_C(4096), 40 * INT32_C(4096));
                corner[k].w >>= random_between(&g, 0, 8);
            } else {
                corner[k].x = random_between(&g, -200 * INT32_C(4096), 520 * INT32_C(4096));
                corner[k].y = random_between(&g, -100 * INT32_C(4096), 340 * INT32_C(4096));
                corner[k].u *= texels_more;
                corner[k].v *= texels_more;
            }
        }
        result = checked(ew_raster_triangle(&same_raster, &corner[0], &corner[1], &corner[2]));
        drawn += result > 0;
    }
    if (result < 0 || drawn < COUNT / 4) print_failure("large triangles", ew_error_text(result));
    return picture_hash(picture_hash(hash, same_picture.colour, 320 * 240), same_picture.depth, 320 * 240);
}
#endif

static uint32_t draw(const ew_target *picture, const ew_material *material, int small)
{
    static const uint8_t bits[] = { 16, 16, 8, 8, 4, 1 }; /* of a pixel, by ew_target_format */
    const uint32_t units = WIDTH * BAND_ROWS / 16 * bits[picture->format];
    uint32_t hash = PICTURE_HASH_START;
    ew_target target = *picture;
    int drawn = 0, result = 0;
    for (int band = 0; band < BANDS && result >= 0; band++) {
        generator g = { 2463534242u };
        target.first_row = (uint16_t)(band * BAND_ROWS);
        result = ew_raster_init(&same_raster, &target);
        if (!result) result = ew_raster_set_material(&same_raster, material);
        if (!result) result = ew_raster_set_fog(&same_raster, 0xC618, UINT32_C(1) << 31, UINT32_C(1) << 27);
        ew_raster_clear(&same_raster, 0x18E3);
        if (small && result >= 0) {
            result = draw_small(target.first_row);
            drawn += TRIANGLES;
        }
        for (int i = 0; i < TRIANGLES && !small; i++) {
            ew_raster_vertex corner[3];
            for (int k = 0; k < 3; k++) any_corner(&g, &corner[k]);
            if (result >= 0) result = checked(ew_raster_triangle(&same_raster, &corner[0], &corner[1], &corner[2]));
            drawn += result > 0;
        }
        hash = picture_hash(hash, same_picture.colour, units);
        hash = picture_hash(hash, same_picture.depth, WIDTH * BAND_ROWS);
    }
    if (result < 0 || drawn < TRIANGLES) print_failure("triangles", ew_error_text(result));
    return hash;
}

static const triangle_case cases[] = {
    { "constant", .rung = EW_RUNG_CONSTANT },
    { "affine", .rung = EW_RUNG_AFFINE },
    { "runs8", .rung = EW_RUNG_RUNS_8 },
    { "runs32", .rung = EW_RUNG_RUNS_32 },
    { "table", .rung = EW_RUNG_TABLE },
    { "exact", .rung = EW_RUNG_EXACT },
    { "runs", .rung = EW_RUNG_RUNS, .tolerance = 4 },
    { "auto", .tolerance = 0 },
    { "auto", .tolerance = 4 },
    { "auto", .tolerance = 16 },
    { "without-depth", .flags = EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE },
    { "shaded", .flags = EW_SHADED },
    { "shaded-constant", .rung = EW_RUNG_CONSTANT, .flags = EW_SHADED },
    { "fog", .flags = EW_FOG },
    { "half", .blend = EW_BLEND_HALF },
    { "add", .blend = EW_BLEND_ADD },
    { "key", .flags = EW_COLOUR_KEY },
    { "mask", .flags = EW_ALPHA_MASK },
    { "clamp", .wrap = EW_WRAP_CLAMP },
    { "mirror", .wrap = EW_WRAP_MIRROR },
    { "bilinear", .filter = EW_FILTER_BILINEAR },
    { "mips", .levels = LEVELS },
    { "trilinear", .filter = EW_FILTER_TRILINEAR, .levels = LEVELS },
    { "rgb332", .texture_format = EW_TEXTURE_RGB332 },
    { "grey8", .texture_format = EW_TEXTURE_GREY8 },
    { "palette8", .texture_format = EW_TEXTURE_PALETTE8 },
    { "palette4", .texture_format = EW_TEXTURE_PALETTE4 },
    { "palette1", .texture_format = EW_TEXTURE_PALETTE1 },
    { "to-swapped", .target_format = EW_TARGET_RGB565_SWAPPED },
    { "to-rgb332", .target_format = EW_TARGET_RGB332 },
    { "to-grey8", .target_format = EW_TARGET_GREY8 },
    { "to-grey4", .target_format = EW_TARGET_GREY4 },
    { "to-mono", .target_format = EW_TARGET_MONO },
    { "to-rgb565-dithered", .flags = EW_SHADED, .dither = 1 },
    { "to-grey4-dithered", .target_format = EW_TARGET_GREY4, .dither = 1 },
    { "to-mono-dithered", .target_format = EW_TARGET_MONO, .dither = 1 },
    { "all", .tolerance = 4, .flags = EW_SHADED | EW_FOG | EW_COLOUR_KEY, .blend = EW_BLEND_HALF,
      .filter = EW_FILTER_TRILINEAR, .wrap = EW_WRAP_MIRROR, .levels = LEVELS,
      .target_format = EW_TARGET_RGB565_SWAPPED, .dither = 1 },
#if SAME_BITS_ROOM > 0 /* an AVR keeps this table in RAM */
    { "auto", .tolerance = 4, .small = 1 },
    { "affine", .rung = EW_RUNG_AFFINE, .small = 1 },
    { "exact", .rung = EW_RUNG_EXACT, .small = 1 },
    { "runs", .rung = EW_RUNG_RUNS, .tolerance = 4, .small = 1 },
    { "runs", .rung = EW_RUNG_RUNS, .tolerance = 16, .small = 1 },
    { "shaded", .tolerance = 4, .flags = EW_SHADED, .small = 1 },
#endif
#if SAME_BITS_ROOM >= 3
    { "auto", .tolerance = 1, .large = 1 },
    { "auto", .tolerance = 4, .large = 1 },
    { "auto", .tolerance = 32, .large = 1 },
    { "dear-runs", .tolerance = 4, .large = 1, .dear = 1 },
    { "runs", .rung = EW_RUNG_RUNS, .tolerance = 16, .large = 1 },
    { "runs16", .rung = EW_RUNG_RUNS_16, .large = 1 },
    { "affine", .rung = EW_RUNG_AFFINE, .large = 1 },
#endif
};

void triangle_bits(void)
{
    generator g = { 1 };
    for (unsigned i = 0; i < sizeof texels / sizeof *texels; i++) texels[i] = (uint16_t)random32(&g);
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        const triangle_case *c = &cases[i];
        const ew_target target = { .colour = same_picture.colour, .depth = same_picture.depth,
                                   .width = WIDTH, .height = BAND_ROWS, .stride = WIDTH,
                                   .format = c->target_format, .dither = c->dither };
        const ew_texture texture = { .texels = texels, .width = TEXTURE, .height = TEXTURE, .palette = texels,
                                     .mask = (const uint8_t *)texels, .key = texels[0],
                                     .format = c->texture_format, .wrap_u = c->wrap, .wrap_v = c->wrap,
                                     .levels = c->levels };
        const ew_material material = { .texture = c->rung == EW_RUNG_CONSTANT ? NULL : &texture, .colour = 0xFBE0,
                                       .tolerance = c->tolerance, .rung = c->rung,
                                       .flags = EW_DOUBLE_SIDED | c->flags,
                                       .blend = c->blend, .filter = c->filter };
#if SAME_BITS_ROOM >= 3
        if (c->large) {
            print_hash("large", c->method, c->tolerance, "320x240", draw_large(&material, c->dear));
            continue;
        }
#endif
        print_hash(c->small ? "small" : "triangles", c->method, c->tolerance, "64x48", draw(&target, &material, c->small));
    }
}
