/* Looks for the triangle that uses most of its promise, for each way to draw: random ones, then
 * small changes to the worst as long as they make it worse. Prints each as a row of
 * worst_triangles.inc, how much of the promise it uses behind it; above 1 it is broken.
 *
 *   search_worst [--tries N] [WAY ...]
 *
 * N triangles are drawn for each way; EW_SEED makes it another search. Exit status 1 when a promise
 * was broken. */
#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "triangles.h"
#include "worst.h"

enum { PX = 4096, FIRST = 60, PATIENCE = 300, JUDGED = 300 };

static int32_t clamp(double a, double low, double high) { return (int32_t)fmin(high, fmax(low, a)); }

static void choose_picture(worst_case *c)
{
    static const uint16_t sizes[][2] = { { 64, 48 }, { 64, 48 }, { 64, 48 }, { 320, 40 }, { 40, 320 }, { 4096, 4 }, { 4, 4096 } };
    static const uint16_t textures[][2] = { { 256, 256 }, { 2048, 2048 }, { 2048, 32 }, { 64, 1024 } };
    const uint16_t *size = sizes[pick(7)], *texture = textures[pick(4)];
    c->width = size[0], c->height = size[1], c->texture_width = texture[0], c->texture_height = texture[1];
}

/* A triangle of any kind; 1/z and texels of its corners alike or far apart. */
static void choose(worst_case *c)
{
    static const triangle_kind kinds[] = { KIND_ORDINARY, KIND_ORDINARY, KIND_SLIVER, KIND_TINY, KIND_HUGE, KIND_AXIS, KIND_CENTRES };
    double ratio = pow(10, uniform(0, 6)), reach = pow(10, uniform(0, pick(2) ? 2.7 : 4.5)), nearest = pick(2) ? 1 : exp2(uniform(-14, 0));
    double far_off = pick(4) ? 0 : uniform(-1, 1) * (262143 - reach);
    choose_picture(c);
    memset(c->v, 0, sizeof c->v);
    triangle_place(c->v, kinds[pick(7)], c->width, c->height);
    for (int i = 0; i < 3; i++) {
        c->v[i].w = (uint32_t)fmax(1, ldexp(nearest * pow(ratio, -uniform(0, 1)), 31));
        c->v[i].u = (int32_t)(PX * (far_off + uniform(0, reach))), c->v[i].v = (int32_t)(PX * (far_off + uniform(0, reach)));
    }
}

static void move(ew_q20_12 *a, double step, double most) { *a = clamp(*a + step * uniform(-1, 1), -most, most); }

/* One to three changes of one corner, of any size. */
static void change(worst_case *c)
{
    const double guard = (double)EW_GUARD_PX * PX, texels = 262143.0 * PX;
    for (int n = 1 + (int)pick(3); n > 0; n--) {
        ew_raster_vertex *v = &c->v[pick(3)];
        double px = PX * exp2(uniform(-12, 8)), texel = PX * exp2(uniform(-12, 12));
        switch (pick(8)) {
        case 0: move(&v->x, px, guard); break;
        case 1: move(&v->y, px, guard); break;
        case 2: move(&v->x, px, guard), move(&v->y, px, guard); break;
        case 3: move(&v->u, texel, texels); break;
        case 4: move(&v->v, texel, texels); break;
        case 5: v->w = (uint32_t)fmin(0x80000000, fmax(1, v->w * exp2(uniform(-1, 1) * exp2(uniform(-20, 2))))); break;
        case 6: v->w = c->v[pick(3)].w; break;
        default: /* the whole triangle nearer or farther away */
            for (double by = exp2(uniform(-2, 2)), i = 0; i < 3; i++) {
                uint32_t *w = &c->v[(int)i].w;
                *w = (uint32_t)fmin(0x80000000, fmax(1, *w * by));
            }
        }
    }
    if (pick(50) == 0) choose_picture(c);
}

/* Large pictures are judged in part on the way there. */
static worst_verdict look(const worst_case *c)
{
    worst_verdict v = worst_judge(c, 1 + c->width * c->height / 4 / JUDGED);
    return v;
}

/* One climb from the worst of a few; the number of triangles drawn. */
static long climb(const char *way, worst_case *best, worst_verdict *used)
{
    worst_case c = { .way = way };
    long drawn = 0;
    used->used = -2;
    for (; drawn < FIRST; drawn++) {
        choose(&c);
        worst_verdict v = look(&c);
        if (v.used > used->used) *best = c, *used = v;
    }
    for (int failed = 0; failed < PATIENCE; failed++, drawn++) {
        c = *best;
        change(&c);
        worst_verdict v = look(&c);
        if (v.used < used->used) continue;
        if (v.used > used->used) failed = 0;
        *best = c, *used = v;
    }
    return drawn;
}

/* Returns whether the promise was broken. */
static int search(const char *way, long tries)
{
    worst_case best = { .way = way };
    worst_verdict used = { -2, 0, 0, 0, 0 };
    for (long drawn = 0, number = 0; drawn < tries; number++) {
        worst_case c;
        worst_verdict v;
        test_restart((uint64_t)number);
        drawn += climb(way, &c, &v);
        if (v.used > used.used) best = c, used = v;
        if (isatty(STDERR_FILENO)) fprintf(stderr, "\r\033[K%s: %ld of %ld, %.3f", way, drawn, tries, used.used);
    }
    if (isatty(STDERR_FILENO)) fprintf(stderr, "\r\033[K");
    used = worst_judge(&best, 1);
    worst_print(&best, &used);
    if (used.used > 1) printf("/* BROKEN: pixel %d %d: drawn %.6f, exact %.6f */\n", used.x, used.y, used.drawn, used.exact);
    fflush(stdout);
    return used.used > 1;
}

int main(int argc, char **argv)
{
    long tries = 20000;
    int first = 1, broken = 0, asked = 0;
    if (argc > 2 && strcmp(argv[1], "--tries") == 0) tries = strtol(argv[2], NULL, 10), first = 3;
    if (tries <= 0) {
        fprintf(stderr, "usage: search_worst [--tries N] [WAY ...]\n");
        return 2;
    }
    for (int k = 0; k <= PROMISE_WAYS; k++) {
        const char *name = k < PROMISE_WAYS ? promise_ways[k].name : "depth";
        int wanted = first >= argc;
        for (int i = first; i < argc; i++) wanted = wanted || strcmp(argv[i], name) == 0;
        asked += wanted;
        if (wanted) broken |= search(name, tries);
    }
    if (!asked) fprintf(stderr, "search_worst: %s: no such way to draw\n", argv[first]);
    return asked ? broken : 2;
}
