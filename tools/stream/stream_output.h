/* What ew-stream writes: files that appear under their names only when whole, and the
 * pictures of a simulated display. */
#ifndef EW_STREAM_OUTPUT_H
#define EW_STREAM_OUTPUT_H

#include <stdint.h>
#include <stdio.h>

/* A file written under a temporary name beside its own. */
typedef struct ew_whole_file {
    FILE *file; /* NULL: not wanted */
    const char *path;
    char *temporary;
} ew_whole_file;

/* path NULL: nothing is written. Returns 0, or -1 after an error line. */
int ew_whole_file_open(ew_whole_file *whole, const char *path);
/* Gives the file its name, or with `keep` 0 removes it. Returns 0, or -1 after an error line. */
int ew_whole_file_close(ew_whole_file *whole, int keep);

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
