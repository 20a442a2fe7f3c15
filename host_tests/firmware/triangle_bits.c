/* A set of triangles on a 64x48 picture with a 16x16 texture, small enough for 8 KB of RAM:
 * four bands of twelve rows, each drawn with the set moved up to it. */
#include "same_bits.h"

#include "../../examples/firmware/picture_hash.h"
#include "edgewalk/raster.h"

enum { WIDTH = 64, BAND_ROWS = 12, BANDS = 4, TRIANGLES = 40, TEXTURE = 16 };

static uint16_t texels[TEXTURE * TEXTURE];

/* Most are of the picture's size and many reach over its borders; near/z over a range of 32. */
static void any_corner(generator *g, ew_raster_vertex *corner, int32_t first_row)
{
    corner->x = random_between(g, -20 * INT32_C(4096), 84 * INT32_C(4096));
    corner->y = random_between(g, -20 * INT32_C(4096), 68 * INT32_C(4096)) - first_row * 4096;
    corner->w = (UINT32_C(1) << 31) >> random_between(g, 0, 4);
    corner->w -= random32(g) % (corner->w / 2u);
    corner->u = random_between(g, -64 * INT32_C(4096), 64 * INT32_C(4096));
    corner->v = random_between(g, -64 * INT32_C(4096), 64 * INT32_C(4096));
    uint32_t colour = random32(g);
    corner->colour.r = (uint8_t)colour;
    corner->colour.g = (uint8_t)(colour >> 8);
    corner->colour.b = (uint8_t)(colour >> 16);
}

static uint32_t draw(const ew_material *material)
{
    const ew_target target = { .colour = same_colour, .depth = same_depth,
                               .width = WIDTH, .height = BAND_ROWS, .stride = WIDTH };
    uint32_t hash = PICTURE_HASH_START;
    ew_raster raster;
    int drawn = 0, result = ew_raster_init(&raster, &target);
    if (!result) result = ew_raster_set_material(&raster, material);
    for (int band = 0; band < BANDS; band++) {
        generator g = { 2463534242u };
        ew_raster_clear(&raster, 0x18E3);
        for (int i = 0; i < TRIANGLES; i++) {
            ew_raster_vertex corner[3] = { 0 };
            for (int k = 0; k < 3; k++) any_corner(&g, &corner[k], band * (int32_t)BAND_ROWS);
            if (result >= 0) result = ew_raster_triangle(&raster, &corner[0], &corner[1], &corner[2]);
            drawn += result > 0;
        }
        hash = picture_hash(hash, same_colour, WIDTH * BAND_ROWS);
        hash = picture_hash(hash, same_depth, WIDTH * BAND_ROWS);
    }
    if (result < 0 || drawn < TRIANGLES) print_failure("triangles", ew_error_text(result));
    return hash;
}

void triangle_bits(void)
{
    static const struct {
        const char *method;
        uint8_t rung, tolerance, flags;
    } cases[] = {
        { "constant", EW_RUNG_CONSTANT, 0, 0 },
        { "affine", EW_RUNG_AFFINE, 0, 0 },
        { "table", EW_RUNG_TABLE, 0, 0 },
        { "exact", EW_RUNG_EXACT, 0, 0 },
        { "runs", EW_RUNG_RUNS, 4, 0 },
        { "auto", EW_RUNG_AUTO, 0, 0 },
        { "auto", EW_RUNG_AUTO, 4, 0 },
        { "auto", EW_RUNG_AUTO, 16, 0 },
        { "without-depth", EW_RUNG_AUTO, 4, EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE },
    };
    generator g = { 1 };
    for (int i = 0; i < TEXTURE * TEXTURE; i++) texels[i] = (uint16_t)random32(&g);
    const ew_texture texture = { .texels = texels, .width = TEXTURE, .height = TEXTURE };
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        const ew_material material = { .texture = &texture, .colour = 0xFBE0, .tolerance = cases[i].tolerance,
                                       .rung = cases[i].rung, .flags = EW_DOUBLE_SIDED | cases[i].flags };
        print_hash("triangles", cases[i].method, cases[i].tolerance, "64x48", draw(&material));
    }
}
