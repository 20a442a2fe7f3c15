#include "promise.h"

#include <math.h>
#include <string.h>

#include "../unit/unit.h"

const promise_way promise_ways[PROMISE_WAYS] = {
    { "auto 1 px", EW_RUNG_AUTO, 16, 0, 32768 },
    { "auto 1/2 px", EW_RUNG_AUTO, 8, 0, 32768 },
    { "auto 1/4 px", EW_RUNG_AUTO, 4, 0, 32768 },
    { "auto 1/8 px", EW_RUNG_AUTO, 2, 0, 32768 },
    { "auto 1/16 px", EW_RUNG_AUTO, 1, 0, 32768 },
    { "auto 0", EW_RUNG_AUTO, 0, 0, 32768 },
    { "auto 2 px", EW_RUNG_AUTO, 32, 0, 32768 },
    { "runs 1/4 px", EW_RUNG_RUNS, 4, 0, 32768 },
    { "runs 2 px", EW_RUNG_RUNS, 32, 0, 32768 },
    { "table", EW_RUNG_TABLE, 0, 0, 1408 },
    { "exact", EW_RUNG_EXACT, 0, 0, 32768 },
    { "affine", EW_RUNG_AFFINE, 0, 0, 512 },
    { "runs of 8", EW_RUNG_RUNS_8, 0, 8, 512 },
    { "runs of 16", EW_RUNG_RUNS_16, 0, 16, 512 },
    { "runs of 32", EW_RUNG_RUNS_32, 0, 32, 512 },
};

ew_raster promise_raster;
promise_fragment promise_drawn[2 * PROMISE_PIXELS];
int promise_count, promise_rung;

static uint16_t colour[PROMISE_PIXELS], depth[PROMISE_PIXELS], texels[PROMISE_TEXTURE_MOST * PROMISE_TEXTURE_MOST];
static ew_texture texture;

void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c, int rung)
{
    (void)a, (void)b, (void)c;
    promise_rung = rung;
}

void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t d, ew_q20_12 u, ew_q20_12 v)
{
    if (promise_count == 2 * PROMISE_PIXELS) return;
    promise_fragment f = { x, y, d, u, v };
    promise_drawn[promise_count++] = f;
}

void promise_picture(uint16_t width, uint16_t height, uint16_t texture_width, uint16_t texture_height)
{
    const ew_target target = { .colour = colour, .depth = depth, .width = width, .height = height, .stride = width };
    texture = (ew_texture){ .texels = texels, .width = texture_width, .height = texture_height };
    memset(depth, 0, 2u * width * height);
    assert_int_equal(ew_raster_init(&promise_raster, &target), EW_OK);
}

void promise_use(const promise_way *way, long profile)
{
    static const ew_cost dear = { 440, 26, 81 }; /* runs of 9 pixels at least */
    const ew_cost *const costs[5] = { &ew_cost_generic, &ew_cost_m0plus, &ew_cost_m3, &ew_cost_host, &dear };
    const ew_material material = { .texture = &texture, .tolerance = way->tolerance, .rung = (uint8_t)way->rung,
                                   .flags = EW_DOUBLE_SIDED };
    assert_int_equal(ew_raster_set_material(&promise_raster, &material), EW_OK);
    assert_int_equal(ew_raster_set_cost(&promise_raster, costs[profile % 5]), EW_OK);
    promise_count = 0;
}

promise_triangle promise_of(const ew_raster_vertex v[3])
{
    promise_triangle t = { 0, 0, 0 };
    double least = HUGE_VAL, sum = 0, most = 0;
    for (int i = 0; i < 3; i++) {
        const ew_raster_vertex *a = &v[i], *b = &v[(i + 1) % 3];
        double way = ldexp(hypot((double)a->x - b->x, (double)a->y - b->y), -12) * fabs((double)a->w - b->w);
        t.reach = fmax(t.reach, ldexp(fmax(fabs((double)a->u - b->u), fabs((double)a->v - b->v)), -12));
        t.w_most = fmax(t.w_most, ldexp(a->w, -31));
        least = fmin(least, a->w);
        sum += way, most = fmax(most, way);
    }
    t.affine = most / (4 * least); /* docs/error-bound.md, "a whole triangle" */
    return t;
}

/* 1/z has 31 fraction bits, u/z and v/z have 29 at the nearest corner, for differences of 128
 * texels or more. */
int promise_given(const promise_triangle *t, const exact_forms *at)
{
    double w = (double)at->w.at, g = t->w_most / w;
    double off = fmax(t->reach, 128) * ldexp(g, -27) + t->reach * ldexp(1 / w, -31);
    return w >= 1.0 / 65536 && off <= PROMISE_BEYOND;
}

double promise_limit(const promise_way *way, const promise_triangle *t, const exact_forms *at)
{
    if (way->rung == EW_RUNG_AFFINE) return t->affine + PROMISE_SNAP;
    if (!way->run) return way->tolerance / 16.0 + PROMISE_SNAP;
    /* wherever the run begins, it and the pixel behind it end at most so far away; the slope is a
     * number of 32 bits as long as 1/z at most doubles or halves */
    double rise = fabs((double)at->w.dx), far = (double)at->w.at - way->run * rise;
    if (far <= way->run * rise) return HUGE_VAL;
    return way->run * (double)way->run * rise / (4 * far) + PROMISE_SNAP;
}

double promise_used(const exact_forms *at, const exact_form *attribute, ew_q20_12 drawn, int period, double limit)
{
    enum { STEPS = 16, MOST = 16 };
    double inside = exact_radius(at, attribute, drawn / 4096.0, period, 0), low = 0, high = MOST;
    if (inside <= limit) return inside / limit - 1;
    for (int i = 0; i < STEPS; i++) {
        double middle = (low + high) / 2;
        if (exact_radius(at, attribute, drawn / 4096.0, period, middle * PROMISE_E) <= limit) high = middle;
        else low = middle;
    }
    return high;
}
