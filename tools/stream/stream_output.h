/* The pictures of a simulated display. */
#ifndef EW_STREAM_OUTPUT_H
#define EW_STREAM_OUTPUT_H

#include <stdint.h>
#include <stdio.h>

/* Pictures shown: DIR/frame-0000.png and so on, and at the end DIR/animation.png. */
typedef struct ew_pictures {
    const char *dir; /* NULL: not wanted */
    unsigned width, height, count;
    FILE *spool; /* all pictures: the number of frames comes first in an APNG file */
} ew_pictures;

/* Returns 0, or -1 after an error line. */
int ew_pictures_open(ew_pictures *pictures, const char *dir, unsigned width, unsigned height);
int ew_pictures_add(ew_pictures *pictures, const uint16_t *rgb565);
int ew_pictures_close(ew_pictures *pictures, double fps);

#endif
