/* Exact attributes of a triangle around a point of the screen, and how far from it a drawn
 * value is at home.
 *
 * 1/z, u/z and v/z are linear on the screen. So the places where u has some value c lie on
 * the line u/z - c/z = 0, and how far away that is needs one division: no disc is sampled.
 */
#ifndef EW_EXACT_H
#define EW_EXACT_H

#include "edgewalk/raster.h"
#include "referee.h"

/* One linear quantity at a point, and what it grows by per pixel. */
typedef struct exact_form {
    long double at, dx, dy;
} exact_form;

/* 1/z times near (1 at the near plane), and u and v, in texels, times that. */
typedef struct exact_forms {
    exact_form w, u, v;
} exact_forms;

/* A triangle of corners as the raster layer takes them. */
typedef struct exact_corners {
    int64_t x[3], y[3], w[3], u[3], v[3];
} exact_corners;

/* Returns 0 for one of no area. */
int exact_corners_init(exact_corners *t, const ew_raster_vertex v[3]);
/* The forms at the centre of a pixel: sums exact in 128 bits, rounded once to long double. */
exact_forms exact_from_corners(const exact_corners *t, int px, int py);
/* The same from the referee's triangle, in double. */
exact_forms exact_from_truth(const ref_triangle *t, int px, int py);

/* u where `attribute` is f->u. */
double exact_value(const exact_forms *f, const exact_form *attribute);

/* The radius, in px, of the smallest disc around the point whose exact values, widened by e,
 * hold `drawn`; `drawn` is known modulo `period`. HUGE_VAL when none does. */
double exact_radius(const exact_forms *f, const exact_form *attribute, double drawn, double period, double e);

/* The same for a nearest texel: any value of [texel, texel + 1) will do. */
double exact_texel_radius(const exact_forms *f, const exact_form *attribute, int texel, int period, double e);

/* How far, in units, a stored depth (plus 1/2) is outside of the exact depths over a disc of that radius;
 * negative inside. NAN where depth is clamped. */
double exact_depth_off(const exact_forms *f, uint16_t stored, double radius);

#endif
