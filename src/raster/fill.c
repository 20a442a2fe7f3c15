/* The generic span path: every combination of material, texture and target, a pixel at a
 * time. span.c has a loop of its own for the common ones; both draw the same pixels. */
#include "fill.h"

static uint16_t depth_of(uint32_t w)
{
    uint32_t d = w >> 15;
    return (uint16_t)(d < 1 ? 1 : d > 65535 ? 65535 : d);
}

/* Textures repeat and are powers of two wide and high. */
static uint16_t texel_at(const ew_raster *raster, uint64_t u, uint64_t v)
{
    const ew_texture *t = &raster->texture;
    const uint16_t *texels = t->texels;
    uint32_t column = (uint32_t)(u >> 32) & (t->width - 1u), row = (uint32_t)(v >> 32) & (t->height - 1u);
    return texels[(row << raster->log2_width) + column];
}

#if EW_TRACE
static ew_q20_12 within(uint64_t u, uint32_t size) { return (ew_q20_12)((u >> 20) & ((size << 12) - 1u)); }
#endif

void ew_fill_any(const ew_raster *raster, const ew_run *run, int32_t n)
{
    const size_t start = (size_t)run->y * raster->target.stride + run->x;
    uint16_t *colour = raster->target.colour + start;
    uint16_t *depth = raster->target.depth ? raster->target.depth + start : NULL;
    const int test = depth && !(raster->material.flags & EW_NO_DEPTH_TEST);
    const int write = depth && !(raster->material.flags & EW_NO_DEPTH_WRITE);
    uint32_t w = run->w;
    uint64_t u = run->u, v = run->v;
    for (int32_t i = 0; i < n; i++, w += run->dw, u += run->du, v += run->dv) {
        uint16_t d = depth_of(w);
#if EW_TRACE
        ew_trace_fragment((uint16_t)(run->x + i), run->y, d, within(u, raster->texture.width),
                          within(v, raster->texture.height));
#endif
        if (test && d <= depth[i]) continue;
        if (write) depth[i] = d;
        colour[i] = raster->texture.texels ? texel_at(raster, u, v) : raster->material.colour;
    }
}
