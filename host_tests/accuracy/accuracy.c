/* ew-accuracy: holds frames of a baked scene against the double-precision referee. */
#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "edgewalk/edgewalk.h"
#include "../../tools/common/options.h"
#include "../../tools/common/picture_options.h"
#include "../../tools/common/player.h"
#include "scene_measure.h"

static const char tool[] = "ew-accuracy";
const char *argp_program_version = "ew-accuracy " EW_VERSION;

struct options {
    ew_picture_options picture;
    unsigned every;
    int tolerance;
};

static const struct argp_option option_table[] = {
    { "every", 'e', "K", 0, "Judge every Kth frame only (1)", 0 },
    { "exact", 'x', NULL, 0, "Draw with tolerance 0 instead of the materials' own", 0 },
    { 0 }
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    struct options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT: state->child_inputs[0] = &o->picture; break;
    case 'e':
        if (ew_parse_unsigned(arg, 1, 10000, &o->every)) argp_error(state, "--every %s: not 1 to 10000", arg);
        break;
    case 'x': o->tolerance = 0; break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

int main(int argc, char **argv)
{
    struct options o = { EW_PICTURE_DEFAULTS, 1, -1 };
    const ew_picture_options *p = &o.picture;
    const struct argp_child children[] = { { &ew_picture_argp, 0, NULL, 0 }, { 0 } };
    const struct argp argp = { option_table, parse, NULL,
                               "Draws frames of a baked scene with the fixed-point core and holds every fragment "
                               "against the double-precision referee. Exit status 1 when a pixel is wrong or an error "
                               "is beyond what docs/conventions.md and docs/error-bound.md promise.",
                               children, NULL, NULL };
    static char name[] = "ew-accuracy";
    if (argc > 0) argv[0] = name; /* argp's words begin with it, whatever path was typed */
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    ew_player *player = ew_player_open(tool, p->scene, p->width, p->height);
    if (!player) return 1;
    size_t pixels = (size_t)p->width * p->height;
    uint16_t *colour = malloc(2 * pixels), *depth = malloc(2 * pixels);
    if (!colour || !depth) abort();
    const ew_target target = { .colour = colour, .depth = depth, .width = (uint16_t)p->width, .height = (uint16_t)p->height, .stride = (uint16_t)p->width };

    measures worst, m;
    memset(&worst, 0, sizeof worst);
    long differing = 0;
    unsigned judged = 0;
    double u_sum = 0, v_sum = 0;
    for (unsigned i = 0; i < p->frames; i += o.every) {
        int failed = ew_player_draw(player, i, p->frames, p->fps);
        if (!failed) {
            failed = measure_scene(ew_player_scene(player), ew_player_camera(player), ew_player_time_ms(player),
                                   &target, EW_PLAYER_BACKGROUND, o.tolerance, EW_RUNG_AUTO, NULL, &m);
            if (failed) fprintf(stderr, "%s: %s: cannot draw the scene: %s\n", tool, p->scene, ew_error_text(failed));
        }
        if (failed) return 1;
        if (o.tolerance < 0) {
            for (size_t k = 0; k < pixels; k++) differing += colour[k] != ew_player_pixels(player)[k];
        }
        judged++;
        worst.fragments += m.fragments;
        worst.textured += m.textured;
        worst.wrong_px += m.wrong_px;
        worst.double_hits += m.double_hits;
        worst.wrong_truth_px += m.wrong_truth_px;
        worst.covered_px += m.covered_px;
        worst.colour_px += m.colour_px;
        worst.depth_max = fmax(worst.depth_max, m.depth_max);
        worst.uv_off = fmax(worst.uv_off, m.uv_off);
        worst.depth_off = fmax(worst.depth_off, m.depth_off);
        worst.snapped_max = fmax(worst.snapped_max, m.snapped_max);
        worst.u_max = fmax(worst.u_max, m.u_max), worst.v_max = fmax(worst.v_max, m.v_max);
        u_sum += m.u_rms * m.u_rms * (double)m.textured, v_sum += m.v_rms * m.v_rms * (double)m.textured;
        if (isatty(STDERR_FILENO)) fprintf(stderr, "\rjudged frame %u of %u", i + 1, p->frames);
    }
    if (isatty(STDERR_FILENO)) fputc('\n', stderr);
    double n = worst.textured ? (double)worst.textured : 1;
    printf("%s: %u frames of %ux%u against the referee: %ld fragments, %ld wrong pixels, %ld hit twice, "
           "%ld of a colour outside the tolerance\n",
           p->scene, judged, p->width, p->height, worst.fragments, worst.wrong_px, worst.double_hits, worst.colour_px);
    printf("%s: texel error rms u %.4f v %.4f, worst u %.3f v %.3f, %.4f beyond the tolerance; depth worst %.3f units, "
           "%.3f over the disc of 1/256 px; "
           "vertices within %.3f subpixel; %.4f %% of pixels differ from the unsnapped truth's outline\n",
           p->scene, sqrt(u_sum / n), sqrt(v_sum / n), worst.u_max, worst.v_max, worst.uv_off, worst.depth_max, worst.depth_off, worst.snapped_max,
           worst.covered_px ? 100.0 * (double)worst.wrong_truth_px / (double)worst.covered_px : 0.0);
    if (differing) printf("%s: %ld pixels differ between drawing at once and by triangle\n", p->scene, differing);
    free(colour);
    free(depth);
    ew_player_close(player);
    /* the snap moves outlines by 1/512 px: more than 1 pixel in 200 is something else */
    int beyond = worst.wrong_truth_px * 200 > worst.covered_px || worst.snapped_max > 0.75 || worst.depth_off > 1 || worst.uv_off > 1.0 / 64;
    return worst.wrong_px || worst.double_hits || worst.colour_px || differing || beyond ? 1 : 0;
}
