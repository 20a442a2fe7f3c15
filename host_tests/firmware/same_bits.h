/* What is computed on every machine and must come out the same: one hash per case. */
#ifndef SAME_BITS_H
#define SAME_BITS_H

#include <stdint.h>

#include "edgewalk/picture.h"

/* What a target has room for:
 *   0  fixed-point functions, the set of triangles and the HUD (AVR: 8 KB of RAM, 16-bit int)
 *   1  and the standard scenes A, C, D and E at 64x48 (16 KB)
 *   2  and scene B, whose vertices take 17 KB (64 KB)
 *   3  and all five at 320x240 (more than 330 KB) */
#ifndef SAME_BITS_ROOM
#define SAME_BITS_ROOM 3
#endif

/* The one picture's memory. */
#if SAME_BITS_ROOM >= 3
#define SAME_BITS_PIXELS (320 * 240)
#elif SAME_BITS_ROOM >= 1
#define SAME_BITS_PIXELS (64 * 48)
#else
#define SAME_BITS_PIXELS (64 * 12)
#endif
/* The byte between puts one of the two at an odd address where that will do (AVR): the core
 * once refused those. */
extern struct same_picture {
    uint16_t colour[SAME_BITS_PIXELS];
    uint8_t between;
    uint16_t depth[SAME_BITS_PIXELS];
} same_picture;
extern ew_raster same_raster; /* one context for all: small boards have no room for two */

/* Prints `hash SCENE METHOD TOLERANCE SIZE HASH`: the tolerance in 1/16 px, `-` for what does
 * not apply. */
void print_hash(const char *scene, const char *method, int tolerance, const char *size, uint32_t hash);
void print_failure(const char *scene, const char *what);
void print_memory(const char *scene, const char *mode, uint32_t bytes, uint32_t active, const ew_picture_counts *counts,
                  uint32_t triangles, uint32_t vertices);

void fixed_bits(void);
void triangle_bits(void);
void hud_bits(void);
void scene_bits(void);

/* Pseudo-random numbers, the same everywhere. */
typedef struct generator {
    uint32_t state; /* not 0 */
} generator;
uint32_t random32(generator *g);
int32_t random_between(generator *g, int32_t low, int32_t high); /* both included; high - low < 2^31 */

#endif
