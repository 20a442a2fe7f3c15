/* Loops of their own for what is drawn most (private to the raster layer). */
#ifndef EW_RASTER_LOOPS_H
#define EW_RASTER_LOOPS_H

#include "arch.h"
#include "triangle.h"

/* What loops have. */
enum {
    HAS_DEPTH = 1,   /* tested and written                                                 */
    HAS_TEXTURE = 2, /* RGB565, repeated, sizes of powers of two; nearest                  */
    HAS_SMOOTH = 4,  /* bilinear                                                           */
    HAS_KEY = 8,     /* texels that equal the key are left out, if there is one            */
    HAS_LIGHT = 16,
    HAS_GREY4 = 32   /* the target: 4-bit grey, else RGB565 in either byte order           */
};

/* The loops of loops.c: names, which config.h has behind EW_WITH_LOOP_, and what they have. */
#define LOOPS(X) \
    X(FLAT, HAS_DEPTH) \
    X(GOURAUD, HAS_DEPTH | HAS_LIGHT) \
    X(NO_DEPTH, HAS_TEXTURE) \
    X(KEYED, HAS_DEPTH | HAS_TEXTURE | HAS_KEY) \
    X(LIT, HAS_DEPTH | HAS_TEXTURE | HAS_LIGHT) \
    X(BILINEAR, HAS_DEPTH | HAS_TEXTURE | HAS_SMOOTH) \
    X(GREY4, HAS_DEPTH | HAS_TEXTURE | HAS_GREY4)

/* What draws a material on a target: ew_raster.loop. */
enum {
    LOOP_NONE,     /* ew_fill_any                                                          */
    LOOP_TEXTURED, /* fill_pixels in span.c                                              */
#define X(name, has) LOOP_##name,
    LOOPS(X)
#undef X
    LOOP_COUNT
};

/* By the context's target and material. */
uint8_t ew_loop_of(const ew_raster *raster);

/* With a trace the generic path draws everything: it alone tells what it draws. */
#define LOOP_IS_IN(name, has) || EW_WITH_LOOP_##name
#define EW_HAS_LOOPS (!EW_TRACE && (0 LOOPS(LOOP_IS_IN)))

#if EW_HAS_LOOPS
/* Makes ready for a piece of a span on row y. */
void ew_loop_start(ew_raster *raster, uint32_t y);

/* Draws the next n pixels, a run at work's attributes and position, and moves the position behind
 * them. Returns 0, and has done nothing, where the run must go through ew_fill_any; the pixels are
 * the same. */
int ew_loop_fill(ew_raster *raster, int32_t n);
#else
static inline void ew_loop_start(ew_raster *raster, uint32_t y) { (void)raster, (void)y; }
static inline int ew_loop_fill(ew_raster *raster, int32_t n)
{
    (void)raster, (void)n;
    return 0;
}
#endif

/* Light of channel i at a run's first pixel, as ew_run has it, and its step. */
EW_ALWAYS_INLINE uint32_t ew_light_at(const ew_triangle *t, const ew_attribute_run *run, int i)
{
    /* rounds to nearest where the fraction is dropped */
    return (uint32_t)(t->shade_origin[i] * 16 + 32768 + EW_ASR((int32_t)run->shade[i], EW_FRACTION(EW_SHADE_BITS) - 16));
}
EW_ALWAYS_INLINE uint32_t ew_light_step(const ew_attribute_run *run, int i)
{
    return (uint32_t)EW_ASR((int32_t)run->dshade[i], EW_FRACTION(EW_SHADE_BITS) - 16);
}

#endif
