/* src/raster/loops.c where it draws: each loop, runs of every length that end where the target's memory does,
 * into every kind of target and from every texture that it is chosen for. */
#include "seams.h"

#ifdef EW_PROVE_SHORT
enum { ACROSS = 3 };
#else
enum { ACROSS = 11 };
#endif
enum { FIRST_ROW = 5, STRIDE = 12, BEFORE = STRIDE }; /* the second of two rows */

static uint16_t colour[BEFORE + ACROSS], depth[BEFORE + ACROSS], texels[32];
static uint8_t greys[(BEFORE + ACROSS + 1) / 2];
static ew_raster raster;

static void run(uint8_t loop, int32_t n)
{
    ew_position *at = &raster.work.now.span.fill.any.position;
    any_triangle(&raster);
    ew_loop_start(&raster, FIRST_ROW + 1);
    at->loop = loop;
    at->x = (uint16_t)(ACROSS - n);
    const int drawn = ew_loop_fill(&raster, n);
    //@ assert moved: at->x == ACROSS - n || at->x == ACROSS;
    (void)drawn;
}

static void runs(uint8_t loop, uint8_t format, int has_depth, uint32_t log2_width, uint32_t log2_height)
{
    const ew_target target = { format == EW_TARGET_GREY4 ? (void *)greys : (void *)colour, has_depth ? depth : NULL,
                               ACROSS, 2, STRIDE, format, (uint8_t)any_of(2), FIRST_ROW };
    const size_t size = (size_t)1 << (log2_width + log2_height);
    any_context(&raster);
    raster.target = target;
    raster.texture.texels = texels + 32 - size;
    raster.texture.width = (uint16_t)(1u << log2_width), raster.texture.height = (uint16_t)(1u << log2_height);
    raster.log2_width = (uint8_t)log2_width, raster.log2_height = (uint8_t)log2_height;
    //@ loop unroll ACROSS;
    for (int32_t n = 1; n <= ACROSS; n++) run(loop, n);
}

void prove_loops(void)
{
    any_bytes(colour, sizeof colour), any_bytes(depth, sizeof depth);
    any_bytes(greys, sizeof greys), any_bytes(texels, sizeof texels);
    //@ loop unroll LOOP_COUNT;
    for (uint8_t loop = LOOP_TEXTURED + 1; loop < LOOP_COUNT; loop++) {
        const int has_depth = loop != LOOP_NO_DEPTH;
        if (loop == LOOP_GREY4) {
            runs(loop, EW_TARGET_GREY4, has_depth, 3, 2);
            runs(loop, EW_TARGET_GREY4, has_depth, 0, 0);
        } else {
            runs(loop, EW_TARGET_RGB565, has_depth, 3, 2);
            runs(loop, EW_TARGET_RGB565_SWAPPED, has_depth, 3, 2);
            runs(loop, EW_TARGET_RGB565, has_depth, 0, 0);
            runs(loop, EW_TARGET_RGB565, has_depth, 0, 5);
        }
    }
}
