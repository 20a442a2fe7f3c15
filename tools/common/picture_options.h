/* What programs that draw frames of a scene ask for: the scene, --size, --frames, --fps. An
 * argp child; the parent passes its ew_picture_options as the child's input. */
#ifndef EW_TOOLS_PICTURE_OPTIONS_H
#define EW_TOOLS_PICTURE_OPTIONS_H

#include <argp.h>

typedef struct ew_picture_options {
    const char *scene;
    unsigned width, height, frames, fps;
} ew_picture_options;

#define EW_PICTURE_DEFAULTS { NULL, 320, 240, 1, 30 }

extern const struct argp ew_picture_argp;

#endif
