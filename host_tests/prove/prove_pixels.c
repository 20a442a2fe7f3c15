/* src/raster/target.c and fill.c: runs without a texture, and clearing, into every kind of target. The
 * target's memory ends where its last pixel does, so that a step too far would be seen. */
#include "../../src/raster/fill.h"
#include "unknown.h"

enum { WIDTH = 11, STRIDE = 16, HEIGHT = 2, FIRST_ROW = 5 };

static const uint8_t bits_of[] = { 16, 16, 8, 8, 4, 1 }; /* of a pixel, by ew_target_format */
static uint16_t colour[STRIDE * HEIGHT], depth[STRIDE * HEIGHT];
static ew_raster raster;

static void any_run(ew_run *run, uint16_t x, uint16_t y)
{
    any_bytes(run, sizeof *run);
    run->x = x, run->y = y;
}

static void runs(uint8_t format, uint8_t dither)
{
    ew_run run;
    const size_t pixels = (size_t)STRIDE * (HEIGHT - 1) + WIDTH, bytes = (pixels * bits_of[format] + 7) / 8;
    /* the end of the array is the end of the target */
    uint8_t *first = (uint8_t *)colour + ((sizeof colour - bytes) & ~(size_t)1);
    const ew_target target = { first, perhaps(depth + STRIDE - WIDTH),
                               WIDTH, HEIGHT, STRIDE, format, dither, FIRST_ROW };
    raster.target = target;
    any_run(&run, 0, FIRST_ROW);
    ew_fill_any(&raster, &run, WIDTH);
    any_run(&run, 1, FIRST_ROW + HEIGHT - 1);
    ew_fill_any(&raster, &run, WIDTH - 1);
    const ew_rect whole = { 0, FIRST_ROW, WIDTH, FIRST_ROW + HEIGHT };
    const ew_rect part = { 3, FIRST_ROW + 1, 10, FIRST_ROW + HEIGHT };
    raster.scissor = whole;
    ew_raster_clear(&raster, any16());
    raster.scissor = part;
    ew_raster_clear(&raster, any16());
}

void prove_pixels(void)
{
    any_bytes(colour, sizeof colour);
    any_bytes(depth, sizeof depth);
    any_bytes(&raster, sizeof raster);
    raster.texture.texels = NULL, raster.material.texture = NULL;
    raster.material.flags = (uint8_t)any_of(128);
    raster.material.blend = (uint8_t)any_of(3);
    raster.fog_near = (uint32_t)Frama_C_unsigned_long_interval(0, 0x80000000u);
    raster.fog_shift = (uint8_t)any_of(17);
    //@ loop unroll 6;
    for (uint8_t format = 0; format < 6; format++) {
        runs(format, 0);
        runs(format, 1);
    }
}
