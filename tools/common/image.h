/* PNG pictures and animated PNG files of RGB565 pixels, through libpng. Functions print one
 * line `tool: path: what: why` on stderr and return -1 (or NULL) on failure; a file appears
 * under its name only when it is whole. */
#ifndef EW_TOOLS_IMAGE_H
#define EW_TOOLS_IMAGE_H

#include <stdint.h>

int ew_image_write_png(const char *tool, const char *path, const uint16_t *rgb565, unsigned width,
                       unsigned height);

/* An animation that repeats for ever; viewers without APNG show its first frame. */
typedef struct ew_apng ew_apng;
ew_apng *ew_apng_open(const char *tool, const char *path, unsigned width, unsigned height, unsigned frames,
                      unsigned fps);
int ew_apng_add(ew_apng *apng, const uint16_t *rgb565);
/* Frees it in any case. With keep = 0 nothing is left of the file; otherwise fewer frames than
 * were announced is a failure. */
int ew_apng_close(ew_apng *apng, int keep);

#endif
