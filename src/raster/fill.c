/* The generic span path: every combination of material, texture and target. What is drawn most
 * has loops of its own, in span.c and loops.c; they draw the same pixels.
 *
 * A run is drawn in pieces of EW_PIECE pixels. A piece goes through one step after the other
 * - depth test, texture, depth write, light, fog, target - each a loop over its live pixels,
 * so that what to do is decided once per piece. docs/fills.md says what each step does.
 *
 * Steps stay functions of their own: inlined into each other, they would all take room on the
 * stack at the same time.
 */
#include "fill.h"

#include "arch.h"
#include "pixel.h"
#include "target.h"
#include "texture.h"

/* 1/z is above 0, but the rounding of steps may carry it a little below. */
static uint32_t above_zero(uint32_t w) { return w >= 0xC0000000u ? 0 : w; }

static uint16_t depth_of(uint32_t w)
{
    uint32_t d = above_zero(w) >> 15;
    return (uint16_t)(d < 1 ? 1 : d > 65535 ? 65535 : d);
}

static int is_live(const ew_piece *piece, int i) { return piece->live >> i & 1; }

#if EW_TRACE
static void trace(const ew_raster *raster, const ew_run *run, int n)
{
    const ew_texture *t = &raster->texture;
    for (int i = 0; i < n; i++) {
        const uint64_t k = (uint64_t)i;
        ew_trace_fragment((uint16_t)(run->x + i), run->y, depth_of(run->w + run->dw * (uint32_t)i),
                          ew_texture_traced(run->u + run->du * k, t->width, t->wrap_u),
                          ew_texture_traced(run->v + run->dv * k, t->height, t->wrap_v));
    }
}
#endif

static uint16_t *depth_at(const ew_raster *raster, const ew_run *run)
{
    return raster->target.depth + ew_row_start(&raster->target, run->y) + run->x;
}

EW_NOINLINE void test_depth(const ew_raster *raster, const ew_run *run, ew_piece *piece)
{
    const uint16_t *depth = depth_at(raster, run);
    uint32_t w = run->w;
    unsigned live = 0;
    for (int i = 0; i < piece->n; i++, w += run->dw) {
        if (depth_of(w) > depth[i]) live |= 1u << i;
    }
    piece->live = (uint8_t)live;
}

EW_NOINLINE void write_depth(const ew_raster *raster, const ew_run *run, const ew_piece *piece)
{
    uint16_t *depth = depth_at(raster, run);
    uint32_t w = run->w;
    for (int i = 0; i < piece->n; i++, w += run->dw) {
        if (is_live(piece, i)) depth[i] = depth_of(w);
    }
}

EW_HOT void ew_piece_paint(ew_piece *piece, const ew_target *target, uint16_t rgb565)
{
    uint16_t c[3];
    ew_decode_565(c, rgb565, ew_wide(target));
    for (int i = 0; i < piece->n; i++) {
        for (int k = 0; k < 3; k++) piece->colour[i][k] = c[k];
    }
}

EW_NOINLINE void shade(const ew_run *run, ew_piece *piece)
{
    for (int k = 0; k < 3; k++) {
        uint32_t s = (uint32_t)run->shade[k];
        for (int i = 0; i < piece->n; i++, s += (uint32_t)run->dshade[k]) {
            if (!is_live(piece, i)) continue;
            uint32_t light = s >> 16; /* 256: all of it */
            if (light > 256) light = s >> 31 ? 0 : 256;
            piece->colour[i][k] = (uint16_t)(piece->colour[i][k] * light >> 8); /* <= 4095 * 256 */
        }
    }
}

EW_NOINLINE void fog(const ew_raster *raster, const ew_run *run, ew_piece *piece)
{
    const uint32_t range = raster->fog_near - raster->fog_far;
    uint16_t c[3];
    ew_decode_565(c, raster->fog_colour, ew_wide(&raster->target));
    uint32_t w = run->w;
    for (int i = 0; i < piece->n; i++, w += run->dw) {
        if (!is_live(piece, i)) continue;
        uint32_t here = above_zero(w);
        uint32_t beyond = here >= raster->fog_near ? 0 : raster->fog_near - here;
        if (beyond > range) beyond = range;
        /* (range >> shift) < 2^16, and its product with the scale is from 2^31 to 2^31 + 2^16 */
        uint32_t share = (beyond >> raster->fog_shift) * raster->fog_scale >> 23;
        for (int k = 0; k < 3; k++) piece->colour[i][k] = ew_mix256(piece->colour[i][k], c[k], share);
    }
}

/* Returns whether the sampler is ready for the next piece; `ready` says whether it is for this one. */
static int fill_piece(ew_raster *raster, const ew_run *run, int n, int ready)
{
    const int flags = raster->material.flags;
    ew_piece *piece = &raster->work.now.span.fill.any.piece;
    piece->x = run->x;
    piece->y = run->y;
    piece->n = n;
    piece->live = (uint8_t)(0xFFu >> (EW_PIECE - n));
    if (raster->target.depth && !(flags & EW_NO_DEPTH_TEST)) {
        test_depth(raster, run, piece);
        if (!piece->live) return 0;
    }
    if (raster->texture.texels) {
        ew_sampler *s = &raster->work.now.span.fill.any.sampler;
        if (!ready) ew_texture_start(s, raster, run);
        do ew_texture_sample(s, piece);
        while (ew_texture_next(s, raster, run));
    } else {
        ew_piece_paint(piece, &raster->target, raster->material.colour);
    }
    if (raster->target.depth && !(flags & EW_NO_DEPTH_WRITE)) write_depth(raster, run, piece);
    if (EW_WITH_SHADING && (flags & EW_SHADED)) shade(run, piece);
    if (EW_WITH_FOG && (flags & EW_FOG)) fog(raster, run, piece);
    ew_target_put(&raster->target, piece, raster->material.blend);
    return !EW_WITH_MIPS || raster->texture.levels <= 1;
}

EW_HOT void ew_fill_any(ew_raster *raster, ew_run *run, int32_t n)
{
    for (int ready = 0;;) {
        const int count = n < EW_PIECE ? (int)n : EW_PIECE;
#if EW_TRACE
        trace(raster, run, count);
#endif
        ready = fill_piece(raster, run, count, ready);
        n -= count;
        if (n <= 0) return;
        run->x = (uint16_t)(run->x + EW_PIECE);
        run->w += run->dw * EW_PIECE;
        run->u += run->du * EW_PIECE;
        run->v += run->dv * EW_PIECE;
        for (int k = 0; k < 3; k++) {
            run->shade[k] = (int32_t)((uint32_t)run->shade[k] + (uint32_t)run->dshade[k] * EW_PIECE);
        }
    }
}
