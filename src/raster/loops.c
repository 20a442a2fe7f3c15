/* Loops of their own for what is drawn most: seven, made from one definition. Each draws the same
 * pixels as ew_fill_any, to the bit; what they leave to it are other targets, materials and
 * textures (ew_loop_of), and runs whose 1/z or light leaves its range.
 *
 * docs/fills.md has 12 bits for a channel between texture and target. From RGB565 to RGB565
 * what lies between falls out: floors of floors are one floor.
 */
#include "loops.h"

#include "pixel.h"
#include "target.h"

/* ---- which ---- */

static int is_simple(const ew_texture *t)
{
    return t->format == EW_TEXTURE_RGB565 && !t->wrap_u && !t->wrap_v && t->levels <= 1 &&
           !(t->width & (t->width - 1u)) && !(t->height & (t->height - 1u));
}

/* What a loop must have for the context's target and material; -1: none will do. */
static int needed(const ew_raster *raster)
{
    const ew_target *target = &raster->target;
    const ew_material *m = &raster->material;
    const int textured = raster->texture.texels != NULL, no_depth = EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE;
    int flags = m->flags & ~EW_DOUBLE_SIDED, has = target->format == EW_TARGET_GREY4 ? HAS_GREY4 : 0;
    if (m->blend || (!has && target->format > EW_TARGET_RGB565_SWAPPED)) return -1;
    if (!target->depth) flags |= no_depth;
    if (!(flags & no_depth)) has |= HAS_DEPTH;
    else if ((flags & no_depth) != no_depth) return -1;
    if (textured) {
        if (!is_simple(&raster->texture) || m->filter > EW_FILTER_BILINEAR) return -1;
        has |= HAS_TEXTURE;
        if (m->filter) has |= HAS_SMOOTH;
        if (flags & EW_COLOUR_KEY) has |= HAS_KEY;
    }
    if (flags & EW_SHADED) has |= HAS_LIGHT;
    if ((flags & EW_FOG) || (textured && (flags & EW_ALPHA_MASK))) return -1;
    /* dither changes nothing that comes from as many bits */
    return target->dither && (has & (HAS_SMOOTH | HAS_LIGHT)) ? -1 : has;
}

uint8_t ew_loop_of(const ew_raster *raster)
{
    const int widths = raster->log2_width, heights = raster->log2_height;
    int has = needed(raster);
    if (has == (HAS_DEPTH | HAS_TEXTURE)) {
        if (raster->target.format == EW_TARGET_RGB565 && widths >= 1 && heights >= 1 && widths + heights <= 16) {
            return LOOP_TEXTURED;
        }
        has |= HAS_KEY; /* but none has it */
    }
    switch (has) {
#define X(name, what) case what: return EW_WITH_LOOP_##name ? LOOP_##name : LOOP_NONE;
    LOOPS(X)
#undef X
    default: return LOOP_NONE;
    }
}

#if EW_HAS_LOOPS

/* ---- colours ---- */

/* Positions are texels with 20 bits of fraction, as many as spans have at most; 12 bits of texels
 * wrap as the sizes do, all of which divide 2^12. */
enum { FRACTION = 20 };
#define TEXEL (UINT32_C(1) << FRACTION)
#define HALF_TEXEL (TEXEL / 2 - TEXEL / 64) /* as in texture.c */

typedef struct place {
    const uint16_t *texels;
    uint32_t u, v;
    uint32_t columns, rows; /* as in ew_loop_work */
    int down;
} place;

EW_ALWAYS_INLINE const uint16_t *row_at(const place *p, uint32_t v) { return p->texels + (v >> p->down & p->rows); }
EW_ALWAYS_INLINE uint32_t column_at(const place *p, uint32_t u) { return u >> FRACTION & p->columns; }

EW_ALWAYS_INLINE uint32_t nearest(const place *p) { return row_at(p, p->v)[column_at(p, p->u)]; }

/* Room for a sum of weights of 32 above each channel. */
#define SPREAD UINT32_C(0x07E0F81F)
EW_ALWAYS_INLINE uint32_t spread(uint32_t p) { return (p | p << 16) & SPREAD; }

/* Four texels, by the weights of docs/fills.md, twice. For a channel's sum S, of 32 c, 5 bits of it are
 * floor(floor(132 S / 32) / 128) = floor((S + floor(S / 32)) / 32), 6 bits
 * floor(floor(65 S / 32) / 64) = floor((S + floor(S / 64)) / 32). */
EW_ALWAYS_INLINE uint32_t bilinear(const place *p)
{
    const uint16_t *row = row_at(p, p->v), *row_below = row_at(p, p->v + TEXEL);
    const uint32_t column = column_at(p, p->u), right = column_at(p, p->u + TEXEL);
    const uint32_t fu = p->u >> (FRACTION - 5) & 31u, fv = p->v >> (FRACTION - 5) & 31u;
    const uint32_t a = spread(row[column]), b = spread(row[right]);
    const uint32_t c = spread(row_below[column]), d = spread(row_below[right]);
    const uint32_t across = b - a; /* wraps as the sum does, which is a sum of no negative weights */
    const uint32_t sum = (a << 5) + fu * across + fv * (c - a) + ((fu * fv + 16u) >> 5) * (d - c - across);
    const uint32_t c565 = ((sum + (sum >> 5 & 0xF81Fu) + (sum >> 6 & UINT32_C(0x03E00000))) >> 5) & SPREAD;
    return c565 | (c565 >> 16 | c565 << 16);
}

/* Pixels stand in both halves of a word: a rotation by 8 exchanges their bytes, one by 16 does not. */
EW_ALWAYS_INLINE uint32_t twice(uint32_t p) { return p | p << 16; }
EW_ALWAYS_INLINE uint16_t ordered(uint32_t p, uint32_t turn)
{
    const uint32_t turned = p >> turn | p << (32 - turn); /* on its own, or GCC sees 16 bits and no rotation */
    return (uint16_t)turned;
}

/* To 12 bits, and times light: floor(floor(c L / 256) / 2^(12 - bits)); c L < 2^20. */
EW_ALWAYS_INLINE void decode(uint32_t channel[3], uint32_t p)
{
    channel[0] = (p >> 11) * 132u, channel[1] = (p >> 5 & 63u) * 65u, channel[2] = (p & 31u) * 132u;
}
EW_ALWAYS_INLINE uint32_t lit(const uint32_t channel[3], const uint32_t light[3])
{
    return channel[0] * (light[0] >> 16) >> 15 << 11 | channel[1] * (light[1] >> 16) >> 14 << 5 |
           channel[2] * (light[2] >> 16) >> 15;
}

/* RGB565 as 12 bits of grey: 1057 c / 8 is 132 c + c / 8. */
EW_ALWAYS_INLINE uint32_t grey_of_565(uint32_t p)
{
    const uint32_t r = (p >> 11) * 1057u >> 3, g = (p >> 5 & 63u) * 65u, b = (p & 31u) * 1057u >> 3;
    return (77u * r + 150u * g + 29u * b) >> 8;
}

/* ---- the definition ---- */

EW_HOT void ew_loop_start(ew_raster *raster, uint32_t y)
{
    const ew_triangle *t = &raster->work.triangle;
    const ew_target *target = &raster->target;
    ew_loop_work *k = &raster->work.now.span.fill.any.loop;
    const size_t row = ew_row_start(target, y);
    EW_KEEP_ORDER(t);
    EW_KEEP_ORDER(k);
    k->depth = target->depth ? target->depth + row : NULL;
    k->colour = (uint8_t *)target->colour + (target->format == EW_TARGET_GREY4 ? row >> 1 : row << 1);
    k->thresholds = ew_thresholds(target, y);
    k->of_dither = target->dither ? 4 : 31; /* c >> 31 is 0 */
    k->turn = target->format == EW_TARGET_RGB565_SWAPPED ? 8 : 16;
    k->key = raster->material.flags & EW_COLOUR_KEY ? raster->texture.key : UINT32_C(0x10000);
    k->texels = raster->texture.texels;
    if (k->texels) {
        const uint32_t back = raster->material.filter ? HALF_TEXEL : 0;
        k->columns = raster->texture.width - 1u;
        k->rows = (uint32_t)(raster->texture.height - 1u) << raster->log2_width;
        k->down = (uint8_t)(FRACTION - raster->log2_width);
        k->up = (uint8_t)(FRACTION - EW_FRACTION(t->uv_bits)); /* 0 at least */
        k->u_origin = ((uint32_t)t->u_origin << (FRACTION - 12)) - back;
        k->v_origin = ((uint32_t)t->v_origin << (FRACTION - 12)) - back;
    }
}

/* Whether light stays inside [0, 257) over n pixels; with steps below 128 it does not wrap. */
EW_ALWAYS_INLINE int light_stays(uint32_t s, uint32_t ds, int32_t n)
{
    const uint32_t most = UINT32_C(257) << 16, steps = UINT32_C(1) << 23;
    return s < most && s + ds * (uint32_t)(n - 1) < most && ds + steps < 2 * steps;
}

/* n pixels with what `has` says, which is constant where this is inlined. */
EW_ALWAYS_INLINE int fill(ew_raster *raster, int32_t n, const int has)
{
    const ew_triangle *t = &raster->work.triangle;
    const ew_attribute_run *run = &raster->work.now.span.fill.any.attributes;
    const ew_loop_work *k = &raster->work.now.span.fill.any.loop;
    ew_position *at = &raster->work.now.span.fill.any.position;
    EW_KEEP_ORDER(run); /* and what lies behind it, within short offsets */
    uint32_t light[3] = { 0, 0, 0 }, dlight[3] = { 0, 0, 0 };
    if (has & HAS_LIGHT) {
        light[0] = ew_light_at(t, run, 0), dlight[0] = ew_light_step(run, 0);
        light[1] = ew_light_at(t, run, 1), dlight[1] = ew_light_step(run, 1);
        light[2] = ew_light_at(t, run, 2), dlight[2] = ew_light_step(run, 2);
        if (!light_stays(light[0], dlight[0], n) || !light_stays(light[1], dlight[1], n) ||
            !light_stays(light[2], dlight[2], n)) {
            return 0;
        }
    }
    uint32_t x = at->x, w = at->w, colour = raster->material.colour, channel[3] = { 0, 0, 0 }, du = 0, dv = 0;
    const uint32_t dw = at->dw, key = k->key, turn = k->turn;
    uint8_t *const bytes = k->colour;
    const uint8_t *const thresholds = k->thresholds;
    const int of_dither = k->of_dither;
    uint16_t *c = has & HAS_GREY4 ? NULL : (uint16_t *)k->colour + x;
    uint16_t *z = has & HAS_DEPTH ? k->depth + x : c, *const end = z + n;
    place p = { NULL, 0, 0, 0, 0, 0 };
    if (has & HAS_TEXTURE) {
        p.texels = k->texels, p.columns = k->columns, p.rows = k->rows, p.down = k->down;
        p.u = (run->u << k->up) + k->u_origin, du = run->du << k->up;
        p.v = (run->v << k->up) + k->v_origin, dv = run->dv << k->up;
    } else if (has & HAS_LIGHT) {
        decode(channel, colour);
    } else {
        colour = ordered(twice(colour), turn);
    }
    at->x = (uint16_t)(x + (uint32_t)n);
    at->w = w + dw * (uint32_t)n;
    do {
        const uint32_t d = w >> 15;
        if (!(has & HAS_DEPTH) || d > *z) {
            if (has & HAS_TEXTURE) colour = has & HAS_SMOOTH ? bilinear(&p) : nearest(&p);
            if (!(has & HAS_KEY) || colour != key) {
                if (has & HAS_DEPTH) *z = (uint16_t)d;
                if ((has & HAS_TEXTURE) && (has & HAS_LIGHT)) decode(channel, colour);
                if (has & HAS_LIGHT) colour = lit(channel, light);
                if (has & HAS_GREY4) {
                    const uint32_t grey = grey_of_565(colour);
                    ew_packed_set(bytes, x, 2, (grey - (grey >> of_dither) + thresholds[x & 7u] * 4u) >> 8);
                } else {
                    *c = !(has & (HAS_TEXTURE | HAS_LIGHT)) ? (uint16_t)colour : /* it is in order */
                             ordered(has & HAS_SMOOTH ? colour : twice(colour), turn);
                }
            }
        }
        w += dw;
        if (has & HAS_TEXTURE) p.u += du, p.v += dv;
        if (has & HAS_LIGHT) light[0] += dlight[0], light[1] += dlight[1], light[2] += dlight[2];
        if (has & HAS_GREY4) x++;
        else c++;
    } while ((has & HAS_DEPTH ? ++z : c) != end);
    return 1;
}

/* ---- the loops ---- */

#define X(name, has) EW_NOINLINE int fill_##name(ew_raster *raster, int32_t n) { return fill(raster, n, has); }
LOOPS(X)
#undef X

EW_HOT int ew_loop_fill(ew_raster *raster, int32_t n)
{
    switch (raster->work.now.span.fill.any.position.loop) {
#define X(name, has) case LOOP_##name: return EW_WITH_LOOP_##name ? fill_##name(raster, n) : 0;
    LOOPS(X)
#undef X
    default: return 0;
    }
}

#endif
