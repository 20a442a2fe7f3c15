/* Spans: what is done for each pixel.
 *
 * One definition, span_loop, is specialised by its constant arguments into the few loops
 * that exist: colour or texture by rung, with depth in range or clamped.
 *
 * w and the two texture quantities step in 32 bits. A step is off by at most half a unit,
 * so the last of 4,096 pixels is off by 2^11 units of 2^-31 in w: 1/16 of a depth unit.
 * The exact rung steps in 64 bits: where 1/z falls to a small part of its largest value
 * along a span, u and v would otherwise feel those units as often enlarged.
 */
#include "triangle.h"

#if defined(__GNUC__)
#define ALWAYS_INLINE static inline __attribute__((always_inline))
#else
#define ALWAYS_INLINE static inline
#endif

/* What a span's loop reads and changes. */
typedef struct span {
    uint16_t *colour, *depth;
    int32_t n;
    uint64_t w, dw, u, du, v, dv; /* wide or not: plane_start */
#if EW_TRACE
    uint16_t x, y;
#endif
} span;

/* The value `columns` pixels right of the plane's own, and the step to the next pixel; where
 * not wide, their upper halves, the step rounded. */
ALWAYS_INLINE uint64_t plane_start(const ew_plane *p, int32_t columns, int wide)
{
    uint64_t start = p->row + ew_wrap_mul64(p->dx, columns);
    return wide ? start : start >> 32;
}
ALWAYS_INLINE uint64_t plane_step(const ew_plane *p, int wide)
{
    return wide ? p->dx : (p->dx + 0x80000000u) >> 32;
}

/* near/z to a stored depth. */
ALWAYS_INLINE uint16_t depth_from_w(uint32_t w, int clamped)
{
    uint32_t d = w >> 15;
    if (clamped) {
        if (d < 1) d = 1;
        if (d > 65535) d = 65535;
    }
    return (uint16_t)d;
}

/* For the few spans with w near 0 or 1, where a step's rounding could carry it out of what
 * the set-up allowed for: 1 <= w < 2^(32 - lead), so that nothing is shifted too far. */
ALWAYS_INLINE uint32_t w_in_range(uint32_t w, int lead)
{
    uint32_t top = 0xFFFFFFFFu >> lead;
    return w < 1 ? 1 : w > top ? top : w;
}

/* u = (u/z) / (1/z): the quantity is normalised together with w, so that the product of
 * its 30 bits with the 31-bit reciprocal always has the same scale. */
ALWAYS_INLINE int32_t over_w(uint32_t uw, int lead, uint32_t reciprocal, int shift)
{
    int32_t normalised = (int32_t)(uw << lead); /* |.| < 2^31: triangle.c leaves the room */
    return EW_ASR(ew_mulh_s32(normalised, (int32_t)reciprocal), shift);
}

ALWAYS_INLINE void span_loop(const ew_raster *raster, const ew_triangle *t, span *s, const int rung,
                             const int clamped)
{
    const uint16_t *texels = raster->texture.texels;
    const uint32_t u_mask = ((uint32_t)1 << raster->texture.log2_width) - 1u;
    const uint32_t v_mask = ((uint32_t)1 << raster->texture.log2_height) - 1u;
    const int row_shift = raster->texture.log2_width;
    const int shift = t->uv_shift;
    const int test = s->depth && !(raster->material.flags & EW_NO_DEPTH_TEST);
    const int write = s->depth && !(raster->material.flags & EW_NO_DEPTH_WRITE);
    uint16_t pixel = raster->material.colour;

    /* wide: the planes' 64 bits; else their upper halves alone */
    const int wide = rung == EW_RUNG_EXACT;
    const uint32_t dw = (uint32_t)s->dw, du = (uint32_t)s->du, dv = (uint32_t)s->dv;
    uint32_t w = (uint32_t)s->w, uw = (uint32_t)s->u, vw = (uint32_t)s->v;

    for (int32_t i = 0; i < s->n; i++) {
        if (wide) w = (uint32_t)(s->w >> 32), uw = (uint32_t)(s->u >> 32), vw = (uint32_t)(s->v >> 32);
        uint16_t d = depth_from_w(w, clamped);
        int32_t u = 0, v = 0;
        int visible = !test || d > s->depth[i];
        if (rung != EW_RUNG_CONSTANT && (visible || EW_TRACE)) {
            if (rung == EW_RUNG_AFFINE) {
                u = EW_ASR((int32_t)uw, shift);
                v = EW_ASR((int32_t)vw, shift);
            } else {
                uint32_t divisor = clamped ? w_in_range(w, t->w_lead) : w;
                int zeros = ew_clz32(divisor), lead = zeros - t->w_lead;
                uint32_t m = divisor << zeros;
                uint32_t r = rung == EW_RUNG_EXACT ? ew_recip_newton(m) : ew_recip_table(m);
                u = over_w(uw, lead, r, shift);
                v = over_w(vw, lead, r, shift);
            }
            u = ew_wrap_add32(u, t->u_base);
            v = ew_wrap_add32(v, t->v_base);
            pixel = texels[(((uint32_t)EW_ASR(v, 12) & v_mask) << row_shift) +
                           ((uint32_t)EW_ASR(u, 12) & u_mask)];
        }
#if EW_TRACE
        ew_trace_fragment((uint16_t)(s->x + i), s->y, d, u, v);
#endif
        if (visible) {
            if (write) s->depth[i] = d;
            s->colour[i] = pixel;
        }
        if (wide) s->w += s->dw, s->u += s->du, s->v += s->dv;
        else w += dw, uw += du, vw += dv; /* what a rung does not use, the compiler leaves out */
    }
}

ALWAYS_INLINE void span_by_rung(const ew_raster *raster, const ew_triangle *t, span *s, const int clamped)
{
    switch (t->rung) {
    case EW_RUNG_CONSTANT: span_loop(raster, t, s, EW_RUNG_CONSTANT, clamped); break;
    case EW_RUNG_AFFINE: span_loop(raster, t, s, EW_RUNG_AFFINE, clamped); break;
    case EW_RUNG_TABLE: span_loop(raster, t, s, EW_RUNG_TABLE, clamped); break;
    default: span_loop(raster, t, s, EW_RUNG_EXACT, clamped); break;
    }
}

void ew_span(const ew_raster *raster, const ew_triangle *t, int32_t x, int32_t y, int32_t n)
{
    span s;
    int32_t columns = x - t->column;
    size_t at = (size_t)y * raster->target.stride + (size_t)x;
    s.colour = raster->target.colour + at;
    s.depth = raster->target.depth ? raster->target.depth + at : NULL;
    s.n = n;
    int wide = t->rung == EW_RUNG_EXACT;
    s.w = plane_start(&t->w, columns, wide);
    s.dw = plane_step(&t->w, wide);
    s.u = s.v = s.du = s.dv = 0;
    if (t->rung != EW_RUNG_CONSTANT) {
        s.u = plane_start(&t->u, columns, wide);
        s.du = plane_step(&t->u, wide);
        s.v = plane_start(&t->v, columns, wide);
        s.dv = plane_step(&t->v, wide);
    }
#if EW_TRACE
    s.x = (uint16_t)x;
    s.y = (uint16_t)y;
#endif
    /* w is linear, so the two ends say whether any pixel's depth needs clamping. */
    uint64_t end = s.w + s.dw * (uint64_t)(n - 1);
    uint32_t first = (uint32_t)(wide ? s.w >> 32 : s.w), last = (uint32_t)(wide ? end >> 32 : end);
    int in_range = first >= 32768u && first <= INT32_MAX && last >= 32768u && last <= INT32_MAX;
    if (in_range) span_by_rung(raster, t, &s, 0);
    else span_by_rung(raster, t, &s, 1);
}
