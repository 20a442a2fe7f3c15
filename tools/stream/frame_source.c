#include "frame_source.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DEFAULT_FPS = 30, ENDLESS_ORBIT_SECONDS = 10 };

int ew_frame_source_open(ew_frame_source *source, const ew_stream_options *options, unsigned width,
                         unsigned height)
{
    memset(source, 0, sizeof *source);
    source->options = options;
    source->width = width;
    source->height = height;
    if (!options->raw) {
        source->player = ew_player_open(ew_stream_tool, options->scene, width, height);
        return source->player ? 0 : -1;
    }
    if (options->raw_width != width || options->raw_height != height) {
        fprintf(stderr, "%s: stdin: raw frames of %ux%u pixels: the display has %ux%u\n", ew_stream_tool,
                options->raw_width, options->raw_height, width, height);
        return -1;
    }
    source->raw = malloc((size_t)width * height * sizeof *source->raw);
    if (!source->raw) {
        fprintf(stderr, "%s: stdin: raw frames: out of memory\n", ew_stream_tool);
        return -1;
    }
    return 0;
}

void ew_frame_source_close(ew_frame_source *source)
{
    if (source->player) {
        ew_player_close(source->player);
    }
    free(source->raw);
    memset(source, 0, sizeof *source);
}

/* Bytes read, fewer than `size` only at the end of stdin or when interrupted; or -1. */
static ssize_t read_stdin(uint8_t *bytes, size_t size, const atomic_int *interrupted)
{
    size_t have = 0;
    while (have < size && !*interrupted) {
        ssize_t n = read(STDIN_FILENO, bytes + have, size - have);
        if (n == 0) {
            break;
        }
        if (n < 0 && errno != EINTR) {
            return -1;
        }
        have += n > 0 ? (size_t)n : 0;
    }
    return (ssize_t)have;
}

static int next_raw(ew_frame_source *source, const atomic_int *interrupted)
{
    size_t pixels = (size_t)source->width * source->height, size = 2 * pixels, i;
    const uint8_t *bytes = (const uint8_t *)source->raw;
    ssize_t n = read_stdin((uint8_t *)source->raw, size, interrupted);

    if (n < 0) {
        fprintf(stderr, "%s: stdin: frame %u: %s\n", ew_stream_tool, source->drawn, strerror(errno));
        return -1;
    }
    if (n == 0 || *interrupted) {
        return 0;
    }
    if ((size_t)n < size) {
        fprintf(stderr, "%s: stdin: frame %u: ends after %zd of %zu bytes\n", ew_stream_tool, source->drawn,
                n, size);
        return -1;
    }
    for (i = 0; i < pixels; i++) { /* in place: pixel i lies where its two bytes lay */
        source->raw[i] = (uint16_t)(bytes[2 * i] | bytes[2 * i + 1] << 8);
    }
    source->pixels = source->raw;
    return 1;
}

static int next_drawn(ew_frame_source *source)
{
    const ew_stream_options *o = source->options;
    double fps = o->fps > 0 ? o->fps : DEFAULT_FPS;
    unsigned orbit = o->frames ? o->frames : (unsigned)(ENDLESS_ORBIT_SECONDS * fps + 1);

    if (ew_player_draw(source->player, source->drawn, orbit, fps)) {
        return -1;
    }
    source->pixels = ew_player_pixels(source->player);
    return 1;
}

int ew_frame_source_next(ew_frame_source *source, const atomic_int *interrupted)
{
    int r;
    if (source->options->frames && source->drawn == source->options->frames) {
        return 0;
    }
    r = source->raw ? next_raw(source, interrupted) : next_drawn(source);
    source->drawn += r == 1;
    return r;
}
