#include "exact.h"

#include <math.h>

__extension__ typedef __int128 int128;

enum { PX = 4096 }; /* q20.12 */

int exact_corners_init(exact_corners *t, const ew_raster_vertex v[3])
{
    int64_t area = (int64_t)(v[1].x - v[0].x) * (v[2].y - v[0].y) - (int64_t)(v[2].x - v[0].x) * (v[1].y - v[0].y);
    for (int i = 0; i < 3; i++) {
        const ew_raster_vertex *c = &v[area < 0 && i ? 3 - i : i]; /* weights positive inside */
        t->x[i] = c->x, t->y[i] = c->y, t->w[i] = c->w, t->u[i] = c->u, t->v[i] = c->v;
    }
    return area != 0;
}

/* The weights' sum over the corners' values, and its steps: |b| <= 2^61, |value| <= 2^61, so
 * the sums stay below 2^124. */
static exact_form form(const int64_t b[3], const int64_t bx[3], const int64_t by[3], const int128 value[3], long double unit)
{
    int128 at = 0, dx = 0, dy = 0;
    for (int i = 0; i < 3; i++) {
        at += b[i] * value[i];
        dx += bx[i] * value[i];
        dy += by[i] * value[i];
    }
    exact_form f = { (long double)at * unit, (long double)dx * (unit * PX), (long double)dy * (unit * PX) };
    return f;
}

exact_forms exact_from_corners(const exact_corners *t, int px, int py)
{
    int64_t cx = (int64_t)px * PX + PX / 2, cy = (int64_t)py * PX + PX / 2, b[3], bx[3], by[3], area = 0;
    int128 w[3], u[3], v[3];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        b[i] = (t->x[j] - cx) * (t->y[k] - cy) - (t->x[k] - cx) * (t->y[j] - cy);
        bx[i] = t->y[j] - t->y[k];
        by[i] = t->x[k] - t->x[j];
        area += b[i];
        w[i] = t->w[i];
        u[i] = (int128)t->w[i] * t->u[i];
        v[i] = (int128)t->w[i] * t->v[i];
    }
    long double unit = ldexpl(1, -31) / (long double)area;
    exact_forms f = { form(b, bx, by, w, unit), form(b, bx, by, u, unit / PX), form(b, bx, by, v, unit / PX) };
    return f;
}

exact_forms exact_from_truth(const ref_triangle *t, int px, int py)
{
    exact_forms f = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
    exact_form *const forms[3] = { &f.w, &f.u, &f.v };
    for (int i = 0; i < 3; i++) {
        const double value[3] = { 1, t->corner[i].u, t->corner[i].v };
        for (int k = 0; k < 3; k++) {
            long double scale = (long double)t->near_z * value[k];
            forms[k]->dx += scale * t->b[i][0];
            forms[k]->dy += scale * t->b[i][1];
            forms[k]->at += scale * (t->b[i][0] * (px + 0.5L) + t->b[i][1] * (py + 0.5L) + t->b[i][2]);
        }
    }
    return f;
}

double exact_value(const exact_forms *f, const exact_form *attribute) { return (double)(attribute->at / f->w.at); }

/* How far the line is on which the attribute is c. Only its half before the horizon, where
 * 1/z is above 0, is seen: when the foot lies behind, that half's end is the nearest. */
static double distance_to(const exact_forms *f, const exact_form *a, long double c)
{
    long double at = a->at - c * f->w.at, dx = a->dx - c * f->w.dx, dy = a->dy - c * f->w.dy, square = dx * dx + dy * dy;
    if (square == 0) return HUGE_VAL;
    if (f->w.at - at * (dx * f->w.dx + dy * f->w.dy) / square > 0) return (double)(fabsl(at) / sqrtl(square));
    long double cross = dx * f->w.dy - dy * f->w.dx;
    return (double)(hypotl(f->w.at * dy - at * f->w.dy, at * f->w.dx - f->w.at * dx) / fabsl(cross));
}

/* The nearest place of a value from low to high, either of which may be the same and both of
 * which are known modulo the period: the next ones above and below count, since u may grow
 * faster on one side than on the other. */
static double nearest_of(const exact_forms *f, const exact_form *a, long double low, long double high, double period)
{
    long double here = a->at / f->w.at, down = floorl((low - here) / period) * period;
    low -= down, high -= down; /* low: the first at or above here */
    if (low - here <= 0 || high - period >= here) return 0;
    return fmin(distance_to(f, a, low), distance_to(f, a, high - period));
}

double exact_radius(const exact_forms *f, const exact_form *attribute, double drawn, double period, double e)
{
    return nearest_of(f, attribute, drawn - (long double)e, drawn + (long double)e, period);
}

double exact_texel_radius(const exact_forms *f, const exact_form *attribute, int texel, int period, double e)
{
    return nearest_of(f, attribute, texel - (long double)e, texel + 1.0L + e, period);
}

double exact_depth_off(const exact_forms *f, uint16_t stored, double radius)
{
    double depth = (double)(65536 * f->w.at), rise = (double)(65536 * hypotl(f->w.dx, f->w.dy)) * radius;
    if (depth < 1 || depth >= 65535) return NAN;
    return fabs(stored + 0.5 - depth) - rise;
}
