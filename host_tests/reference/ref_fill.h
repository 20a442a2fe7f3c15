/* The referee of fills: docs/fills.md once more, slowly and pixel by pixel. Includes the public
 * header for its structures only; shares no code with the core. */
#ifndef EW_REF_FILL_H
#define EW_REF_FILL_H

#include <stddef.h>
#include <stdint.h>

#include "edgewalk/raster.h"

typedef struct ref_fog {
    uint16_t colour;
    int64_t near, far; /* uq1.31; near = far: no fog */
} ref_fog;

/* A run as src/raster/fill.h has it, in plain numbers: nothing wraps. */
typedef struct ref_run {
    int x, y, n;
    int64_t w, dw;         /* 2^-31                       */
    int64_t u, du, v, dv;  /* 2^-32 texel                 */
    int64_t u_down, v_down;
    int64_t shade[3], dshade[3]; /* 2^24 is all of it */
} ref_run;

/* Bytes of a row of pixels or texels of `bits` bits. */
size_t ref_row_bytes(size_t width, int bits);
int ref_texture_bits(int format);
int ref_target_bits(int format);
/* Of all levels; bits = 1 for a mask. */
size_t ref_texture_bytes(const ew_texture *texture, int bits);

/* log2 of rho, -infinity for none. */
double ref_lambda(const ref_run *run);

/* Draws into target->colour and ->depth. lambda256: of the mip level, in 1/256, at least 0. */
void ref_fill(const ew_target *target, const ew_material *material, const ref_fog *fog, const ref_run *run,
              int lambda256);

/* A pixel's stored value for a colour, in the target's own byte order, and of a stored one. */
unsigned ref_convert(const ew_target *target, const int c[3], int x, int y);
unsigned ref_read(const ew_target *target, int x, int y);
void ref_decode_565(const ew_target *target, unsigned value, int c[3]);

#endif
