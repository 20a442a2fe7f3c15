/* The stability atlas: walks each axis along which methods fail, from safe to broken, and holds every
 * picture against the referee. One CSV line for each axis, method and step:
 *
 *   axis,method,x,err_px,err_lsb,wrong_px,predicted_limit,state
 *
 * err_px is the worst displacement, err_lsb the worst depth error, wrong_px fragments missing, extra
 * or hit twice. predicted_limit is where the method's formula says that it stops being ok, na where
 * none does. state: refused (an error code), degraded (a coverage, depth or displacement beyond the
 * promise, or beyond 1/4 px for the affine method and fixed runs; on the axes of texture range, u or v off by
 * more than e = 1/64 texel for methods that take no tolerance), ok.
 *
 * `--only recip` walks only the axis that depends on the size of the reciprocal table, `--only maps` prints the
 * cells of the heat maps instead, `--only recip-map` those of the map that depends on the table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "walk.h"

enum { W = 320, H = 48 };

/* A quad over columns x0 to x1 with near/z = w0 on the left and w1 on the right. */
static void wall(canvas *c, double x0, double x1, double y0, double y1, double w0, double w1, double u)
{
    const ew_raster_vertex v[4] = { walk_at(x0, y0, w0, 0, 0), walk_at(x0, y1, w0, 0, u), walk_at(x1, y1, w1, u, u), walk_at(x1, y0, w1, u, 0) };
    walk_quad(c, v);
}

/* ---- axes ---- */

/* Farthest over nearest z along 240 pixels, less one. A run of N pixels is off by
 * N |sqrt(r) - 1| / (sqrt(r) + 1); to first order, at the far end, by N^2 x / (4 240). */
static void depth_ratio(const pen *p)
{
    const double n = 240, t = 0.25;
    const double run = p->method->run;
    const double limit = p->method->bound == BOUND_AFFINE ? pow((n + t) / (n - t), 2) - 1
                         : p->method->bound == BOUND_RUN  ? 4 * n * t / (run * run)
                                                          : walk_no_limit;
    for (double x = 1e-4; x < 2e6; x *= 1.333521432163324) { /* 8 steps to a decade */
        canvas c;
        walk_begin(&c, p, W, H, 256, 256);
        wall(&c, 40, 40 + n, 4, 44, 1, 1 / (1 + x), 200);
        measures m = walk_end(&c);
        walk_report("depth_ratio_less_1", p, x, &c, &m, 0, limit);
    }
}

/* Pixels of the wall, if all of them have the same depth. */
static long untold_depths(const canvas *c, int x0, int x1, int y0, int y1)
{
    const uint16_t *first = c->target.depth + (size_t)y0 * c->target.stride + (size_t)x0;
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            if (c->target.depth[(size_t)y * c->target.stride + (size_t)x] != *first) return 0;
        }
    }
    return (long)(x1 - x0) * (y1 - y0);
}

/* near/z of a wall on the left, twice as far away on the right. Half of it in depth units tells both sides apart:
 * down to 2^-15 that is one unit; below, the wall's pixels count as wrong. Displacement stays as promised. */
static void far_horizon(const pen *p)
{
    const double end = ldexp(1, -15), step = pow(2, 0.25);
    for (double w = 1; w >= ldexp(1, -30); w /= w < 16.1 * end && w > end / 15.9 ? step : 2) {
        canvas c;
        walk_begin(&c, p, W, H, 256, 256);
        wall(&c, 40, 280, 4, 44, w, w / 2, 200);
        const long untold = untold_depths(&c, 40, 280, 4, 44);
        measures m = walk_end(&c);
        walk_report("far_horizon_near_over_z", p, w, &c, &m, untold, walk_careless(p) ? walk_no_limit : end);
    }
}

/* Thickness in pixels of slivers from side to side, or from top to bottom, 100 at random places; the rest of the slant
 * is chance. */
static void slivers(const pen *p, int upright)
{
    srand48(1);
    for (double thick = 8; thick > 0.0005; thick /= 2) {
        canvas c;
        walk_begin(&c, p, upright ? H : W, upright ? W : H, 256, 256);
        for (int i = 0; i < 100; i++) {
            const double at = 4 + drand48() * (H - 16), slant = (drand48() - 0.5) * 8, w = 0.05 + 0.9 * drand48();
            const double corner[3][2] = { { drand48(), at }, { 319 + drand48(), at + slant }, { 160 * drand48(), at + thick } };
            ew_raster_vertex v[3];
            for (int k = 0; k < 3; k++) {
                v[k] = walk_at(corner[k][upright], corner[k][!upright], k == 1 ? 0.9 * w : w, k == 1 ? 250 : 0, k == 2 ? 100 : 0);
            }
            walk_triangle(&c, &v[0], &v[1], &v[2]);
        }
        measures m = walk_end(&c);
        walk_report(upright ? "sliver_width_px" : "sliver_height_px", p, thick, &c, &m, 0, walk_no_limit);
    }
}

/* Side in pixels of the cells of a net of triangles: each pixel of the union exactly once. */
static void tiny_triangles(const pen *p)
{
    for (double side = 16; side >= 0.25; side /= 2) {
        const double x0 = 10.37, y0 = 8.61, across = 96;
        int cells = (int)(across / side);
        canvas c;
        walk_begin(&c, p, 128, 120, 256, 256);
        for (int j = 0; j < cells; j++) {
            for (int i = 0; i < cells; i++) {
                ew_raster_vertex v[4];
                for (int k = 0; k < 4; k++) {
                    double gx = i + (k == 2 || k == 3), gy = j + (k == 1 || k == 2);
                    v[k] = walk_at(x0 + gx * side, y0 + gy * side, 0.5 - gx * side / 1000, gx * side * 2, gy * side * 2);
                }
                walk_quad(&c, v);
            }
        }
        measures m = walk_end(&c);
        walk_report("tiny_triangle_side_px", p, side, &c, &m, m.hit_again, walk_no_limit);
    }
}

/* Pixels of a span, 1/z falling to 60 % over it. */
static void long_spans(const pen *p)
{
    for (int n = 1; n <= 4096; n += n < 4 ? 1 : n / 2) {
        const double limit = p->method->bound == BOUND_AFFINE ? 0.25 * (sqrt(1 / 0.6) + 1) / (sqrt(1 / 0.6) - 1) : walk_no_limit;
        canvas c;
        walk_begin(&c, p, n, 1, 256, 256);
        wall(&c, 0, n, 0, 1, 0.9, 0.54, n * 0.4);
        measures m = walk_end(&c);
        walk_report("span_px", p, n, &c, &m, 0, limit);
    }
}

/* Texels from side to side. Above 32,768 between corners there is no format: refused. */
static void uv_range(const pen *p)
{
    for (double u = 16; u <= 1 << 17; u *= 1.189207115002721) {
        double limit = p->method->bound == BOUND_TABLE ? walk_e * exp2(walk_promised[EW_RECIP_BITS - 4]) : 32768;
        canvas c;
        walk_begin(&c, p, W, H, 256, 256);
        wall(&c, 40, 280, 4, 44, 0.9, 0.45, u);
        measures m = walk_end(&c);
        walk_report("uv_range_texels", p, u, &c, &m, 0, walk_careless(p) ? walk_no_limit : limit);
    }
}

/* The same for every size of the table, as one axis each: the pairs of a map. */
static void recip_bits(const pen *p)
{
    char axis[40];
    snprintf(axis, sizeof axis, "uv_range_at_%d_bits", EW_RECIP_BITS);
    for (double u = 4; u <= 1 << 15; u *= 1.4142135623730951) {
        double limit = p->method->bound == BOUND_TABLE ? walk_e * exp2(walk_promised[EW_RECIP_BITS - 4]) : walk_no_limit;
        canvas c;
        walk_begin(&c, p, W, H, 256, 256);
        wall(&c, 40, 280, 4, 44, 0.9, 0.45, u);
        measures m = walk_end(&c);
        walk_report(axis, p, u, &c, &m, 0, limit);
    }
}

/* Width in pixels of a triangle that stands over the screen: 2^17 is the guard band. */
static void guard_band(const pen *p)
{
    for (double half = 256; half <= 1 << 19; half *= 1.189207115002721) {
        canvas c;
        walk_begin(&c, p, W, H, 256, 256);
        const ew_raster_vertex a = walk_at(160 - half, -30, 0.5, -half / 300, 0), b = walk_at(160 + half, -30, 0.4, half / 300, 0);
        const ew_raster_vertex d = walk_at(160, half, 0.5, 0, half / 300);
        walk_triangle(&c, &a, &b, &d);
        measures m = walk_end(&c);
        walk_report("guard_half_width_px", p, half, &c, &m, 0, p->method->bound == BOUND_AFFINE ? walk_no_limit : (double)EW_GUARD_PX);
    }
}

/* Steps of 1 depth unit between two walls, the nearer drawn second, at 64 distances. */
static void depth_separation(const pen *p)
{
    static const double distances[] = { 4, 32, 256, 2048 };
    for (int k = 0; k < 4; k++) {
        char axis[48];
        snprintf(axis, sizeof axis, "depth16_steps_apart_at_%g_near", distances[k]);
        for (double steps = 0.0625; steps <= 16; steps *= 1.4142135623730951) {
            long lost = 0, drawn = 0;
            measures m;
            canvas c;
            memset(&m, 0, sizeof m);
            for (int i = 0; i < 64 && drawn < 1 << 20; i++) {
                double w = (1 + i / 64.0) / distances[k];
                walk_begin(&c, p, 64, 4, 256, 256);
                const ew_raster_vertex v[4] = { walk_at(0, 0, w, 0, 0), walk_at(0, 4, w, 0, 0), walk_at(64, 4, w * 0.97, 0, 0), walk_at(64, 0, w * 0.97, 0, 0) };
                walk_quad(&c, v);
                ew_raster_vertex n[4];
                for (int j = 0; j < 4; j++) n[j] = v[j], n[j].w += (uint32_t)llrint(steps * 32768);
                uint16_t *before = malloc(64 * 4 * 2);
                if (!before) abort();
                for (int y = 0; y < 4; y++) memcpy(before + 64 * y, c.target.depth + (size_t)y * c.target.stride, 128);
                walk_quad(&c, n);
                for (int y = 0; y < 4; y++) {
                    for (int x = 0; x < 64; x++) lost += c.target.depth[(size_t)y * c.target.stride + (size_t)x] == before[64 * y + x];
                }
                drawn += 256;
                free(before);
                measures one = walk_end(&c);
                m.depth_max = fmax(m.depth_max, one.depth_max);
            }
            walk_row(axis, p->method->name, steps, 0, m.depth_max, lost, 1, lost ? "degraded" : "ok");
        }
    }
}

/* ---- the near plane: through the geometry layer ---- */

/* z of the two near corners of a floor, in 1/1000 of the near distance: on it, before it, at the eye
 * and behind. Nothing to predict: clipped exactly everywhere. */
static void near_plane(const pen *p)
{
    static const int thousandths[] = { 4000, 2000, 1001, 1000, 999, 500, 100, 1, 0, -1, -500, -1000, -4000, -16000 };
    for (size_t k = 0; k < sizeof thousandths / sizeof *thousandths; k++) {
        canvas c;
        walk_begin(&c, p, W, H, 256, 256);
        /* 1 unit of a vertex is 1/1000 near */
        const ew_vertex16 v[4] = { { -9000, -900, (int16_t)-thousandths[k], 0, 0 }, { 9000, -1100, (int16_t)-thousandths[k], 3200, 0 },
                                   { 9000, -1000, -32000, 3200, 3200 }, { -9000, -1000, -32000, 0, 3200 } };
        walk_floor(&c, v, 32.768, 0);
        measures m = walk_end(&c);
        walk_report("near_plane_z_over_near", p, thousandths[k] / 1000.0, &c, &m, 0, walk_no_limit);
    }
}

static void all_axes(const pen *p)
{
    depth_ratio(p);
    far_horizon(p);
    slivers(p, 0);
    slivers(p, 1);
    tiny_triangles(p);
    long_spans(p);
    uv_range(p);
    guard_band(p);
    near_plane(p);
    more_axes_of(p);
    if (p->method->rung == EW_RUNG_EXACT) depth_separation(p); /* depth does not depend on the rung */
}

int main(int argc, char **argv)
{
    const char *what = argc == 3 && strcmp(argv[1], "--only") == 0 ? argv[2] : "";
    const int only_recip = strcmp(what, "recip") == 0, recip_map = strcmp(what, "recip-map") == 0, all_maps = strcmp(what, "maps") == 0;
    if (argc != 1 && !only_recip && !recip_map && !all_maps) {
        fprintf(stderr, "usage: stability [--only recip|recip-map|maps]\n");
        return 2;
    }
    if (recip_map || all_maps) {
        maps(recip_map);
        return 0;
    }
    if (!only_recip) {
        printf("axis,method,x,err_px,err_lsb,wrong_px,predicted_limit,state\n");
        memory_axes();
        link_axes();
        more_axes();
    }
    for (int i = 0; i < BENCH_METHODS; i++) {
        const pen p = { &bench_methods[i], bench_methods[i].takes_tolerance ? 4 : 0 };
        if (!only_recip) all_axes(&p);
        recip_bits(&p);
    }
    return 0;
}
