#include "worst.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../unit/unit.h"
#include "triangles.h"

static const promise_way *way_of(const char *name)
{
    for (int i = 0; i < PROMISE_WAYS; i++) {
        if (strcmp(promise_ways[i].name, name) == 0) return &promise_ways[i];
    }
    return strcmp(name, "depth") == 0 ? way_of("exact") : NULL;
}

static void worse(worst_verdict *worst, const promise_fragment *f, double used, double drawn, double exact)
{
    if (used > worst->used) *worst = (worst_verdict){ used, f->x, f->y, drawn, exact };
}

static void judge_fragment(worst_verdict *worst, const worst_case *c, const promise_way *way, const promise_triangle *t,
                           const exact_corners *corners, const promise_fragment *f)
{
    exact_forms at = exact_from_corners(corners, f->x, f->y);
    if (strcmp(c->way, "depth") == 0) {
        double off = exact_depth_off(&at, f->depth, PROMISE_SNAP);
        if (!isnan(off)) worse(worst, f, off, f->depth + 0.5, (double)(65536 * at.w.at));
        return;
    }
    double limit = promise_limit(way, t, &at);
    if (!promise_given(t, &at) || isinf(limit)) return;
    worse(worst, f, promise_used(&at, &at.u, f->u, c->texture_width, limit), f->u / 4096.0, exact_value(&at, &at.u));
    worse(worst, f, promise_used(&at, &at.v, f->v, c->texture_height, limit), f->v / 4096.0, exact_value(&at, &at.v));
}

worst_verdict worst_judge(const worst_case *c, int part)
{
    worst_verdict worst = { -1, 0, 0, 0, 0 };
    const promise_way *way = way_of(c->way);
    const promise_triangle t = promise_of(c->v);
    exact_corners corners;
    assert_non_null(way);
    if (!exact_corners_init(&corners, c->v) || t.reach > way->reach) return worst;
    promise_picture(c->width, c->height, c->texture_width, c->texture_height);
    promise_use(way, 0);
    assert_true(ew_raster_triangle(&promise_raster, &c->v[0], &c->v[1], &c->v[2]) >= 0);
    for (int i = 0; i < promise_count; i += part) judge_fragment(&worst, c, way, &t, &corners, &promise_drawn[i]);
    return worst;
}

void worst_print(const worst_case *c, const worst_verdict *v)
{
    printf("{ \"%s\", %d, %d, %d, %d, %s }, /* %.3f */\n", c->way, c->width, c->height, c->texture_width, c->texture_height,
           triangle_row(c->v), v->used);
}
