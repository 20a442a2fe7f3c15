/* Axes of the stability atlas: what meets at edges, positions and sizes, minification, and the numbers before
 * the raster layer (rotations, chains of matrices). err_px is what the axis' comment says. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../host_tests/reference/exact.h"
#include "rotations.h"
#include "walk.h"

/* ---- of each method ---- */

/* Pixels of a column, 1/z falling to 60 % on the way down. */
static void tall_triangles(const pen *p)
{
    const double limit = p->method->bound == BOUND_AFFINE ? 0.25 * (sqrt(1 / 0.6) + 1) / (sqrt(1 / 0.6) - 1) : walk_no_limit;
    for (int n = 1; n <= 4096; n += n < 4 ? 1 : n / 2) {
        canvas c;
        walk_begin(&c, p, 1, n, 256, 256);
        const double u = n * 0.4;
        const ew_raster_vertex v[4] = { walk_at(0, 0, 0.9, 0, 0), walk_at(0, n, 0.54, 0, u), walk_at(1, n, 0.54, u, u), walk_at(1, 0, 0.9, u, 0) };
        walk_quad(&c, v);
        measures m = walk_end(&c);
        walk_report("column_px", p, n, &c, &m, 0, limit);
    }
}

/* Spokes of a fan around a point: each pixel of the union exactly once. */
static void fans(const pen *p)
{
    for (int spokes = 4; spokes <= 2048; spokes *= 2) {
        const double turn = 2 * acos(-1.0) / spokes;
        const ew_raster_vertex centre = walk_at(60.3, 58.7, 0.5, 100, 100);
        canvas c;
        walk_begin(&c, p, 128, 120, 256, 256);
        for (int i = 0; i < spokes; i++) {
            const double a = i * turn, b = (i + 1) % spokes * turn;
            const ew_raster_vertex from = walk_at(60.3 + 50 * cos(a), 58.7 + 50 * sin(a), 0.5 + 0.05 * cos(a), 100 + 90 * cos(a), 100 + 90 * sin(a));
            const ew_raster_vertex to = walk_at(60.3 + 50 * cos(b), 58.7 + 50 * sin(b), 0.5 + 0.05 * cos(b), 100 + 90 * cos(b), 100 + 90 * sin(b));
            walk_triangle(&c, &centre, &from, &to);
        }
        measures m = walk_end(&c);
        walk_report("fan_spokes", p, spokes, &c, &m, m.hit_again, walk_no_limit);
    }
}

/* How far from 0 u and v are, in texels: ew_raster_triangle refuses 2^18. */
static void uv_offset(const pen *p)
{
    for (double offset = 32768; offset < 1 << 19; offset *= sqrt(2)) {
        canvas c;
        walk_begin(&c, p, 320, 48, 256, 256);
        const double u = -offset, v = offset - 200;
        const ew_raster_vertex q[4] = { walk_at(40, 4, 0.9, u, v), walk_at(40, 44, 0.9, u, v + 200), walk_at(280, 44, 0.899, u + 200, v + 200),
                                        walk_at(280, 4, 0.899, u + 200, v) };
        walk_quad(&c, q);
        measures m = walk_end(&c);
        walk_report("uv_offset_texels", p, offset, &c, &m, 0, ldexp(1, 18));
    }
}

/* Texels along the side of a texture, powers of two and sizes between them. */
static void texture_sides(const pen *p)
{
    static const int sides[] = { 1, 2, 3, 5, 8, 17, 64, 100, 255, 256, 257, 640, 1000, 1024, 2047, 2048 };
    for (size_t k = 0; k < sizeof sides / sizeof *sides; k++) {
        canvas c;
        walk_begin(&c, p, 320, 48, sides[k], sides[(k + 3) % (sizeof sides / sizeof *sides)]);
        const ew_raster_vertex q[4] = { walk_at(40, 4, 0.9, -150, 0), walk_at(40, 44, 0.9, -150, 200), walk_at(280, 44, 0.899, 50, 200),
                                        walk_at(280, 4, 0.899, 50, 0) };
        walk_quad(&c, q);
        measures m = walk_end(&c);
        walk_report("texture_side_texels", p, sides[k], &c, &m, 0, walk_no_limit);
    }
}

/* ---- once: coverage and depth do not depend on the method ---- */

static const pen plain = { &bench_methods[5], 0 };

static const ew_material hits_material = { .colour = 1, .flags = EW_DOUBLE_SIDED | EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE,
                                           .blend = EW_BLEND_ADD };

/* Draws without being measured. */
static void hit(ew_raster *raster, const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c)
{
    measure_pause(1);
    if (ew_raster_triangle(raster, a, b, c) < 0) abort();
    measure_pause(0);
}

/* Length of an edge on whose middle another triangle's corner lies, of random directions: corners are snapped,
 * so the two sides part by a sliver. A sliver of length L and d wide covers L d / 2 pixel centres on the average;
 * d is the middle corner's snap less half the snaps of both ends, each uniform within 1/512 px both ways: 0.564
 * of that on the average. ok: no more than 1 crack (a hole, or a pixel hit twice) in 100 junctions. */
static void t_junctions(void)
{
    enum { SIDE = 160, JUNCTIONS = 4000 };
    static uint16_t pixels[SIDE * SIDE];
    const ew_target target = { .colour = pixels, .width = SIDE, .height = SIDE, .stride = SIDE };
    const double limit = 0.01 / (0.564 / 512 / 2);
    srand48(2);
    for (double length = 2; length < 140; length *= 1.5) {
        long cracks = 0;
        for (int i = 0; i < JUNCTIONS; i++) {
            ew_raster raster;
            const double angle = 2 * acos(-1.0) * drand48(), x = SIDE / 2 + drand48(), y = SIDE / 2 + drand48();
            const double dx = length / 2 * cos(angle), dy = length / 2 * sin(angle);
            const ew_raster_vertex a = walk_at(x - dx, y - dy, 0.5, 0, 0), b = walk_at(x + dx, y + dy, 0.5, 0, 0), t = walk_at(x, y, 0.5, 0, 0);
            const ew_raster_vertex near = walk_at(x - 3 * sin(angle), y + 3 * cos(angle), 0.5, 0, 0);
            const ew_raster_vertex far = walk_at(x + 3 * sin(angle), y - 3 * cos(angle), 0.5, 0, 0);
            ew_raster_init(&raster, &target);
            const double left = x - fabs(dx) - 4, top = y - fabs(dy) - 4;
            const ew_rect box = { (uint16_t)fmax(0, left), (uint16_t)fmax(0, top), (uint16_t)fmin(SIDE, 2 * x - left + 1), (uint16_t)fmin(SIDE, 2 * y - top + 1) };
            ew_raster_set_scissor(&raster, &box);
            ew_raster_clear(&raster, 0);
            ew_raster_set_material(&raster, &hits_material);
            hit(&raster, &a, &b, &near);
            hit(&raster, &a, &t, &far);
            hit(&raster, &t, &b, &far);
            /* the same watertight: what is covered once there is right */
            static uint16_t whole[SIDE * SIDE];
            ew_raster other = raster;
            other.target.colour = whole;
            ew_raster_clear(&other, 0);
            hit(&other, &a, &t, &near);
            hit(&other, &t, &b, &near);
            hit(&other, &a, &t, &far);
            hit(&other, &t, &b, &far);
            for (int j = box.y0; j < box.y1; j++) {
                for (int k = box.x0; k < box.x1; k++) cracks += pixels[j * SIDE + k] != whole[j * SIDE + k];
            }
        }
        walk_row("t_junction_edge_px", "any", length, 0, 0, cracks, limit, cracks > JUNCTIONS / 100 ? "degraded" : "ok");
    }
}

/* Pixels across and down of a picture that is drawn whole, and in bands of 7 rows: the same, pixel for pixel. */
static void resolutions(void)
{
    static const int sides[] = { 1, 2, 3, 5, 7, 8, 15, 31, 33, 64, 100, 127, 255, 320, 511, 1024 };
    static const pen a_quarter = { &bench_methods[BENCH_METHODS - 1], 4 };
    for (size_t k = 0; k < sizeof sides / sizeof *sides; k++) {
        enum { ROWS = 7 };
        const int n = sides[k];
        long differing = 0;
        canvas c;
        const ew_raster_vertex v[3] = { walk_at(-0.3 * n, 0.1 * n, 0.9, 0, 0), walk_at(0.2 * n, 1.4 * n, 0.3, 0, 250), walk_at(1.1 * n, 0.05 * n, 0.5, 250, 0) };
        walk_begin(&c, &a_quarter, n, n, 256, 256);
        walk_triangle(&c, &v[0], &v[1], &v[2]);
        uint16_t *band = malloc((size_t)n * ROWS * 4);
        if (!band) abort();
        for (int y = 0; y < n; y += ROWS) {
            const int rows = n - y < ROWS ? n - y : ROWS;
            const ew_target target = { .colour = band, .depth = band + n * ROWS, .width = (uint16_t)n, .height = (uint16_t)rows,
                                       .stride = (uint16_t)n, .first_row = (uint16_t)y };
            ew_raster raster;
            ew_material material = c.raster.material;
            material.texture = &c.raster.texture;
            ew_raster_init(&raster, &target);
            ew_raster_clear(&raster, 0);
            ew_raster_set_material(&raster, &material);
            hit(&raster, &v[0], &v[1], &v[2]);
            for (int j = 0; j < rows; j++) {
                const size_t at = (size_t)(y + j) * c.target.stride;
                differing += memcmp(band + j * n, (const uint16_t *)c.target.colour + at, 2u * (unsigned)n) != 0;
                differing += memcmp(target.depth + j * n, c.target.depth + at, 2u * (unsigned)n) != 0;
            }
        }
        free(band);
        measures m = walk_end(&c);
        walk_report("picture_side_px", &a_quarter, n, &c, &m, differing, walk_no_limit);
    }
}

/* Depth units per pixel of a triangle that is drawn twice, the second time from its other corners: the first
 * drawn wins, and wrong_px are the pixels of the second. err_lsb is how far its depth is from the first. */
static void coplanar(void)
{
    for (double slope = 1.0 / 64; slope <= 256; slope *= 2) {
        canvas c;
        long taken = 0;
        const double rise = slope * 100 / 65536;
        const ew_raster_vertex v[3] = { walk_at(4.2, 3.7, 0.01, 0, 0), walk_at(20.4, 44.1, 0.01 + rise / 3, 0, 0), walk_at(104.2, 9.6, 0.01 + rise, 0, 0) };
        walk_begin(&c, &plain, 128, 48, 256, 256);
        walk_triangle(&c, &v[0], &v[1], &v[2]);
        const size_t bytes = 2u * c.target.stride * 48u;
        uint16_t *first = malloc(bytes);
        if (!first) abort();
        memcpy(first, c.target.depth, bytes);
        hit(&c.raster, &v[1], &v[2], &v[0]);
        double most = 0;
        for (size_t i = 0; i < bytes / 2; i++) {
            if (i % c.target.stride >= 128) continue;
            taken += c.target.depth[i] != first[i];
            most = fmax(most, c.target.depth[i] - first[i]);
        }
        free(first);
        walk_end(&c);
        walk_row("coplanar_units_per_px", "any", slope, 0, most, taken, walk_no_limit, taken ? "degraded" : "ok");
    }
}

/* Depth units per pixel at which two walls cross: wrong_px are those where the farther one is seen, though it is
 * more than the 2 units behind that both depths may be off together. */
static void interpenetrating(void)
{
    for (double slope = 1.0 / 64; slope <= 256; slope *= 2) {
        enum { SIDE = 96 };
        canvas c;
        long wrong = 0;
        const double rise = slope * SIDE / 65536, middle = 0.5;
        const ew_raster_vertex a[3] = { walk_at(0, 0, middle, 0, 0), walk_at(0, 2 * SIDE, middle, 0, 0), walk_at(2 * SIDE, 0, middle, 0, 0) };
        const ew_raster_vertex b[3] = { walk_at(0, 0, middle - rise / 2, 0, 0), walk_at(0, 2 * SIDE, middle - rise / 2, 0, 0),
                                        walk_at(2 * SIDE, 0, middle + rise * 1.5, 0, 0) };
        walk_begin(&c, &plain, SIDE, SIDE, 256, 256);
        exact_corners ea, eb;
        exact_corners_init(&ea, a), exact_corners_init(&eb, b);
        for (int order = 0; order < 2; order++) {
            ew_material material = { .colour = 1, .flags = EW_DOUBLE_SIDED };
            ew_raster_clear(&c.raster, 0);
            for (int i = 0; i < 2; i++) {
                const ew_raster_vertex *v = i == order ? a : b;
                material.colour = i == order ? 1 : 2;
                ew_raster_set_material(&c.raster, &material);
                hit(&c.raster, &v[0], &v[1], &v[2]);
            }
            for (int y = 0; y < SIDE; y++) {
                for (int x = 0; x < SIDE; x++) {
                    const double apart = 65536 * (double)(exact_from_corners(&ea, x, y).w.at - exact_from_corners(&eb, x, y).w.at);
                    const uint16_t seen = ((const uint16_t *)c.target.colour)[y * c.target.stride + x];
                    wrong += fabs(apart) > 2 && seen != (apart > 0 ? 1 : 2);
                }
            }
        }
        walk_end(&c);
        walk_row("crossing_units_per_px", "any", slope, 0, 0, wrong, walk_no_limit, wrong ? "degraded" : "ok");
    }
}

/* Half the size of a floor over the near distance, the eye in its middle. EW_ERR_RANGE comes when the model is about
 * 2^30 times the near distance; before that positions lose their last bits, as ew_transform_vertices states. */
static void huge_floors(void)
{
    for (int k = 2; k <= 40; k++) {
        static const ew_vertex16 v[4] = { { -32000, 0, 32000, 0, 0 }, { 32000, 0, 32000, 3200, 0 }, { 32000, 0, -32000, 3200, 3200 }, { -32000, 0, -32000, 0, 3200 } };
        canvas c;
        walk_begin(&c, &plain, 320, 48, 256, 256);
        walk_floor(&c, v, ldexp(1, k) / 32000 * 32768, -1.5);
        measures m = walk_end(&c);
        walk_report("floor_half_size_over_near", &plain, ldexp(1, k), &c, &m, 0, walk_no_limit);
    }
}

/* ---- minification ---- */

enum { LEVELS = 9, LEVEL_GREEN = 7 };

/* Every level of 256 x 256 to 1 x 1 in a green of its own: a pixel's colour tells its level. */
static const ew_texture *level_texture(void)
{
    static uint16_t texels[256 * 256 * 2];
    static ew_texture texture = { .texels = texels, .width = 256, .height = 256, .levels = LEVELS };
    size_t at = 0;
    for (int level = 0; level < LEVELS; level++) {
        for (int i = 256 >> level; i > 0; i--) {
            for (int k = 256 >> level; k > 0; k--) texels[at++] = (uint16_t)(level * LEVEL_GREEN << 5);
        }
    }
    return &texture;
}

/* log2 of the texels that a pixel is long or high, in the direction where it is more. */
static double exact_level(const exact_forms *f)
{
    const double w = (double)f->w.at, u = (double)f->u.at / w, v = (double)f->v.at / w;
    const double across = hypot((double)f->u.dx - u * (double)f->w.dx, (double)f->v.dx - v * (double)f->w.dx) / w;
    const double down = hypot((double)f->u.dy - u * (double)f->w.dy, (double)f->v.dy - v * (double)f->w.dy) / w;
    return log2(fmax(across, down));
}

/* Degrees between a floor and the line of sight in the topmost of 40 rows, seen with a focal length of 240 px. err_px is
 * not in pixels here: it is by how many mip levels the drawn one is off, where the exact one is one of the texture's. ok
 * below 1, as is asked of the nearest level; trilinear filtering is held to 1/4, so that no seam is seen between levels. */
static void grazing_angles(const pen *p, ew_filter filter)
{
    char axis[48];
    snprintf(axis, sizeof axis, "grazing_degrees_%s", filter == EW_FILTER_NEAREST ? "nearest_level" : "trilinear");
    for (double degrees = 45; degrees > 0.005; degrees /= 1.5) {
        const double first = 240 * tan(degrees / 180 * acos(-1.0)), w0 = 0.9 * first / (first + 40), w1 = 0.9;
        /* v is the distance: 1/w, times what keeps the farther corner within 30,000 texels */
        const double scale = fmin(200, 30000 * w0), u = fmin(200, 30000 * w0 / w1);
        const ew_raster_vertex v[4] = { walk_at(40, 4, w0, 0, scale / w0), walk_at(40, 44, w1, 0, scale / w1), walk_at(280, 44, w1, u, scale / w1),
                                        walk_at(280, 4, w0, u * w1 / w0, scale / w0) };
        canvas c;
        walk_begin(&c, p, 320, 48, 256, 256);
        ew_material material = c.raster.material;
        material.texture = level_texture();
        material.filter = (uint8_t)filter;
        ew_raster_set_material(&c.raster, &material);
        exact_corners corners;
        exact_corners_init(&corners, v);
        measure_pause(1);
        for (int i = 0; i < 2 && !c.error; i++) {
            const int drawn = ew_raster_triangle(&c.raster, &v[0], &v[1 + i], &v[2 + i]);
            c.error = drawn < 0 ? drawn : 0;
        }
        double most = 0;
        for (int y = 4; y < 44; y++) {
            for (int x = 40; x < 280; x++) {
                const exact_forms at = exact_from_corners(&corners, x, y);
                const double level = exact_level(&at), drawn = (((const uint16_t *)c.target.colour)[y * c.target.stride + x] >> 5 & 63) / (double)LEVEL_GREEN;
                if (level >= 0 && level <= LEVELS - 1) most = fmax(most, fabs(drawn - level));
            }
        }
        walk_end(&c);
        char name[32];
        snprintf(name, sizeof name, p->method->takes_tolerance ? "%s %g" : "%s", p->method->name, p->tolerance / 16.0);
        const int fine = most <= (filter == EW_FILTER_NEAREST ? 1 : 0.25);
        walk_row(axis, name, degrees, c.error ? 0 : most, 0, 0, walk_no_limit, c.error ? "refused" : fine ? "ok" : "degraded");
    }
}

/* ---- rotations and matrices: err_px is by how much a point 160 px from the middle is displaced ---- */

enum { ARM_PX = 160, TRIALS = 2000 };
static const double sixteenth = 1.0 / 16;

static void rotation_row(const char *axis, const char *format, double x, double off, double limit)
{
    walk_row(axis, format, x, off * ARM_PX, 0, 0, limit, off * ARM_PX <= sixteenth ? "ok" : "degraded");
}

/* Angles between two keys in radians, whole ones as the core takes them and those that are stored with 14 bits. */
static void slerp_angles(void)
{
    static const struct {
        const char *name;
        int bits;
    } formats[] = { { "q2.30", 30 }, { "q2.14", 14 } };
    for (int f = 0; f < 2; f++) {
        const int bits = formats[f].bits;
        /* the dot product of keys whose components are rounded: a variance of 1/12 unit for each, weighted with the
         * other key's components, makes 1/6; and as much for the division by the lengths, to 30 bits. Of 2,000 the
         * largest is about 3.5 standard deviations; the dot product is half of what is left to half a turn */
        const double deviation = sqrt(1.0 / 6) * sqrt(ldexp(1, -2 * bits) + ldexp(1, -60));
        for (double angle = 1e-7; angle < 3; angle *= 4) rotation_row("slerp_angle_rad", formats[f].name, angle, rotations_worst(angle, bits, 1, TRIALS), walk_no_limit);
        for (double left = 1; left > 1e-11; left /= 1.5) {
            rotation_row("slerp_short_of_half_turn_rad", formats[f].name, left, rotations_worst(acos(-1.0) - left, bits, 1, TRIALS), 2 * 3.5 * deviation);
        }
    }
    /* a key's length: what is left of its 30 bits; four roundings of half a unit make one unit, twice that of angle */
    for (double length = 1.9; length > 1e-8; length /= 1.5) {
        rotation_row("slerp_key_length", "q2.30", length, rotations_worst(1, 30, length, TRIALS), 2 * ldexp(1, -30) * ARM_PX / sixteenth);
    }
}

/* Matrices in a chain: turned, and scaled evenly, unevenly and mirrored, by up to 10^4 and back. */
static void matrix_chains(void)
{
    static const char *const kinds[] = { "turned", "scaled by 10^4 and back", "uneven and mirrored" };
    for (int kind = 0; kind < 3; kind++) {
        for (int n = 1; n <= 128; n *= 2) {
            double off;
            const int error = rotations_chain(n, kind, &off);
            walk_row("chain_length", kinds[kind], n, error ? 0 : off * ARM_PX, 0, 0, walk_no_limit,
                     error ? "refused" : off * ARM_PX <= sixteenth ? "ok" : "degraded");
        }
    }
    /* each scaled by 10^4 again: exponents end at 1,000 */
    for (int n = 32; n <= 128; n += 2) {
        double off;
        const int error = rotations_chain(n, 3, &off);
        walk_row("chain_of_10_to_4_length", "scaled", n, error ? 0 : off * ARM_PX, 0, 0, 1000 / log2(1e4),
                 error ? "refused" : off * ARM_PX <= sixteenth ? "ok" : "degraded");
    }
}

void more_axes(void)
{
    t_junctions();
    resolutions();
    coplanar();
    interpenetrating();
    huge_floors();
    slerp_angles();
    matrix_chains();
}

void more_axes_of(const pen *p)
{
    tall_triangles(p);
    fans(p);
    uv_offset(p);
    texture_sides(p);
    grazing_angles(p, EW_FILTER_NEAREST);
    grazing_angles(p, EW_FILTER_TRILINEAR);
}
