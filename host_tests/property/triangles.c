#include "triangles.h"

#include <math.h>
#include <stdio.h>

#include "cases.h"

const char *const triangle_kind_name[KIND_COUNT] = {
    "ordinary", "sliver", "one pixel", "zero area", "tiny", "huge", "along rows", "corners on centres",
    "edges through centres"
};

enum { PX = 4096, STEP = PX >> EW_SUBPIXEL_BITS }; /* q20.12 of a pixel, of a snapped unit */
static const int32_t GUARD_Q = EW_GUARD_PX * PX;

static int32_t within_guard(int64_t a)
{
    return (int32_t)(a > GUARD_Q ? GUARD_Q : a < -GUARD_Q ? -GUARD_Q : a);
}

/* -8 to size + 8 px, on a grid of `step`. */
static int32_t place(int size, int32_t step)
{
    int32_t a = (int32_t)pick((uint32_t)(size + 16) * PX) - 8 * PX;
    return a - (a % step + step) % step;
}

static int32_t somewhere(int32_t most) { return (int32_t)pick(2 * (uint32_t)most + 1) - most; }

/* Any magnitude up to the guard band, the guard band itself now and then. */
static int32_t far_away(void)
{
    if (pick(16) == 0) return pick(2) ? GUARD_Q : -GUARD_Q;
    double a = exp2(uniform(0, 29));
    return within_guard((int64_t)(pick(2) ? a : -a));
}

static void sliver(ew_raster_vertex v[3], int width, int height)
{
    double angle = uniform(0, 2 * acos(-1.0));
    double length = PX * pow(2 * (width > height ? width : height), uniform(0, 1));
    if (pick(4) == 0) angle = acos(-1.0) / 2 * pick(4);
    int32_t dx = (int32_t)(length * cos(angle)), dy = (int32_t)(length * sin(angle)), thick = STEP << pick(2);
    double along = pick(4) ? uniform(0, 1) : uniform(-1, 2);
    if (pick(2)) { /* from centre to centre: most others lie between all centres */
        v[0].x += PX / 2 - (v[0].x & (PX - 1)), v[0].y += PX / 2 - (v[0].y & (PX - 1));
        dx -= dx % PX, dy -= dy % PX;
    }
    v[1].x = within_guard((int64_t)v[0].x + dx), v[1].y = within_guard((int64_t)v[0].y + dy);
    v[2].x = within_guard(v[0].x + (int64_t)(along * dx) + somewhere(thick));
    v[2].y = within_guard(v[0].y + (int64_t)(along * dy) + somewhere(thick));
}

static void zero_area(ew_raster_vertex v[3])
{
    /* whole snapped units, then less than half of one back and forth */
    int32_t dx = somewhere(40), dy = somewhere(40);
    for (int i = 0; i < 3; i++) {
        int32_t along = i == 0 ? 0 : somewhere(200);
        v[i].x = (v[0].x / STEP + along * dx) * STEP;
        v[i].y = (v[0].y / STEP + along * dy) * STEP;
    }
    for (int i = 0; i < 3; i++) {
        v[i].x += (int32_t)pick(STEP) - STEP / 2;
        v[i].y += (int32_t)pick(STEP) - STEP / 2;
    }
}

/* Edge 0-1 through the centre of a pixel, by a step (dx, dy) of snapped units. */
static void through(ew_raster_vertex v[3])
{
    int32_t x = v[0].x - (v[0].x & (PX - 1)) + PX / 2, y = v[0].y - (v[0].y & (PX - 1)) + PX / 2;
    int32_t dx = somewhere(600) * STEP, dy = somewhere(600) * STEP;
    int32_t back = (int32_t)pick(20), on = (int32_t)pick(20);
    v[0].x = x - back * dx, v[0].y = y - back * dy;
    v[1].x = x + on * dx, v[1].y = y + on * dy;
}

void triangle_place(ew_raster_vertex v[3], triangle_kind kind, int width, int height)
{
    static const int32_t grid[] = { 1, 1, STEP, STEP, 256, PX / 2, PX };
    int32_t step = grid[pick(7)];
    for (int i = 0; i < 3; i++) v[i].x = place(width, step), v[i].y = place(height, step);
    switch (kind) {
    case KIND_SLIVER: sliver(v, width, height); break;
    case KIND_ONE_PIXEL:
    case KIND_TINY:
        for (int i = 2; i >= 0; i--) {
            int32_t reach = kind == KIND_TINY ? PX / 2 : 5 * PX / 4;
            v[i].x = v[0].x - (v[0].x & (PX - 1)) + PX / 2 + somewhere(reach);
            v[i].y = v[0].y - (v[0].y & (PX - 1)) + PX / 2 + somewhere(reach);
        }
        break;
    case KIND_ZERO_AREA: zero_area(v); break;
    case KIND_HUGE:
        for (int i = 0; i < 3; i++) {
            if (pick(4)) v[i].x = far_away();
            if (pick(4)) v[i].y = far_away();
        }
        break;
    case KIND_AXIS:
        v[1].x = v[0].x;
        v[2].y = v[pick(2)].y;
        if (pick(4) == 0) v[2].x = within_guard((int64_t)v[0].x + somewhere(STEP)); /* and thin */
        break;
    case KIND_CENTRES:
        for (int i = 0; i < 3; i++) v[i].x = place(width, PX) + PX / 2, v[i].y = place(height, PX) + PX / 2;
        break;
    case KIND_THROUGH: through(v); break;
    default: break;
    }
}

static int64_t snapped(int32_t a)
{
    int64_t n = 2 * (int64_t)a + STEP; /* floor((2 a + STEP) / (2 STEP)) */
    return n >= 0 ? n / (2 * STEP) : -((-n + 2 * STEP - 1) / (2 * STEP));
}

void triangle_snapped(int64_t sx[3], int64_t sy[3], const ew_raster_vertex v[3])
{
    for (int i = 0; i < 3; i++) sx[i] = snapped(v[i].x), sy[i] = snapped(v[i].y);
}

const char *triangle_row(const ew_raster_vertex v[3])
{
    static char row[3][100], all[sizeof row + 16];
    for (int i = 0; i < 3; i++) {
        snprintf(row[i], sizeof row[i], "{ .x = %d, .y = %d, .w = %u, .u = %d, .v = %d }", v[i].x, v[i].y, v[i].w, v[i].u,
                 v[i].v);
    }
    snprintf(all, sizeof all, "{ %s, %s, %s }", row[0], row[1], row[2]);
    return all;
}

void triangle_context(const char *what, long number, const ew_raster_vertex v[3])
{
    test_context("EW_CASE=%ld, %s: %s", number, what, triangle_row(v));
}
