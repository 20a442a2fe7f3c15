#include "measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A covering triangle at a pixel, by exact coverage. */
typedef struct candidate {
    double depth;
    double low[2], high[2]; /* u and v that the colour may come from                            */
    double u, v;            /* at the pixel's centre                                            */
    uint16_t colour;
    int8_t textured;
    ew_texture texture;
} candidate;

enum { CANDIDATES = 6 }; /* the nearest ones of a pixel */

typedef struct pixel {
    candidate kept[CANDIDATES];
    int count;
    uint16_t hits, seen; /* fragments; the nearest one's depth                                  */
    uint8_t truth;
    float displacement, texels; /* of the nearest one                                           */
} pixel;

typedef struct logged_triangle {
    ew_raster_vertex corner[3];
} logged_triangle;
typedef struct logged_fragment {
    uint16_t x, y, depth;
    uint8_t rung;
    ew_q20_12 u, v;
} logged_fragment;

static struct {
    ew_target target;
    ref_camera camera;
    uint16_t background;
    pixel *pixels;
    uint8_t *exact, *drawn; /* of the source triangle at hand: how often each pixel is hit      */
    measures m;
    double depth_sum, u_sum, v_sum, disp_sum;
    logged_triangle triangle[16];
    int triangles, rung, active;
    logged_fragment *fragment;
    size_t fragments, fragment_room;
} now;
static measure_maps wanted;

void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c,
                       int rung)
{
    if (!now.active) return;
    if (now.triangles == 16) abort();
    logged_triangle *t = &now.triangle[now.triangles++];
    t->corner[0] = *a, t->corner[1] = *b, t->corner[2] = *c;
    now.rung = rung;
}

void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t depth, ew_q20_12 u, ew_q20_12 v)
{
    if (!now.active) return;
    if (now.fragments == now.fragment_room) {
        now.fragment_room = now.fragment_room ? 2 * now.fragment_room : 1 << 16;
        now.fragment = realloc(now.fragment, now.fragment_room * sizeof *now.fragment);
        if (!now.fragment) abort();
    }
    logged_fragment f = { x, y, depth, (uint8_t)now.rung, u, v };
    now.fragment[now.fragments++] = f;
}

static size_t pixel_count(void) { return (size_t)now.target.width * now.target.height; }
static size_t index_of(int x, int y) { return (size_t)y * now.target.width + (size_t)x; }

void measure_begin(const ew_target *target, const ref_camera *camera, uint16_t background)
{
    memset(&now, 0, sizeof now);
    now.target = *target;
    now.camera = *camera;
    now.background = background;
    now.active = 1;
    now.pixels = calloc(pixel_count(), sizeof *now.pixels);
    now.exact = calloc(pixel_count(), 1);
    now.drawn = calloc(pixel_count(), 1);
    if (!now.pixels || !now.exact || !now.drawn) abort();
}

void measure_pause(int paused) { now.active = now.pixels && !paused; }

/* ---- one source triangle ---- */

static void keep(size_t at, const candidate *c)
{
    pixel *p = &now.pixels[at];
    int i = p->count < CANDIDATES ? p->count++ : CANDIDATES - 1;
    if (p->count == CANDIDATES && i == CANDIDATES - 1 && p->kept[i].depth > c->depth) return;
    for (; i > 0 && p->kept[i - 1].depth < c->depth; i--) p->kept[i] = p->kept[i - 1];
    p->kept[i] = *c;
}

/* Exact u and v over a disc: least and largest of its centre and 16 points of its rim. */
static void attribute_range(const ref_triangle *t, double px, double py, double radius, double low[2], double high[2])
{
    enum { DIRECTIONS = 16 };
    low[0] = low[1] = HUGE_VAL, high[0] = high[1] = -HUGE_VAL;
    for (int k = 0; k <= DIRECTIONS; k++) {
        double angle = 2 * acos(-1.0) * k / DIRECTIONS, r = k == DIRECTIONS ? 0 : radius;
        ref_sample s = ref_sample_at(t, px + r * cos(angle), py + r * sin(angle));
        if (!(s.z > 0)) continue;
        low[0] = fmin(low[0], s.u), high[0] = fmax(high[0], s.u);
        low[1] = fmin(low[1], s.v), high[1] = fmax(high[1], s.v);
        if (radius == 0) break;
    }
}

static void mark_exact(const ew_raster *raster, const ref_triangle *truth, int *box)
{
    for (int k = 0; k < now.triangles; k++) {
        const logged_triangle *t = &now.triangle[k];
        int64_t sx[3], sy[3], left = INT64_MAX, right = INT64_MIN, top = INT64_MAX, bottom = INT64_MIN;
        for (int i = 0; i < 3; i++) {
            double x = ldexp(t->corner[i].x, -12), y = ldexp(t->corner[i].y, -12);
            sx[i] = ref_snap(x, EW_SUBPIXEL_BITS);
            sy[i] = ref_snap(y, EW_SUBPIXEL_BITS);
            left = sx[i] < left ? sx[i] : left, right = sx[i] > right ? sx[i] : right;
            top = sy[i] < top ? sy[i] : top, bottom = sy[i] > bottom ? sy[i] : bottom;
            /* corners that the clipper cut at the guard band are nobody's */
            if (fabs(x) >= EW_GUARD_PX - 2 || fabs(y) >= EW_GUARD_PX - 2) continue;
            double one = ldexp(1, EW_SUBPIXEL_BITS);
            now.m.vertex_max = fmax(now.m.vertex_max, one * ref_nearest_corner(truth, &now.camera, x, y));
            now.m.snapped_max = fmax(now.m.snapped_max, one * ref_nearest_corner(truth, &now.camera, (double)sx[i] / one,
                                                                                 (double)sy[i] / one));
        }
        int x0 = (int)fmax(0, floor(ldexp((double)left, -EW_SUBPIXEL_BITS)));
        int x1 = (int)fmin(now.target.width - 1, ceil(ldexp((double)right, -EW_SUBPIXEL_BITS)));
        int y0 = (int)fmax(0, floor(ldexp((double)top, -EW_SUBPIXEL_BITS)));
        int y1 = (int)fmin(now.target.height - 1, ceil(ldexp((double)bottom, -EW_SUBPIXEL_BITS)));
        box[0] = x0 < box[0] ? x0 : box[0], box[1] = y0 < box[1] ? y0 : box[1];
        box[2] = x1 > box[2] ? x1 : box[2], box[3] = y1 > box[3] ? y1 : box[3];
        for (int y = y0; y <= y1; y++) {
            for (int x = x0; x <= x1; x++) {
                if (!ref_covers(sx, sy, EW_SUBPIXEL_BITS, x, y)) continue;
                now.exact[index_of(x, y)]++;
                candidate c;
                memset(&c, 0, sizeof c);
                c.depth = ref_depth(truth, x + 0.5, y + 0.5);
                c.colour = raster->material.colour;
                c.textured = raster->material.texture != NULL;
                c.texture = raster->texture;
                if (c.textured) {
                    ref_sample s = ref_sample_at(truth, x + 0.5, y + 0.5);
                    c.u = s.u, c.v = s.v;
                    attribute_range(truth, x + 0.5, y + 0.5, raster->material.tolerance / 16.0, c.low, c.high);
                }
                keep(index_of(x, y), &c);
            }
        }
    }
}

/* Difference of texture coordinates: the core's are modulo the texture's size, and taken for
 * the one nearest to the middle of what is promised. */
static double uv_error(ew_q20_12 core, double exact, double low, double high, int size)
{
    double middle = (low + high) / 2;
    return middle + remainder(ldexp(core, -12) - middle, size) - exact;
}

/* Where one attribute of a triangle in perspective has a given value is a straight line on
 * the screen: this is how far away the nearest point is whose u or v (as the number of the
 * reference's coefficients) lies within e of `drawn`. */
static double displacement(const ref_triangle *t, double px, double py, double drawn, double exact, int v)
{
    const double e = 1.0 / 64;
    if (fabs(drawn - exact) <= e) return 0;
    double value = drawn > exact ? drawn - e : drawn + e, line[3] = { 0, 0, 0 };
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) line[k] += t->b[i][k] * ((v ? t->corner[i].v : t->corner[i].u) - value);
    }
    return fabs(line[0] * px + line[1] * py + line[2]) / hypot(line[0], line[1]);
}

/* The bound of a run over its length squared: |dw| / (4 w), w the 1/z at the pixel. */
static double run_bound(const ref_triangle *t, const ref_sample *s, double px, double py)
{
    return fabs(1 / ref_sample_at(t, px + 1, py).z - 1 / s->z) * s->z / 4;
}

static void bound_triangle(const logged_triangle *t)
{
    double w_min = HUGE_VAL, widest = 0;
    for (int i = 0; i < 3; i++) {
        const ew_raster_vertex *a = &t->corner[i], *b = &t->corner[(i + 1) % 3];
        w_min = fmin(w_min, a->w);
        widest = fmax(widest, ldexp(hypot(a->x - b->x, a->y - b->y), -12) * fabs((double)a->w - b->w));
        now.m.reach = fmax(now.m.reach, ldexp(fmax(fabs((double)a->u - b->u), fabs((double)a->v - b->v)), -12));
    }
    now.m.affine_bound = fmax(now.m.affine_bound, widest / (4 * w_min));
}

static void judge_fragment(const logged_fragment *f, const ref_triangle *truth, const ew_raster *raster)
{
    now.m.fragments++;
    now.m.rung[f->rung]++;
    now.drawn[index_of(f->x, f->y)]++;
    pixel *p = &now.pixels[index_of(f->x, f->y)];
    if (p->hits++) now.m.hit_again++;
    int is_seen = p->hits == 1 || f->depth > p->seen;
    if (is_seen) p->seen = f->depth, p->displacement = p->texels = -1;
    ref_sample s = ref_sample_at(truth, f->x + 0.5, f->y + 0.5);
    double depth = 65536 * truth->near_z / s.z;
    if (depth >= 1 && depth < 65535) {
        double e = fabs(f->depth + 0.5 - depth);
        now.m.depth_max = fmax(now.m.depth_max, e);
        /* 1/z is linear: over a disc it goes up and down by its gradient times the radius */
        double gx = ref_depth(truth, f->x + 1.5, f->y + 0.5) - depth;
        double gy = ref_depth(truth, f->x + 0.5, f->y + 1.5) - depth;
        now.m.depth_off = fmax(now.m.depth_off, e - hypot(gx, gy) / 256);
        now.depth_sum += e * e;
    } else {
        now.m.saturated++;
    }
    if (f->rung == EW_RUNG_CONSTANT) return;
    double low[2], high[2];
    attribute_range(truth, f->x + 0.5, f->y + 0.5, raster->material.tolerance / 16.0 + 1.0 / 256, low, high);
    double eu = uv_error(f->u, s.u, low[0], high[0], raster->texture.width);
    double ev = uv_error(f->v, s.v, low[1], high[1], raster->texture.height);
    now.m.textured++;
    now.m.u_max = fmax(now.m.u_max, fabs(eu));
    now.m.v_max = fmax(now.m.v_max, fabs(ev));
    now.m.uv_off = fmax(now.m.uv_off, fmax(s.u + eu - high[0], low[0] - (s.u + eu)));
    now.m.uv_off = fmax(now.m.uv_off, fmax(s.v + ev - high[1], low[1] - (s.v + ev)));
    now.u_sum += eu * eu;
    now.v_sum += ev * ev;
    double du = displacement(truth, f->x + 0.5, f->y + 0.5, s.u + eu, s.u, 0);
    double d = fmax(du, displacement(truth, f->x + 0.5, f->y + 0.5, s.v + ev, s.v, 1));
    now.m.disp_max = fmax(now.m.disp_max, d);
    now.m.within_e += d == 0;
    now.disp_sum += d * d;
    now.m.run_bound = fmax(now.m.run_bound, run_bound(truth, &s, f->x + 0.5, f->y + 0.5));
    if (is_seen) p->displacement = (float)d, p->texels = (float)fmax(fabs(eu), fabs(ev));
}

/* Pixels that the unsnapped triangle covers. A triangle that crosses the near plane may
 * reach anywhere, so then all pixels are asked. */
static void mark_truth(const ref_triangle *truth, int double_sided)
{
    double x0 = HUGE_VAL, x1 = -HUGE_VAL, y0 = HUGE_VAL, y1 = -HUGE_VAL;
    int in_front = 0;
    if (!double_sided && truth->determinant <= 0) return;
    for (int i = 0; i < 3; i++) {
        const ref_corner *c = &truth->corner[i];
        if (c->z < truth->near_z) continue;
        in_front++;
        double x = now.camera.left + now.camera.width / 2 * (1 + now.camera.fx * c->x / c->z);
        double y = now.camera.top + now.camera.height / 2 * (1 - now.camera.fy * c->y / c->z);
        x0 = fmin(x0, x), x1 = fmax(x1, x), y0 = fmin(y0, y), y1 = fmax(y1, y);
    }
    if (in_front == 0) return;
    if (in_front < 3) x0 = y0 = 0, x1 = now.target.width, y1 = now.target.height;
    int last_x = (int)fmin(now.target.width, x1 + 1), last_y = (int)fmin(now.target.height, y1 + 1);
    for (int y = (int)fmax(0, y0 - 1); y < last_y; y++) {
        for (int x = (int)fmax(0, x0 - 1); x < last_x; x++) {
            if (ref_sample_at(truth, x + 0.5, y + 0.5).inside) now.pixels[index_of(x, y)].truth = 1;
        }
    }
}

static void judge_triangle(const ew_raster *raster, const ref_triangle *truth)
{
    int box[4] = { 1 << 20, 1 << 20, -1, -1 };
    mark_exact(raster, truth, box);
    for (int k = 0; k < now.triangles && raster->material.texture; k++) bound_triangle(&now.triangle[k]);
    for (size_t i = 0; i < now.fragments; i++) {
        const logged_fragment *f = &now.fragment[i];
        judge_fragment(f, truth, raster);
        box[0] = f->x < box[0] ? f->x : box[0], box[1] = f->y < box[1] ? f->y : box[1];
        box[2] = f->x > box[2] ? f->x : box[2], box[3] = f->y > box[3] ? f->y : box[3];
    }
    for (int y = box[1]; y <= box[3]; y++) {
        for (int x = box[0]; x <= box[2]; x++) {
            size_t at = index_of(x, y);
            if (now.exact[at] != now.drawn[at]) now.m.wrong_px++;
            if (now.drawn[at] > 1) now.m.double_hits++;
            now.exact[at] = now.drawn[at] = 0;
        }
    }
}

/* Judges what was traced since the source triangle began. */
static void judge_drawn(const ew_raster *raster, const ref_corner corner[3])
{
    ref_triangle truth;
    if (!ref_triangle_init(&truth, &now.camera, corner)) {
        now.m.wrong_px += (long)now.fragments; /* drawn, though seen edge-on */
        return;
    }
    if (now.triangles || now.fragments) judge_triangle(raster, &truth);
    mark_truth(&truth, raster->material.flags & EW_DOUBLE_SIDED);
}

int measure_mesh(ew_geometry *geometry, const double mv[3][4], const ew_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        ew_mesh one = *mesh;
        one.indices += i, one.index_count = 3;
        ref_corner corner[3];
        for (int k = 0; k < 3; k++) {
            const ew_vertex16 *v = &one.vertices[one.indices[k]];
            double p[3] = { v->x / 32768.0, v->y / 32768.0, v->z / 32768.0 }, view[3];
            for (int r = 0; r < 3; r++) view[r] = mv[r][0] * p[0] + mv[r][1] * p[1] + mv[r][2] * p[2] + mv[r][3];
            corner[k] = (ref_corner){ view[0], view[1], -view[2], ldexp(v->u, -one.uv_fraction_bits),
                                      ldexp(v->v, -one.uv_fraction_bits) };
        }
        now.triangles = 0;
        now.fragments = 0;
        int32_t result = ew_draw_triangles(geometry, &one);
        if (result < 0) return (int)result;
        judge_drawn(geometry->raster, corner);
    }
    return 0;
}

int measure_triangle(ew_raster *raster, const ew_raster_vertex *const v[3])
{
    ref_corner corner[3];
    const ref_camera *c = &now.camera;
    for (int k = 0; k < 3; k++) {
        double z = c->near_z / ldexp(v[k]->w, -31), x = ldexp(v[k]->x, -12), y = ldexp(v[k]->y, -12);
        corner[k] = (ref_corner){ ((x - c->left) * 2 / c->width - 1) * z / c->fx, (1 - (y - c->top) * 2 / c->height) * z / c->fy, z,
                                  ldexp(v[k]->u, -12), ldexp(v[k]->v, -12) };
    }
    now.triangles = 0;
    now.fragments = 0;
    int result = ew_raster_triangle(raster, v[0], v[1], v[2]);
    if (result >= 0) judge_drawn(raster, corner);
    return result < 0 ? result : 0;
}

/* ---- the picture ---- */

static int colour_allowed(const candidate *c, uint16_t colour, double border)
{
    if (!c->textured) return colour == c->colour;
    int width = c->texture.width, height = c->texture.height;
    const uint16_t *texels = c->texture.texels;
    double u0 = floor(c->low[0] - border), u1 = floor(c->high[0] + border);
    double v0 = floor(c->low[1] - border), v1 = floor(c->high[1] + border);
    if (u1 - u0 >= width) u0 = 0, u1 = width - 1;
    if (v1 - v0 >= height) v0 = 0, v1 = height - 1;
    for (double v = v0; v <= v1; v++) {
        for (double u = u0; u <= u1; u++) {
            int iu = (int)((long long)u & (width - 1)), iv = (int)((long long)v & (height - 1));
            if (texels[iv * width + iu] == colour) return 1;
        }
    }
    return 0;
}

static int pixel_right(const pixel *p, uint16_t colour, double border)
{
    if (p->count == 0) return colour == now.background;
    for (int i = 0; i < p->count && p->kept[i].depth >= p->kept[0].depth - 1; i++) {
        if (colour_allowed(&p->kept[i], colour, border)) return 1;
    }
    return 0;
}

static uint16_t reference_colour(const pixel *p)
{
    if (p->count == 0) return now.background;
    const candidate *c = &p->kept[0];
    if (!c->textured) return c->colour;
    const uint16_t *texels = c->texture.texels;
    long long u = (long long)floor(c->u) & (c->texture.width - 1), v = (long long)floor(c->v) & (c->texture.height - 1);
    return texels[v * c->texture.width + u];
}

void measure_want_maps(const measure_maps *maps) { wanted = *maps; }

static void write_maps(const measure_maps *maps)
{
    for (size_t i = 0; i < pixel_count(); i++) {
        const pixel *p = &now.pixels[i];
        if (maps->reference) maps->reference[i] = reference_colour(p);
        if (maps->displacement) maps->displacement[i] = p->hits ? p->displacement : -1;
        if (maps->texels) maps->texels[i] = p->hits ? p->texels : -1;
    }
}

void measure_end(measures *result, double border)
{
    write_maps(&wanted);
    memset(&wanted, 0, sizeof wanted);
    for (int y = 0; y < now.target.height; y++) {
        for (int x = 0; x < now.target.width; x++) {
            const pixel *p = &now.pixels[index_of(x, y)];
            if (p->hits) now.m.covered_px++;
            if ((p->hits != 0) != p->truth) now.m.wrong_truth_px++;
            uint16_t colour = ((const uint16_t *)now.target.colour)[(size_t)y * now.target.stride + (size_t)x];
            if (!pixel_right(p, colour, border)) now.m.colour_px++;
        }
    }
    long judged = now.m.fragments - now.m.saturated;
    now.m.depth_rms = judged ? sqrt(now.depth_sum / (double)judged) : 0;
    now.m.u_rms = now.m.textured ? sqrt(now.u_sum / (double)now.m.textured) : 0;
    now.m.v_rms = now.m.textured ? sqrt(now.v_sum / (double)now.m.textured) : 0;
    now.m.disp_rms = now.m.textured ? sqrt(now.disp_sum / (double)now.m.textured) : 0;
    *result = now.m;
    free(now.pixels);
    free(now.exact);
    free(now.drawn);
    free(now.fragment);
    memset(&now, 0, sizeof now);
}

void measure_print_heading(void)
{
    printf("%-22s %8s %8s %6s %6s %6s %7s %7s %7s %7s %7s %7s %7s %6s %7s\n", "picture", "fragment", "covered",
           "wrong", "double", "truth", "vertex", "depth", "rms", "u max", "u rms", "v max", "v rms", "colour", "affine");
}

void measure_print(const char *name, const measures *m)
{
    printf("%-22s %8ld %8ld %6ld %6ld %6ld %7.4f %7.3f %7.3f %7.4f %7.4f %7.4f %7.4f %6ld %6.1f%%\n", name,
           m->fragments, m->covered_px, m->wrong_px, m->double_hits, m->wrong_truth_px, m->snapped_max,
           m->depth_max, m->depth_rms, m->u_max, m->u_rms, m->v_max, m->v_rms, m->colour_px,
           m->fragments ? 100.0 * (double)m->rung[EW_RUNG_AFFINE] / (double)m->fragments : 0.0);
}
