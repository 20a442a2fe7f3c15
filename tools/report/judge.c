/* Holds every picture that tools/cycles counts against the referee: one line of figures for each.
 *
 *   judge [--pictures DIR | --method NAME] NAME=FILE.ewb ...
 *
 * Without an option all cases are judged, in the order of the bench, with --method only those of that method.
 * With --pictures only the default method of each scene is drawn, into PNG files: reference, ours, difference
 * and error maps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../host_tests/accuracy/scene_measure.h"
#include "../../host_tests/accuracy/standard_measure.h"
#include "../common/image.h"
#include "../common/player.h"
#include "../cycles/cases.h"

enum { W = BENCH_WIDTH, H = BENCH_HEIGHT, BACKGROUND = 0, PIXELS = W * H };
static const char tool[] = "judge";

/* What the error maps show as the end of their scale. */
static const double map_texels = 1;
enum { MAP_TOLERANCE = 4 };

typedef struct judged_scene {
    char name[64];
    ew_player *player; /* NULL: the standard scene of that letter */
} judged_scene;

static uint16_t colour[PIXELS], depth[PIXELS];
static const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };

static int draw(const judged_scene *s, ew_rung rung, uint16_t tolerance, const ew_cost *cost, measures *m)
{
    int error;
    if (s->player) {
        ew_scene_camera camera;
        ew_scene_get_camera(ew_player_scene(s->player), &camera);
        error = measure_scene(ew_player_scene(s->player), &camera, BENCH_TIME_MS, &target, BACKGROUND, tolerance, rung, cost, m);
    } else {
        error = measure_standard(s->name[0], rung, tolerance, cost, &target, BACKGROUND, m);
    }
    if (error) fprintf(stderr, "%s: %s: cannot draw the scene: %s\n", tool, s->name, ew_error_text(error));
    return error;
}

/* ---- figures ---- */

/* Pixels by which a method may be off in a scene by formula, beyond e; infinite where no
 * formula promises anything. docs/error-bound.md. */
static double bound(const bench_method *method, uint16_t tolerance, const measures *m)
{
    static const double table[] = { 11.02, 12.97, 14.91, 16.53, 17.00, 17.00 }; /* include/edgewalk/fixed.h */
    static const int promised = EW_RECIP_BITS >= 6;
    switch (method->bound) {
    case BOUND_AFFINE: return m->affine_bound;
    case BOUND_RUN: return promised ? m->run_bound * method->run * method->run : HUGE_VAL;
    case BOUND_TABLE: return m->reach * exp2(-table[EW_RECIP_BITS - 4]) <= 11.0 / 1024 ? 0 : HUGE_VAL;
    case BOUND_EXACT: return promised ? 0 : HUGE_VAL;
    default: return promised ? tolerance / 16.0 : HUGE_VAL;
    }
}

/* Of the picture, as the bench prints it. */
static uint32_t hash(void)
{
    uint32_t h = 2166136261u;
    for (int i = 0; i < PIXELS; i++) h = (((h ^ colour[i]) * 16777619u) ^ depth[i]) * 16777619u;
    return h;
}

static int judge_case(const judged_scene *s, const char *name, const bench_method *method, uint16_t tolerance, const ew_cost *cost)
{
    measures m;
    if (draw(s, method->rung, tolerance, cost, &m)) return 1;
    printf("%s,%s,%g,%ld,%ld,%ld,%ld,%.6g,%.6g,%ld,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%08x\n", s->name, name, tolerance / 16.0,
           m.fragments, m.textured, m.wrong_px, m.double_hits, m.disp_max, m.disp_rms, m.within_e, m.u_max, m.u_rms, m.v_max, m.v_rms,
           m.depth_max, m.depth_rms, bound(method, tolerance, &m), hash());
    return 0;
}

static int judge_all(const judged_scene *scenes, int count, const char *only)
{
    static const bench_method automatic = { "auto", EW_RUNG_AUTO, 1, BOUND_TOLERANCE, 0 };
    const bench_method *method;
    uint16_t tolerance;
    int failed = 0;
    printf("scene,method,tolerance_px,fragments,textured,wrong_px,double_hits,disp_max_px,disp_rms_px,within_e,u_max,u_rms,"
           "v_max,v_rms,depth_max_lsb,depth_rms_lsb,bound_px,picture\n");
    for (int s = 0; s < count && !failed; s++) {
        for (int i = 0; bench_case(i, &method, &tolerance) && !failed; i++) {
            if (!only || strcmp(only, method->name) == 0) failed = judge_case(&scenes[s], method->name, method, tolerance, NULL);
        }
        for (int i = 0; i < BENCH_PROFILES * BENCH_TOLERANCES && !failed; i++) {
            const bench_profile *p = &bench_profiles[i / BENCH_TOLERANCES];
            tolerance = bench_tolerances[i % BENCH_TOLERANCES];
            if (!only || strcmp(only, p->name) == 0) failed = judge_case(&scenes[s], p->name, &automatic, tolerance, p->cost);
        }
    }
    return failed;
}

/* ---- pictures ---- */

static uint16_t rgb565(double r, double g, double b)
{
    return (uint16_t)((unsigned)lrint(31 * r) << 11 | (unsigned)lrint(63 * g) << 5 | (unsigned)lrint(31 * b));
}

/* 0 dark blue, over green and yellow, to 1 red; below 0 grey: nothing to judge. tools/report/page.py
 * draws the same scale. */
static uint16_t heat(double x)
{
    static const double stops[5][3] = { { 0.05, 0.05, 0.3 }, { 0, 0.45, 0.7 }, { 0.2, 0.75, 0.3 }, { 1, 0.85, 0.1 }, { 0.85, 0.1, 0.1 } };
    if (x < 0) return rgb565(0.75, 0.75, 0.75);
    double at = fmin(x, 1) * 4, f = at - fmin(floor(at), 3);
    const double *a = stops[(int)fmin(floor(at), 3)], *b = a + 3;
    return rgb565(a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]), a[2] + f * (b[2] - a[2]));
}

static int write_png(const char *folder, const char *scene, const char *kind, const uint16_t *pixels)
{
    char path[4096];
    if (snprintf(path, sizeof path, "%s/%s-%s.png", folder, scene, kind) >= (int)sizeof path) return -1;
    return ew_image_write_png(tool, path, pixels, W, H);
}

static int write_pictures(const judged_scene *s, const char *folder)
{
    static uint16_t reference[PIXELS], picture[PIXELS];
    static float displacement[PIXELS], off[PIXELS];
    const measure_maps maps = { reference, displacement, off };
    measures m;
    long differing = 0;
    measure_want_maps(&maps);
    if (draw(s, EW_RUNG_AUTO, MAP_TOLERANCE, NULL, &m)) return -1;
    int failed = write_png(folder, s->name, "reference", reference) || write_png(folder, s->name, "ours", colour);
    for (int i = 0; i < PIXELS; i++) {
        int a = reference[i], b = colour[i];
        picture[i] = rgb565(abs((a >> 11) - (b >> 11)) / 31.0, abs((a >> 5 & 63) - (b >> 5 & 63)) / 63.0,
                            abs((a & 31) - (b & 31)) / 31.0);
        differing += a != b;
    }
    failed = failed || write_png(folder, s->name, "difference", picture);
    for (int i = 0; i < PIXELS; i++) picture[i] = heat(displacement[i] * 16 / MAP_TOLERANCE);
    failed = failed || write_png(folder, s->name, "displacement", picture);
    for (int i = 0; i < PIXELS; i++) picture[i] = heat(off[i] / map_texels);
    failed = failed || write_png(folder, s->name, "texels", picture);
    printf("%s,%ld,%d\n", s->name, differing, PIXELS);
    return failed ? -1 : 0;
}

int main(int argc, char **argv)
{
    enum { MOST = 16 };
    static judged_scene scenes[MOST];
    const char *folder = argc > 2 && strcmp(argv[1], "--pictures") == 0 ? argv[2] : NULL;
    const char *only = argc > 2 && strcmp(argv[1], "--method") == 0 ? argv[2] : NULL;
    int count = 0, failed = 0;
    for (char name = 'A'; name <= 'E'; name++) scenes[count++].name[0] = name;
    for (int i = folder || only ? 3 : 1; i < argc; i++) {
        const char *path = strchr(argv[i], '=');
        if (!path || count == MOST || path - argv[i] >= (int)sizeof scenes->name) {
            fprintf(stderr, "usage: %s [--pictures DIR | --method NAME] NAME=FILE.ewb ...\n", tool);
            return 2;
        }
        memcpy(scenes[count].name, argv[i], (size_t)(path - argv[i]));
        scenes[count].player = ew_player_open(tool, path + 1, W, H);
        if (!scenes[count++].player) return 1;
    }
    if (folder) {
        for (int i = 0; i < count && !failed; i++) failed = write_pictures(&scenes[i], folder) != 0;
    } else {
        failed = judge_all(scenes, count, only);
    }
    for (int i = 0; i < count; i++) {
        if (scenes[i].player) ew_player_close(scenes[i].player);
    }
    return failed;
}
