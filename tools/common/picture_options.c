#include "picture_options.h"

#include "options.h"

static const struct argp_option option_table[] = {
    { "size", 's', "WxH", 0, "Size of the picture in pixels, up to 4096x4096 (320x240)", 0 },
    { "frames", 'n', "N", 0, "Number of frames, 1 to 10000 (1)", 0 },
    { "fps", 'f', "N", 0, "Frames per second of the scene's animation, 1 to 1000 (30)", 0 },
    { 0 }
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    ew_picture_options *o = state->input;
    switch (key) {
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

const struct argp ew_picture_argp = { option_table, parse, "SCENE.ewb", NULL, NULL, NULL, NULL };
