/* What transform and clip share (private to the geometry layer). */
#ifndef EW_GEOMETRY_PROJECT_H
#define EW_GEOMETRY_PROJECT_H

#include "edgewalk/geometry.h"

/* Sums of a transform's rows, each in units of 2^(e - 45) of its own row: |.| <= 2^47. */
typedef struct ew_homogeneous_vertex {
    int64_t x, y, w;
} ew_homogeneous_vertex;

void ew_homogeneous(ew_homogeneous_vertex *out, const ew_transform *transform, const ew_vertex16 *v);

/* Divides by w. x is in units 2^e_x times those of w, y in 2^e_y times; near_w in those of
 * w, 2^16 <= near_w. |x|, |y|, |w| < 2^63. A vertex nearer than near_w gets EW_OUT_NEAR and
 * no position; one outside the guard band gets EW_OUT_GUARD. */
void ew_project(ew_screen_vertex *out, const ew_transform *transform, const ew_homogeneous_vertex *h,
                int32_t e_x, int32_t e_y, int64_t near_w);

#endif
