/* edgewalk/config.h - what a build of the core may choose.
 *
 * Every macro may be set on the compiler's command line; the value is the same for
 * the library and for whoever includes its headers. Each has a default and a range
 * that is checked here.
 */
#ifndef EW_CONFIG_H
#define EW_CONFIG_H

#include <limits.h>

/* Fraction bits of a snapped vertex position, 4 to 8. 8 is the default: it is what
 * the coverage promise of docs/conventions.md is stated for. */
#ifndef EW_SUBPIXEL_BITS
#define EW_SUBPIXEL_BITS 8
#endif
#if EW_SUBPIXEL_BITS < 4 || EW_SUBPIXEL_BITS > 8
#error "EW_SUBPIXEL_BITS: 4 to 8"
#endif

/* log2 of the number of entries of the reciprocal table, 4 to 9. A table of 2^b
 * entries takes 2^(b+1) + 2 bytes of flash. */
#ifndef EW_RECIP_BITS
#define EW_RECIP_BITS 8
#endif
#if EW_RECIP_BITS < 4 || EW_RECIP_BITS > 9
#error "EW_RECIP_BITS: 4 to 9"
#endif

/* 1: the core has an instruction for 32 x 32 -> 64 bits. 0: where it matters, products are
 * made of 16-bit pieces instead, with the same bits. By default 0 for the Cortex-M0, M0+, M1
 * and M23 and where int has 16 bits, else 1. */
#ifndef EW_LONG_MULTIPLY
#if defined(__ARM_ARCH_6M__) || defined(__ARM_ARCH_8M_BASE__) || INT_MAX == 32767
#define EW_LONG_MULTIPLY 0
#else
#define EW_LONG_MULTIPLY 1
#endif
#endif

/* Parts of the fills (docs/fills.md): 1, the default, has them; 0 leaves their code out, and
 * a target, a material or a fog that asks for them gets EW_ERR_UNSUPPORTED. What the parts
 * cost: docs/fills.md.
 *
 *   EW_WITH_SHADING          EW_SHADED: the colours of corners
 *   EW_WITH_FOG              EW_FOG and ew_raster_set_fog
 *   EW_WITH_BLENDS           EW_BLEND_HALF and EW_BLEND_ADD
 *   EW_WITH_CUTOUTS          EW_COLOUR_KEY and EW_ALPHA_MASK
 *   EW_WITH_BILINEAR         EW_FILTER_BILINEAR; EW_FILTER_TRILINEAR needs EW_WITH_MIPS besides
 *   EW_WITH_MIPS             textures of more levels than one
 *   EW_WITH_WRAPS            EW_WRAP_CLAMP and EW_WRAP_MIRROR, and sizes that are no powers of two
 *   EW_WITH_TEXTURE_FORMATS  textures of other formats than RGB565
 *   EW_WITH_TARGET_FORMATS   targets of other formats than RGB565 in the machine's order
 *   EW_WITH_DITHER           ew_target.dither
 */
#ifndef EW_WITH_SHADING
#define EW_WITH_SHADING 1
#endif
#ifndef EW_WITH_FOG
#define EW_WITH_FOG 1
#endif
#ifndef EW_WITH_BLENDS
#define EW_WITH_BLENDS 1
#endif
#ifndef EW_WITH_CUTOUTS
#define EW_WITH_CUTOUTS 1
#endif
#ifndef EW_WITH_BILINEAR
#define EW_WITH_BILINEAR 1
#endif
#ifndef EW_WITH_MIPS
#define EW_WITH_MIPS 1
#endif
#ifndef EW_WITH_WRAPS
#define EW_WITH_WRAPS 1
#endif
#ifndef EW_WITH_TEXTURE_FORMATS
#define EW_WITH_TEXTURE_FORMATS 1
#endif
#ifndef EW_WITH_TARGET_FORMATS
#define EW_WITH_TARGET_FORMATS 1
#endif
#ifndef EW_WITH_DITHER
#define EW_WITH_DITHER 1
#endif
/* Loops of their own for what is drawn most (docs/fills.md has what each draws and costs). 1, the
 * default where the part of the fills is there, has one; 0 leaves its code out, and the same pixels
 * come out of the generic path for several times the instructions.
 *
 *   EW_WITH_LOOP_FLAT      one colour
 *   EW_WITH_LOOP_GOURAUD   one colour, EW_SHADED
 *   EW_WITH_LOOP_NO_DEPTH  nearest texels, depth neither tested nor written
 *   EW_WITH_LOOP_KEYED     nearest texels, EW_COLOUR_KEY; or none, and RGB565 swapped
 *   EW_WITH_LOOP_LIT       nearest texels, EW_SHADED
 *   EW_WITH_LOOP_BILINEAR  EW_FILTER_BILINEAR
 *   EW_WITH_LOOP_GREY4     nearest texels on EW_TARGET_GREY4
 */
#ifndef EW_WITH_LOOP_FLAT
#define EW_WITH_LOOP_FLAT 1
#endif
#ifndef EW_WITH_LOOP_GOURAUD
#define EW_WITH_LOOP_GOURAUD EW_WITH_SHADING
#endif
#ifndef EW_WITH_LOOP_NO_DEPTH
#define EW_WITH_LOOP_NO_DEPTH 1
#endif
#ifndef EW_WITH_LOOP_KEYED
#define EW_WITH_LOOP_KEYED 1
#endif
#ifndef EW_WITH_LOOP_LIT
#define EW_WITH_LOOP_LIT EW_WITH_SHADING
#endif
#ifndef EW_WITH_LOOP_BILINEAR
#define EW_WITH_LOOP_BILINEAR EW_WITH_BILINEAR
#endif
#ifndef EW_WITH_LOOP_GREY4
#define EW_WITH_LOOP_GREY4 EW_WITH_TARGET_FORMATS
#endif

/* 1, the default, has EW_DEPTH_SPANS (docs/memory-modes.md); 0 leaves out its code, 3.7 KB on a Cortex-M0, and a picture that
 * asks for it gets EW_ERR_UNSUPPORTED. */
#ifndef EW_WITH_SPANS
#define EW_WITH_SPANS 1
#endif

#if (EW_WITH_SPANS != 0 && EW_WITH_SPANS != 1) || (EW_WITH_SHADING != 0 && EW_WITH_SHADING != 1) || (EW_WITH_FOG != 0 && EW_WITH_FOG != 1) || \
    (EW_WITH_BLENDS != 0 && EW_WITH_BLENDS != 1) || (EW_WITH_CUTOUTS != 0 && EW_WITH_CUTOUTS != 1) || \
    (EW_WITH_BILINEAR != 0 && EW_WITH_BILINEAR != 1) || (EW_WITH_MIPS != 0 && EW_WITH_MIPS != 1) || \
    (EW_WITH_WRAPS != 0 && EW_WITH_WRAPS != 1) || (EW_WITH_TEXTURE_FORMATS != 0 && EW_WITH_TEXTURE_FORMATS != 1) || \
    (EW_WITH_TARGET_FORMATS != 0 && EW_WITH_TARGET_FORMATS != 1) || (EW_WITH_DITHER != 0 && EW_WITH_DITHER != 1) || \
    (EW_WITH_LOOP_FLAT != 0 && EW_WITH_LOOP_FLAT != 1) || (EW_WITH_LOOP_GOURAUD != 0 && EW_WITH_LOOP_GOURAUD != 1) || \
    (EW_WITH_LOOP_NO_DEPTH != 0 && EW_WITH_LOOP_NO_DEPTH != 1) || (EW_WITH_LOOP_KEYED != 0 && EW_WITH_LOOP_KEYED != 1) || \
    (EW_WITH_LOOP_LIT != 0 && EW_WITH_LOOP_LIT != 1) || (EW_WITH_LOOP_BILINEAR != 0 && EW_WITH_LOOP_BILINEAR != 1) || \
    (EW_WITH_LOOP_GREY4 != 0 && EW_WITH_LOOP_GREY4 != 1)
#error "EW_WITH_...: 0 or 1"
#endif

/* Check of what a caller promised (a size out of its stated range, an order of calls;
 * pointers are used as they are). Compiled away by default; a host build sets it to assert(). Bad
 * data - a file, a stream - is never checked with it. */
#ifndef EW_ASSERT
#define EW_ASSERT(condition) ((void)0)
#endif

/* Marks a function that must not be inlined: its caller's frame would grow by what it needs, also
 * below the caller's other calls. */
#if defined(__GNUC__)
#define EW_OWN_FRAME __attribute__((noinline))
#else
#define EW_OWN_FRAME
#endif

/* Where the code of rows and pixels goes, and the tables that it reads: nothing, or a section that
 * the firmware's linker script puts into RAM or an ITCM (docs/porting.md), as in
 * -D'EW_HOT=__attribute__((section(".ew_hot")))'. Two sections: code and tables may not share one. */
#ifndef EW_HOT
#define EW_HOT
#endif
#ifndef EW_HOT_TABLE
#define EW_HOT_TABLE
#endif

/* Called for every fragment, before the depth test, when a build defines EW_TRACE as
 * 1 (the host's accuracy tests do). 0, the default, leaves no trace in the code. */
#ifndef EW_TRACE
#define EW_TRACE 0
#endif

#endif
