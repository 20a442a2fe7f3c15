/* ew-render: draws a baked scene with the fixed-point core into PNG files. */
#include <argp.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "edgewalk/edgewalk.h"
#include "../common/image.h"
#include "../common/picture_options.h"
#include "../common/player.h"

static const char tool[] = "ew-render";
const char *argp_program_version = "ew-render " EW_VERSION;

struct options {
    ew_picture_options picture;
    const char *output;
    int animate;
    unsigned rows, active;
    ew_visibility visibility;
};

static const struct argp_option option_table[] = {
    { "output", 'o', "FILE", 0, "PNG file to write (frame.png). For several frames its name is numbered: "
                                "frame-0000.png, frame-0001.png ...", 0 },
    { "animation", 'a', NULL, 0, "Write all frames into the one FILE, as an animated PNG", 0 },
    { "rows", 'r', "N", 0, "Draw in bands of N rows, 1 is line by line: the same picture in less memory", 0 },
    { "active", 'A', "N", 0, "With --rows or --visibility: memory for N triangles that reach from band to band (64)", 0 },
    { "visibility", 'v', "HOW", 0, "What is seen is found by depth, a buffer of it (the default); by spans, compared where they "
                                   "begin and end, for scenes that are opaque; or by none: what is drawn later covers what was "
                                   "drawn before", 0 },
    { 0 }
};

/* A number of an option, 0 to `most`. */
static unsigned number(struct argp_state *state, const char *option, const char *text, unsigned long least, unsigned long most)
{
    char *end;
    errno = 0;
    const unsigned long n = strtoul(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || errno || n < least || n > most) {
        argp_error(state, "--%s: '%s' is not a whole number from %lu to %lu", option, text, least, most);
    }
    return (unsigned)n;
}

static const char *const visibilities[] = { "depth", "none", "spans" }; /* as in ew_visibility */

static ew_visibility visibility(struct argp_state *state, const char *text)
{
    for (int i = EW_DEPTH_BUFFER; i <= EW_DEPTH_SPANS; i++) {
        if (strcmp(text, visibilities[i]) == 0) return (ew_visibility)i;
    }
    argp_error(state, "--visibility: '%s' is none of depth, none, spans", text);
    return EW_DEPTH_BUFFER;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    struct options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT: state->child_inputs[0] = &o->picture; break;
    case 'o': o->output = arg; break;
    case 'a': o->animate = 1; break;
    case 'r': o->rows = number(state, "rows", arg, 1, 4096); break;
    case 'A': o->active = number(state, "active", arg, 0, 1000000); break;
    case 'v': o->visibility = visibility(state, arg); break;
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
    const ew_picture_options *p = &o->picture;
    ew_apng *apng = NULL;
    int one_file = o->animate || p->frames == 1;
    if (one_file) {
        apng = ew_apng_open(tool, o->output, p->width, p->height, p->frames, p->fps);
        if (!apng) return -1;
    }
    int failed = 0;
    for (unsigned i = 0; i < p->frames && !failed; i++) {
        failed = ew_player_draw(player, i, p->frames, p->fps);
        if (failed) break;
        if (one_file) {
            failed = ew_apng_add(apng, ew_player_pixels(player));
        } else {
            char name[4096];
            if (numbered(name, sizeof name, o->output, i)) {
                fprintf(stderr, "%s: %s: cannot write the picture: the name is too long\n", tool, o->output);
                failed = 1;
            } else {
                failed = ew_image_write_png(tool, name, ew_player_pixels(player), p->width, p->height);
            }
        }
        if (isatty(STDERR_FILENO) && p->frames > 1) {
            fprintf(stderr, "\rframe %u of %u%s", i + 1, p->frames, i + 1 == p->frames ? "\n" : "");
        }
    }
    if (apng && ew_apng_close(apng, !failed)) failed = 1;
    return failed ? -1 : 0;
}

int main(int argc, char **argv)
{
    struct options o = { EW_PICTURE_DEFAULTS, "frame.png", 0, 0, 64, EW_DEPTH_BUFFER };
    const struct argp_child children[] = { { &ew_picture_argp, 0, NULL, 0 }, { 0 } };
    const struct argp argp = { option_table, parse, NULL,
                               "Draws a baked scene with the fixed-point core into PNG files. A scene with an "
                               "animation plays it; round any other the camera goes once in all frames.",
                               children, NULL, NULL };
    static char name[] = "ew-render";
    if (argc > 0) argv[0] = name; /* argp's words begin with it, whatever path was typed */
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &o);

    ew_player *player = ew_player_open(tool, o.picture.scene, o.picture.width, o.picture.height);
    if (!player) return 1;
    if (o.visibility && !o.rows) o.rows = o.picture.height;
    int failed = (o.rows && ew_player_use_bands(player, o.rows, o.active, o.visibility)) || render(&o, player);
    if (!failed && o.rows) {
        ew_picture_counts c;
        const size_t bytes = ew_player_memory(player, &c);
        printf("%s: bands of %u rows in %zu bytes, %u triangles active at most, %u of %u set-ups for want of room", o.output,
               o.rows, bytes, (unsigned)c.most_active, (unsigned)c.again, (unsigned)c.set_up);
        if (o.visibility == EW_DEPTH_SPANS) printf(", %u crossings, %u sections", (unsigned)c.crossings, (unsigned)c.sections);
        printf("\n");
    } else if (!failed) {
        const ew_picture_options *p = &o.picture;
        printf("%s: %u frame%s of %ux%u, %d triangles in the last\n", o.output, p->frames, p->frames == 1 ? "" : "s",
               p->width, p->height, (int)ew_player_drawn(player));
    }
    ew_player_close(player);
    return failed ? 1 : 0;
}
