/* src/raster/texture.c: the texels that pieces take. Axes alone for many sizes; pieces from textures
 * whose memory ends where the last level, the palette and the mask do. */
#include "src/raster/texture.c" /* of the tree that is analysed: planted faults, too */
#include "unknown.h"

static ew_axis axis;

static void axis_of(uint32_t size, int wrap, uint32_t inverse, uint32_t level, uint32_t back)
{
    axis.at = any64(), axis.step = any64(), axis.size = size;
    axis_start(&axis, level, wrap, inverse, back);
    const uint64_t period = (uint64_t)axis.period << 32;
    //@ assert axis_started: period == 0 || (axis.at < period && axis.step < period);
    axis_step(&axis);
    //@ assert axis_goes_on: period == 0 || axis.at < period;
    const uint32_t here = texel_index(&axis, 0), next = texel_index(&axis, 1);
    //@ assert texel_is_there: here < axis.size && next < axis.size;
}

static void axes_of(uint32_t size, uint32_t level)
{
    const uint32_t inverse = ew_texture_inverse(size);
    //@ loop unroll 3;
    for (int wrap = 0; wrap <= EW_WRAP_MIRROR; wrap++) {
        axis_of(size, wrap, inverse, level, 0);
        axis_of(size, wrap, inverse, level, HALF_TEXEL);
    }
}

/* ---- pieces ---- */

static const uint8_t bits_of[] = { 16, 8, 8, 8, 4, 1 }; /* of a texel, by ew_texture_format */
static const uint16_t entries_of[] = { 0, 0, 0, 256, 16, 2 };
static uint16_t memory[128], mask_memory[128], palette_memory[256], one_pixel[1];
static ew_raster raster;

/* Bytes of all levels. */
static size_t bytes_of(uint32_t width, uint32_t height, int levels, int bits)
{
    size_t sum = 0;
    //@ loop unroll 12;
    for (int i = 0; i < levels; i++) {
        sum += (width * (uint32_t)bits + 7) / 8 * height;
        width = width > 1 ? width / 2 : 1, height = height > 1 ? height / 2 : 1;
    }
    return sum;
}

static void piece(uint16_t width, uint16_t height, uint8_t levels, uint8_t format, uint8_t wrap_u, uint8_t wrap_v)
{
    ew_run run;
    ew_piece p;
    ew_sampler s;
    const size_t bytes = bytes_of(width, height, levels, bits_of[format]), masked = bytes_of(width, height, levels, 1);
    any_bytes(&raster, sizeof raster);
    const ew_texture t = { (uint8_t *)memory + ((sizeof memory - bytes) & ~(size_t)1), width, height,
                           palette_memory + 256 - entries_of[format], (uint8_t *)mask_memory + (sizeof mask_memory - masked),
                           any16(), format, wrap_u, wrap_v, levels };
    const ew_target target = { .colour = one_pixel, .format = (uint8_t)any_of(6), .dither = (uint8_t)any_of(2) };
    if (ew_texture_check(&t, EW_FILTER_TRILINEAR, EW_COLOUR_KEY | EW_ALPHA_MASK) != EW_OK) return;
    raster.texture = t, raster.target = target;
    raster.inverse_width = ew_texture_inverse(width), raster.inverse_height = ew_texture_inverse(height);
    raster.material.filter = (uint8_t)any_of(3);
    any_bytes(&run, sizeof run), any_bytes(&p, sizeof p), any_bytes(&s, sizeof s);
    p.n = between(1, EW_PIECE);
    raster.material.flags = (uint8_t)((EW_COLOUR_KEY | EW_ALPHA_MASK) * any_of(2));
    //@ split raster.material.flags;
    //@ split raster.material.filter;
    ew_texture_start(&s, &raster, &run);
    ew_texture_sample(&s, &p);
    if (!ew_texture_next(&s, &raster, &run)) return;
    ew_texture_sample(&s, &p);
    const int third = ew_texture_next(&s, &raster, &run);
    //@ assert two_levels: third == 0;
}

#ifdef EW_PROVE_SHORT
enum { ALL_SIZES_TO = 3, FORMATS = 1 };
#else
enum { ALL_SIZES_TO = 64, FORMATS = 6 };
#endif

void prove_texture(void)
{
    static const uint16_t sizes[] = { 100, 255, 320, 640, 1023, 1025, 2047, 2048 };
    //@ loop unroll 64;
    for (uint32_t size = 1; size <= ALL_SIZES_TO; size++) axes_of(size, 0);
    //@ loop unroll 8;
    for (int i = 0; i < 8; i++) axes_of(sizes[i], 0), axes_of(sizes[i], 1), axes_of(sizes[i], 5), axes_of(sizes[i], 11);
    any_bytes(memory, sizeof memory), any_bytes(mask_memory, sizeof mask_memory);
    any_bytes(palette_memory, sizeof palette_memory);
    //@ loop unroll 6;
    for (uint8_t format = 0; format < FORMATS; format++) {
        piece(5, 3, 1, format, EW_WRAP_REPEAT, EW_WRAP_CLAMP);
        piece(5, 3, 3, format, EW_WRAP_MIRROR, EW_WRAP_REPEAT);
        piece(4, 8, 1, format, EW_WRAP_CLAMP, EW_WRAP_MIRROR);
        piece(1, 1, 1, format, EW_WRAP_REPEAT, EW_WRAP_MIRROR);
    }
}
