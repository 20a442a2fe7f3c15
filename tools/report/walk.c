#include "walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MARGIN = 64, SIDE = EW_TEXTURE_MAX };

static uint16_t texels[SIDE * SIDE];

static void fill_texels(void)
{
    for (uint32_t i = 0; !texels[SIDE * SIDE - 1] && i < SIDE * SIDE; i++) texels[i] = (uint16_t)(i * 40503u >> 3);
}

const ew_texture *walk_texture(void)
{
    static const ew_texture texture = { .texels = texels, .width = 256, .height = 256 };
    fill_texels();
    return &texture;
}

void walk_begin(canvas *c, const pen *p, int width, int height, int texture_width, int texture_height)
{
    size_t stride = (size_t)width + MARGIN, size = stride * (size_t)(height + 2);
    memset(c, 0, sizeof *c);
    c->width = width, c->height = height;
    for (int k = 0; k < 2; k++) {
        c->memory[k] = malloc(2 * size);
        if (!c->memory[k]) abort();
        memset(c->memory[k], 0xA5, 2 * size);
    }
    c->target = (ew_target){ .colour = c->memory[0] + stride, .depth = c->memory[1] + stride, .width = (uint16_t)width,
                             .height = (uint16_t)height, .stride = (uint16_t)stride };
    fill_texels();
    const ew_texture texture = { .texels = texels, .width = (uint16_t)texture_width, .height = (uint16_t)texture_height };
    const ew_material material = { .texture = &texture, .tolerance = p->tolerance, .rung = p->method->rung,
                                   .flags = EW_DOUBLE_SIDED };
    const ref_camera eye = { 1, 1, 1, 0, 0, width, height };
    c->error = ew_raster_init(&c->raster, &c->target);
    ew_raster_clear(&c->raster, 0);
    if (!c->error) c->error = ew_raster_set_material(&c->raster, &material);
    measure_begin(&c->target, &eye, 0);
}

void walk_triangle(canvas *c, const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *d)
{
    const ew_raster_vertex *const v[3] = { a, b, d };
    if (!c->error) c->error = measure_triangle(&c->raster, v);
}

void walk_quad(canvas *c, const ew_raster_vertex v[4])
{
    walk_triangle(c, &v[0], &v[1], &v[2]);
    walk_triangle(c, &v[0], &v[2], &v[3]);
}

int walk_view(ew_transform *t, int width, int height, double size, double up)
{
    const ew_projection projection = { 65536, 98304, { 1 << 29, 1 } };
    const ew_viewport viewport = { 0, 0, (uint16_t)width, (uint16_t)height };
    ew_mat34 model_view;
    int e;
    memset(&model_view, 0, sizeof model_view);
    const int32_t mantissa = (int32_t)lrint(ldexp(frexp(size, &e), 30));
    for (int i = 0; i < 3; i++) model_view.row[i].m[i] = mantissa, model_view.row[i].e = (int16_t)e;
    model_view.row[1].m[3] = (int32_t)lrint(ldexp(frexp(up, &e), 30)), model_view.row[1].e_last = (int16_t)e;
    return ew_transform_set(t, &projection, &model_view, &viewport);
}

void walk_floor(canvas *c, const ew_vertex16 v[4], double size, double up)
{
    static const uint16_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    const double exact[3][4] = { { size, 0, 0, 0 }, { 0, size, 0, up }, { 0, 0, size, 0 } };
    const ref_camera eye = { 1, 1.5, 1, 0, 0, c->width, c->height };
    measures discarded;
    ew_geometry geometry;
    ew_screen_vertex screen[4];
    measure_end(&discarded, 0.125);
    measure_begin(&c->target, &eye, 0);
    ew_geometry_init(&geometry, &c->raster);
    if (!c->error) c->error = walk_view(&geometry.transform, c->width, c->height, size, up);
    if (c->error) return;
    ew_transform_vertices(&geometry.transform, v, 4, screen);
    const ew_mesh mesh = { v, screen, NULL, indices, 6, 4 };
    c->error = measure_mesh(&geometry, exact, &mesh);
}

measures walk_end(canvas *c)
{
    measures m;
    measure_end(&m, 0.125);
    for (int k = 0; k < 2; k++) {
        size_t stride = c->target.stride, rows = (size_t)c->height + 2;
        for (size_t i = 0; i < stride * rows; i++) {
            int inside = i % stride < (size_t)c->width && i / stride >= 1 && i / stride <= (size_t)c->height;
            if (!inside && c->memory[k][i] != 0xA5A5) {
                fprintf(stderr, "stability: written outside of the picture\n");
                abort();
            }
        }
        free(c->memory[k]);
    }
    return m;
}

void walk_row(const char *axis, const char *method, double x, double err_px, double err_lsb, long wrong, double limit,
              const char *state)
{
    printf("%s,%s,%.6g,%.6g,%.6g,%ld,", axis, method, x, err_px, err_lsb, wrong);
    if (limit == walk_no_limit) printf("na,%s\n", state);
    else printf("%.6g,%s\n", limit, state);
}

int walk_careless(const pen *p) { return p->method->bound == BOUND_AFFINE || p->method->bound == BOUND_RUN; }

double walk_allowed(const pen *p)
{
    if (p->method->takes_tolerance) return p->tolerance / 16.0 + walk_snap;
    return walk_careless(p) ? 0.25 + walk_snap : walk_snap;
}

void walk_report(const char *axis, const pen *p, double x, const canvas *c, const measures *m, long more_wrong, double limit)
{
    long wrong = m->wrong_px + m->double_hits + more_wrong;
    int fine = wrong == 0 && m->disp_max <= walk_allowed(p) && m->depth_off <= 1;
    if (strncmp(axis, "uv_range", 8) == 0 && walk_allowed(p) == walk_snap) fine = fine && fmax(m->u_max, m->v_max) <= walk_e;
    char name[32];
    if (p->method->takes_tolerance) snprintf(name, sizeof name, "%s %g", p->method->name, p->tolerance / 16.0);
    else snprintf(name, sizeof name, "%s", p->method->name);
    walk_row(axis, name, x, c->error ? 0 : m->disp_max, c->error ? 0 : m->depth_max, wrong, limit,
             c->error ? "refused" : fine ? "ok" : "degraded");
}

ew_raster_vertex walk_at(double x, double y, double w, double u, double v)
{
    ew_raster_vertex r;
    memset(&r, 0, sizeof r);
    r.x = (ew_q20_12)lrint(x * 4096), r.y = (ew_q20_12)lrint(y * 4096);
    r.w = (ew_uq1_31)fmax(1, fmin(rint(ldexp(w, 31)), 0x80000000));
    r.u = (ew_q20_12)fmin(INT32_MAX, fmax(-INT32_MAX, rint(u * 4096))), r.v = (ew_q20_12)fmin(INT32_MAX, fmax(-INT32_MAX, rint(v * 4096)));
    return r;
}

