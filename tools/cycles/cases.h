/* What is counted and measured: methods, tolerances, the frames of baked scenes. A new rung
 * is one line of bench_methods. */
#ifndef EW_CYCLES_CASES_H
#define EW_CYCLES_CASES_H

#include "edgewalk/picture.h"

/* By which formula of docs/error-bound.md a method's displacement is known beforehand. */
typedef enum bench_bound {
    BOUND_AFFINE,    /* max L |dw| / (3 w_min)                                              */
    BOUND_RUN,       /* run^2 |dw| / (4 w)                                                  */
    BOUND_TABLE,     /* the table reciprocal's error of the way in texels, against e        */
    BOUND_EXACT,     /* none but e                                                          */
    BOUND_TOLERANCE  /* the material's tolerance                                            */
} bench_bound;

typedef struct bench_method {
    const char *name;
    uint8_t rung;
    uint8_t takes_tolerance; /* drawn once for each tolerance, or once                      */
    bench_bound bound;
    uint16_t run;            /* pixels, for BOUND_RUN                                       */
} bench_method;

static const bench_method bench_methods[] = {
    { "affine", EW_RUNG_AFFINE, 0, BOUND_AFFINE, 0 },
    { "runs8", EW_RUNG_RUNS_8, 0, BOUND_RUN, 8 },
    { "runs16", EW_RUNG_RUNS_16, 0, BOUND_RUN, 16 },
    { "runs32", EW_RUNG_RUNS_32, 0, BOUND_RUN, 32 },
    { "table", EW_RUNG_TABLE, 0, BOUND_TABLE, 0 },
    { "exact", EW_RUNG_EXACT, 0, BOUND_EXACT, 0 },
    { "runs", EW_RUNG_RUNS, 1, BOUND_TOLERANCE, 0 },
    { "auto", EW_RUNG_AUTO, 1, BOUND_TOLERANCE, 0 },
};
enum { BENCH_METHODS = sizeof bench_methods / sizeof *bench_methods };

/* 1/16 px */
static const uint16_t bench_tolerances[] = { 0, 1, 2, 4, 8, 16, 32 };
enum { BENCH_TOLERANCES = sizeof bench_tolerances / sizeof *bench_tolerances };

/* How the same pictures are drawn in less memory, with rung auto at BENCH_MODE_TOLERANCE: cases behind
 * all others. They clear, too. */
typedef struct bench_mode {
    const char *name;
    uint16_t rows; /* of a band */
    uint8_t visibility;
} bench_mode;

static const bench_mode bench_modes[] = {
    { "at-once", 240, EW_DEPTH_BUFFER }, { "bands-32", 32, EW_DEPTH_BUFFER }, { "bands-16", 16, EW_DEPTH_BUFFER },
    { "bands-8", 8, EW_DEPTH_BUFFER },   { "bands-4", 4, EW_DEPTH_BUFFER },   { "line", 1, EW_DEPTH_BUFFER },
    { "spans", 1, EW_DEPTH_SPANS },
};
enum { BENCH_MODES = sizeof bench_modes / sizeof *bench_modes, BENCH_MODE_TOLERANCE = 4 };
/* Fills that are counted besides, on the rung that is chosen for 1/4 px: every loop of
 * src/raster/loops.c, then some that go through the generic path. */
typedef struct bench_fill {
    const char *name;
    uint8_t textured;
    uint8_t flags, blend, filter; /* of the material                                        */
    uint8_t wrap;                 /* of u and v                                             */
    uint8_t format;               /* of the target, dithered but for RGB565                 */
} bench_fill;

static const bench_fill bench_fills[] = {
    { "flat", 0, 0, 0, 0, 0, 0 },
    { "gouraud", 0, EW_SHADED, 0, 0, 0, 0 },
    { "no-depth", 1, EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE, 0, 0, 0, 0 },
    { "keyed", 1, EW_COLOUR_KEY, 0, 0, 0, 0 },
    { "lit", 1, EW_SHADED, 0, 0, 0, 0 },
    { "bilinear", 1, 0, 0, EW_FILTER_BILINEAR, 0, 0 },
    { "grey4", 1, 0, 0, 0, 0, EW_TARGET_GREY4 },
    { "clamped", 1, 0, 0, 0, EW_WRAP_CLAMP, 0 },
    { "half", 1, 0, EW_BLEND_HALF, 0, 0, 0 },
    { "lit-bilinear", 1, EW_SHADED, 0, EW_FILTER_BILINEAR, 0, 0 },
    { "swapped", 1, 0, 0, 0, 0, EW_TARGET_RGB565_SWAPPED },
};
enum { BENCH_FILLS = sizeof bench_fills / sizeof *bench_fills, BENCH_FILL_TOLERANCE = 4 };

/* What the automatic choice goes by: beside "auto", which is drawn with ew_cost_generic, each of these is
 * drawn at every tolerance. */
typedef struct bench_profile {
    const char *name;
    const ew_cost *cost;
} bench_profile;

static const bench_profile bench_profiles[] = {
    { "auto m0plus", &ew_cost_m0plus },
    { "auto m3", &ew_cost_m3 },
    { "auto host", &ew_cost_host },
};
enum { BENCH_PROFILES = sizeof bench_profiles / sizeof *bench_profiles };

/* Of baked scenes, whose camera is used as it is. */
enum { BENCH_WIDTH = 320, BENCH_HEIGHT = 240, BENCH_TIME_MS = 1000 };

/* One picture to count or to judge: `number` runs over methods and their tolerances. Returns
 * 0 behind the last. */
static inline int bench_case(int number, const bench_method **method, uint16_t *tolerance)
{
    for (int i = 0; i < BENCH_METHODS; i++) {
        int cases = bench_methods[i].takes_tolerance ? BENCH_TOLERANCES : 1;
        if (number < cases) {
            *method = &bench_methods[i];
            *tolerance = bench_methods[i].takes_tolerance ? bench_tolerances[number] : 0;
            return 1;
        }
        number -= cases;
    }
    return 0;
}

#endif
