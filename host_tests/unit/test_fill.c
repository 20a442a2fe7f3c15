/* Fills: the generic span path against the referee of docs/fills.md, byte for byte; conversions
 * exhaustively; what the page promises in real numbers against doubles. Built once more for each
 * EW_WITH_... that is 0: cases that need it must be refused, all others be the same. */
#include "unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edgewalk/raster.h"
#include "../../src/raster/fill.h"
#include "../../src/raster/loops.h"
#include "../../src/raster/texture.h"
#include "../reference/ref_fill.h"

/* Builds with a part left out try a fraction of the cases. */
#ifndef SHARE
#define SHARE 1
#endif

/* ---- a case: memory and everything that a run depends on ---- */

enum { W = 40, H = 6, STRIDE_MOST = W + 16, GUARD = 16, TEXELS_MOST = 1 << 17 };

typedef struct pixels {
    _Alignas(8) uint8_t colour[2 * STRIDE_MOST * H + 2 * GUARD];
    uint16_t depth[STRIDE_MOST * H + 2 * GUARD];
} pixels;

static pixels before, drawn, expected;
static _Alignas(8) uint8_t texels[TEXELS_MOST], mask[TEXELS_MOST];
static uint16_t palette[256];

typedef struct fill_case {
    ew_target target;
    ew_texture texture;
    ew_material material;
    ref_fog fog;
    ref_run run;
} fill_case;

static uint32_t below(uint32_t n) { return test_random() % n; }
static int chance(uint32_t one_in) { return below(one_in) == 0; }

/* A signed number of up to `bits` bits, small ones as often as large ones. */
static int64_t any_signed(uint32_t bits)
{
    uint64_t r = ((uint64_t)test_random() << 32 | test_random()) >> (64 - 1 - below(bits));
    return chance(2) ? (int64_t)r : -(int64_t)r;
}

static void random_bytes(void *memory, size_t n)
{
    uint8_t *p = memory;
    for (size_t i = 0; i < n; i++) p[i] = (uint8_t)test_random();
}

/* The case's target in one of the two memories. */
static ew_target target_in(const fill_case *c, pixels *p)
{
    ew_target t = c->target;
    t.colour = p->colour + GUARD;
    t.depth = c->target.depth ? p->depth + GUARD : NULL;
    return t;
}

static void random_target(ew_target *t)
{
    memset(t, 0, sizeof *t);
    t->format = (uint8_t)below(6);
    const uint32_t per_byte = t->format == EW_TARGET_GREY4 ? 2 : t->format == EW_TARGET_MONO ? 8 : 1;
    t->width = (uint16_t)(1 + below(W));
    t->height = H;
    t->stride = (uint16_t)((t->width + below(9) + per_byte - 1) / per_byte * per_byte);
    t->dither = (uint8_t)below(2);
    t->first_row = (uint16_t)(chance(2) ? 0 : below(EW_TARGET_MAX - H + 1));
    t->depth = chance(4) ? NULL : before.depth;
}

static uint16_t random_size(void)
{
    return (uint16_t)(chance(3) ? 1u << below(8) : chance(20) ? 1 + below(2048) : 1 + below(40));
}

static void random_texture(ew_texture *t)
{
    static const uint32_t most[6] = { 65536, 256, 256, 256, 16, 2 };
    memset(t, 0, sizeof *t);
    t->format = (uint8_t)below(6);
    t->texels = texels, t->mask = mask, t->palette = palette;
    do {
        t->width = random_size();
        t->height = random_size();
        t->levels = 1;
        for (int larger = t->width > t->height ? t->width : t->height; larger > 1 && !chance(4); larger /= 2) t->levels++;
        if (chance(4)) t->levels = 0;
    } while (ref_texture_bytes(t, 16) > TEXELS_MOST);
    t->wrap_u = (uint8_t)below(3);
    t->wrap_v = (uint8_t)below(3);
    t->key = (uint16_t)below(most[t->format]);
    if (t->format == EW_TEXTURE_RGB565) t->key = ((const uint16_t *)(const void *)texels)[below(16)];
}

static void random_material(ew_material *m, const ew_texture *texture)
{
    memset(m, 0, sizeof *m);
    m->texture = chance(6) ? NULL : texture;
    m->colour = (uint16_t)test_random();
    m->rung = (uint8_t)below(6);
    m->flags = (uint8_t)below(128);
    if (chance(2)) m->flags &= (uint8_t)~(EW_COLOUR_KEY | EW_ALPHA_MASK);
    if (chance(2)) m->flags |= EW_NO_DEPTH_TEST;
    m->blend = (uint8_t)below(3);
    m->filter = (uint8_t)below(3);
}

static void random_run(ref_run *r, const ew_target *target, const ew_texture *t)
{
    memset(r, 0, sizeof *r);
    r->x = (int)below(target->width);
    r->y = target->first_row + (int)below(target->height);
    const int mips = t->levels > 1;
    const uint32_t room = (uint32_t)(target->width - r->x);
    r->n = 1 + (int)below(mips && room > 16 ? 16 : room);
    /* 1/z from just below 0 to a little above 1 */
    const int64_t w0 = (int64_t)(test_random() >> 1 >> (chance(2) ? below(31) : 0)) - (chance(8) ? 2048 : 0);
    const int64_t w1 = chance(2) ? w0 : (int64_t)(test_random() >> 1) + (chance(8) ? (1 << 29) : 0);
    r->w = w0;
    r->dw = (w1 - w0) / r->n;
    /* steps of runs with levels stay where the page speaks of lambda */
    const uint32_t step_bits = mips ? 32 + 13 : 32 + 24;
    r->u = any_signed(32 + 24), r->v = any_signed(32 + 24);
    r->du = any_signed(step_bits), r->dv = any_signed(step_bits);
    r->u_down = any_signed(step_bits), r->v_down = any_signed(step_bits);
    if (chance(3)) { /* along texel borders and centres */
        r->u = r->u / (1 << 26) * (1 << 26), r->du = r->du / (1 << 26) * (1 << 26);
        r->v = r->v / (1 << 26) * (1 << 26), r->dv = r->dv / (1 << 26) * (1 << 26);
    }
    for (int k = 0; k < 3; k++) {
        r->shade[k] = chance(4) ? 1 << 24 : (int64_t)below(1 << 25) - (1 << 23);
        r->dshade[k] = chance(2) ? 0 : ((int64_t)below(1 << 25) - (1 << 24)) / r->n;
    }
}

static void random_fog(uint32_t *near, uint32_t *far)
{
    *far = below(1u << 31) >> below(31);
    *near = *far + 1 + below((1u << 31) - *far);
    if (chance(3)) *near = *far + 1 + (*near - *far - 1) % 100000;
}

/* Takes out what the build leaves out. */
static void fit_to_build(fill_case *c)
{
    ew_texture *t = &c->texture;
    ew_material *m = &c->material;
    if (!EW_WITH_TARGET_FORMATS) c->target.format = 0;
    if (!EW_WITH_DITHER) c->target.dither = 0;
    if (!EW_WITH_SHADING) m->flags &= (uint8_t)~EW_SHADED;
    if (!EW_WITH_FOG) m->flags &= (uint8_t)~EW_FOG;
    if (!EW_WITH_CUTOUTS) m->flags &= (uint8_t)~(EW_COLOUR_KEY | EW_ALPHA_MASK);
    if (!EW_WITH_BLENDS) m->blend = 0;
    if (!EW_WITH_MIPS && m->filter == EW_FILTER_TRILINEAR) m->filter = EW_FILTER_BILINEAR;
    if (!EW_WITH_BILINEAR) m->filter = EW_FILTER_NEAREST;
    if (!EW_WITH_MIPS) t->levels = 0;
    if (!EW_WITH_TEXTURE_FORMATS) t->format = 0;
    if (!EW_WITH_WRAPS) {
        t->wrap_u = t->wrap_v = 0;
        t->width = (uint16_t)(1u << (31 - __builtin_clz(t->width))), t->height = (uint16_t)(1u << (31 - __builtin_clz(t->height)));
    }
}

static void random_case(fill_case *c)
{
    random_target(&c->target);
    random_texture(&c->texture);
    random_material(&c->material, &c->texture);
    if (chance(2)) fit_to_build(c);
    random_run(&c->run, &c->target, &c->texture);
    c->fog.colour = (uint16_t)test_random();
    uint32_t near, far;
    random_fog(&near, &far);
    c->fog.near = near, c->fog.far = far;
}

static void say(const fill_case *c)
{
    const ew_target *g = &c->target;
    const ew_texture *t = &c->texture;
    const ew_material *m = &c->material;
    const ref_run *r = &c->run;
    test_context("target format %d dither %d rows from %u stride %d%s; texture %s %dx%d format %d wraps %d %d levels %d key %x; "
                 "colour %x rung %d flags %d blend %d filter %d; run %d,%d n %d w %lld %+lld u %lld %+lld v %lld %+lld "
                 "down %lld %lld shade %lld %+lld; fog %x %lld..%lld",
                 g->format, g->dither, g->first_row, g->stride, g->depth ? "" : " no depth", m->texture ? "" : "(none)",
                 t->width, t->height, t->format, t->wrap_u, t->wrap_v, t->levels, t->key, m->colour, m->rung, m->flags,
                 m->blend, m->filter, r->x, r->y, r->n, (long long)r->w, (long long)r->dw, (long long)r->u,
                 (long long)r->du, (long long)r->v, (long long)r->dv, (long long)r->u_down, (long long)r->v_down,
                 (long long)r->shade[0], (long long)r->dshade[0], c->fog.colour, (long long)c->fog.far,
                 (long long)c->fog.near);
}

/* Whether the build leaves a part out that the case needs. */
static int target_needs_more(const ew_target *t)
{
    return (!EW_WITH_TARGET_FORMATS && t->format) || (!EW_WITH_DITHER && t->dither);
}
static int power_of_two(uint32_t n) { return n == 1u << (31 - __builtin_clz(n)); }
static int material_needs_more(const ew_material *m)
{
    const ew_texture *t = m->texture;
    return (!EW_WITH_SHADING && (m->flags & EW_SHADED)) || (!EW_WITH_FOG && (m->flags & EW_FOG)) ||
           (!EW_WITH_BLENDS && m->blend) ||
           (t && ((!EW_WITH_CUTOUTS && (m->flags & (EW_COLOUR_KEY | EW_ALPHA_MASK))) || (!EW_WITH_BILINEAR && m->filter) ||
                  (!EW_WITH_MIPS && (t->levels > 1 || m->filter == EW_FILTER_TRILINEAR)) ||
                  (!EW_WITH_WRAPS && (t->wrap_u || t->wrap_v || !power_of_two(t->width) || !power_of_two(t->height))) ||
                  (!EW_WITH_TEXTURE_FORMATS && t->format)));
}

/* Returns whether the build can draw the case. */
static int begin(ew_raster *raster, const fill_case *c)
{
    const ew_target target = target_in(c, &drawn);
    int refused = target_needs_more(&target);
    assert_int_equal(ew_raster_init(raster, &target), refused ? EW_ERR_UNSUPPORTED : EW_OK);
    if (refused) return 0;
    refused = material_needs_more(&c->material);
    assert_int_equal(ew_raster_set_material(raster, &c->material), refused ? EW_ERR_UNSUPPORTED : EW_OK);
    if (refused) return 0;
    int fog = ew_raster_set_fog(raster, c->fog.colour, (uint32_t)c->fog.near, (uint32_t)c->fog.far);
    assert_int_equal(fog, EW_WITH_FOG ? EW_OK : EW_ERR_UNSUPPORTED);
    return 1;
}

static ew_run core_run(const ref_run *r)
{
    ew_run run = { .x = (uint16_t)r->x, .y = (uint16_t)r->y, .w = (uint32_t)r->w, .dw = (uint32_t)r->dw };
    run.u = (uint64_t)r->u, run.du = (uint64_t)r->du, run.v = (uint64_t)r->v, run.dv = (uint64_t)r->dv;
    run.u_down = (uint64_t)r->u_down, run.v_down = (uint64_t)r->v_down;
    for (int k = 0; k < 3; k++) run.shade[k] = (int32_t)r->shade[k], run.dshade[k] = (int32_t)r->dshade[k];
    return run;
}

static int same_pixels(void) { return memcmp(&drawn, &expected, sizeof drawn) == 0; }

static void print_differences(const fill_case *c, const ew_rect *rect)
{
    const ew_target mine = target_in(c, &drawn), right = target_in(c, &expected);
    for (int y = rect->y0; y < rect->y1; y++) {
        for (int x = rect->x0; x < rect->x1; x++) {
            unsigned value = ref_read(&mine, x, y), wanted = ref_read(&right, x, y);
            if (value != wanted) printf("# pixel %d,%d: %x, expected %x\n", x, y, value, wanted);
        }
    }
}

/* Draws with both and compares all memory. A level's lambda is only known to 1/150. */
static void check_case(const fill_case *c)
{
    ew_raster raster;
    drawn = before;
    if (!begin(&raster, c)) return;
    ew_run run = core_run(&c->run);
    ew_fill_any(&raster, &run, c->run.n);
    const ew_target target = target_in(c, &expected);
    const int textured = c->material.texture && c->material.rung != EW_RUNG_CONSTANT;
    double lambda = textured && c->texture.levels > 1 ? 256 * ref_lambda(&c->run) : 0;
    int from = lambda > 0 ? (int)ceil(lambda - 256 / 150.0) : 0, to = lambda > -256 / 150.0 ? (int)floor(lambda + 256 / 150.0) : 0;
    if (!(textured && c->texture.levels > 1)) from = to = 0;
    for (int k = from < 0 ? 0 : from; k <= to; k++) {
        expected = before;
        ref_fill(&target, &c->material, &c->fog, &c->run, k);
        if (same_pixels()) return;
    }
    const ew_run at = core_run(&c->run);
    const ew_rect of_run = { at.x, at.y, (uint16_t)(at.x + c->run.n), (uint16_t)(at.y + 1) };
    print_differences(c, &of_run);
    fail_msg("differs from the referee");
}

static void random_memory(void)
{
    random_bytes(&before, sizeof before);
    random_bytes(texels, sizeof texels);
    random_bytes(mask, sizeof mask);
    random_bytes(palette, sizeof palette);
}

/* Depths that stand where the case draws: one below, equal, one above. */
static void near_depths(const fill_case *c)
{
    for (int i = 0; i < c->run.n; i++) {
        const int64_t w = c->run.w + i * c->run.dw, d = w < 0 ? 0 : w >> 15 > 65535 ? 65535 : w >> 15;
        before.depth[GUARD + (c->run.y - c->target.first_row) * c->target.stride + c->run.x + i] = (uint16_t)(d + (int64_t)below(3) - 1);
    }
}

static void any_combination(void **state)
{
    (void)state;
    fill_case c;
    for (int n = 0; n < 60000 / SHARE; n++) {
        if (n % 2000 == 0) random_memory();
        random_case(&c);
        if (chance(2)) near_depths(&c);
        say(&c);
        check_case(&c);
    }
}

/* Any bits in a run: nothing but the pixels of the run is written. */
static void any_run(void **state)
{
    (void)state;
    fill_case c;
    random_memory();
    for (int n = 0; n < 30000 / SHARE; n++) {
        ew_raster raster;
        random_case(&c);
        say(&c);
        drawn = before;
        if (!begin(&raster, &c)) continue;
        ew_run run;
        random_bytes(&run, sizeof run);
        run.x = (uint16_t)c.run.x, run.y = (uint16_t)c.run.y;
        if (chance(2)) run.u = (uint64_t)(int64_t)test_awkward() << 32, run.du = (uint64_t)(int64_t)test_awkward();
        ew_fill_any(&raster, &run, c.run.n);
        const ew_target mine = target_in(&c, &drawn), was = target_in(&c, &before);
        for (int i = 0; i < c.run.n; i++) { /* put them back: then nothing may have changed */
            const int x = c.run.x + i, y = c.run.y - mine.first_row, bits = ref_target_bits(mine.format);
            uint8_t *row = (uint8_t *)mine.colour + (size_t)y * ref_row_bytes(mine.stride, bits);
            const uint8_t *row_was = (const uint8_t *)was.colour + (size_t)y * ref_row_bytes(mine.stride, bits);
            for (int bit = x * bits; bit < (x + 1) * bits; bit++) {
                const int one = 0x80 >> bit % 8;
                row[bit / 8] = (uint8_t)((row[bit / 8] & ~one) | (row_was[bit / 8] & one));
            }
            if (mine.depth) mine.depth[y * mine.stride + x] = was.depth[y * mine.stride + x];
        }
        assert_memory_equal(&drawn, &before, sizeof drawn);
    }
}

/* ---- conversions ---- */

/* Every colour, format and threshold, by clearing 8 x 8 pixels. */
static void conversions(void **state)
{
    (void)state;
    static uint16_t memory[8 * 8];
    for (int format = 0; format <= EW_TARGET_MONO; format++) {
        for (uint8_t dither = 0; dither < 2; dither++) {
            const ew_target target = { .colour = memory, .width = 8, .height = 8, .stride = 8, .format = (uint8_t)format, .dither = dither };
            ew_raster raster;
            if (target_needs_more(&target)) continue;
            assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
            for (uint32_t colour = 0; colour < 65536; colour += dither ? SHARE : 7) {
                int c[3], wrong = 0;
                ref_decode_565(&target, colour, c);
                ew_raster_clear(&raster, (uint16_t)colour);
                for (int i = 0; i < 64; i++) wrong += ref_read(&target, i % 8, i / 8) != ref_convert(&target, c, i % 8, i / 8);
                if (wrong) fail_msg("format %d dither %d colour %04x: %d pixels", format, dither, colour, wrong);
            }
        }
    }
}

#if EW_WITH_DITHER && EW_WITH_TEXTURE_FORMATS && EW_WITH_TARGET_FORMATS
/* Draws a texture of 256 texels whose stored values are 0 to 255 (or all RGB565 values, 256 at
 * a time), texel i at pixel i, to a target of 256 x 8. Returns the number of wrong pixels. */
static int copied(int texture_format, int target_format, const uint16_t *stored, unsigned (*expect)(unsigned))
{
    static uint16_t out[256 * 8];
    static _Alignas(2) uint8_t bytes[256];
    int wrong = 0;
    for (int i = 0; i < 256; i++) bytes[i] = (uint8_t)stored[i];
    const ew_texture texture = { .texels = texture_format == EW_TEXTURE_RGB565 ? (const void *)stored : bytes, .width = 256, .height = 1, .format = (uint8_t)texture_format };
    const ew_material material = { .texture = &texture };
    const ew_target target = { .colour = out, .width = 256, .height = 8, .stride = 256, .format = (uint8_t)target_format, .dither = 1 };
    ew_raster raster;
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
    for (uint16_t y = 0; y < 8; y++) {
        for (uint64_t turn = 0; turn < 8; turn++) { /* each texel on each column of the matrix */
            ew_run run = { .y = y, .u = turn << 32, .du = UINT64_C(1) << 32 };
            ew_fill_any(&raster, &run, 256);
            for (int x = 0; x < 256; x++) wrong += ref_read(&target, x, y) != expect(stored[(x + (int)turn) % 256]);
        }
    }
    return wrong;
}

static unsigned same(unsigned v) { return v; }
static unsigned upper_half(unsigned v) { return v >> 4; }
static unsigned upper_bit(unsigned v) { return v >> 7; }

static void dither_leaves_what_needs_none(void **state)
{
    (void)state;
    uint16_t stored[256];
    for (int i = 0; i < 256; i++) stored[i] = (uint16_t)i;
    assert_int_equal(copied(EW_TEXTURE_GREY8, EW_TARGET_GREY8, stored, same), 0);
    assert_int_equal(copied(EW_TEXTURE_RGB332, EW_TARGET_RGB332, stored, same), 0);
    for (int i = 0; i < 256; i++) stored[i] = (uint16_t)(i % 16 * 17);
    assert_int_equal(copied(EW_TEXTURE_GREY8, EW_TARGET_GREY4, stored, upper_half), 0);
    for (int i = 0; i < 256; i++) stored[i] = i % 3 ? 255 : 0;
    assert_int_equal(copied(EW_TEXTURE_GREY8, EW_TARGET_MONO, stored, upper_bit), 0);
    for (int page = 0; page < 256; page += SHARE) {
        for (int i = 0; i < 256; i++) stored[i] = (uint16_t)(page * 256 + i);
        assert_int_equal(copied(EW_TEXTURE_RGB565, EW_TARGET_RGB565, stored, same), 0);
        assert_int_equal(copied(EW_TEXTURE_RGB565, EW_TARGET_RGB565_SWAPPED, stored, same), 0);
    }
}
#endif

#if EW_WITH_DITHER && EW_WITH_TARGET_FORMATS
/* The share of white pixels in a mono picture is the grey's, to 1/64 and a rounding. */
static void dither_keeps_the_mean(void **state)
{
    (void)state;
    static uint8_t memory[8];
    const ew_target target = { .colour = memory, .width = 8, .height = 8, .stride = 8, .format = EW_TARGET_MONO, .dither = 1 };
    ew_raster raster;
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    for (unsigned green = 0; green < 64; green++) {
        int white = 0;
        ew_raster_clear(&raster, (uint16_t)(green << 5 | green >> 1 << 11 | green >> 1));
        for (int i = 0; i < 64; i++) white += (int)ref_read(&target, i % 8, i / 8);
        /* red and blue have a bit less */
        if (fabs(white - green * 64.0 / 63) > 1.6) fail_msg("grey %u/63: %d of 64 pixels are white", green, white);
    }
}
#endif

/* ---- textures ---- */

static int expected_texel(int wrap, int size, int64_t i)
{
    int64_t m = i % size;
    if (wrap == EW_WRAP_CLAMP) return (int)(i < 0 ? 0 : i >= size ? size - 1 : i);
    if (wrap == EW_WRAP_REPEAT) return (int)(m < 0 ? m + size : m);
    m = i % (2 * size);
    if (m < 0) m += 2 * size;
    return (int)(m < size ? m : 2 * size - 1 - m);
}

/* Every size and wrap; texel numbers as colours, along u and along v. */
static void sizes_and_wraps(void **state)
{
    (void)state;
    static uint16_t numbers[2048], out[W];
    for (int i = 0; i < 2048; i++) numbers[i] = (uint16_t)i;
    const ew_target target = { .colour = out, .width = W, .height = 1, .stride = W };
    ew_raster raster;
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    for (int size = 1; size <= 2048; size += size < 40 ? 1 : size < 2000 ? 67 : 1) {
        for (int n = 0; n < 3 * 2 * 20; n++) {
            const int wrap = n % 3, along_v = n / 3 % 2;
            const ew_texture texture = { .texels = numbers, .width = (uint16_t)(along_v ? 1 : size), .height = (uint16_t)(along_v ? size : 1), .wrap_u = (uint8_t)wrap, .wrap_v = (uint8_t)wrap };
            const ew_material material = { .texture = &texture };
            if (material_needs_more(&material)) continue;
            assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
            int64_t u = any_signed(32 + (n < 60 ? 7u : 30u)), du = any_signed(32 + (n < 60 ? 2u : 24u));
            if (n % 7 == 0) u &= ~(int64_t)0xFFFFFFFF, du &= ~(int64_t)0xFFFFFFFF; /* exactly on borders */
            ew_run run = { .u = (uint64_t)u, .du = (uint64_t)du, .v = (uint64_t)any_signed(60), .dv = (uint64_t)any_signed(60) };
            if (along_v) run = (ew_run){ .v = run.u, .dv = run.du, .u = run.v, .du = run.dv };
            ew_fill_any(&raster, &run, W);
            for (int i = 0; i < W; i++) {
                int64_t texel = EW_ASR(u + i * du, 32);
                if (out[i] != expected_texel(wrap, size, texel)) {
                    fail_msg("size %d wrap %d %s u %lld %+lld, pixel %d: %d", size, wrap, along_v ? "v" : "u", (long long)u, (long long)du, i, out[i]);
                }
            }
        }
    }
}

#if EW_WITH_BILINEAR && EW_WITH_WRAPS && EW_WITH_TEXTURE_FORMATS && EW_WITH_TARGET_FORMATS
/* Bilinear on a grey ramp of random texels: within D / 16 + 1 of the exact, D = 4095 at most. */
static void bilinear_is_near_the_exact(void **state)
{
    (void)state;
    enum { SIZE = 7 };
    static uint8_t grey[SIZE * SIZE], out[W];
    const ew_target target = { .colour = out, .width = W, .height = 1, .stride = W, .format = EW_TARGET_GREY8 };
    const ew_texture texture = { .texels = grey, .width = SIZE, .height = SIZE, .format = EW_TEXTURE_GREY8, .wrap_u = EW_WRAP_CLAMP };
    const ew_material material = { .texture = &texture, .filter = EW_FILTER_BILINEAR };
    ew_raster raster;
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
    double worst = 0;
    for (int n = 0; n < 2000 / SHARE; n++) {
        random_bytes(grey, sizeof grey);
        for (int i = 0; n % 2 == 0 && i < SIZE * SIZE; i++) grey[i] = grey[i] & 1 ? 255 : 0;
        ew_run run = { .u = (uint64_t)any_signed(36), .du = (uint64_t)any_signed(32), .v = (uint64_t)any_signed(36), .dv = (uint64_t)any_signed(32) };
        double u = ldexp((double)(int64_t)run.u, -32), du = ldexp((double)(int64_t)run.du, -32);
        double v = ldexp((double)(int64_t)run.v, -32), dv = ldexp((double)(int64_t)run.dv, -32);
        ew_fill_any(&raster, &run, W);
        for (int i = 0; i < W; i++) {
            double x = u + i * du - 0.5, y = v + i * dv - 0.5, sum = 0;
            for (int k = 0; k < 4; k++) {
                double share = (k & 1 ? x - floor(x) : 1 - x + floor(x)) * (k & 2 ? y - floor(y) : 1 - y + floor(y));
                int column = expected_texel(EW_WRAP_CLAMP, SIZE, (int64_t)floor(x) + (k & 1));
                int row = expected_texel(EW_WRAP_REPEAT, SIZE, (int64_t)floor(y) + (k >> 1));
                sum += share * grey[row * SIZE + column];
            }
            worst = fmax(worst, fabs(out[i] + 0.5 - sum));
        }
    }
    /* in 8 bits: 255 / 16, the floors of filter and target */
    if (getenv("EW_PRINT")) printf("# bilinear: %.2f of 255 at most\n", worst);
    assert_true(worst < 255 / 16.0 + 1);
    assert_true(worst > 1); /* it was measured */
}
#endif

#if EW_WITH_MIPS
static void levels_are_near_the_exact(void **state)
{
    (void)state;
    double low = 0, high = 0;
    for (int n = 0; n < 1000000 / SHARE; n++) {
        const uint32_t bits = 25 + below(23); /* up to 2^15 texels per pixel: rho below 2^15.5 */
        ref_run r = { .du = any_signed(bits), .dv = any_signed(bits), .u_down = any_signed(bits), .v_down = any_signed(bits) };
        if (n % 4 == 0) r.dv = r.u_down = r.v_down = 0;
        const ew_run run = core_run(&r);
        double exact = ref_lambda(&r), off = ew_texture_level(&run) / 256.0 - fmax(0, exact);
        if (exact > 15) continue;
        test_context("du %lld dv %lld down %lld %lld: lambda %g, off %g", (long long)r.du, (long long)r.dv, (long long)r.u_down, (long long)r.v_down, exact, off);
        low = fmin(low, off), high = fmax(high, off);
        assert_true(fabs(off) < 1 / 150.0);
    }
    if (getenv("EW_PRINT")) printf("# lambda: %+.4f to %+.4f off\n", low, high);
    assert_true(high - low > 0.005); /* it was measured */
    const ew_run still = { .x = 0 }, wild = { .du = UINT64_C(1) << 63, .dv = UINT64_C(1) << 62 };
    assert_int_equal(ew_texture_level(&still), 0);
    assert_in_range(ew_texture_level(&wild), 14 * 256, 17 * 256);
}
#endif

#if EW_WITH_MIPS && EW_WITH_BILINEAR && EW_WITH_TEXTURE_FORMATS && EW_WITH_TARGET_FORMATS
/* White levels above black ones and so on: as rho grows by 1 %, grey moves by little. */
static void trilinear_has_no_seam(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    static uint8_t grey[2 * SIZE * SIZE], out[1];
    const ew_target target = { .colour = out, .width = 1, .height = 1, .stride = 1, .format = EW_TARGET_GREY8 };
    const ew_texture texture = { .texels = grey, .width = SIZE, .height = SIZE, .format = EW_TEXTURE_GREY8, .levels = 7 };
    const ew_material material = { .texture = &texture, .filter = EW_FILTER_TRILINEAR };
    ew_raster raster;
    size_t at = 0;
    for (int k = 0; k < 7; k++) {
        size_t size = (size_t)(SIZE >> k) * (size_t)(SIZE >> k);
        memset(grey + at, k & 1 ? 255 : 0, size);
        at += size;
    }
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    assert_int_equal(ew_raster_set_material(&raster, &material), EW_OK);
    int last = -1, least = 255, most = 0;
    for (double rho = 0.5; rho < 200; rho *= 1.01) {
        ew_run run = { .du = (uint64_t)(int64_t)ldexp(rho, 32) };
        ew_fill_any(&raster, &run, 1);
        /* log2 1.01 = 0.0144 levels, twice lambda's error */
        if (last >= 0 && abs(out[0] - last) > 255 * 0.03) fail_msg("from %d to %d at rho = %g", last, out[0], rho);
        last = out[0];
        least = last < least ? last : least, most = last > most ? last : most;
    }
    assert_int_equal(last, 0); /* level 6 */
    assert_true(least == 0 && most >= 252);
}
#endif

/* ---- fog ---- */

#if EW_WITH_FOG
static void fog_is_linear(void **state)
{
    (void)state;
    for (int n = 0; n < 20000 / SHARE; n++) {
        static uint16_t out[1];
        const ew_target target = { .colour = out, .width = 1, .height = 1, .stride = 1 };
        const ew_material black = { .rung = EW_RUNG_CONSTANT, .flags = EW_FOG };
        ew_raster raster;
        assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
        assert_int_equal(ew_raster_set_material(&raster, &black), EW_OK);
        uint32_t near, far;
        random_fog(&near, &far);
        ew_run run = { .w = n & 1 ? far + below(near - far) : n & 2 ? near : far };
        const double share = (double)(near - run.w) / (near - far);
        test_context("fog %u to %u, w %u", near, far, run.w);
        assert_int_equal(ew_raster_set_fog(&raster, 0x07E0, near, far), EW_OK);
        ew_fill_any(&raster, &run, 1);
        assert_true(fabs((out[0] >> 5) - 63 * share) < 1 + 63 / 256.0);
        if (share <= 0 || share >= 1) assert_int_equal(out[0], share > 0 ? 0x07E0 : 0);
    }
}
#endif

/* ---- through the public calls ---- */

/* Often what span.c has loops of its own for. */
static void likely_plain(fill_case *c)
{
    c->texture.levels = 0;
    if (chance(2)) c->texture.format = EW_TEXTURE_RGB565;
    if (chance(2)) c->texture.width = (uint16_t)(1u << below(7)), c->texture.height = (uint16_t)(1u << below(7));
    if (chance(2)) c->texture.wrap_u = 0;
    if (chance(2)) c->texture.wrap_v = 0;
    if (chance(2)) c->target.format = EW_TARGET_RGB565;
    if (chance(2)) c->material.flags &= EW_SHADED | EW_DOUBLE_SIDED;
    if (chance(2)) c->material.filter = c->material.blend = 0;
    c->material.rung = (uint8_t)below(EW_RUNG_COUNT);
}

/* Two triangles over the whole target: every part of span.c, and clears, draw what the page says. */
static void triangles_and_clears(void **state)
{
    (void)state;
    fill_case c;
    random_memory();
    for (int n = 0; n < 10000 / SHARE; n++) {
        ew_raster raster;
        random_bytes(&before, sizeof before);
        random_case(&c);
        likely_plain(&c);
        c.material.flags &= (uint8_t)~(EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE);
        say(&c);
        drawn = before;
        if (!begin(&raster, &c)) continue;
        const uint16_t background = (uint16_t)test_random();
        const ew_target target = target_in(&c, &expected);
        const ew_rect part = { (uint16_t)below(target.width), (uint16_t)(target.first_row + 1), target.width,
                               (uint16_t)(target.first_row + 2 + below(H - 1)) };
        assert_int_equal(ew_raster_set_scissor(&raster, &part), EW_OK);
        ew_raster_clear(&raster, background);
        const ew_uq1_31 w = 65536 + below((1u << 31) - 65536);
        /* texel = pixel, some texels and a quarter aside: a weight of 8/32, if somebody weighs */
        const int32_t u0 = ((int32_t)below(400) - 200) * 4096 + 1024, v0 = ((int32_t)below(400) - 200) * 4096;
        const ew_colour888 light = { (uint8_t)test_random(), (uint8_t)test_random(), (uint8_t)test_random() };
        ew_raster_vertex corner[4];
        for (int i = 0; i < 4; i++) {
            const int32_t x = i >= 2 ? W * 4096 : 0, y = (target.first_row + (i == 1 || i == 2 ? H : 0)) * 4096;
            corner[i] = (ew_raster_vertex){ .x = x, .y = y, .w = w, .u = x + u0, .v = y + v0, .colour = light };
        }
        assert_true(ew_raster_triangle(&raster, &corner[0], &corner[1], &corner[2]) >= 0);
        assert_true(ew_raster_triangle(&raster, &corner[0], &corner[2], &corner[3]) >= 0);

        expected = before;
        const ew_material clear = { .colour = background, .flags = EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE };
        for (int y = part.y0; y < part.y1; y++) {
            ref_run r = { .x = part.x0, .y = y, .n = part.x1 - part.x0, .w = w };
            r.u = (part.x0 * 4096 + 2048 + (int64_t)u0) * (1 << 20), r.du = (int64_t)1 << 32;
            r.v = (y * 4096 + 2048 + (int64_t)v0) * (1 << 20);
            r.shade[0] = (light.r + (light.r >> 7)) << 16, r.shade[1] = (light.g + (light.g >> 7)) << 16;
            r.shade[2] = (light.b + (light.b >> 7)) << 16;
            ref_fill(&target, &clear, &c.fog, &r, 0);
            for (int x = part.x0; x < part.x1; x++) {
                if (target.depth) target.depth[(y - target.first_row) * target.stride + x] = 0;
            }
            ref_fill(&target, &c.material, &c.fog, &r, 0);
        }
        if (!same_pixels()) {
            print_differences(&c, &part);
            fail_msg("differs from the referee");
        }
    }
}

/* ---- loops ---- */

/* Which are in the build. */
#define X(name, has) EW_WITH_LOOP_##name,
static const uint8_t with[LOOP_COUNT] = { 1, 1, LOOPS(X) };
#undef X

/* What the loops of loops.c are for, and what is nearly that. */
static void likely_loop(fill_case *c)
{
    static const uint8_t formats[] = { EW_TARGET_RGB565, EW_TARGET_RGB565_SWAPPED, EW_TARGET_GREY4 };
    static const uint8_t flags[] = { 0, EW_SHADED, EW_COLOUR_KEY, EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE };
    ew_texture *t = &c->texture;
    ew_material *m = &c->material;
    if (!chance(8)) c->target.format = formats[below(3)], c->target.stride = (uint16_t)((c->target.stride + 1) & ~1);
    if (c->target.format != EW_TARGET_GREY4) c->target.dither = (uint8_t)chance(8);
    do t->width = (uint16_t)(1u << below(12)), t->height = (uint16_t)(1u << below(12));
    while ((uint32_t)t->width * t->height > TEXELS_MOST / 4);
    t->levels = t->width > 1 && chance(8) ? 2 : 0, t->format = chance(8) ? t->format : EW_TEXTURE_RGB565;
    if (!chance(8)) t->wrap_u = t->wrap_v = 0;
    t->key = ((const uint16_t *)(const void *)texels)[below(16)];
    m->flags = flags[below(4)];
    if (chance(8)) m->flags |= (uint8_t)(1u << below(7));
    m->flags |= EW_DOUBLE_SIDED;
    m->filter = (uint8_t)(chance(20) ? 2 : below(2));
    m->blend = (uint8_t)chance(20);
    m->rung = (uint8_t)(chance(2) ? EW_RUNG_AUTO : below(EW_RUNG_COUNT));
    m->tolerance = (uint16_t)(chance(4) ? EW_TOLERANCE_MAX : below(chance(2) ? 5 : 64)); /* light may leave its range */
    fit_to_build(c);
}

static void likely_corner(ew_raster_vertex *v, int first_row, uint32_t w_bits, uint32_t uv_bits)
{
    v->x = (int32_t)below(3 * W * 4096) - W * 4096, v->y = (int32_t)below(3 * H * 4096) + (first_row - H) * 4096;
    v->w = 1 + (test_random() >> 1 >> below(w_bits));
    v->u = (int32_t)any_signed(uv_bits), v->v = (int32_t)any_signed(uv_bits);
    uint8_t *channel[3] = { &v->colour.r, &v->colour.g, &v->colour.b };
    for (int k = 0; k < 3; k++) *channel[k] = (uint8_t)(chance(2) ? test_random() : chance(2) ? 255 : 0);
}

/* Every loop against the generic path: colours and depths, bit for bit. */
static void loops_and_the_generic_path_agree(void **state)
{
    (void)state;
    int drawn_with[LOOP_COUNT] = { 0 };
    fill_case c;
    random_memory();
    for (int n = 0; n < 60000 / SHARE; n++) {
        ew_raster raster;
        if (n % 1000 == 0) random_memory();
        for (int i = 0; n % 2000 == 0 && i < TEXELS_MOST; i++) texels[i] &= 0x11; /* some equal the key */
        random_case(&c);
        likely_loop(&c);
        drawn = before;
        if (!begin(&raster, &c)) continue;
        assert_true(raster.loop < LOOP_COUNT && with[raster.loop]);
        if (raster.loop <= LOOP_TEXTURED) continue;
        const ew_raster with_loop = raster;
        ew_raster_vertex v[3];
        const uint32_t w_bits = chance(4) ? 31 : 1 + below(4), uv_bits = 15 + below(13);
        for (int k = 0; k < 3; k++) likely_corner(&v[k], c.target.first_row, w_bits, uv_bits);
        if (chance(4)) v[1].w = v[2].w = v[0].w;
        if (chance(4)) v[1].colour = v[2].colour = v[0].colour;
        say(&c);
        /* below all depths now and then */
        for (size_t i = 0; chance(2) && i < sizeof drawn.depth / sizeof *drawn.depth; i++) drawn.depth[i] = 0;
        const pixels at_first = drawn;
        raster.loop = LOOP_NONE;
        if (ew_raster_triangle(&raster, &v[0], &v[1], &v[2]) <= 0) continue;
        expected = drawn;
        drawn = at_first;
        raster = with_loop;
        assert_int_equal(ew_raster_triangle(&raster, &v[0], &v[1], &v[2]), 1);
        drawn_with[raster.loop]++;
        if (!same_pixels()) {
            const ew_rect whole = raster.scissor;
            print_differences(&c, &whole);
            fail_msg("loop %d differs from the generic path, corners %d,%d,%u %d,%d %d,%d,%u %d,%d %d,%d,%u %d,%d", with_loop.loop,
                     v[0].x, v[0].y, v[0].w, v[0].u, v[0].v, v[1].x, v[1].y, v[1].w, v[1].u, v[1].v, v[2].x, v[2].y, v[2].w,
                     v[2].u, v[2].v);
        }
    }
    for (int k = LOOP_FLAT; k < LOOP_COUNT; k++) {
        if (getenv("EW_PRINT")) printf("# loop %d: %d triangles\n", k, drawn_with[k]);
        assert_true((drawn_with[k] > 200 / SHARE) == with[k]);
    }
}

/* What goes through which loop: were another one chosen, the pixels would be the same. */
static void loops_are_chosen(void **state)
{
    (void)state;
    enum { NO_DEPTH = EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE, WITHOUT = 1, SWAPPED = EW_TARGET_RGB565_SWAPPED };
    static const struct {
        uint8_t untextured, flags, filter, format, dither, no_buffer, loop;
    } cases[] = {
        { .loop = LOOP_TEXTURED }, { .flags = EW_DOUBLE_SIDED, .dither = 1, .loop = LOOP_TEXTURED },
        { WITHOUT, .loop = LOOP_FLAT }, { WITHOUT, EW_COLOUR_KEY | EW_ALPHA_MASK, .format = SWAPPED, .loop = LOOP_FLAT },
        { WITHOUT, EW_SHADED, .loop = LOOP_GOURAUD }, { WITHOUT, EW_SHADED, .dither = 1, .loop = LOOP_NONE },
        { .flags = NO_DEPTH, .loop = LOOP_NO_DEPTH }, { .no_buffer = 1, .loop = LOOP_NO_DEPTH },
        { .flags = EW_NO_DEPTH_TEST, .loop = LOOP_NONE }, { .flags = EW_NO_DEPTH_WRITE, .loop = LOOP_NONE },
        { .flags = EW_COLOUR_KEY, .loop = LOOP_KEYED }, { .format = SWAPPED, .loop = LOOP_KEYED },
        { .flags = EW_SHADED, .loop = LOOP_LIT }, { .flags = EW_SHADED | EW_FOG, .loop = LOOP_NONE },
        { .filter = EW_FILTER_BILINEAR, .loop = LOOP_BILINEAR }, { .filter = EW_FILTER_BILINEAR, .dither = 1, .loop = LOOP_NONE },
        { .format = EW_TARGET_GREY4, .dither = 1, .loop = LOOP_GREY4 }, { .format = EW_TARGET_GREY8, .loop = LOOP_NONE },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const ew_texture texture = { .texels = texels, .width = 16, .height = 8, .mask = mask };
        const ew_material m = { .texture = cases[i].untextured ? NULL : &texture, .flags = cases[i].flags, .filter = cases[i].filter };
        const ew_target target = { .colour = drawn.colour, .depth = cases[i].no_buffer ? NULL : drawn.depth, .width = 8, .height = 4,
                                   .stride = 8, .format = cases[i].format, .dither = cases[i].dither };
        ew_raster raster;
        test_context("case %zu", i);
        if (target_needs_more(&target) || material_needs_more(&m)) continue;
        assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
        assert_int_equal(ew_raster_set_material(&raster, &m), EW_OK);
        assert_int_equal(raster.loop, with[cases[i].loop] ? cases[i].loop : LOOP_NONE);
    }
}

static int material_result(ew_raster *raster, const ew_material *m) { return ew_raster_set_material(raster, m); }

static void arguments_are_checked(void **state)
{
    (void)state;
    static uint16_t memory[64], entries[256];
    ew_target t = { .colour = memory, .width = 5, .height = 4, .stride = 8 };
    ew_raster raster;
    assert_int_equal(ew_raster_init(&raster, &t), EW_OK);
    t.format = 6;
    assert_int_equal(ew_raster_init(&raster, &t), EW_ERR_ARGUMENT);
    t.format = 0, t.dither = 2;
    assert_int_equal(ew_raster_init(&raster, &t), EW_ERR_ARGUMENT);
    t.dither = 0, t.colour = (uint8_t *)memory + 1;
    assert_int_equal(ew_raster_init(&raster, &t), EW_ERR_ARGUMENT);
    t.colour = memory, t.depth = (uint16_t *)(void *)((uint8_t *)memory + 1);
    assert_int_equal(ew_raster_init(&raster, &t), EW_ERR_ARGUMENT);
    t.depth = NULL, t.first_row = EW_TARGET_MAX - 3;
    assert_int_equal(ew_raster_init(&raster, &t), EW_ERR_ARGUMENT);
    t.first_row = 0;
#if EW_WITH_TARGET_FORMATS
    t.format = EW_TARGET_GREY4, t.stride = 7;
    assert_int_equal(ew_raster_init(&raster, &t), EW_ERR_ARGUMENT);
    t.format = EW_TARGET_MONO, t.stride = 12;
    assert_int_equal(ew_raster_init(&raster, &t), EW_ERR_ARGUMENT);
    t.stride = 8, t.colour = (uint8_t *)memory + 1; /* bytes lie anywhere */
    assert_int_equal(ew_raster_init(&raster, &t), EW_OK);
    t.colour = memory;
#endif
    t.format = 0, t.stride = 8;
    assert_int_equal(ew_raster_init(&raster, &t), EW_OK);

    ew_texture x = { .texels = memory, .width = 8, .height = 4 };
    ew_material m = { .texture = &x }, wrong;
    assert_int_equal(material_result(&raster, &m), EW_OK);
    wrong = m, wrong.blend = 3;
    assert_int_equal(material_result(&raster, &wrong), EW_ERR_ARGUMENT);
    wrong = m, wrong.filter = 3;
    assert_int_equal(material_result(&raster, &wrong), EW_ERR_ARGUMENT);
    wrong = m, wrong.flags = 128;
    assert_int_equal(material_result(&raster, &wrong), EW_ERR_ARGUMENT);
    wrong = m, wrong.flags = EW_ALPHA_MASK; /* and no mask */
    assert_int_equal(material_result(&raster, &wrong), EW_ERR_ARGUMENT);
    x.format = 6;
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.format = EW_TEXTURE_PALETTE4; /* and no palette */
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.palette = (const uint16_t *)(const void *)((uint8_t *)entries + 1);
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.palette = entries;
    assert_int_equal(material_result(&raster, &m), EW_WITH_TEXTURE_FORMATS ? EW_OK : EW_ERR_UNSUPPORTED);
    x.format = 0, x.texels = (uint8_t *)memory + 1;
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.texels = memory, x.wrap_v = 3;
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.wrap_v = 0, x.wrap_u = 3;
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.wrap_u = 0, x.levels = 5; /* 8 4 2 1 */
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.levels = 4;
    assert_int_equal(material_result(&raster, &m), EW_WITH_MIPS ? EW_OK : EW_ERR_UNSUPPORTED);
    x.levels = 0, x.height = 0;
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.height = 2049;
    assert_int_equal(material_result(&raster, &m), EW_ERR_ARGUMENT);
    x.height = 3;
    assert_int_equal(material_result(&raster, &m), EW_WITH_WRAPS ? EW_OK : EW_ERR_UNSUPPORTED);

    assert_int_equal(ew_raster_set_fog(&raster, 0, 5, 5), EW_ERR_ARGUMENT);
    assert_int_equal(ew_raster_set_fog(&raster, 0, 5, 6), EW_ERR_ARGUMENT);
    assert_int_equal(ew_raster_set_fog(&raster, 0, 0x80000001u, 6), EW_ERR_ARGUMENT);
    assert_int_equal(ew_raster_set_fog(&raster, 0, 0x80000000u, 5), EW_WITH_FOG ? EW_OK : EW_ERR_UNSUPPORTED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(any_combination),
        TEST(any_run),
        TEST(conversions),
#if EW_WITH_DITHER && EW_WITH_TEXTURE_FORMATS && EW_WITH_TARGET_FORMATS
        TEST(dither_leaves_what_needs_none),
#endif
#if EW_WITH_DITHER && EW_WITH_TARGET_FORMATS
        TEST(dither_keeps_the_mean),
#endif
        TEST(sizes_and_wraps),
#if EW_WITH_BILINEAR && EW_WITH_WRAPS && EW_WITH_TEXTURE_FORMATS && EW_WITH_TARGET_FORMATS
        TEST(bilinear_is_near_the_exact),
#endif
#if EW_WITH_MIPS
        TEST(levels_are_near_the_exact),
#endif
#if EW_WITH_MIPS && EW_WITH_BILINEAR && EW_WITH_TEXTURE_FORMATS && EW_WITH_TARGET_FORMATS
        TEST(trilinear_has_no_seam),
#endif
#if EW_WITH_FOG
        TEST(fog_is_linear),
#endif
        TEST(triangles_and_clears),
        TEST(loops_are_chosen),
        TEST(loops_and_the_generic_path_agree),
        TEST(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
