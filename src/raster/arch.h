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
    (defined(__thumb2__) || !defined(__clang__)) && !EW_TRACE
#define EW_HAS_PIXEL_LOOP 1
#define EW_AT(type, field, where) (offsetof(type, field) == (where))
typedef char ew_packing_order[EW_AT(ew_packing, texels, 0) && EW_AT(ew_packing, turn, 4) && EW_AT(ew_packing, mask, 8) ? 1 : -1];
typedef char ew_rows_order[EW_AT(ew_rows, texels, 0) && EW_AT(ew_rows, turn, 4) && EW_AT(ew_rows, mask, 8) &&
                           EW_AT(ew_rows, dhigh, 12) && EW_AT(ew_rows, dlow, 16) && EW_AT(ew_rows, rest, 20) &&
                           EW_AT(ew_rows, end, 24) && EW_AT(ew_rows, edge, 28) && EW_AT(ew_rows, planes, 32) && EW_AT(ew_rows, x1, 40) &&
                           EW_AT(ew_rows, depth, 44) && EW_AT(ew_rows, stride, 48) && EW_AT(ew_rows, apart, 52) &&
                           EW_AT(ew_rows, left, 56) && EW_AT(ew_rows, reached, 60) && EW_AT(ew_rows, recip, 64) &&
                           EW_AT(ew_rows, low, 68) && EW_AT(ew_rows, log2_height, 72) && EW_AT(ew_rows, is_256, 76) &&
                           EW_AT(ew_rows, first, 80) && EW_AT(ew_rows, pixels, 84) && EW_AT(ew_rows, run, 88) &&
                           EW_AT(ew_rows, drawn, 92) ? 1 : -1];
typedef char ew_triangle_order[EW_AT(ew_triangle, run_scale, 0) && EW_AT(ew_triangle, longest, 6) &&
                               EW_AT(ew_triangle, shortest, 8) && EW_AT(ew_triangle, sure_run, 10) &&
                               EW_AT(ew_triangle, column, 12) && EW_AT(ew_triangle, run_shift, 14) &&
                               EW_AT(ew_triangle, is_wide, 16) && EW_AT(ew_triangle, w_lead, 21) &&
                               EW_AT(ew_triangle, uv_bits, 22) && EW_AT(ew_triangle, u_shift, 23) &&
                               EW_AT(ew_triangle, v_shift, 24) && EW_AT(ew_triangle, u_base, 28) &&
                               EW_AT(ew_triangle, v_base, 32) && EW_AT(ew_triangle, plane, 40) ? 1 : -1];
typedef char ew_span_order[EW_AT(ew_linear, dv, 20) && EW_AT(ew_span_work, by, 52) && EW_AT(ew_span_work, limit, 76) &&
                           EW_AT(ew_run_limit, fall, 4) && EW_AT(ew_run_limit, longest, 8) && EW_AT(ew_run_limit, down, 12) &&
                           EW_AT(ew_span_work, first, 96) && EW_AT(ew_span_work, is_ready, 100) &&
                           EW_AT(ew_span_work, fill.textured.pen, 104) && EW_AT(ew_pen, w, 8) && EW_AT(ew_pen, dw, 12) &&
                           EW_AT(ew_span_work, fill.textured.rows, 124) && EW_AT(ew_edge, dy, 16) && sizeof(ew_edge) == 20 &&
                           sizeof(ew_plane32) == 12 && sizeof(ew_plane64) == 24 ? 1 : -1];
#undef EW_AT
/* What is taken off ew_rows.apart: the pixel loop of Thumb-2 has gone on to the next pixel's depth when it stores a
 * colour. */
#if defined(__thumb2__)
#define EW_APART_LESS 2u
#else
#define EW_APART_LESS 0u
#endif
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
/* The same by eights, for long runs: half as much for the loop. */
#define EW_PIXELS_8(index) \
    "subs %[n], %[n], #8\n\t" \
    "blt 2f\n" \
    "1:\t" EW_PIXEL(index) EW_PIXEL(index) EW_PIXEL(index) EW_PIXEL(index) \
    EW_PIXEL(index) EW_PIXEL(index) EW_PIXEL(index) EW_PIXEL(index) \
    "subs %[n], %[n], #8\n\t" \
    "bge 1b\n" \
    "2:\tlsls %[n], %[n], #30\n\t" \
    "bcc 3f\n\t" \
    EW_PIXEL(index) EW_PIXEL(index) EW_PIXEL(index) EW_PIXEL(index) \
    "3:\tcmp %[n], #0\n\t" \
    "bge 3f\n\t" \
    EW_PIXEL(index) EW_PIXEL(index) \
    "3:\tlsls %[n], %[n], #1\n\t" \
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
    } else { /* all registers but r7: GCC does not find them where there is an FPU */
        const uint16_t *const texels = k->texels; /* no load once the first has its register: instruments may call */
        const uint32_t mask = k->mask, turn = k->turn;
        register uint16_t *z_ __asm__("r0") = z;
        register int32_t n_ __asm__("r1") = n;
        register uint32_t w_ __asm__("r2") = w, high_ __asm__("r3") = high, low_ __asm__("r4") = low, t_ __asm__("r5");
        register uint32_t dw_ __asm__("r6") = dw, dhigh_ __asm__("r8") = dhigh, dlow_ __asm__("r9") = dlow;
        register const uint16_t *texels_ __asm__("r10") = texels;
        register uint32_t apart_ __asm__("r11") = apart, mask_ __asm__("r12") = mask, turn_ __asm__("lr") = turn;
        __asm__ volatile(EW_PIXELS("ror %[t], %[high], %[turn]\n\tand %[t], %[t], %[mask]\n\t")
                         : [z] "+r"(z_), [n] "+r"(n_), [w] "+r"(w_), [high] "+r"(high_), [low] "+r"(low_), [t] "=&r"(t_)
                         : [dw] "r"(dw_), [dhigh] "r"(dhigh_), [dlow] "r"(dlow_), [texels] "r"(texels_),
                           [apart] "r"(apart_), [mask] "r"(mask_), [turn] "r"(turn_)
                         : "cc", "memory");
        return w_;
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
/* A row's head: r2 at the planes, where its first pixel's depth is and how many columns from theirs, n > 0 pixels
 * in r8; to 6 if there is none. Takes r1 to r6 and r8. */
#define EW_ROW_HEAD(z, columns) \
    "add r1, r0, #28\n\t" \
    "ldm r1, {r1, r2, r3, r4}\n\t"                 /* edge, planes, x0, x1         */ \
    "ldr r6, [r1]\n\t"                             /* x, from the left edge        */ \
    "ldr r8, [r1, #20]\n\t"                        /* n, from the right one        */ \
    "cmp r6, r3\n\tit lt\n\tmovlt r6, r3\n\t" \
    "cmp r8, r4\n\tit gt\n\tmovgt r8, r4\n\t" \
    "ldrd r1, r3, [r0, #44]\n\t"                   /* depth, stride                */ \
    "add r3, r3, r1\n\t" \
    "str r3, [r0, #44]\n\t" \
    "subs r8, r8, r6\n\t" \
    "ble 6f\n\t" \
    "ldrh " columns ", [r2, #-28]\n\t"             /* column                       */ \
    "sub " columns ", r6, " columns "\n\t" \
    "add " z ", r1, r6, lsl #1\n\t"
/* One row less that pixels are reached on. */
#define EW_ROW_EMPTY \
    "ldr r1, [r0, #60]\n\t" \
    "subs r1, r1, #1\n\t" \
    "str r1, [r0, #60]\n\t"
/* To the next row, at 5, or on behind the last. */
#define EW_ROW_END \
    "ldr r1, [r0, #28]\n\t" EW_EDGES_STEP \
    "ldr r2, [r0, #56]\n\t"                        /* left                         */ \
    "subs r2, r2, #1\n\t" \
    "str r2, [r0, #56]\n\t" \
    "bne 5b\n\t"
#define EW_ROWS(before, index, after) \
    "5:\t" EW_ROW_HEAD("r4", "lr") \
    "ldrb r6, [r2, #-19]\n\t"                      /* w_lead                       */ \
    "ldm r2, {r1, r5, r9}\n\t"                     /* of 1/z: row, dx, dy          */ \
    "add r9, r9, r1\n\t" \
    "str r9, [r2], #12\n\t" \
    "mla r1, r5, lr, r1\n\t" \
    "lsrs r1, r1, r6\n\t" \
    "asrs r5, r5, r6\n\t" \
    "lsls r1, r1, #1\n\t" \
    "lsls r5, r5, #1\n\t" \
    "ldm r2, {r3, r6, r9, r10, r11, r12}\n\t"      /* of both packed: high, low    */ \
    "adds r12, r12, r10\n\t" \
    "adc r9, r9, r3\n\t" \
    "str r9, [r2]\n\t" \
    "str r12, [r2, #12]\n\t" \
    "umull r12, r9, r11, lr\n\t" \
    "mla r9, r6, lr, r9\n\t" \
    "adds r10, r10, r12\n\t" \
    "adc r3, r3, r9\n\t" \
    "ldr r9, [r0, #52]\n\t"                        /* apart                        */ \
    "ldr r12, [r0]\n\t"                            /* texels                       */ \
    before EW_PIXELS(index) after \
    "7:\t" EW_ROW_END \
    "b 7f\n" \
    "6:\t" EW_ROW_EMPTY \
    "ldm r2, {r1, r3, r4, r5, r6, r8, r9, r10, r11}\n\t" /* planes only                 */ \
    "add r1, r1, r4\n\t" \
    "adds r9, r9, r11\n\t" \
    "adc r5, r5, r8\n\t" \
    "str r1, [r2]\n\t" \
    "str r5, [r2, #12]\n\t" \
    "str r9, [r2, #24]\n\t" \
    "b 7b\n" \
    "7:"
#define EW_ROWS_OPERANDS \
    [z] "=&r"(z), [n] "=&r"(n), [w] "=&r"(w), [high] "=&r"(high), [low] "=&r"(low), [t] "=&r"(t), [dw] "=&r"(dw), \
        [dhigh] "=&r"(dhigh), [dlow] "=&r"(dlow), [texels] "=&r"(texels), [apart] "=&r"(apart), [turn] "=&r"(turn)
EW_ALWAYS_INLINE void ew_walk_rows(ew_rows *rows, const ew_triangle *triangle, int is_256)
{
    register ew_rows *s __asm__("r0") = rows;
    register uint32_t w __asm__("r1"), t __asm__("r2"), high __asm__("r3"), z __asm__("r4"), dw __asm__("r5");
    register uint32_t dhigh __asm__("r6"), n __asm__("r8"), apart __asm__("r9"), low __asm__("r10"), dlow __asm__("r11");
    register uint32_t texels __asm__("r12"), turn __asm__("lr");
    (void)triangle;
    if (is_256) {
        __asm__ volatile(EW_ROWS("", "uxth %[t], %[high], ror #24\n\t", "") : EW_ROWS_OPERANDS : [s] "r"(s) : "cc", "memory");
    } else {
        __asm__ volatile(EW_ROWS("push {r0}\n\tldrd %[turn], r0, [%[s], #4]\n\t",
                                 "ror %[t], %[high], %[turn]\n\tand %[t], %[t], r0\n\t", "\n\tpop {r0}\n")
                         : EW_ROWS_OPERANDS : [s] "r"(s) : "cc", "memory");
    }
}
/* A run of n > 0 pixels with a tangent, where the table's reciprocal will do: what `tangent` and `pack` (span.c) do,
 * in 54 instructions. On the way in w', u, v and their steps are in r1, r4, r10 and r3, r9, r11, n is in r8; r5 is
 * how far the tangent's pixel is from where w', u, v are. On the way out both packed are in r4, r10, their steps in
 * r9, r11; r6 and r8 are left alone. */
#define EW_TANGENT \
    "mla r1, r3, r5, r1\n\t"                       /* w' there, and its reciprocal */ \
    "clz r2, r1\n\t" \
    "lsls r1, r1, r2\n\t" \
    "mla r4, r9, r5, r4\n\t" \
    "mla r10, r11, r5, r10\n\t" \
    "lsrs r5, r8, #1\n\t"                          /* from there to the first pixel */ \
    "ubfx r12, r1, %[to_index], %[index_bits]\n\t" \
    "ldr lr, [r0, #64]\n\t"                        /* recip                        */ \
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
    "ldr r12, [r0, #32]\n\t"                       /* planes, and what lies above: */ \
    "ldrb r1, [r12, #-17]\n\t"                     /* u_shift, v_shift             */ \
    "ldrb r2, [r12, #-16]\n\t" \
    "ldrd r3, r5, [r12, #-12]\n\t"                 /* u_base, v_base               */ \
    "ldrd r12, lr, [r0, #68]\n\t"                  /* low, log2_height             */ \
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
/* a over w', its slope, and a at the run's first pixel */
#define EW_TANGENT_OF(a, da) \
    "lsl " a ", " a ", r2\n\t" \
    "smull r12, " a ", r1, " a "\n\t" \
    "lsl r12, " a ", #2\n\t" \
    "smull lr, r12, r3, r12\n\t" \
    "sub " da ", " da ", r12\n\t" \
    "lsl " da ", " da ", r2\n\t" \
    "smull r12, " da ", r1, " da "\n\t" \
    "mls " a ", " da ", r5, " a "\n\t"
/* n pixels from r6 on, with what EW_TANGENT leaves behind and the pen's 1/z, which r1 is afterwards. */
#define EW_RUN_PIXELS \
    "sub r12, r0, #12\n\t" \
    "ldm r12, {r1, r2, r3, r12, lr}\n\t"           /* the pen's w, dw; texels, turn */ \
    "ldr r5, [r0, #52]\n\t"                        /* apart                        */ \
    "ldr r3, [r0, #76]\n\t"                        /* is_256                       */ \
    "cmp r3, #0\n\tbeq 16f\n\t" \
    EW_PIXELS_8("uxth %[t], %[high], ror #24\n\t") \
    "\n\tb 17f\n" \
    "16:\tpush {r0}\n\t" \
    "ldr r0, [r0, #8]\n\t"                         /* mask                         */ \
    EW_PIXELS("ror %[t], %[high], lr\n\tand %[t], %[t], r0\n\t") \
    "\n\tpop {r0}\n" \
    "17:"
#define EW_RUN_OPERANDS \
    [w] "=&r"(w), [dw] "=&r"(dw), [t] "=&r"(t), [high] "=&r"(high), [apart] "=&r"(apart), [z] "=&r"(z), [n] "=&r"(n), \
        [dhigh] "=&r"(dhigh), [low] "=&r"(low), [dlow] "=&r"(dlow), [texels] "=&r"(texels), [turn] "=&r"(turn)
#define EW_RUN_REGISTERS \
    register uint32_t w __asm__("r1"), dw __asm__("r2"), t __asm__("r3"), high __asm__("r4"), apart __asm__("r5"); \
    register uint32_t z __asm__("r6"), dhigh __asm__("r9"), low __asm__("r10"), dlow __asm__("r11"); \
    register uint32_t texels __asm__("r12"), turn __asm__("lr")
#define EW_RECIP_OPERANDS \
    [to_index] "i"(31 - EW_RECIP_BITS), [index_bits] "i"(EW_RECIP_BITS), [to_fraction] "i"(15 - EW_RECIP_BITS)

/* Planes at r2, r5 columns on: w', u, v to r1, r4, r10, their steps to r3, r9, r11; and down to the next row. */
#define EW_NARROW_AT \
    "ldm r2!, {r1, r3, r4}\n\t" \
    "add r4, r4, r1\n\t" \
    "str r4, [r2, #-12]\n\t" \
    "mla r1, r3, r5, r1\n\t" \
    "ldm r2!, {r4, r9, r10}\n\t" \
    "add r10, r10, r4\n\t" \
    "str r10, [r2, #-12]\n\t" \
    "mla r4, r9, r5, r4\n\t" \
    "ldm r2, {r10, r11, r12}\n\t" \
    "add r12, r12, r10\n\t" \
    "str r12, [r2]\n\t" \
    "mla r10, r11, r5, r10\n\t"
#define EW_WIDE_AT \
    "adds r2, r2, #48\n\t" \
    "ldm r2, {r1, r3, r4, r9, r10, r12}\n\t"       /* v: row, dx, dy, low words first */ \
    "adds r10, r10, r1\n\t" \
    "adc r12, r12, r3\n\t" \
    "strd r10, r12, [r2], #-24\n\t" \
    "umull r4, r12, r4, r5\n\t" \
    "mla r12, r9, r5, r12\n\t" \
    "adds r4, r4, r1\n\t" \
    "adc r10, r12, r3\n\t" \
    "mov r11, r9\n\t" \
    "ldm r2, {r1, r3, r4, r9, r12, lr}\n\t"        /* u                            */ \
    "adds r12, r12, r1\n\t" \
    "adc lr, lr, r3\n\t" \
    "strd r12, lr, [r2], #-24\n\t" \
    "umull r4, r12, r4, r5\n\t" \
    "mla r12, r9, r5, r12\n\t" \
    "adds r4, r4, r1\n\t" \
    "adc r4, r12, r3\n\t" \
    "ldrd r1, r3, [r2]\n\t"                        /* w'                           */ \
    "ldrd r12, lr, [r2, #16]\n\t" \
    "adds r12, r12, r1\n\t" \
    "adc lr, lr, r3\n\t" \
    "strd r12, lr, [r2]\n\t" \
    "ldrd r12, lr, [r2, #8]\n\t" \
    "umull r12, r2, r12, r5\n\t" \
    "mla r2, lr, r5, r2\n\t" \
    "adds r1, r1, r12\n\t" \
    "adc r1, r2, r3\n\t" \
    "mov r3, lr\n\t"
/* the plane of 64 bits at r2 without pixels, and to the next one */
#define EW_WIDE_STEP \
    "ldrd r1, r3, [r2]\n\t" \
    "ldrd r4, r5, [r2, #16]\n\t" \
    "adds r1, r1, r4\n\t" \
    "adcs r3, r5\n\t" \
    "strd r1, r3, [r2], #24\n\t"

/* What ew_walk_spans returns: behind the last row; for a span that has to be cut; for one whose first run is to be
 * found by first_run; or, 0 or above, what runs_of_texture does. */
enum { EW_ROWS_DONE = -3, EW_SPAN_CUT = -2, EW_SPAN_FIRST = -1 };

#define EW_HAS_SPAN_LOOP 1
/* Rows of a triangle whose runs the table's reciprocal does for, as the twin of ew_rows_of_texture (span.c) draws
 * them. Planes are on the next row when a span begins. A run takes about 100 instructions besides its pixels where GCC
 * needs 132, a row of one run 135 with its own, or 155 with planes of 64 bits, where it needs 190 or more. */
EW_ALWAYS_INLINE int32_t ew_walk_spans(ew_rows *rows)
{
    register ew_rows *s __asm__("r0") = rows;
    register int32_t n __asm__("r8");
    EW_RUN_REGISTERS;
    __asm__ volatile("5:\t" EW_ROW_HEAD("r6", "r5")
                     "ldrb r3, [r2, #-24]\n\t"                   /* is_wide                      */
                     "cmp r3, #0\n\t"
                     "bne 10f\n\t" EW_NARROW_AT
                     "20:\tldr r2, [r0, #32]\n\t"
                     "ldrb r12, [r2, #-19]\n\t"                  /* w_lead; the pen's w, dw      */
                     "lsr r5, r1, r12\n\t"
                     "asr r12, r3, r12\n\t"
                     "lsls r5, r5, #1\n\t"
                     "lsl r12, r12, #1\n\t"
                     "strd r5, r12, [r0, #-12]\n\t"
                     "strd r6, r8, [r0, #80]\n\t"                /* first, pixels                */
                     "ldrh r5, [r2, #-30]\n\t"                   /* sure_run                     */
                     "cmp r8, r5\n\t"
                     "bhi 21f\n"
                     "14:\tlsr r5, r8, #1\n"
                     "22:\t" EW_TANGENT EW_RUN_PIXELS
                     "ldrd r2, r5, [r0, #80]\n\t"
                     "subs r6, r6, r2\n\t"
                     "subs r5, r5, r6, lsr #1\n\t"               /* what is left                 */
                     "beq 7f\n\t"
                     "lsrs r6, r6, #1\n\t"                       /* drawn                        */
                     "str r1, [r0, #-12]\n\t"
                     "sub r1, r0, #124\n\t"
                     "ldm r1, {r1, r3, r4, r9, r10, r11}\n\t"    /* linear                       */
                     "ldr r8, [r0, #88]\n\t"                     /* run                          */
                     "mla r2, r3, r6, r1\n\t"                    /* the next one's, as ew_run_after */
                     "ldrd r12, lr, [r0, #-48]\n\t"              /* scale, fall                  */
                     "lsrs r2, r2, #15\n\t"
                     "mul r2, r12, r2\n\t"
                     "ldr r12, [r0, #-36]\n\t"                   /* down                         */
                     "lsr r2, r2, r12\n\t"
                     "cmp lr, #0\n\t"
                     "beq 13f\n"
                     "11:\tadd r12, lr, r8, lsl #2\n\t"
                     "mul r12, r12, r8\n\t"
                     "cmp r2, r12, lsl #6\n\t"
                     "bcs 12f\n\t"
                     "sub r8, r8, #1\n\t"
                     "b 11b\n"
                     "12:\tcmp r8, r5\n\t"
                     "bge 9f\n\t"
                     "ldr r2, [r0, #32]\n\t"
                     "ldrh r2, [r2, #-32]\n\t"                   /* shortest                     */
                     "cmp r8, r2\n\t"
                     "bge 15f\n\t"
                     "b 18f\n"
                     "13:\tldr lr, [r0, #-40]\n"                  /* longest                      */
                     "8:\tcmp r8, lr\n\t"
                     "bge 12f\n\t"
                     "add r12, r8, #1\n\t"
                     "mul r12, r12, r12\n\t"
                     "cmp r2, r12, lsl #8\n\t"
                     "bcc 12f\n\t"
                     "add r8, r8, #1\n\t"
                     "b 8b\n"
                     "12:\tcmp r8, r5\n\t"                       /* not shorter than the one before */
                     "blt 15f\n"
                     "9:\tmov r8, r5\n"
                     "15:\tldr r12, [r0, #80]\n\t"
                     "str r8, [r0, #88]\n\t"
                     "add r5, r6, r8, lsr #1\n\t"
                     "add r6, r12, r6, lsl #1\n\t"
                     "b 22b\n"

                     "7:\t" EW_ROW_END
                     "mvn r8, #2\n\t"                            /* EW_ROWS_DONE                 */
                     "b 19f\n"

                     "10:\t" EW_WIDE_AT
                     "b 20b\n"

                     "6:\t" EW_ROW_EMPTY
                     "ldrb r1, [r2, #-24]\n\t"                   /* planes only                  */
                     "cbnz r1, 8f\n\t"
                     "ldm r2, {r1, r3, r4, r5, r6, r8, r9, r10, r11}\n\t"
                     "add r1, r1, r4\n\t"
                     "add r5, r5, r8\n\t"
                     "add r9, r9, r11\n\t"
                     "str r1, [r2]\n\t"
                     "str r5, [r2, #12]\n\t"
                     "str r9, [r2, #24]\n\t"
                     "b 7b\n"
                     "8:\t" EW_WIDE_STEP EW_WIDE_STEP EW_WIDE_STEP
                     "b 7b\n"

                     "21:\tldrb r5, [r2, #-24]\n\t"             /* steps_suffice                */
                     "cbz r5, 8f\n\t"
                     "cmp r8, #512\n\t"                            /* EW_LONGEST_PIECE             */
                     "bgt 17f\n\t"
                     "sub r5, r8, #1\n\t"
                     "mla r5, r3, r5, r1\n\t"
                     "cmp r5, r1\n\tit gt\n\tmovgt r5, r1\n\t"
                     "ldrb r12, [r2, #-18]\n\t"                  /* uv_bits                      */
                     "sub r12, r12, #19\n\t"
                     "lsl r12, r8, r12\n\t"
                     "cmp r12, r5, asr #18\n\t"
                     "bgt 17f\n"
                     "8:\tldrh r5, [r2, #-34]\n\t"              /* ew_one_run_suffices: longest */
                     "cmp r8, r5\n\t"
                     "bgt 8f\n\t"
                     "mla r5, r3, r8, r1\n\t"
                     "cmp r5, r1\n\tit gt\n\tmovgt r5, r1\n\t"
                     "cmp r5, #0\n\t"
                     "ble 8f\n\t"
                     "lsrs r5, r5, #15\n\t"
                     "ldrh r12, [r2, #-40]\n\t"                  /* run_scale                    */
                     "mul r5, r12, r5\n\t"
                     "ldrb r12, [r2, #-26]\n\t"                  /* run_shift                    */
                     "lsr r5, r5, r12\n\t"
                     "mul r12, r8, r8\n\t"
                     "cmp r5, r12, lsl #8\n\t"
                     "bcs 14b\n"
                     "8:\tldrb r5, [r0, #-24]\n\t"              /* first_run: is_ready          */
                     "cbz r5, 8f\n\t"
                     "cmp r8, #8\n\t"
                     "blt 8f\n\t"
                     "ldr r5, [r0, #-72]\n\t"                    /* by                           */
                     "rsb r12, r5, #0\n\t"
                     "cmp r1, r12\n\t"
                     "bhi 9f\n"
                     "8:\tsub r2, r0, #124\n\t"
                     "stm r2, {r1, r3, r4, r9, r10, r11}\n\t"    /* linear                       */
                     "mov r8, #-1\n\t"                           /* EW_SPAN_FIRST                */
                     "b 19f\n"
                     "9:\tadd r1, r1, r5\n\t"
                     "ldrd r5, r12, [r0, #-68]\n\t"
                     "add r4, r4, r5\n\t"
                     "add r10, r10, r12\n\t"
                     "sub r2, r0, #124\n\t"
                     "stm r2, {r1, r3, r4, r9, r10, r11}\n\t"    /* linear                       */
                     "sub r5, r0, #48\n\t"
                     "ldm r5, {r2, r5, r8, r12}\n\t"             /* scale, fall, longest, down; ew_run_near */
                     "lsr lr, r1, #15\n\t"
                     "mul lr, r2, lr\n\t"
                     "lsr lr, lr, r12\n\t"
                     "ldr r2, [r0, #-28]\n\t"                    /* first                        */
                     "cmp r2, r8\n\tit gt\n\tmovgt r2, r8\n"
                     "11:\tcmp r2, r8\n\t"
                     "bge 12f\n\t"
                     "adds r2, r2, #1\n\t"
                     "add r12, r5, r2, lsl #2\n\t"
                     "mul r12, r12, r2\n\t"
                     "cmp lr, r12, lsl #6\n\t"
                     "bcs 11b\n"
                     "13:\tsubs r2, r2, #1\n"
                     "12:\tadd r12, r5, r2, lsl #2\n\t"
                     "mul r12, r12, r2\n\t"
                     "cmp lr, r12, lsl #6\n\t"
                     "bcc 13b\n\t"
                     "str r2, [r0, #-28]\n\t"
                     "ldr r8, [r0, #84]\n\t"                     /* pixels                       */
                     "cmp r2, r8\n\t"
                     "bge 8f\n\t"
                     "mov r8, r2\n\t"
                     "ldr r2, [r0, #32]\n\t"
                     "ldrh r2, [r2, #-32]\n\t"                   /* shortest                     */
                     "cmp r8, r2\n\t"
                     "it lt\n\tmovlt r6, #0\n\t"
                     "blt 18f\n"
                     "8:\tstr r8, [r0, #88]\n\t"
                     "b 14b\n"
                     "18:\tstr r6, [r0, #92]\n\t"                /* drawn                        */
                     "b 19f\n"
                     "17:\tmvn r8, #1\n"                         /* EW_SPAN_CUT                  */
                     "19:"
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
#undef EW_ROW_HEAD
#undef EW_ROW_EMPTY
#undef EW_ROW_END
#undef EW_NARROW_AT
#undef EW_WIDE_AT
#undef EW_WIDE_STEP
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
EW_ALWAYS_INLINE void ew_walk_rows(ew_rows *rows, const ew_triangle *triangle, int is_256)
{
    const ew_plane32 *p = triangle->plane.narrow;
    register ew_rows *s __asm__("r0") = rows;
    register uint32_t t __asm__("r1"), w __asm__("r2"), high __asm__("r3"), low __asm__("r4"), c __asm__("r5"), z __asm__("r6");
    register uint32_t d __asm__("r7");
    register uint32_t dw __asm__("r12") = (uint32_t)EW_ASR((int32_t)p[EW_PLANE_W].dx, triangle->w_lead) << 1;
    (void)is_256;
    rows->dhigh = p[EW_PLANE_U].dx, rows->dlow = p[EW_PLANE_V].dx;
    __asm__ volatile(".syntax unified\n"
                     "5:\tldr r1, [r0, #28]\n\t" /* edge */
                     "ldr r2, [r1]\n\t"          /* x    */
                     "ldr r3, [r1, #20]\n\t"     /* n    */
                     "ldr r4, [r0, #36]\n\t"     /* x0   */
                     "ldr r5, [r0, #40]\n\t"     /* x1   */
                     "cmp r2, r4\n\tbge 6f\n\tmovs r2, r4\n"
                     "6:\tcmp r3, r5\n\tble 6f\n\tmovs r3, r5\n"
                     "6:\tldr r4, [r0, #44]\n\t" /* depth */
                     "ldr r5, [r0, #48]\n\t"     /* stride */
                     "lsls r6, r2, #1\n\t"
                     "adds r6, r6, r4\n\t"       /* z */
                     "adds r4, r4, r5\n\t"
                     "str r4, [r0, #44]\n\t"
                     "ldr r1, [r0, #32]\n\t"     /* planes */
                     "subs r3, r3, r2\n\tbgt 9f\n\tb 7f\n"
                     "9:\t"
                     "lsls r4, r3, #1\n\t"
                     "adds r4, r4, r6\n\t"
                     "str r4, [r0, #20]\n\t"     /* rest */
                     "lsrs r3, r3, #2\n\t"
                     "lsls r3, r3, #3\n\t"
                     "adds r3, r3, r6\n\t"
                     "str r3, [r0, #24]\n\t"     /* end */
                     "subs r1, #40\n\t"            /* the triangle */
                     "ldrh r4, [r1, #12]\n\t"     /* column */
                     "ldrb r7, [r1, #21]\n\t"     /* w_lead */
                     "adds r1, #40\n\t"
                     "subs r2, r2, r4\n\t"
                     "mov r8, r6\n\t"
                     "ldmia r1!, {r3, r4, r5}\n\t" /* of 1/z: row, dx, dy */
                     "adds r5, r5, r3\n\t"
                     "subs r1, #12\n\t"
                     "muls r4, r2, r4\n\t"
                     "adds r3, r3, r4\n\t"
                     "lsrs r3, r7\n\t"
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
                     "ldr r5, [r0, #52]\n\t"     /* apart */
                     "adds r5, r5, r6\n\t"
                     "mov r2, r7\n\t" EW_PIXELS
                     "6:\tldr r1, [r0, #28]\n\t" EW_EDGES_STEP
                     "ldr r2, [r0, #56]\n\t"     /* left */
                     "subs r2, #1\n\t"
                     "str r2, [r0, #56]\n\t"
                     "beq 8f\n\t"
                     "b 5b\n"
                     "7:\tldr r2, [r0, #60]\n\t" /* reached: no pixel here, planes only */
                     "subs r2, #1\n\t"
                     "str r2, [r0, #60]\n\t"
                     "ldmia r1!, {r2, r3, r4}\n\t"
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
#undef EW_PIXELS_8
#undef EW_PIXEL
#else
#define EW_HAS_PIXEL_LOOP 0
#endif
#ifndef EW_HAS_ROW_LOOP
#define EW_HAS_ROW_LOOP 0
#endif
#ifndef EW_HAS_SPAN_LOOP
#define EW_HAS_SPAN_LOOP 0
#endif
#ifndef EW_HAS_EDGES_STEP
EW_ALWAYS_INLINE void ew_edges_step(ew_edge *edge)
{
    ew_edge_step(&edge[0]);
    ew_edge_step(&edge[1]);
}
#endif

#endif
