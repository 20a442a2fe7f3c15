/* Where the frames come from: a baked scene, drawn, or raw RGB565 on stdin. */
#ifndef EW_FRAME_SOURCE_H
#define EW_FRAME_SOURCE_H

#include <stdatomic.h>
#include <stdint.h>

#include "tools/common/player.h"
#include "stream_options.h"

typedef struct ew_frame_source {
    const ew_stream_options *options;
    ew_player *player;
    uint16_t *raw;
    unsigned width, height, drawn;
    const uint16_t *pixels; /* the frame drawn last */
} ew_frame_source;

/* Opens for a display of width x height pixels. Returns 0, or -1 after an error line. */
int ew_frame_source_open(ew_frame_source *source, const ew_stream_options *options, unsigned width,
                         unsigned height);
void ew_frame_source_close(ew_frame_source *source);

/* Makes the next frame. Returns 1, 0 at the end, or -1 after an error line. */
int ew_frame_source_next(ew_frame_source *source, const atomic_int *interrupted);

#endif
