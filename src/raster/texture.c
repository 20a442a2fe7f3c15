/* Textures: wraps, mip levels, filters, formats. docs/fills.md has the formulas.
 *
 * Along each axis a position is kept inside one period of the texture - its size, twice
 * that where it is mirrored - and so is its step: a sum is then brought back by one
 * comparison, whatever the size. A clamped position has no period and stays what it is.
 */
#include "texture.h"

#include "arch.h"
#include "pixel.h"

/* ---- checks ---- */

static uint8_t log2_bits_of(int format)
{
    static const uint8_t log2_bits[] EW_HOT_TABLE = { 4, 3, 3, 3, 2, 0 };
    return EW_WITH_TEXTURE_FORMATS ? log2_bits[format] : 4;
}

static int is_power_of_two(uint32_t n) { return !(n & (n - 1u)); }

static int is_size(uint32_t size) { return size >= 1 && size <= EW_TEXTURE_MAX; }

int ew_texture_check_stored(const ew_texture *t, int flags)
{
    if (!t->texels || !is_size(t->width) || !is_size(t->height) || t->format > EW_TEXTURE_PALETTE1 ||
        (t->format >= EW_TEXTURE_PALETTE8 && (!t->palette || !ew_is_aligned16(t->palette))) ||
        (t->format == EW_TEXTURE_RGB565 && !ew_is_aligned16(t->texels)) || ((flags & EW_ALPHA_MASK) && !t->mask)) {
        return EW_ERR_ARGUMENT;
    }
    if ((!EW_WITH_TEXTURE_FORMATS && t->format) || (!EW_WITH_CUTOUTS && (flags & (EW_COLOUR_KEY | EW_ALPHA_MASK)))) {
        return EW_ERR_UNSUPPORTED;
    }
    return EW_OK;
}

int ew_texture_check(const ew_texture *t, int filter, int flags)
{
    const int error = ew_texture_check_stored(t, flags);
    if (error == EW_ERR_ARGUMENT || t->wrap_u > EW_WRAP_MIRROR || t->wrap_v > EW_WRAP_MIRROR ||
        t->levels > 32 - ew_clz32((uint32_t)t->width | t->height)) {
        return EW_ERR_ARGUMENT;
    }
    if ((!EW_WITH_MIPS && t->levels > 1) ||
        (!EW_WITH_WRAPS && (t->wrap_u || t->wrap_v || !is_power_of_two(t->width) || !is_power_of_two(t->height))) ||
        (!EW_WITH_BILINEAR && filter) || (!EW_WITH_MIPS && filter == EW_FILTER_TRILINEAR)) {
        return EW_ERR_UNSUPPORTED;
    }
    return error;
}

uint32_t ew_texture_inverse(uint32_t size)
{
    if (EW_WITH_WRAPS + EW_WITH_MIPS == 0) return 0;
    return 0xFFFFFFFFu / size + (is_power_of_two(size) ? 1u : 0u); /* 2^32 becomes 0 */
}

/* ---- positions ---- */

/* Texels of one axis before they come again. */
static uint32_t period_of(uint32_t size, int wrap)
{
    return EW_WITH_WRAPS && wrap == EW_WRAP_MIRROR ? 2u * size : size;
}

static uint64_t with_whole(uint64_t u, uint32_t whole) { return (uint64_t)whole << 32 | (uint32_t)(u & 0xFFFFFFFFu); }

/* The whole part of a position modulo the period. */
static EW_HOT uint32_t within_period(uint32_t whole, uint32_t size, int wrap, uint32_t inverse)
{
    const uint32_t period = period_of(size, wrap);
    uint32_t r;
    if (!EW_WITH_WRAPS || is_power_of_two(period)) {
        r = whole & (period - 1u);
    } else {
        /* with a < 2^31, a times floor(2^32 / period) / 2^32 is a / period or less than 1 below:
         * the quotient is right or one too small. -1 - a comes to period - 1 - (a mod period). */
        const int negative = (int32_t)whole < 0;
        const uint32_t a = negative ? ~whole : whole;
        r = a - ew_mulh_u32(a, wrap == EW_WRAP_MIRROR ? inverse >> 1 : inverse) * period;
        if (r >= period) r -= period;
        //@ assert remainder_of_period: r < period;
        if (negative) r = period - 1u - r;
    }
    return r;
}

/* floor(u ratio / 2^32), u as q32.32 with its sign. */
static uint64_t scaled(uint64_t u, uint32_t ratio)
{
    const uint32_t whole = (uint32_t)(u >> 32), fraction = (uint32_t)(u & 0xFFFFFFFFu);
    return ew_mul_u32(whole, ratio) - ((int32_t)whole < 0 ? (uint64_t)ratio << 32 : 0u) + ew_mulh_u32(fraction, ratio);
}

/* The position, the step and the size are those of the first level. `back` is taken off the
 * position, below one texel. */
EW_NOINLINE void axis_start(ew_axis *a, uint32_t level, int wrap, uint32_t inverse, uint32_t back)
{
    const int clamped = EW_WITH_WRAPS && wrap == EW_WRAP_CLAMP;
    const uint32_t size = a->size;
    if (EW_WITH_MIPS && level) a->size = size >> level ? size >> level : 1u;
    a->period = clamped ? 0 : period_of(a->size, wrap);
    if (!clamped) {
        const uint64_t whole = (uint64_t)period_of(size, wrap) << 32;
        a->at = with_whole(a->at, within_period((uint32_t)(a->at >> 32), size, wrap, inverse));
        a->step = with_whole(a->step, within_period((uint32_t)(a->step >> 32), size, wrap, inverse));
        if (a->step > whole >> 1) a->step -= whole; /* the smaller step loses less when it is scaled */
    }
    if (EW_WITH_MIPS && a->size != size) {
        a->at = scaled(a->at, a->size * inverse); /* inverse <= 2^31: the level is at most half as large */
        a->step = scaled(a->step, a->size * inverse);
    }
    if (!clamped) {
        if (a->at < back) a->at += (uint64_t)a->period << 32;
        if (a->step >> 63) a->step += (uint64_t)a->period << 32;
    }
    a->at -= back;
}

/* With the sum below 2 periods. */
static void axis_step(ew_axis *a)
{
    a->at += a->step;
    if (a->period && a->at >= (uint64_t)a->period << 32) a->at -= (uint64_t)a->period << 32;
}

static uint32_t clamp(uint32_t i, uint32_t size)
{
    return (int32_t)i < 0 ? 0u : i >= size ? size - 1u : i;
}

/* The texel of the position, or the one `next` behind it, 0 or 1. */
EW_NOINLINE uint32_t texel_index(const ew_axis *a, uint32_t next)
{
    uint32_t i = (uint32_t)(a->at >> 32) + next;
    if (EW_WITH_WRAPS && !a->period) return clamp(i, a->size);
    if (i == a->period) i = 0;
    return EW_WITH_WRAPS && i >= a->size ? a->period - 1u - i : i; /* above the size in a mirror only */
}

#if EW_TRACE
ew_q20_12 ew_texture_traced(uint64_t u, uint32_t size, int wrap)
{
    if (wrap != EW_WRAP_CLAMP) u = with_whole(u, within_period((uint32_t)(u >> 32), size, wrap, ew_texture_inverse(size)));
    return (ew_q20_12)(uint32_t)(u >> 20 & 0xFFFFFFFFu);
}
#endif

/* ---- levels ---- */

#if EW_WITH_MIPS
/* |step| in 2^-16 texel per pixel, below 2^31. */
static uint32_t magnitude(uint64_t step)
{
    uint64_t a = (step >> 63 ? 0u - step : step) >> 16;
    return a >> 31 ? 0x7FFFFFFFu : (uint32_t)a;
}

static uint32_t larger(uint32_t a, uint32_t b) { return a > b ? a : b; }

/* The logarithm of the larger of the lengths of (du/dx, dv/dx) and (du/dy, dv/dy), by
 * OpenGL 2.1, 3.8.8: rho and lambda; half the logarithm of the length's square. */
EW_HOT uint32_t ew_texture_level(const ew_run *run)
{
    uint32_t ux = magnitude(run->du), vx = magnitude(run->dv), uy = magnitude(run->u_down), vy = magnitude(run->v_down);
    int shift = 17 - ew_clz32(larger(larger(ux, vx), larger(uy, vy)));
    if (shift < 0) return 0; /* all below 2^14: rho < 2^-1.5 */
    ux >>= shift, vx >>= shift, uy >>= shift, vy >>= shift;           /* < 2^15 */
    uint32_t square = larger(ux * ux + vx * vx, uy * uy + vy * vy);   /* < 2^31, >= 2^26 */
    int zeros = ew_clz32(square | 1u); /* never 0: Eva sees it, too */
    /* square = 2^(31 - zeros) (1 + x), and log2(1 + x) = x + 89/256 x (1 - x) within 0.0078 */
    uint32_t x = (square << zeros << 1) >> 16;                        /* uq0.16 */
    x += ((x * (65536u - x)) >> 16) * 89u >> 8;                       /* x (1 - x) <= 2^30 */
    /* in 1/256; an exponent of 2 (16 - shift) stands for 1 texel */
    int32_t level = (int32_t)(((uint32_t)(31 - zeros) << 16) + x + 256u) >> 9;
    level += (int32_t)(shift - 16) * 256;
    return level < 0 ? 0 : (uint32_t)level;
}
#endif


static uint32_t row_bytes_of(uint32_t width, int log2_bits) { return ((width << log2_bits) + 7u) >> 3; }

static EW_HOT void find_level(ew_sampler *s, uint32_t level)
{
    uint32_t width = s->texture->width, height = s->texture->height;
    s->texels = s->texture->texels;
    for (; EW_WITH_MIPS && level > 0; level--) {
        s->texels += (size_t)row_bytes_of(width, s->log2_bits) * height;
        if (s->mask) s->mask += (size_t)row_bytes_of(width, 0) * height;
        width = width > 1 ? width >> 1 : 1;
        height = height > 1 ? height >> 1 : 1;
    }
    s->row_bytes = (uint16_t)row_bytes_of(width, s->log2_bits);
    s->mask_row_bytes = (uint16_t)row_bytes_of(width, 0);
}

/* ---- texels ---- */

static uint32_t stored(const ew_sampler *s, uint32_t column, uint32_t row)
{
    const uint8_t *line = s->texels + (size_t)row * s->row_bytes;
    if (!EW_WITH_TEXTURE_FORMATS || s->log2_bits == 4) return ((const uint16_t *)(const void *)line)[column];
    return ew_packed_get(line, column, s->log2_bits);
}

EW_NOINLINE void fetch_texel(const ew_sampler *s, uint32_t column, uint32_t row, uint16_t colour[3])
{
    const ew_texture *t = s->texture;
    uint32_t value = stored(s, column, row);
    switch (EW_WITH_TEXTURE_FORMATS ? t->format : EW_TEXTURE_RGB565) {
    case EW_TEXTURE_RGB565: break;
    case EW_TEXTURE_RGB332: ew_decode_332(colour, value); return;
    case EW_TEXTURE_GREY8: ew_decode_grey(colour, value); return;
    default: value = t->palette[value]; break;
    }
    ew_decode_565(colour, value, s->wide);
}

/* Whether a texel is left out. */
EW_NOINLINE int is_cut(const ew_sampler *s, uint32_t column, uint32_t row)
{
    if ((s->cuts & EW_ALPHA_MASK) && !ew_packed_get(s->mask + (size_t)row * s->mask_row_bytes, column, 0)) return 1;
    return (s->cuts & EW_COLOUR_KEY) && stored(s, column, row) == s->texture->key;
}

void ew_texture_open(ew_sampler *s, const ew_texture *texture, int cuts, uint8_t wide)
{
    s->texture = texture;
    s->log2_bits = log2_bits_of(texture->format);
    s->wide = wide;
    s->cuts = (uint8_t)cuts;
    s->mask = EW_WITH_CUTOUTS && (cuts & EW_ALPHA_MASK) ? texture->mask : NULL;
    find_level(s, 0);
}

EW_HOT int ew_texture_texel(const ew_sampler *s, uint32_t column, uint32_t row, uint16_t colour[3])
{
    if (EW_WITH_CUTOUTS && s->cuts && is_cut(s, column, row)) return 0;
    fetch_texel(s, column, row, colour);
    return 1;
}

#if EW_WITH_BILINEAR
/* The four texels around a position whose whole part is the upper left one are weighted in
 * 1/32: fu and fv are five bits of the fraction. */
EW_NOINLINE void weigh(ew_sampler *s, uint32_t fu, uint32_t fv)
{
    const uint32_t both = (fu * fv + 16u) >> 5; /* the weights: none is below 0, their sum is 32 */
    s->weight[0] = (uint8_t)(32u - fu - fv + both);
    s->weight[1] = (uint8_t)(fu - both);
    s->weight[2] = (uint8_t)(fv - both);
    s->weight[3] = (uint8_t)both;
}

/* Their sum, at most 32 * 4095, and from it the pixel's colour. */
EW_NOINLINE void add_texels(ew_sampler *s, uint16_t colour[3])
{
    const uint32_t column[2] = { texel_index(&s->u, 0), texel_index(&s->u, 1) };
    uint32_t row = texel_index(&s->v, 0), r = 0, g = 0, b = 0;
    for (int k = 0; k < 4; k++) {
        const uint32_t weight = s->weight[k];
        if (k == 2) row = texel_index(&s->v, 1);
        fetch_texel(s, column[k & 1], row, s->texel);
        r += weight * s->texel[0], g += weight * s->texel[1], b += weight * s->texel[2];
    }
    colour[0] = (uint16_t)(r >> 5), colour[1] = (uint16_t)(g >> 5), colour[2] = (uint16_t)(b >> 5);
}
#endif

/* ---- pieces ---- */

/* Bilinear positions begin at the upper left texel's centre; 1/64 texel rounds the weights. */
#define HALF_TEXEL ((UINT32_C(1) << 31) - (UINT32_C(1) << 26))

EW_NOINLINE void start_level(ew_sampler *s, const ew_raster *raster, const ew_run *run)
{
    const ew_texture *t = &raster->texture;
    const uint32_t back = s->smooth ? HALF_TEXEL : 0;
    s->mask = EW_WITH_CUTOUTS && (raster->material.flags & EW_ALPHA_MASK) ? t->mask : NULL;
    find_level(s, s->level);
    s->u.at = run->u, s->u.step = run->du, s->u.size = t->width;
    s->v.at = run->v, s->v.step = run->dv, s->v.size = t->height;
    axis_start(&s->u, s->level, t->wrap_u, raster->inverse_width, back);
    axis_start(&s->v, s->level, t->wrap_v, raster->inverse_height, back);
}

static void sample_pixel(ew_sampler *s, uint32_t fu, uint32_t fv, uint32_t column, uint32_t row, uint16_t colour[3])
{
#if EW_WITH_BILINEAR
    if (fu | fv) {
        weigh(s, fu, fv);
        add_texels(s, colour);
        return;
    }
#else
    (void)fu, (void)fv;
#endif
    fetch_texel(s, column, row, colour);
}

EW_HOT void ew_texture_sample(ew_sampler *s, ew_piece *piece)
{
    const int second = EW_WITH_MIPS && s->share < 256;
    for (int i = 0; i < piece->n; i++) {
        if (piece->live >> i & 1) {
            const uint32_t fu = s->smooth ? (uint32_t)(s->u.at >> 27 & 31u) : 0, fv = s->smooth ? (uint32_t)(s->v.at >> 27 & 31u) : 0;
            /* the nearest texel is the one with the larger weight */
            const uint32_t column = texel_index(&s->u, fu >> 4), row = texel_index(&s->v, fv >> 4);
            if (EW_WITH_CUTOUTS && s->cuts && is_cut(s, column, row)) {
                piece->live = (uint8_t)(piece->live & ~(1u << i));
            } else {
                uint16_t *colour = piece->colour[i];
                sample_pixel(s, fu, fv, column, row, second ? s->level_colour : colour);
                for (int k = 0; second && k < 3; k++) colour[k] = ew_mix256(colour[k], s->level_colour[k], s->share);
            }
        }
        axis_step(&s->u);
        axis_step(&s->v);
    }
}

static uint8_t cuts_of(const ew_raster *raster)
{
    return EW_WITH_CUTOUTS ? raster->material.flags & (EW_COLOUR_KEY | EW_ALPHA_MASK) : 0;
}

EW_HOT void ew_texture_start(ew_sampler *s, const ew_raster *raster, const ew_run *run)
{
    s->level = s->next_share = 0;
#if EW_WITH_MIPS
    if (raster->texture.levels > 1) {
        const uint32_t last = raster->texture.levels - 1u, lambda = ew_texture_level(run);
        const int two = EW_WITH_BILINEAR && raster->material.filter == EW_FILTER_TRILINEAR;
        const uint32_t level = (two ? lambda : lambda + 128u) >> 8;
        s->level = (uint16_t)(level < last ? level : last);
        if (two && level < last) s->next_share = lambda & 255u;
    }
#endif
    s->texture = &raster->texture;
    s->log2_bits = log2_bits_of(raster->texture.format);
    s->wide = ew_wide(&raster->target);
    s->smooth = EW_WITH_BILINEAR && raster->material.filter != EW_FILTER_NEAREST;
    s->share = 256;
    s->cuts = s->next_share < 128 ? cuts_of(raster) : 0;
    //@ split s->level;
    start_level(s, raster, run);
}

EW_HOT int ew_texture_next(ew_sampler *s, const ew_raster *raster, const ew_run *run)
{
    if (!EW_WITH_MIPS || !s->next_share) return 0;
    s->level++;
    s->share = s->next_share;
    s->cuts = s->share < 128 ? 0 : cuts_of(raster);
    s->next_share = 0;
    //@ split s->level;
    start_level(s, raster, run);
    return 1;
}
