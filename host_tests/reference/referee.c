#include "referee.h"

#include <math.h>

int ref_triangle_init(ref_triangle *t, const ref_camera *c, const ref_corner corner[3])
{
    /* A point (x, y, z) is seen at (X/z, Y/z) with X = left z + width/2 (z + fx x) and so on.
     * For weights b: sum b_i (X_i, Y_i, z_i) = (px, py, 1), so b = M^-1 (px, py, 1) with the
     * corners as M's columns; sum b_i is then 1/z of the point that is seen there. */
    double m[3][3];
    for (int i = 0; i < 3; i++) {
        t->corner[i] = corner[i];
        m[0][i] = c->left * corner[i].z + c->width / 2 * (corner[i].z + c->fx * corner[i].x);
        m[1][i] = c->top * corner[i].z + c->height / 2 * (corner[i].z - c->fy * corner[i].y);
        m[2][i] = corner[i].z;
    }
    double det = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        /* row i of the inverse times the determinant: the cross product of the other columns */
        t->b[i][0] = m[1][j] * m[2][k] - m[2][j] * m[1][k];
        t->b[i][1] = m[2][j] * m[0][k] - m[0][j] * m[2][k];
        t->b[i][2] = m[0][j] * m[1][k] - m[1][j] * m[0][k];
        if (i == 0) det = m[0][0] * t->b[0][0] + m[1][0] * t->b[0][1] + m[2][0] * t->b[0][2];
    }
    t->near_z = c->near_z;
    /* y points down on the screen, which turns the sign: see docs/conventions.md. */
    t->determinant = -det;
    if (det == 0) return 0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) t->b[i][j] /= det;
    }
    return 1;
}

ref_sample ref_sample_at(const ref_triangle *t, double px, double py)
{
    ref_sample s = { 0, 0, 0, 0 };
    double one_over_z = 0, inside = 1;
    for (int i = 0; i < 3; i++) {
        double b = t->b[i][0] * px + t->b[i][1] * py + t->b[i][2];
        one_over_z += b;
        s.u += b * t->corner[i].u;
        s.v += b * t->corner[i].v;
        if (b < 0) inside = 0;
    }
    s.z = 1 / one_over_z;
    s.u *= s.z;
    s.v *= s.z;
    s.inside = inside && one_over_z > 0 && s.z >= t->near_z;
    return s;
}

double ref_depth(const ref_triangle *t, double px, double py)
{
    return 65536 * t->near_z / ref_sample_at(t, px, py).z;
}

static double screen_distance(const ref_camera *c, double x, double y, double z, double px, double py)
{
    double dx = c->left + c->width / 2 * (1 + c->fx * x / z) - px;
    double dy = c->top + c->height / 2 * (1 - c->fy * y / z) - py;
    return fmax(fabs(dx), fabs(dy));
}

double ref_nearest_corner(const ref_triangle *t, const ref_camera *c, double px, double py)
{
    double best = HUGE_VAL;
    for (int i = 0; i < 3; i++) {
        const ref_corner *a = &t->corner[i], *b = &t->corner[(i + 1) % 3];
        if (a->z >= c->near_z) best = fmin(best, screen_distance(c, a->x, a->y, a->z, px, py));
        if ((a->z < c->near_z) != (b->z < c->near_z)) {
            double f = (c->near_z - a->z) / (b->z - a->z);
            best = fmin(best, screen_distance(c, a->x + f * (b->x - a->x), a->y + f * (b->y - a->y),
                                              c->near_z, px, py));
        }
    }
    return best;
}

int64_t ref_snap(double px, int bits) { return (int64_t)floor(ldexp(px, bits) + 0.5); }

int ref_covers(const int64_t sx[3], const int64_t sy[3], int bits, int x, int y)
{
    int64_t one = (int64_t)1 << bits, px = x * one + one / 2, py = y * one + one / 2;
    int64_t area = (sx[1] - sx[0]) * (sy[2] - sy[0]) - (sx[2] - sx[0]) * (sy[1] - sy[0]);
    if (area == 0) return 0;
    int sign = area > 0 ? 1 : -1;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        /* edge in the direction that has the inside on its right on a y-down screen */
        int64_t dx = sign * (sx[j] - sx[i]), dy = sign * (sy[j] - sy[i]);
        int64_t e = dx * (py - sy[i]) - dy * (px - sx[i]);
        int top = dy == 0 && dx > 0, left = dy < 0;
        if (e < 0 || (e == 0 && !top && !left)) return 0;
    }
    return 1;
}
