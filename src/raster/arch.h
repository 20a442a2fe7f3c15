/* What compilers do not find by themselves, per architecture (private to the raster layer).
 * Each macro has a twin in C that gives the same bits; EW_PORTABLE selects the twins. The host
 * draws with them, boards without: `make firmware-test` compares their hashes. */
#ifndef EW_RASTER_ARCH_H
#define EW_RASTER_ARCH_H

#include "edgewalk/raster_work.h"

/* EW_NOINLINE: a step of rows, spans or fills. */
#if defined(__GNUC__)
#define EW_ALWAYS_INLINE static inline __attribute__((always_inline))
#define EW_NOINLINE static __attribute__((noinline)) EW_HOT
/* No instruction: keeps compilers from turning unrolled additions into sums that need more
 * registers than there are; and a pointer into the context a base of its own, which short
 * offsets on ARMv6-M need. */
#define EW_KEEP_ORDER(x) __asm__("" : "+r"(x))
/* Part of a structure; the number of bytes is constant. */
#define EW_COPY(to, from, bytes) ((void)__builtin_memcpy(to, from, bytes))
/* Two items of 16 bits, both of them `value`, at an address that is a multiple of 4: one store. */
typedef uint32_t __attribute__((may_alias)) ew_pair16;
#define EW_STORE_TWICE(to, value) ((void)(*(ew_pair16 *)(void *)(to) = (uint32_t)(value) << 16 | (value)))
#else
#define EW_STORE_TWICE(to, value) ((void)((to)[0] = (value), (to)[1] = (value)))
#define EW_ALWAYS_INLINE static inline
#define EW_NOINLINE static EW_HOT
#ifndef EW_COPY
#define EW_COPY(to, from, bytes) \
    do { \
        for (size_t i_ = 0; i_ < (bytes); i_++) ((unsigned char *)(to))[i_] = ((const unsigned char *)(from))[i_]; \
    } while (0)
#endif
#define EW_KEEP_ORDER(x) ((void)0)
#endif

/* How far texel numbers are shifted to the left for the pixel loop: on ARMv6-M they count bytes. */
#define EW_INDEX_SHIFT 0u

/* The textured pixel loop of span.c: n > 0 pixels from *colour and *depth on, which must not
 * overlap. What it does, as the loop beside fill_run has it:
 *
 *     if (w >> 15 > *depth) *depth = w >> 15, *colour = texels[rotated right(high, turn) & mask];
 *     high:low += dhigh:dlow, w += dw, depth++, colour++;
 *
 * GCC needs 14 to 17 instructions for a pixel on Thumb-2 and 28 on ARMv6-M, spilling and
 * moving around the carry; here it is 12, or 11 for a texture of 256 x 256, and 18, with half
 * an instruction and one for the loop. Thumb-2's stores find a pixel's colour by the distance
 * between the two pictures. */

#if defined(__GNUC__) && defined(__thumb__) && defined(__OPTIMIZE__) && !defined(EW_PORTABLE)
#define EW_HAS_PIXEL_LOOP 1
#if defined(__thumb2__)
#define EW_PIXEL(index) \
    "ldrh %[t], [%[z]], #2\n\t" \
    "cmp %[t], %[w], lsr #15\n\t" \
    "bcs 9f\n\t" \
    "lsr %[t], %[w], #15\n\t" \
    "strh %[t], [%[z], #-2]\n\t" \
    index \
    "ldrh %[t], [%[texels], %[t], lsl #1]\n\t" \
    "strh %[t], [%[z], %[apart]]\n" \
    "9:\tadds %[low], %[low], %[dlow]\n\t" \
    "adc %[high], %[high], %[dhigh]\n\t" \
    "add %[w], %[w], %[dw]\n\t"
/* n's low bits say what is left once it is below 0 */
#define EW_PIXELS(index) \
    "subs %[n], %[n], #4\n\t" \
    "blt 2f\n" \
    "1:\t" EW_PIXEL(index) EW_PIXEL(index) EW_PIXEL(index) EW_PIXEL(index) \
    "subs %[n], %[n], #4\n\t" \
    "bge 1b\n" \
    "2:\tlsls %[n], %[n], #31\n\t" \
    "bcc 3f\n\t" \
    EW_PIXEL(index) EW_PIXEL(index) \
    "3:\tcmp %[n], #0\n\t" \
    "beq 4f\n\t" \
    EW_PIXEL(index) \
    "4:"
EW_ALWAYS_INLINE uint32_t ew_fill_pixels(ew_packing *k, uint16_t *c, uint16_t *z, int32_t n, uint32_t w, uint32_t dw,
                                         uint32_t high, uint32_t low, uint32_t dhigh, uint32_t dlow)
{
    uint32_t t;
    const uint32_t apart = (uint32_t)((uintptr_t)c - (uintptr_t)z) - 2u;
    if (k->is_256) {
        __asm__ volatile(EW_PIXELS("uxth %[t], %[high], ror #24\n\t")
                         : [z] "+r"(z), [n] "+r"(n), [w] "+r"(w), [high] "+r"(high), [low] "+r"(low), [t] "=&r"(t)
                         : [dw] "r"(dw), [dhigh] "r"(dhigh), [dlow] "r"(dlow), [texels] "r"(k->texels),
                           [apart] "r"(apart)
                         : "cc", "memory");
    } else {
        __asm__ volatile(EW_PIXELS("ror %[t], %[high], %[turn]\n\tand %[t], %[t], %[mask]\n\t")
                         : [z] "+r"(z), [n] "+r"(n), [w] "+r"(w), [high] "+r"(high), [low] "+r"(low), [t] "=&r"(t)
                         : [dw] "r"(dw), [dhigh] "r"(dhigh), [dlow] "r"(dlow), [texels] "r"(k->texels),
                           [apart] "r"(apart), [mask] "r"(k->mask), [turn] "r"(k->turn)
                         : "cc", "memory");
    }
    return w;
}
#else
#undef EW_INDEX_SHIFT
#define EW_INDEX_SHIFT 1u
/* Eight low registers: what does not change is read from *k, as fast as from a high one. */
#define EW_PIXEL(offset) \
    "ldrh %[t], [%[z], #" offset "]\n\t" \
    "lsrs %[d], %[w], #15\n\t" \
    "cmp %[t], %[d]\n\t" \
    "bcs 9f\n\t" \
    "strh %[d], [%[z], #" offset "]\n\t" \
    "mov %[d], %[high]\n\t" \
    "ldr %[t], [%[k], #4]\n\t" \
    "rors %[d], %[t]\n\t" \
    "ldr %[t], [%[k], #8]\n\t" \
    "ands %[d], %[t]\n\t" \
    "ldr %[t], [%[k], #0]\n\t" \
    "ldrh %[d], [%[t], %[d]]\n\t" \
    "strh %[d], [%[c], #" offset "]\n" \
    "9:\tldr %[t], [%[k], #16]\n\t" \
    "ldr %[d], [%[k], #12]\n\t" \
    "adds %[low], %[low], %[t]\n\t" \
    "adcs %[high], %[d]\n\t" \
    "add %[w], %[dw]\n\t"
EW_ALWAYS_INLINE uint32_t ew_fill_pixels(ew_packing *k, uint16_t *c, uint16_t *z, int32_t n, uint32_t w, uint32_t dw,
                                         uint32_t high, uint32_t low, uint32_t dhigh, uint32_t dlow)
{
    uint32_t t, d;
    k->dhigh = dhigh, k->dlow = dlow;
    k->end = z + (n & ~(int32_t)3);
    k->rest = z + n;
    __asm__ volatile(".syntax unified\n\t"
                     "b 2f\n"
                     "1:\t" EW_PIXEL("0") EW_PIXEL("2") EW_PIXEL("4") EW_PIXEL("6")
                     "adds %[z], %[z], #8\n\t"
                     "adds %[c], %[c], #8\n"
                     "2:\tldr %[t], [%[k], #24]\n\t"
                     "cmp %[z], %[t]\n\t"
                     "bne 1b\n\t"
                     "b 4f\n"
                     "3:\t" EW_PIXEL("0")
                     "adds %[z], %[z], #2\n\t"
                     "adds %[c], %[c], #2\n"
                     "4:\tldr %[t], [%[k], #20]\n\t"
                     "cmp %[z], %[t]\n\t"
                     "bne 3b\n\t"
                     : [z] "+l"(z), [c] "+l"(c), [w] "+l"(w), [high] "+l"(high), [low] "+l"(low), [t] "=&l"(t), [d] "=&l"(d)
                     : [k] "l"(k), [dw] "h"(dw)
                     : "cc", "memory");
    return w;
}
#endif
#undef EW_PIXEL
#else
#define EW_HAS_PIXEL_LOOP 0
#endif

#endif
