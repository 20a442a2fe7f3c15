#include "ref_fill.h"

#include <math.h>

typedef __int128 wide;

/* ---- whole numbers ---- */

/* b > 0 */
static wide floor_div(wide a, wide b) { return a >= 0 ? a / b : -((-a + b - 1) / b); } /* NOLINT(clang-analyzer-core.DivideZero) */
static wide floor_mod(wide a, wide b) { return a - b * floor_div(a, b); }
static int at_least(int a, int least) { return a < least ? least : a; }
static int at_most(int a, int most) { return a > most ? most : a; }

/* ---- memory ---- */

size_t ref_row_bytes(size_t width, int bits) { return (width * (size_t)bits + 7) / 8; }
int ref_texture_bits(int format)
{
    return format == EW_TEXTURE_RGB565 ? 16 : format == EW_TEXTURE_PALETTE4 ? 4 : format == EW_TEXTURE_PALETTE1 ? 1 : 8;
}
int ref_target_bits(int format)
{
    return format <= EW_TARGET_RGB565_SWAPPED ? 16 : format == EW_TARGET_GREY4 ? 4 : format == EW_TARGET_MONO ? 1 : 8;
}

static size_t level_bytes(const ew_texture *t, int level, int bits)
{
    return ref_row_bytes((size_t)at_least(t->width >> level, 1), bits) * (size_t)at_least(t->height >> level, 1);
}

size_t ref_texture_bytes(const ew_texture *texture, int bits)
{
    size_t sum = 0;
    for (int k = 0; k < at_least(texture->levels, 1); k++) sum += level_bytes(texture, k, bits);
    return sum;
}

/* Item i of a row, the left one in the high bits; 16 bits in the machine's order. */
static unsigned item(const void *row, int i, int bits)
{
    if (bits == 16) return ((const uint16_t *)row)[i];
    unsigned value = 0;
    for (int bit = i * bits; bit < (i + 1) * bits; bit++) {
        value = 2 * value + ((unsigned)((const uint8_t *)row)[bit / 8] >> (7 - bit % 8) & 1u);
    }
    return value;
}

static void set_item(void *row, int i, int bits, unsigned value)
{
    if (bits == 16) {
        ((uint16_t *)row)[i] = (uint16_t)value;
        return;
    }
    for (int k = 0; k < bits; k++) {
        int bit = i * bits + k;
        uint8_t *byte = (uint8_t *)row + bit / 8;
        unsigned one = 0x80u >> bit % 8;
        *byte = (uint8_t)(value >> (bits - 1 - k) & 1u ? *byte | one : *byte & ~one);
    }
}

/* ---- channels ---- */

void ref_decode_565(const ew_target *target, unsigned value, int c[3])
{
    int is_short = target->format <= EW_TARGET_RGB565_SWAPPED && !target->dither;
    int r = (int)(value / 2048), g = (int)(value / 32 % 64), b = (int)(value % 32);
    c[0] = 132 * r + (is_short ? 0 : r / 8);
    c[1] = 65 * g;
    c[2] = 132 * b + (is_short ? 0 : b / 8);
}

/* ---- textures ---- */

/* One axis of a level. */
typedef struct axis {
    int size, level_size, wrap;
} axis;

static int wrapped(const axis *a, wide i)
{
    const int n = a->level_size;
    if (a->wrap == EW_WRAP_CLAMP) return i < 0 ? 0 : i >= n ? n - 1 : (int)i;
    if (a->wrap == EW_WRAP_REPEAT) return (int)floor_mod(i, n);
    int j = (int)floor_mod(i, 2 * n);
    return j < n ? j : 2 * n - 1 - j;
}

/* The position of pixel i of a run, in 2^-32 texel of the level. */
static wide position(const axis *a, int64_t u, int64_t du, int i)
{
    const wide one = (wide)1 << 32;
    wide base = (wide)u + (wide)du * (i / 8 * 8), step = du;
    if (a->wrap != EW_WRAP_CLAMP) {
        wide period = (a->wrap == EW_WRAP_MIRROR ? 2 : 1) * a->size * one;
        base = floor_mod(base, period);
        step = floor_mod(step, period);
        if (step > period / 2) step -= period;
    }
    if (a->level_size != a->size) {
        wide inverse = one / a->size;
        base = floor_div(base * a->level_size * inverse, one);
        step = floor_div(step * a->level_size * inverse, one);
    }
    return base + step * (i % 8);
}

typedef struct level {
    const ew_texture *texture;
    const uint8_t *texels, *mask;
    axis u, v;
} level;

static level level_of(const ew_texture *t, int k)
{
    level l = { .texture = t, .texels = t->texels, .mask = t->mask };
    l.u = (axis){ t->width, at_least(t->width >> k, 1), t->wrap_u };
    l.v = (axis){ t->height, at_least(t->height >> k, 1), t->wrap_v };
    for (int j = 0; j < k; j++) {
        l.texels += level_bytes(t, j, ref_texture_bits(t->format));
        if (l.mask) l.mask += level_bytes(t, j, 1);
    }
    return l;
}

static unsigned texel(const level *l, int column, int row)
{
    int bits = ref_texture_bits(l->texture->format);
    return item(l->texels + (size_t)row * ref_row_bytes((size_t)l->u.level_size, bits), column, bits);
}

static void texel_colour(const ew_target *target, const level *l, int column, int row, int c[3])
{
    unsigned value = texel(l, column, row);
    switch (l->texture->format) {
    case EW_TEXTURE_RGB565: ref_decode_565(target, value, c); break;
    case EW_TEXTURE_RGB332:
        c[0] = 585 * (int)(value / 32);
        c[1] = 585 * (int)(value / 4 % 8);
        c[2] = 1365 * (int)(value % 4);
        break;
    case EW_TEXTURE_GREY8: c[0] = c[1] = c[2] = (int)(16 * value + value / 16); break;
    default: ref_decode_565(target, l->texture->palette[value], c); break;
    }
}

/* Whether the texel is drawn. */
static int texel_shows(const level *l, int flags, int column, int row)
{
    if ((flags & EW_COLOUR_KEY) && texel(l, column, row) == l->texture->key) return 0;
    return !(flags & EW_ALPHA_MASK) || item(l->mask + (size_t)row * ref_row_bytes((size_t)l->u.level_size, 1), column, 1);
}

/* Returns whether the fragment is drawn. */
static int sample(const ew_target *target, const level *l, const ew_material *m, wide u, wide v, int c[3])
{
    const wide one = (wide)1 << 32;
    if (m->filter == EW_FILTER_NEAREST) {
        int column = wrapped(&l->u, floor_div(u, one)), row = wrapped(&l->v, floor_div(v, one));
        texel_colour(target, l, column, row, c);
        return texel_shows(l, m->flags, column, row);
    }
    wide in_32_u = floor_div((u - one * 31 / 64) * 32, one), in_32_v = floor_div((v - one * 31 / 64) * 32, one);
    wide i = floor_div(in_32_u, 32), j = floor_div(in_32_v, 32);
    int f = (int)floor_mod(in_32_u, 32), g = (int)floor_mod(in_32_v, 32), b = (f * g + 16) / 32;
    const int weights[2][2] = { { 32 - f - g + b, f - b }, { g - b, b } };
    int sum[3] = { 0, 0, 0 };
    for (int y = 0; y < 2; y++) {
        for (int x = 0; x < 2; x++) {
            int one_colour[3];
            texel_colour(target, l, wrapped(&l->u, i + x), wrapped(&l->v, j + y), one_colour);
            for (int k = 0; k < 3; k++) sum[k] += weights[y][x] * one_colour[k];
        }
    }
    for (int k = 0; k < 3; k++) c[k] = sum[k] / 32;
    return texel_shows(l, m->flags, wrapped(&l->u, i + (f >= 16)), wrapped(&l->v, j + (g >= 16)));
}

static int sample_at(const ew_target *target, const ew_material *m, const ref_run *run, int i, int k, int c[3])
{
    const level l = level_of(m->texture, k);
    return sample(target, &l, m, position(&l.u, run->u, run->du, i), position(&l.v, run->v, run->dv, i), c);
}

static int texture_colour(const ew_target *target, const ew_material *m, const ref_run *run, int i, int lambda256, int c[3])
{
    const int last = at_least(m->texture->levels, 1) - 1;
    if (last == 0) return sample_at(target, m, run, i, 0, c);
    if (m->filter != EW_FILTER_TRILINEAR) return sample_at(target, m, run, i, at_most((lambda256 + 128) / 256, last), c);
    const int a = at_most(lambda256 / 256, last), s = a == last ? 0 : lambda256 % 256;
    int shows = sample_at(target, m, run, i, a, c);
    if (s == 0) return shows;
    int other[3], other_shows = sample_at(target, m, run, i, a + 1, other);
    for (int k = 0; k < 3; k++) c[k] = (c[k] * (256 - s) + other[k] * s) / 256;
    return s >= 128 ? other_shows : shows;
}

double ref_lambda(const ref_run *run)
{
    double across = hypot(ldexp((double)run->du, -32), ldexp((double)run->dv, -32));
    double down = hypot(ldexp((double)run->u_down, -32), ldexp((double)run->v_down, -32));
    return log2(fmax(across, down));
}

/* ---- targets ---- */

/* Channel by channel: how many bits. Grey has one. */
static int channel_bits(int format, int k)
{
    static const int bits[6][3] = { { 5, 6, 5 }, { 5, 6, 5 }, { 3, 3, 2 }, { 8, 0, 0 }, { 4, 0, 0 }, { 1, 0, 0 } };
    return bits[format][k];
}

static int threshold(int x, int y)
{
    int t = 0;
    for (int bit = 0; bit < 3; bit++) t = 4 * t + 2 * ((x >> bit ^ y >> bit) & 1) + (y >> bit & 1);
    return t;
}

static unsigned to_bits(const ew_target *target, int c, int b, int x, int y)
{
    if (!target->dither) return (unsigned)(c >> (12 - b));
    int t = (int)floor(ldexp(threshold(x, y), 6 - b));
    return (unsigned)((c - (c >> b) + t) >> (12 - b));
}

unsigned ref_convert(const ew_target *target, const int c[3], int x, int y)
{
    if (target->format >= EW_TARGET_GREY8) {
        return to_bits(target, (77 * c[0] + 150 * c[1] + 29 * c[2]) / 256, channel_bits(target->format, 0), x, y);
    }
    unsigned value = 0;
    for (int k = 0; k < 3; k++) {
        int b = channel_bits(target->format, k);
        value = (value << b) + to_bits(target, c[k], b, x, y);
    }
    return value;
}

static uint8_t *row_of(const ew_target *target, int y)
{
    return (uint8_t *)target->colour + (size_t)(y - target->first_row) * ref_row_bytes(target->stride, ref_target_bits(target->format));
}

unsigned ref_read(const ew_target *target, int x, int y)
{
    unsigned value = item(row_of(target, y), x, ref_target_bits(target->format));
    return target->format == EW_TARGET_RGB565_SWAPPED ? value / 256 + value % 256 * 256 : value;
}

static void store(const ew_target *target, int x, int y, unsigned value)
{
    if (target->format == EW_TARGET_RGB565_SWAPPED) value = value / 256 + value % 256 * 256;
    set_item(row_of(target, y), x, ref_target_bits(target->format), value);
}

static unsigned blended(const ew_target *target, int blend, unsigned value, unsigned old, int x, int y)
{
    if (blend == EW_BLEND_NONE) return value;
    unsigned result = 0;
    int below = ref_target_bits(target->format);
    for (int k = 0; k < 3 && below > 0; k++) {
        int b = channel_bits(target->format, k);
        below -= b;
        unsigned top = (1u << b) - 1, mine = value >> below & top, sum = mine + (old >> below & top);
        unsigned round = target->dither && (x + y) % 2;
        result = (result << b) + (blend == EW_BLEND_HALF ? (sum + round) / 2 : sum > top ? top : sum);
    }
    return result;
}

/* ---- a run ---- */

static int fog_share(const ref_fog *fog, int64_t w)
{
    int64_t range = fog->near - fog->far, d = fog->near - w;
    if (range == 0) return 0;
    d = d < 0 ? 0 : d > range ? range : d;
    int shift = 0;
    while (range >> shift >= 65536) shift++;
    int64_t steps = range >> shift, scale = (((int64_t)1 << 31) + steps - 1) / steps;
    return (int)((d >> shift) * scale >> 23);
}

static void draw_pixel(const ew_target *target, const ew_material *m, const ref_fog *fog, const ref_run *run, int i,
                       int lambda256)
{
    const int x = run->x + i, y = run->y;
    uint16_t *depth = target->depth ? target->depth + (size_t)(y - target->first_row) * target->stride + x : NULL;
    int64_t w = run->w + i * run->dw;
    if (w < 0) w = 0;
    int d = at_most(at_least((int)(w >> 15), 1), 65535);
    if (depth && !(m->flags & EW_NO_DEPTH_TEST) && d <= *depth) return;
    int c[3];
    if (m->texture && m->rung != EW_RUNG_CONSTANT) {
        if (!texture_colour(target, m, run, i, lambda256, c)) return;
    } else {
        ref_decode_565(target, m->colour, c);
    }
    if (depth && !(m->flags & EW_NO_DEPTH_WRITE)) *depth = (uint16_t)d;
    for (int k = 0; k < 3; k++) {
        wide light = floor_div(run->shade[k] + i * run->dshade[k], 65536);
        if (m->flags & EW_SHADED) c[k] = (int)(c[k] * (light < 0 ? 0 : light > 256 ? 256 : light) / 256);
    }
    int fog_c[3], f = fog_share(fog, w);
    ref_decode_565(target, fog->colour, fog_c);
    for (int k = 0; k < 3; k++) {
        if (m->flags & EW_FOG) c[k] = (c[k] * (256 - f) + fog_c[k] * f) / 256;
    }
    store(target, x, y, blended(target, m->blend, ref_convert(target, c, x, y), ref_read(target, x, y), x, y));
}

void ref_fill(const ew_target *target, const ew_material *material, const ref_fog *fog, const ref_run *run,
              int lambda256)
{
    for (int i = 0; i < run->n; i++) draw_pixel(target, material, fog, run, i, lambda256);
}
