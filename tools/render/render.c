/* ew-render: draws a baked scene with the fixed-point core into PNG files. */
#include <argp.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "edgewalk/edgewalk.h"
#include "../common/image.h"
#include "../common/options.h"
#include "../common/player.h"

static const char tool[] = "ew-render";
const char *argp_program_version = "ew-render " EW_VERSION;

struct options {
    const char *scene, *output;
    unsigned width, height, frames, fps;
    int animate;
};

static const struct argp_option option_table[] = {
    { "output", 'o', "FILE", 0, "PNG file to write (frame.png). For several frames its name is numbered: "
                                "frame-0000.png, frame-0001.png ...", 0 },
    { "size", 's', "WxH", 0, "Size of the picture in pixels, up to 4096x4096 (320x240)", 0 },
    { "frames", 'n', "N", 0, "Number of frames, 1 to 10000 (1)", 0 },
    { "fps", 'f', "N", 0, "Frames per second of the scene's animation, 1 to 1000 (30)", 0 },
    { "animation", 'a', NULL, 0, "Write all frames into the one FILE, as an animated PNG", 0 },
    { 0 }
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    struct options *o = state->input;
    switch (key) {
    case 'o': o->output = arg; break;
    case 's':
        if (ew_parse_size(arg, &o->width, &o->height)) {
            argp_error(state, "--size %s: not WxH with both from 1 to 4096", arg);
        }
        break;
    case 'n':
        if (ew_parse_unsigned(arg, 1, 10000, &o->frames)) {
            argp_error(state, "--frames %s: not a number from 1 to 10000", arg);
        }
        break;
    case 'f':
        if (ew_parse_unsigned(arg, 1, 1000, &o->fps)) {
            argp_error(state, "--fps %s: not a number from 1 to 1000", arg);
        }
        break;
    case 'a': o->animate = 1; break;
    case ARGP_KEY_ARG:
        if (o->scene) argp_error(state, "%s: one scene only", arg);
        o->scene = arg;
        break;
    case ARGP_KEY_END:
        if (!o->scene) argp_error(state, "no scene given");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* "dir/frame.png" to "dir/frame-0007.png". */
static int numbered(char *out, size_t room, const char *path, unsigned i)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    if (!dot || (slash && dot < slash)) dot = path + strlen(path);
    int n = snprintf(out, room, "%.*s-%04u%s", (int)(dot - path), path, i, dot);
    return n < 0 || (size_t)n >= room ? -1 : 0;
}

static int render(const struct options *o, ew_player *player)
{
    ew_apng *apng = NULL;
    int one_file = o->animate || o->frames == 1;
    if (one_file) {
        apng = ew_apng_open(tool, o->output, o->width, o->height, o->frames, o->fps);
        if (!apng) return -1;
    }
    int failed = 0;
    for (unsigned i = 0; i < o->frames && !failed; i++) {
        failed = ew_player_draw(player, i, o->frames, o->fps);
        if (failed) break;
        if (one_file) {
            failed = ew_apng_add(apng, ew_player_pixels(player));
        } else {
            char name[4096];
            if (numbered(name, sizeof name, o->output, i)) {
                fprintf(stderr, "%s: %s: cannot write the picture: the name is too long\n", tool, o->output);
                failed = 1;
            } else {
                failed = ew_image_write_png(tool, name, ew_player_pixels(player), o->width, o->height);
            }
        }
        if (isatty(STDERR_FILENO) && o->frames > 1) {
            fprintf(stderr, "\rframe %u of %u%s", i + 1, o->frames, i + 1 == o->frames ? "\n" : "");
        }
    }
    if (apng && ew_apng_close(apng)) failed = 1;
    return failed ? -1 : 0;
}

int main(int argc, char **argv)
{
    struct options o = { .output = "frame.png", .width = 320, .height = 240, .frames = 1, .fps = 30 };
    const struct argp argp = { option_table, parse, "SCENE.ewb",
                               "Draws a baked scene with the fixed-point core into PNG files. A scene with an "
                               "animation plays it; round any other the camera goes once in all frames.",
                               NULL, NULL, NULL };
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &o);

    ew_player *player = ew_player_open(tool, o.scene, o.width, o.height);
    if (!player) return 1;
    int failed = render(&o, player);
    if (!failed) {
        printf("%s: %u frame%s of %ux%u, %d triangles in the last\n", o.output, o.frames,
               o.frames == 1 ? "" : "s", o.width, o.height, (int)ew_player_drawn(player));
    }
    ew_player_close(player);
    return failed ? 1 : 0;
}
