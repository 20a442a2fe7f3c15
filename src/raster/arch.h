/* What compilers do not find by themselves, per architecture (private to the raster layer).
 * Each macro has a twin in C that gives the same bits; EW_PORTABLE selects the twins. The host
 * draws with them, boards without: `make firmware-test` compares their hashes. */
#ifndef EW_RASTER_ARCH_H
#define EW_RASTER_ARCH_H

#include <stddef.h>

#include "edge.h"

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
/* As EW_COPY, where both lie as a uint32_t of this machine does: without a call on ARMv6-M, too, where there are
 * few bytes. */
#define EW_COPY_WORDS(to, from, bytes) \
    ((void)__builtin_memcpy(__builtin_assume_aligned(to, __alignof__(uint32_t)), \
                            __builtin_assume_aligned(from, __alignof__(uint32_t)), bytes))
#else
#define EW_STORE_TWICE(to, value) ((void)((to)[0] = (value), (to)[1] = (value)))
#define EW_COPY_WORDS EW_COPY
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

/* Zero bits above the highest one of w > 0. The C gives 31 at most, so that shifts by it are defined for any w;
 * with Thumb-2's instruction those for w = 0, which the error bound rules out, would give 0. */
#if defined(__GNUC__) && defined(__thumb2__) && !defined(EW_PORTABLE)
EW_ALWAYS_INLINE int ew_zeros_of(uint32_t w)
{
    int zeros;
    __asm__("clz %0, %1" : "=r"(zeros) : "r"(w));
    return zeros;
}
#else
EW_ALWAYS_INLINE int ew_zeros_of(uint32_t w) { return ew_clz32(w | 1u); }
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

/* On ARMv6-M all eight low registers are needed, of which Clang keeps one. */
#if defined(__GNUC__) && defined(__thumb__) && defined(__OPTIMIZE__) && !defined(EW_PORTABLE) && \
    (defined(__thumb2__) || !defined(__clang__))
#define EW_HAS_PIXEL_LOOP 1
typedef char ew_rows_order[offsetof(ew_rows, edge) == 28 && offsetof(ew_rows, depth) == 56 && offsetof(ew_rows, reached) == 72 &&
                           offsetof(ew_rows, u_shift) == 80 && offsetof(ew_rows, shortest) == 108 && offsetof(ew_linear, dv) == 20 &&
                           offsetof(ew_span_work, fill.textured.rows) == 124 && offsetof(ew_span_work, limit) == 76 &&
                           offsetof(ew_span_work, left) == 92 && offsetof(ew_span_work, fill.textured.pen) == 104 &&
                           offsetof(ew_edge, dy) == 16 && sizeof(ew_edge) == 20 && sizeof(ew_plane32) == 12 ? 1 : -1];
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

/* Rows of packed planes: what the twin of ew_rows_packed (span.c) does, in 60 instructions a row besides its
 * pixels where GCC needs 115. Every register but r7 and sp has its part. */
#define EW_HAS_ROW_LOOP 1
/* x, remainder, step, rise, dy of an edge in r2 to r6; `where` its x is from r1 on */
#define EW_EDGE_STEP(where) \
    "add r2, r2, r4\n\t" \
    "adds r3, r3, r5\n\t" \
    "bmi 8f\n\t" \
    "adds r2, r2, #1\n\t" \
    "subs r3, r3, r6\n" \
    "8:\tstrd r2, r3, [r1, #" where "]\n\t"
#define EW_EDGES_STEP \
    "ldmia r1!, {r2, r3, r4, r5, r6}\n\t" EW_EDGE_STEP("-20") \
    "ldm r1, {r2, r3, r4, r5, r6}\n\t" EW_EDGE_STEP("0")
#define EW_ROWS(before, index, after) \
    "5:\tadd r1, %[s], #28\n\t" \
    "ldm r1, {r1, r2, r3, r4, r5}\n\t"             /* edge, planes, x0, x1, column */ \
    "ldr r6, [r1]\n\t"                             /* x, from the left edge        */ \
    "ldr r8, [r1, #20]\n\t"                        /* n, from the right one        */ \
    "cmp r6, r3\n\tit lt\n\tmovlt r6, r3\n\t" \
    "cmp r8, r4\n\tit gt\n\tmovgt r8, r4\n\t" \
    "subs r8, r8, r6\n\t" \
    "ble 6f\n\t" \
    "sub r5, r6, r5\n\t"                           /* columns                      */ \
    "ldrd r1, r3, [%[s], #56]\n\t"                 /* depth, stride                */ \
    "add r4, r1, r6, lsl #1\n\t"                   /* z                            */ \
    "add r1, r1, r3\n\t" \
    "str r1, [%[s], #56]\n\t" \
    "ldmia r2!, {r1, r3, r6}\n\t"                  /* of 1/z: row, dx, dy          */ \
    "add r6, r6, r1\n\t" \
    "str r6, [r2, #-12]\n\t" \
    "mla r1, r3, r5, r1\n\t" \
    "ldm r2, {r3, r6, r9, r10, r11, r12}\n\t"      /* of both packed: high, low    */ \
    "adds r12, r12, r10\n\t" \
    "adc r9, r9, r3\n\t" \
    "str r9, [r2]\n\t" \
    "str r12, [r2, #12]\n\t" \
    "umull r12, r9, r11, r5\n\t" \
    "mla r9, r6, r5, r9\n\t" \
    "adds r10, r10, r12\n\t" \
    "adc r3, r3, r9\n\t" \
    "ldrd r2, r5, [%[s], #48]\n\t"                 /* lead, dw                     */ \
    "lsrs r1, r1, r2\n\t" \
    "lsls r1, r1, #1\n\t" \
    "ldr r9, [%[s], #64]\n\t"                      /* apart, less the step of z    */ \
    "ldr r12, [%[s]]\n\t"                          /* texels                       */ \
    "subs r9, r9, #2\n\t" \
    "str r8, [%[s], #72]\n\t"                      /* reached                      */ \
    before EW_PIXELS(index) after \
    "7:\tldr r1, [%[s], #28]\n\t" EW_EDGES_STEP \
    "ldr r2, [%[s], #68]\n\t"                      /* left                         */ \
    "subs r2, r2, #1\n\t" \
    "str r2, [%[s], #68]\n\t" \
    "bne 5b\n\t" \
    "b 7f\n" \
    "6:\tldm r2, {r1, r3, r4, r5, r6, r8, r9, r10, r11}\n\t" /* no pixel: planes and rows only */ \
    "add r1, r1, r4\n\t" \
    "adds r9, r9, r11\n\t" \
    "adc r5, r5, r8\n\t" \
    "str r1, [r2]\n\t" \
    "str r5, [r2, #12]\n\t" \
    "str r9, [r2, #24]\n\t" \
    "ldrd r1, r3, [%[s], #56]\n\t" \
    "add r1, r1, r3\n\t" \
    "str r1, [%[s], #56]\n\t" \
    "b 7b\n" \
    "7:"
#define EW_ROWS_OPERANDS \
    [z] "=&r"(z), [n] "=&r"(n), [w] "=&r"(w), [high] "=&r"(high), [low] "=&r"(low), [t] "=&r"(t), [dw] "=&r"(dw), \
        [dhigh] "=&r"(dhigh), [dlow] "=&r"(dlow), [texels] "=&r"(texels), [apart] "=&r"(apart), [turn] "=&r"(turn)
EW_ALWAYS_INLINE void ew_walk_rows(ew_rows *rows, int is_256)
{
    register ew_rows *s __asm__("r0") = rows;
    register uint32_t w __asm__("r1"), t __asm__("r2"), high __asm__("r3"), z __asm__("r4"), dw __asm__("r5");
    register uint32_t dhigh __asm__("r6"), n __asm__("r8"), apart __asm__("r9"), low __asm__("r10"), dlow __asm__("r11");
    register uint32_t texels __asm__("r12"), turn __asm__("lr");
    if (is_256) {
        __asm__ volatile(EW_ROWS("", "uxth %[t], %[high], ror #24\n\t", "") : EW_ROWS_OPERANDS : [s] "r"(s) : "cc", "memory");
    } else {
        __asm__ volatile(EW_ROWS("push {r0}\n\tldrd %[turn], r0, [%[s], #4]\n\t",
                                 "ror %[t], %[high], %[turn]\n\tand %[t], %[t], r0\n\t", "\n\tpop {r0}\n")
                         : EW_ROWS_OPERANDS : [s] "r"(s) : "cc", "memory");
    }
}
/* A run of n > 0 pixels with a tangent, where the table's reciprocal will do: what `tangent`, `pack` and
 * fill_packed (span.c) do, in 62 instructions besides the pixels where GCC needs 90. On the way in w', u, v and
 * their steps are in r1, r4, r10 and r3, r9, r11, z in r6, n in r8. Operands as in EW_RUN_OPERANDS. */
#define EW_TANGENT \
    "lsrs r5, r8, #1\n\t"                          /* half                         */ \
    "mla r1, r3, r5, r1\n\t"                       /* w' there, and its reciprocal */ \
    "clz r2, r1\n\t" \
    "lsls r1, r1, r2\n\t" \
    "ubfx r12, r1, %[to_index], %[index_bits]\n\t" \
    "ldr lr, [r0, #76]\n\t"                        /* recip                        */ \
    "add r12, lr, r12, lsl #1\n\t" \
    "ubfx r1, r1, %[to_fraction], #16\n\t" \
    "ldrh lr, [r12]\n\t" \
    "ldrh r12, [r12, #2]\n\t" \
    "sub r12, lr, r12\n\t" \
    "mul r1, r12, r1\n\t" \
    "add lr, lr, #65536\n\t" \
    "lsrs r1, r1, #2\n\t" \
    "rsb r1, r1, lr, lsl #14\n\t" \
    EW_TANGENT_OF("r4", "r9") EW_TANGENT_OF("r10", "r11") \
    "add r1, r0, #80\n\t" \
    "ldm r1, {r1, r2, r3, r5, r12, lr}\n\t"        /* shifts, bases, low, log2_height */ \
    "lsls r4, r4, r1\n\t" \
    "adds r4, r4, r3\n\t" \
    "lsl r9, r9, r1\n\t" \
    "lsl r10, r10, r2\n\t" \
    "add r10, r10, r5\n\t" \
    "lsl r11, r11, r2\n\t" \
    "bic r4, r4, r12\n\t" \
    "bic r9, r9, r12\n\t" \
    "rsb r12, lr, #32\n\t" \
    "lsr r1, r10, r12\n\t" \
    "orrs r4, r4, r1\n\t" \
    "asr r1, r11, r12\n\t" \
    "add r9, r9, r1\n\t" \
    "lsl r10, r10, lr\n\t" \
    "lsl r11, r11, lr\n\t"
/* a at the tangent's pixel over w', the slope, and a at the run's first pixel */
#define EW_TANGENT_OF(a, da) \
    "mla " a ", " da ", r5, " a "\n\t" \
    "lsl " a ", " a ", r2\n\t" \
    "smull r12, " a ", r1, " a "\n\t" \
    "lsl r12, " a ", #2\n\t" \
    "smull lr, r12, r3, r12\n\t" \
    "sub " da ", " da ", r12\n\t" \
    "lsl " da ", " da ", r2\n\t" \
    "smull r12, " da ", r1, " da "\n\t" \
    "mls " a ", " da ", r5, " a "\n\t"
/* r1 is 1/z, r2 its step, r5 as `apart` less the step of z */
#define EW_RUN_PIXELS \
    "ldr r12, [r0]\n\t"                            /* texels                       */ \
    "ldr r3, [r0, #104]\n\t"                       /* is_256                       */ \
    "cmp r3, #0\n\tbeq 16f\n\t" \
    EW_PIXELS("uxth %[t], %[high], ror #24\n\t") \
    "\n\tb 17f\n" \
    "16:\tpush {r0}\n\t" \
    "ldrd lr, r0, [r0, #4]\n\t"                    /* turn, mask                   */ \
    EW_PIXELS("ror %[t], %[high], lr\n\tand %[t], %[t], r0\n\t") \
    "\n\tpop {r0}\n" \
    "17:"
#define EW_RUN_OPERANDS \
    [w] "=&r"(w), [dw] "=&r"(dw), [t] "=&r"(t), [high] "=&r"(high), [apart] "=&r"(apart), [z] "=&r"(z), [n] "+r"(n), \
        [dhigh] "=&r"(dhigh), [low] "=&r"(low), [dlow] "=&r"(dlow), [texels] "=&r"(texels), [turn] "=&r"(turn)
#define EW_RUN_REGISTERS \
    register uint32_t w __asm__("r1"), dw __asm__("r2"), t __asm__("r3"), high __asm__("r4"), apart __asm__("r5"); \
    register uint32_t z __asm__("r6"), dhigh __asm__("r9"), low __asm__("r10"), dlow __asm__("r11"); \
    register uint32_t texels __asm__("r12"), turn __asm__("lr")
#define EW_RECIP_OPERANDS \
    [to_index] "i"(31 - EW_RECIP_BITS), [index_bits] "i"(EW_RECIP_BITS), [to_fraction] "i"(15 - EW_RECIP_BITS)

#define EW_HAS_TANGENT_LOOP 1
/* Runs of a piece, the first of m > 0 pixels, as long as they pay: what the twin in runs_of_texture (span.c) does, in
 * 97 instructions a run besides its pixels where GCC needs 132. Returns what that does. */
EW_ALWAYS_INLINE int32_t ew_walk_runs(ew_rows *rows, int32_t m)
{
    register ew_rows *s __asm__("r0") = rows;
    register int32_t n __asm__("r8") = m;
    EW_RUN_REGISTERS;
    __asm__ volatile("15:\tsub r1, r0, #124\n\t"
                     "ldm r1, {r1, r3, r4, r9, r10, r11}\n\t"       /* linear                       */
                     "mla r2, r3, r8, r1\n\t"
                     "str r2, [r0, #-124]\n\t"
                     "mla r2, r9, r8, r4\n\t"
                     "str r2, [r0, #-116]\n\t"
                     "mla r2, r11, r8, r10\n\t"
                     "str r2, [r0, #-108]\n\t"
                     "ldrd r5, r6, [r0, #-20]\n\t"                 /* the pen's colour and depth   */
                     "str r8, [r0, #72]\n\t"
                     "add r5, r5, r8, lsl #1\n\t"
                     "add r12, r6, r8, lsl #1\n\t"
                     "strd r5, r12, [r0, #-20]\n\t"
                     EW_TANGENT
                     "ldrd r1, r2, [r0, #-12]\n\t"                 /* its w, dw                    */
                     "ldr r5, [r0, #64]\n\t"                       /* apart                        */
                     "subs r5, r5, #2\n\t"
                     EW_RUN_PIXELS
                     "str r1, [r0, #-12]\n\t"
                     "ldr r8, [r0, #72]\n\t"
                     "sub r1, r0, #48\n\t"
                     "ldm r1, {r3, r4, r5, r6, r9}\n\t"            /* scale, fall, longest, down, left */
                     "subs r9, r9, r8\n\t"
                     "str r9, [r0, #-32]\n\t"
                     "beq 19f\n\t"
                     "ldr r1, [r0, #-124]\n\t"                     /* the next run's, as ew_run_after */
                     "lsrs r1, r1, #15\n\t"
                     "muls r1, r3, r1\n\t"
                     "lsrs r1, r6\n\t"
                     "cmp r4, #0\n\t"
                     "beq 13f\n"
                     "11:\tadd r2, r4, r8, lsl #2\n\t"
                     "mul r2, r2, r8\n\t"
                     "cmp r1, r2, lsl #6\n\t"
                     "bcs 12f\n\t"
                     "sub r8, r8, #1\n\t"
                     "b 11b\n"
                     "13:\tcmp r8, r5\n\t"
                     "bge 12f\n\t"
                     "add r2, r8, #1\n\t"
                     "mul r3, r2, r2\n\t"
                     "cmp r1, r3, lsl #8\n\t"
                     "bcc 12f\n\t"
                     "mov r8, r2\n\t"
                     "b 13b\n"
                     "12:\tcmp r8, r9\n\t"
                     "it ge\n\tmovge r8, r9\n\t"
                     "bge 15b\n\t"
                     "ldr r2, [r0, #108]\n\t"                      /* shortest                     */
                     "cmp r8, r2\n\t"
                     "bge 15b\n\t"
                     "b 18f\n"
                     "19:\tmov r8, #0\n"
                     "18:"
                     : EW_RUN_OPERANDS
                     : [s] "r"(s), EW_RECIP_OPERANDS
                     : "cc", "memory");
    return n;
}
#define EW_HAS_EDGES_STEP 1
EW_ALWAYS_INLINE void ew_edges_step(ew_edge *edge)
{
    register ew_edge *e __asm__("r1") = edge;
    __asm__ volatile(EW_EDGES_STEP : "+r"(e) : : "r2", "r3", "r4", "r5", "r6", "cc", "memory");
}
#undef EW_ROWS
#undef EW_ROWS_OPERANDS
#undef EW_TANGENT
#undef EW_TANGENT_OF
#undef EW_RUN_PIXELS
#undef EW_RUN_OPERANDS
#undef EW_RUN_REGISTERS
#undef EW_RECIP_OPERANDS
#undef EW_EDGES_STEP
#undef EW_EDGE_STEP
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
#define EW_PIXELS \
    "b 2f\n" \
    "1:\t" EW_PIXEL("0") EW_PIXEL("2") EW_PIXEL("4") EW_PIXEL("6") \
    "adds %[z], %[z], #8\n\t" \
    "adds %[c], %[c], #8\n" \
    "2:\tldr %[t], [%[k], #24]\n\t" \
    "cmp %[z], %[t]\n\t" \
    "bne 1b\n\t" \
    "b 4f\n" \
    "3:\t" EW_PIXEL("0") \
    "adds %[z], %[z], #2\n\t" \
    "adds %[c], %[c], #2\n" \
    "4:\tldr %[t], [%[k], #20]\n\t" \
    "cmp %[z], %[t]\n\t" \
    "bne 3b\n\t"
EW_ALWAYS_INLINE uint32_t ew_fill_pixels(ew_packing *k, uint16_t *c, uint16_t *z, int32_t n, uint32_t w, uint32_t dw,
                                         uint32_t high, uint32_t low, uint32_t dhigh, uint32_t dlow)
{
    uint32_t t, d;
    k->dhigh = dhigh, k->dlow = dlow;
    k->end = z + (n & ~(int32_t)3);
    k->rest = z + n;
    __asm__ volatile(".syntax unified\n\t" EW_PIXELS
                     : [z] "+l"(z), [c] "+l"(c), [w] "+l"(w), [high] "+l"(high), [low] "+l"(low), [t] "=&l"(t), [d] "=&l"(d)
                     : [k] "l"(k), [dw] "h"(dw)
                     : "cc", "memory");
    return w;
}

/* Rows of packed planes as above: 100 instructions where GCC needs 175. */
#define EW_HAS_ROW_LOOP 1
/* in r2 to r6; r1 moves on to the next edge */
#define EW_EDGE_STEP \
    "ldmia r1!, {r2, r3, r4, r5, r6}\n\t" \
    "adds r2, r2, r4\n\t" \
    "adds r3, r3, r5\n\t" \
    "bmi 8f\n\t" \
    "adds r2, #1\n\t" \
    "subs r3, r3, r6\n" \
    "8:\tsubs r1, #20\n\t" \
    "stmia r1!, {r2, r3}\n\t"
#define EW_EDGES_STEP EW_EDGE_STEP "adds r1, #12\n\t" EW_EDGE_STEP
/* of both packed planes, high in r3 and low in r4; r1 is one word behind the planes' start */
#define EW_PACKED_STEP \
    "ldr r3, [r1, #8]\n\t" \
    "ldr r4, [r1, #20]\n\t" \
    "ldr r5, [r1, #16]\n\t" \
    "ldr r6, [r1, #28]\n\t" \
    "adds r6, r6, r4\n\t" \
    "adcs r5, r3\n\t" \
    "str r6, [r1, #20]\n\t" \
    "str r5, [r1, #8]\n\t"
EW_ALWAYS_INLINE void ew_walk_rows(ew_rows *rows, int is_256)
{
    register ew_rows *s __asm__("r0") = rows;
    register uint32_t t __asm__("r1"), w __asm__("r2"), high __asm__("r3"), low __asm__("r4"), c __asm__("r5"), z __asm__("r6");
    register uint32_t d __asm__("r7"), dw __asm__("r12") = rows->dw;
    (void)is_256;
    __asm__ volatile(".syntax unified\n"
                     "5:\tldr r1, [r0, #28]\n\t" /* edge */
                     "ldr r2, [r1]\n\t"          /* x    */
                     "ldr r3, [r1, #20]\n\t"     /* n    */
                     "ldr r4, [r0, #36]\n\t"     /* x0   */
                     "ldr r5, [r0, #40]\n\t"     /* x1   */
                     "cmp r2, r4\n\tbge 6f\n\tmovs r2, r4\n"
                     "6:\tcmp r3, r5\n\tble 6f\n\tmovs r3, r5\n"
                     "6:\tldr r4, [r0, #56]\n\t" /* depth */
                     "ldr r5, [r0, #60]\n\t"     /* stride */
                     "lsls r6, r2, #1\n\t"
                     "adds r6, r6, r4\n\t"       /* z */
                     "adds r4, r4, r5\n\t"
                     "str r4, [r0, #56]\n\t"
                     "ldr r1, [r0, #32]\n\t"     /* planes */
                     "subs r3, r3, r2\n\tbgt 9f\n\tb 7f\n"
                     "9:\tstr r3, [r0, #72]\n\t"     /* reached */
                     "lsls r4, r3, #1\n\t"
                     "adds r4, r4, r6\n\t"
                     "str r4, [r0, #20]\n\t"     /* rest */
                     "lsrs r3, r3, #2\n\t"
                     "lsls r3, r3, #3\n\t"
                     "adds r3, r3, r6\n\t"
                     "str r3, [r0, #24]\n\t"     /* end */
                     "ldr r4, [r0, #44]\n\t"     /* column */
                     "subs r2, r2, r4\n\t"
                     "mov r8, r6\n\t"
                     "ldmia r1!, {r3, r4, r5}\n\t" /* of 1/z: row, dx, dy */
                     "adds r5, r5, r3\n\t"
                     "subs r1, #12\n\t"
                     "muls r4, r2, r4\n\t"
                     "adds r3, r3, r4\n\t"
                     "ldr r4, [r0, #48]\n\t"     /* lead */
                     "lsrs r3, r4\n\t"
                     "lsls r7, r3, #1\n\t"       /* w */
                     "stmia r1!, {r5}\n\t" EW_PACKED_STEP
                     "ldr r6, [r0, #12]\n\t"     /* dhigh */
                     "ldr r5, [r0, #16]\n\t"     /* dlow */
                     "muls r6, r2, r6\n\t"
                     "adds r3, r3, r6\n\t"
                     "uxth r6, r5\n\t"
                     "muls r6, r2, r6\n\t"       /* columns are below 2^16 */
                     "lsrs r5, r5, #16\n\t"
                     "muls r5, r2, r5\n\t"
                     "lsls r1, r5, #16\n\t"
                     "lsrs r5, r5, #16\n\t"
                     "movs r2, #0\n\t"
                     "adds r6, r6, r1\n\t"
                     "adcs r5, r2\n\t"
                     "adds r4, r4, r6\n\t"
                     "adcs r3, r5\n\t"
                     "mov r6, r8\n\t"
                     "ldr r5, [r0, #64]\n\t"     /* apart */
                     "adds r5, r5, r6\n\t"
                     "mov r2, r7\n\t" EW_PIXELS
                     "6:\tldr r1, [r0, #28]\n\t" EW_EDGES_STEP
                     "ldr r2, [r0, #68]\n\t"     /* left */
                     "subs r2, #1\n\t"
                     "str r2, [r0, #68]\n\t"
                     "beq 8f\n\t"
                     "b 5b\n"
                     "7:\tldmia r1!, {r2, r3, r4}\n\t" /* no pixel: planes only */
                     "adds r2, r2, r4\n\t"
                     "subs r1, #12\n\t"
                     "stmia r1!, {r2}\n\t" EW_PACKED_STEP
                     "b 6b\n"
                     "8:"
                     : [t] "=&l"(t), [w] "=&l"(w), [high] "=&l"(high), [low] "=&l"(low), [c] "=&l"(c), [z] "=&l"(z), [d] "=&l"(d)
                     : [k] "l"(s), [dw] "h"(dw)
                     : "r8", "cc", "memory");
}
#define EW_HAS_EDGES_STEP 1
EW_ALWAYS_INLINE void ew_edges_step(ew_edge *edge)
{
    register ew_edge *e __asm__("r1") = edge;
    __asm__ volatile(".syntax unified\n\t" EW_EDGES_STEP : "+r"(e) : : "r2", "r3", "r4", "r5", "r6", "cc", "memory");
}
#undef EW_PACKED_STEP
#undef EW_EDGES_STEP
#undef EW_EDGE_STEP
#endif
#undef EW_PIXELS
#undef EW_PIXEL
#else
#define EW_HAS_PIXEL_LOOP 0
#endif
#ifndef EW_HAS_ROW_LOOP
#define EW_HAS_ROW_LOOP 0
#endif
#ifndef EW_HAS_TANGENT_LOOP
#define EW_HAS_TANGENT_LOOP 0
#endif
#ifndef EW_HAS_EDGES_STEP
EW_ALWAYS_INLINE void ew_edges_step(ew_edge *edge)
{
    ew_edge_step(&edge[0]);
    ew_edge_step(&edge[1]);
}
#endif

#endif
