/* The referee: what a picture should be, in double precision.
 *
 * Written from docs/conventions.md, slow and simple, sharing nothing with src/. It does not
 * walk edges, step planes or clip polygons: a pixel's truth comes from the ray through its
 * centre, and exact coverage from edge functions in 64-bit integers.
 */
#ifndef EW_REFEREE_H
#define EW_REFEREE_H

#include <stdint.h>

/* A camera that looks down -z: px = left + width/2 (1 + fx x / z), py = top + height/2 (1 - fy y / z),
 * z the distance along the axis. */
typedef struct ref_camera {
    double fx, fy, near_z;
    double left, top, width, height;
} ref_camera;

/* A corner in view space, z as the distance (so minus the view space z), u and v in texels. */
typedef struct ref_corner {
    double x, y, z, u, v;
} ref_corner;

/* A triangle's equations: b_i = row_i . (px, py, 1) are the barycentric weights over z. */
typedef struct ref_triangle {
    ref_corner corner[3];
    double b[3][3];
    double determinant; /* > 0: faces the camera (counter-clockwise to the viewer)              */
    double near_z;
} ref_triangle;

/* Returns 0 for a triangle that is seen edge-on (no equations). */
int ref_triangle_init(ref_triangle *t, const ref_camera *camera, const ref_corner corner[3]);

/* The plane of the triangle at a screen position, inside or outside of it. */
typedef struct ref_sample {
    double z, u, v;
    int inside; /* the position lies in the triangle, at or behind the near plane             */
} ref_sample;
ref_sample ref_sample_at(const ref_triangle *t, double px, double py);

/* 65536 near/z, before floor and clamping. */
double ref_depth(const ref_triangle *t, double px, double py);

/* The least distance, in pixels, from (px, py) to a corner of the triangle after its near
 * clip in double. */
double ref_nearest_corner(const ref_triangle *t, const ref_camera *camera, double px, double py);

/* Coordinates snapped to `bits` fraction bits, as the contract says: floor(2^bits x + 1/2). */
int64_t ref_snap(double px, int bits);

/* Exact coverage of snapped corners (in 2^-bits px, |.| < 2^30) at the centre of pixel
 * (x, y) by the top-left rule, either orientation; zero area covers nothing. */
int ref_covers(const int64_t sx[3], const int64_t sy[3], int bits, int x, int y);

#endif
