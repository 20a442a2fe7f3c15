#include "stream_options.h"

#include <argp.h>
#include <string.h>

#include "edgewalk/edgewalk.h"

#include "panel_lines.h"
#include "tools/common/options.h"

const char ew_stream_tool[] = "ew-stream";
const char *argp_program_version = "ew-stream " EW_VERSION;

enum {
    OPT_PROFILE = 256,
    OPT_FPS,
    OPT_CODEC,
    OPT_KEYFRAME,
    OPT_OUT,
    OPT_COMPARE,
    OPT_RECORD,
    OPT_DUMP_DRAWN,
    OPT_GPIO_RESET,
    OPT_GPIO_TE,
    OPT_TE_TIMEOUT,
    OPT_RECONNECT,
    OPT_TIMEOUT,
    OPT_LIST,
    OPT_FAULT_DROP,
    OPT_RAW
};

/* clang-format off */
static const struct argp_option option_list[] = {
    {"device", 'd', "DEVICE", 0, "sim:WxH, VID:PID, VID:PID:SERIAL or /dev/hidrawN", 1},
    {"list", OPT_LIST, NULL, 0, "List the HID displays that are plugged in, and end", 1},
    {"raw", OPT_RAW, "WxH", 0, "Take RGB565 frames (little-endian, rows without gaps) from stdin instead of a scene",
     2},
    {"frames", 'n', "N", 0, "Frames to send, 0 = until interrupted or stdin ends [60; 0 with --raw]", 2},
    {"fps", OPT_FPS, "N", 0, "Frames a second, 0 = as fast as possible [30; 0 with --gpio-te]", 2},
    {"codec", OPT_CODEC, "CODEC", 0, "auto, raw or srl [auto: whichever is smaller, frame by frame]", 3},
    {"keyframe", OPT_KEYFRAME, "SECONDS", 0,
     "A key frame at least so often [only when needed; 5 for a display without status reports]", 3},
    {"timeout", OPT_TIMEOUT, "MS", 0, "Give up when nothing has moved for so long [3000]", 3},
    {"reconnect", OPT_RECONNECT, "SECONDS", 0, "Wait so long for a display that has gone [0]", 3},
    {"gpio-reset", OPT_GPIO_RESET, "CHIP:LINE", 0, "Pulse this line low before the display is opened", 4},
    {"gpio-te", OPT_GPIO_TE, "CHIP:LINE", 0, "Begin each frame at a rising edge of this line", 4},
    {"te-timeout", OPT_TE_TIMEOUT, "MS", 0, "Longest wait for that edge [two frame periods]", 4},
    {"profile", OPT_PROFILE, "PROFILE", 0, "sim: direct or buffered [buffered]", 5},
    {"out", 'o', "DIR", 0, "sim: what the display shows after each frame, as PNG files and animation.png", 5},
    {"fault-drop", OPT_FAULT_DROP, "N", 0,
     "sim: lose every Nth report, to show recovery; a key frame must take fewer reports than N", 5},
    {"compare", OPT_COMPARE, NULL, 0,
     "Fail unless the display's picture is bit-equal to every frame drawn; a real display has to confirm each "
     "frame instead, with its counters in agreement", 6},
    {"record", OPT_RECORD, "FILE", 0, "Write every report as a line of hex", 6},
    {"dump-drawn", OPT_DUMP_DRAWN, "FILE", 0, "Write every frame drawn, in the form that --raw takes", 6},
    {0}};
/* clang-format on */

static unsigned parse_number(struct argp_state *state, const char *name, const char *text, unsigned most)
{
    unsigned value = 0;
    if (ew_parse_unsigned(text, 0, most, &value)) {
        argp_error(state, "--%s %s: not a whole number from 0 to %u", name, text, most);
    }
    return value;
}

static double parse_decimal(struct argp_state *state, const char *name, const char *text, double most)
{
    double value = 0;
    if (ew_parse_double(text, 0, most, &value)) {
        argp_error(state, "--%s %s: not a number from 0 to %g", name, text, most);
    }
    return value;
}

/* The index of `text` in a list of words. */
static unsigned parse_word(struct argp_state *state, const char *name, const char *text,
                           const char *const *words)
{
    unsigned i;
    for (i = 0; words[i]; i++) {
        if (!strcmp(text, words[i])) {
            return i;
        }
    }
    argp_error(state, "--%s %s: unknown", name, text);
    return 0;
}

/* `text` ends with the size. */
static void parse_size(struct argp_state *state, const char *name, const char *text, const char *size,
                       unsigned *width, unsigned *height)
{
    if (ew_parse_size(size, width, height)) {
        argp_error(state, "--%s %s: size: not WxH with 1 to 4096 pixels on each side", name, text);
    }
}

static void parse_device(struct argp_state *state, ew_stream_options *o, const char *text)
{
    o->device = text;
    o->is_sim = !strncmp(text, "sim:", 4);
    if (o->is_sim) {
        parse_size(state, "device", text, text + 4, &o->sim_width, &o->sim_height);
    } else if (ew_hid_parse_name(&o->hid_name, text)) {
        argp_error(state,
                   "--device %s: neither sim:WxH, nor VID:PID or VID:PID:SERIAL in hex, nor a path", text);
    }
}

static const char *parse_line(struct argp_state *state, const char *name, const char *text)
{
    ew_line_name line;
    if (ew_line_name_parse(&line, text)) {
        argp_error(state, "--%s %s: not of the form CHIP:LINE", name, text);
    }
    return text;
}

static void check_usage(const ew_stream_options *o, struct argp_state *state)
{
    if (o->list) {
        return;
    }
    if (!o->device) {
        argp_error(state, "--device is missing");
    }
    if (!o->raw == !o->scene) {
        argp_error(state, o->raw ? "a scene and --raw exclude each other" : "the scene is missing");
    }
    if (!o->is_sim && (o->out || o->fault_drop || o->profile != EW_HID_BUFFERED)) {
        argp_error(state, "--out, --fault-drop and --profile need a simulated display (--device sim:WxH)");
    }
}

typedef struct parse {
    ew_stream_options *options;
    int frames_given, fps_given;
} parse;

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    static const char *const profiles[] = {"direct", "buffered", NULL};
    static const char *const codecs[] = {"raw", "srl", "auto", NULL};
    parse *p = state->input;
    ew_stream_options *o = p->options;

    switch (key) {
    case 'd': parse_device(state, o, text); break;
    case 'n':
        o->frames = parse_number(state, "frames", text, 1000000000);
        p->frames_given = 1;
        break;
    case 'o': o->out = text; break;
    case OPT_LIST: o->list = 1; break;
    case OPT_RAW:
        o->raw = 1;
        parse_size(state, "raw", text, text, &o->raw_width, &o->raw_height);
        break;
    case OPT_FPS:
        o->fps = parse_decimal(state, "fps", text, 1000);
        p->fps_given = 1;
        break;
    case OPT_CODEC: o->codec = (ew_codec)parse_word(state, "codec", text, codecs); break;
    case OPT_KEYFRAME:
        o->keyframe_ms = (unsigned)(1000 * parse_decimal(state, "keyframe", text, 86400));
        break;
    case OPT_TIMEOUT: o->timeout_ms = parse_number(state, "timeout", text, 3600000); break;
    case OPT_RECONNECT:
        o->reconnect_ms = (unsigned)(1000 * parse_decimal(state, "reconnect", text, 86400));
        break;
    case OPT_GPIO_RESET: o->gpio_reset = parse_line(state, "gpio-reset", text); break;
    case OPT_GPIO_TE: o->gpio_te = parse_line(state, "gpio-te", text); break;
    case OPT_TE_TIMEOUT: o->te_timeout_ms = parse_number(state, "te-timeout", text, 3600000); break;
    case OPT_PROFILE: o->profile = (ew_hid_profile)parse_word(state, "profile", text, profiles); break;
    case OPT_FAULT_DROP: o->fault_drop = parse_number(state, "fault-drop", text, 1000000000); break;
    case OPT_COMPARE: o->compare = 1; break;
    case OPT_RECORD: o->record = text; break;
    case OPT_DUMP_DRAWN: o->dump_drawn = text; break;
    case ARGP_KEY_ARG:
        if (o->scene) {
            argp_error(state, "%s: only one scene can be streamed", text);
        }
        o->scene = text;
        break;
    case ARGP_KEY_END: check_usage(o, state); break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

void ew_stream_parse_options(ew_stream_options *options, int argc, char **argv)
{
    static const struct argp argp = {
        option_list,
        parse_option,
        "[SCENE.ewb]",
        "Draws a baked scene and streams its frames to a USB HID display, or to one simulated inside the "
        "program."
        "\vExit status: 0 the stream ended as asked, 1 it failed, 2 wrong usage.",
        NULL,
        NULL,
        NULL};
    static char name[] = "ew-stream";
    parse p = {options, 0, 0};

    if (argc > 0) {
        argv[0] = name; /* getopt's words begin with it, whatever path was typed */
    }
    memset(options, 0, sizeof *options);
    options->profile = EW_HID_BUFFERED;
    options->frames = 60;
    options->fps = 30;
    options->codec = EW_CODEC_AUTO;
    options->timeout_ms = 3000;
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &p);
    if (options->raw && !p.frames_given) {
        options->frames = 0;
    }
    if (options->gpio_te && !p.fps_given) {
        options->fps = 0;
    }
}
