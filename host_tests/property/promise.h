/* What is promised of each way to draw (docs/error-bound.md), and how much of it one fragment uses.
 *
 * Built with EW_TRACE = 1; one triangle at a time, as the trace functions have no context. */
#ifndef EW_TEST_PROMISE_H
#define EW_TEST_PROMISE_H

#include "edgewalk/raster.h"
#include "../reference/exact.h"

#define PROMISE_E (1.0 / 64)     /* texel: what is beside the disc                             */
#define PROMISE_SNAP (1.0 / 256) /* px: the disc's share of the snap                           */
#define PROMISE_BEYOND (1.0 / 256) /* texel: what the last bits are worth where the promise ends */

typedef struct promise_way {
    const char *name;
    ew_rung rung;
    uint16_t tolerance; /* 1/16 px                                                             */
    uint16_t run;       /* px, of a fixed run; 0: no fixed run                                  */
    double reach;       /* texels between corners up to which it promises something             */
} promise_way;

enum { PROMISE_WAYS = 15 };
extern const promise_way promise_ways[PROMISE_WAYS];

enum { PROMISE_PIXELS = 4096 * 4, PROMISE_TEXTURE_MOST = 2048 };

/* The context that is drawn with. */
extern ew_raster promise_raster;

/* Begins a cleared picture of at most PROMISE_PIXELS, drawn with a texture of that size. */
void promise_picture(uint16_t width, uint16_t height, uint16_t texture_width, uint16_t texture_height);

/* Sets the way's material, for the automatic choice one of the four cost profiles, and forgets what was drawn. */
void promise_use(const promise_way *way, long profile);

typedef struct promise_fragment {
    uint16_t x, y, depth;
    ew_q20_12 u, v;
} promise_fragment;
/* What was drawn since, and the rung of the last triangle. */
extern promise_fragment promise_drawn[2 * PROMISE_PIXELS]; /* clipped triangles may in theory overlap */
extern int promise_count, promise_rung;

/* What the limits are made of. */
typedef struct promise_triangle {
    double reach;  /* texels between its corners, the most                                      */
    double w_most; /* the largest near/z of its corners                                         */
    double affine; /* px by which the affine rung may be off                                    */
} promise_triangle;
promise_triangle promise_of(const ew_raster_vertex v[3]);

/* Whether u and v are promised where 1/z is that of `at`: "where it stops holding". */
int promise_given(const promise_triangle *t, const exact_forms *at);

/* px: the radius of the disc that u and v must be found in; HUGE_VAL where the way promises none. */
double promise_limit(const promise_way *way, const promise_triangle *t, const exact_forms *at);

/* How much of the promise u (`attribute` is &at->u) or v uses: from -1, exact, to 0, at the rim of the disc;
 * from there on the part of e that is needed besides. Above 1 it is broken. */
double promise_used(const exact_forms *at, const exact_form *attribute, ew_q20_12 drawn, int period, double limit);

#endif
