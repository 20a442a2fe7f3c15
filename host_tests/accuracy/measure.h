/* Draws triangles with the core, built with EW_TRACE = 1, and holds every fragment and the
 * final picture against the referee. One picture at a time: the trace functions have no
 * context. */
#ifndef EW_MEASURE_H
#define EW_MEASURE_H

#include "edgewalk/geometry.h"
#include "../reference/referee.h"

typedef struct measures {
    long fragments;        /* drawn, before the depth test                                     */
    long covered_px;       /* pixels with at least one                                         */
    long wrong_px;         /* fragments missing or extra, against exact coverage of the
                              snapped vertices, counted for each triangle                      */
    long double_hits;      /* of those, pixels hit twice by one source triangle                */
    long hit_again;        /* fragments on pixels that had one: overdraw, 0 for scenes without  */
    long wrong_truth_px;   /* pixels covered by the core or by the unsnapped truth, not by both */
    double vertex_max;     /* farthest vertex from its exact projection, before the snap, in
                              snapped units; the snap adds at most 0.5                          */
    double snapped_max;    /* the same after the snap: the contract says 0.75                   */
    double depth_max, depth_rms; /* |stored + 1/2 - 65536 near/z|, where 1 <= 65536 near/z < 65535 */
    double depth_off;      /* the same against the exact depths over the disc of 1/256 px around the
                              pixel's centre: what is promised for triangles of any steepness   */
    long saturated;        /* fragments left out of depth_*                                    */
    double u_max, u_rms, v_max, v_rms; /* texels, fragments of textured triangles               */
    double uv_off;         /* texels, the larger of u and v: how far outside of the exact values over
                              the disc of the material's tolerance + 1/256 px                   */
    long textured;         /* how many those are                                              */
    double disp_max, disp_rms; /* px: how far from the pixel's centre the drawn u and v belong, of which
                              the farther counts, after removing e = 1/64 texel               */
    long within_e;         /* textured fragments that needed only e: displacement 0           */
    /* What the formulas of docs/error-bound.md make of the textured triangles drawn: the bound
     * of the affine rung in px; that of a run of N pixels over N^2; the longest way from a
     * corner in texels, which a reciprocal's relative error is a part of. */
    double affine_bound, run_bound, reach;
    long rung[EW_RUNG_COUNT]; /* fragments by ew_rung                                         */
    long colour_px;        /* pixels whose colour no fragment may have (see measure_end)       */
} measures;

/* Begins a picture of `target` (already cleared to `background`, depth 0). */
void measure_begin(const ew_target *target, const ref_camera *camera, uint16_t background);

/* Draws one mesh, a triangle at a time, with geometry's raster and transform as they are
 * set. `model_view` takes a vertex (as q1.15) to view space in double. Returns 0, or the
 * first error of ew_draw_triangles. */
int measure_mesh(ew_geometry *geometry, const double model_view[3][4], const ew_mesh *mesh);

/* Draws one triangle by ew_raster_triangle; the camera's place does not matter, as the corners are
 * taken where they are. Returns 0 or its error. */
int measure_triangle(ew_raster *raster, const ew_raster_vertex *const corners[3]);

/* Leaves what is drawn from now on out of what is judged, or (0) no longer. */
void measure_pause(int paused);

/* Pictures of what was judged, width * height each, any of them NULL: the colour that exact
 * coverage, depth, u and v give, and of the fragment that is seen its displacement (px, -1
 * where there is none) and its error in texels (the larger of u and v, likewise). */
typedef struct measure_maps {
    uint16_t *reference;
    float *displacement, *texels;
} measure_maps;
/* Asks the next measure_end to fill them. */
void measure_want_maps(const measure_maps *maps);

/* Ends the picture. A pixel's colour is right when it is that of a fragment within one
 * depth unit of the nearest, at a texel that the exact u and v touch over the disc of the
 * material's tolerance around the pixel's centre, widened by `border` texel. */
void measure_end(measures *result, double border);

/* One line of figures, or their heading. */
void measure_print_heading(void);
void measure_print(const char *name, const measures *m);

#endif
