/* Triangle set-up: which rung, and the planes of 1/z, of attributes over z, or of attributes.
 *
 * Edges are made of snapped positions and are exact. Planes are made of the finer positions,
 * q20.12: a silhouette triangle can gain thousands of depth units over one pixel, and there
 * a snap of 1/512 px would already be wrong by several.
 *
 * Most triangles are narrow: of moderate size, not slivers, 1/z within a factor of four. Four
 * gradients of barycentric weights in 32 bits make all their planes. Every other triangle is
 * wide: exact 64-bit numerators over one reciprocal of the area, in arithmetic modulo 2^64.
 * docs/error-bound.md has the errors of both.
 *
 * Source: K.-L. Low, "Perspective-Correct Interpolation", 2002, equations 12 and 16:
 * 1/z and (attribute)/z are linear on the screen. Plane coefficients: docs/conventions.md.
 */
#include "loops.h"
#include "run.h"

static uint32_t larger(uint32_t a, uint32_t b) { return a > b ? a : b; }
static uint32_t smaller(uint32_t a, uint32_t b) { return a < b ? a : b; }

/* ---- corners ---- */

/* From the differences, with corner 0 at (x, y). */
static EW_OWN_FRAME void basis_init(ew_basis *b, int32_t x, int32_t y, const ew_corners *c)
{
    b->area = ew_mul_s32(b->dx1, b->dy2) - ew_mul_s32(b->dx2, b->dy1);
    b->reach = larger(larger(ew_abs32(b->dx1), ew_abs32(b->dx2)), larger(ew_abs32(b->dy1), ew_abs32(b->dy2)));
    b->to_x = c->x0 * 4096 + 2048 - x;
    b->to_y = c->y0 * 4096 + 2048 - y;
}

static void basis_of_vertices(ew_basis *b, const ew_corners *c)
{
    const int32_t x = c->v[0]->x, y = c->v[0]->y;
    b->dx1 = c->v[1]->x - x, b->dy1 = c->v[1]->y - y;
    b->dx2 = c->v[2]->x - x, b->dy2 = c->v[2]->y - y;
    basis_init(b, x, y, c);
}

static void basis_of_snapped(ew_basis *b, const ew_corners *c)
{
    const int32_t x = ew_q20_12_from_snapped(c->x[0]), y = ew_q20_12_from_snapped(c->y[0]);
    b->dx1 = ew_q20_12_from_snapped(c->x[1]) - x, b->dy1 = ew_q20_12_from_snapped(c->y[1]) - y;
    b->dx2 = ew_q20_12_from_snapped(c->x[2]) - x, b->dy2 = ew_q20_12_from_snapped(c->y[2]) - y;
    basis_init(b, x, y, c);
}

/* ---- narrow triangles ---- */

/* Whether 32 bits will do. With L the box and h the height of the triangle: L below 256 px,
 * h at least L/8 and 1/8 px; 1/z within a factor of four; and what steps of 32 bits lose over
 * all of its rows and columns is at most 1/256 texel (docs/error-bound.md). */
static int is_narrow(const ew_basis *b, const ew_corners *c, uint32_t w_min, uint32_t w_max, int bits)
{
    const uint32_t steps = (uint32_t)c->steps; /* not those in the scissor: a band must not decide; <= 2^20 */
    return b->reach < UINT32_C(1) << 20 && w_max / 4 <= w_min &&
           (b->area > 0) == c->positive &&
           ew_abs64(b->area) >= (uint64_t)ew_mul_u32(b->reach, b->reach / 8 + 512) &&
           (uint64_t)(3 * steps + 16) << bits <= (uint64_t)w_min << 2; /* 2^11 2^27, of 256 px */
}

static EW_OWN_FRAME void weights_init(ew_weights *g, const ew_basis *b)
{
    int up = ew_clz32(b->reach) - 1;
    uint64_t area = ew_abs64(b->area);
    int zeros = ew_clz64(area);
    //@ split up;
    /*@ assert narrow_basis: 11 <= up <= 30 && up + 12 <= zeros <= up + 24 &&
          -(1 << 31 - up) < b->dx1 < 1 << 31 - up && -(1 << 31 - up) < b->dy1 < 1 << 31 - up &&
          -(1 << 31 - up) < b->dx2 < 1 << 31 - up && -(1 << 31 - up) < b->dy2 < 1 << 31 - up &&
          -(1 << 21) < b->to_x < 1 << 21 && -(1 << 21) < b->to_y < 1 << 21; */
    int32_t r = (int32_t)(ew_recip_newton((uint32_t)((area << zeros) >> 32)) - 1u); /* 1/area = r 2^(zeros - 94), < 2^31 */
    if (b->area < 0) r = ew_wrap_sub32(0, r); /* r >= 2^30 - 1 */
    /* d 2^up < 2^31 */
    g->x1 = ew_mulh_s32(b->dy2 * ((int32_t)1 << up), r);
    g->x2 = ew_mulh_s32(-b->dy1 * ((int32_t)1 << up), r);
    g->y1 = ew_mulh_s32(-b->dx2 * ((int32_t)1 << up), r);
    g->y2 = ew_mulh_s32(b->dx1 * ((int32_t)1 << up), r);
    /* d / area = weight 2^(zeros - 94 + 32 - up); 2^12 more for a pixel */
    g->shift = 50 - zeros + up;
    /* a pixel within a pixel of the box: at most 16 heights away */
    g->there1 = (int32_t)EW_ASR(ew_mul_s32(g->x1, b->to_x) + ew_mul_s32(g->y1, b->to_y), g->shift - 14); /* 2^30 2^21 */
    g->there2 = (int32_t)EW_ASR(ew_mul_s32(g->x2, b->to_x) + ew_mul_s32(g->y2, b->to_y), g->shift - 14);
}

/* |d| < 2^31. */
static void plane32_init(ew_plane32 *p, const ew_weights *g, uint32_t a0, int32_t d1, int32_t d2)
{
    p->row = a0 + (uint32_t)EW_ASR(ew_mul_s32(d1, g->there1) + ew_mul_s32(d2, g->there2), 26);
    p->dx = (uint32_t)EW_ASR(ew_mul_s32(d1, g->x1) + ew_mul_s32(d2, g->x2), g->shift);
    p->dy = (uint32_t)EW_ASR(ew_mul_s32(d1, g->y1) + ew_mul_s32(d2, g->y2), g->shift);
}

static void narrow_planes(ew_triangle *t, ew_weights *g, const ew_basis *b, const ew_differences *of)
{
    weights_init(g, b);
    for (int i = 0; i <= t->attributes; i++) {
        plane32_init(&t->plane.narrow[i], g, of->a0[i], of->d[i][0], of->d[i][1]);
    }
}

/* ---- wide triangles ---- */

/* The numerators of a plane's gradients per 1/4096 px. */
typedef struct numerators {
    int64_t x, y; /* |.| <= 2^62 */
} numerators;

/* d1 and d2 are the quantity's differences from corner 0, |d| < 2^31. */
static numerators numerators_of(const ew_basis *b, int32_t d1, int32_t d2)
{
    numerators n;
    n.x = ew_mul_s32(d1, b->dy2) - ew_mul_s32(d2, b->dy1);
    n.y = ew_mul_s32(d2, b->dx1) - ew_mul_s32(d1, b->dx2);
    if (b->area < 0) n.x = -n.x, n.y = -n.y;
    return n;
}

/* Whether the plane, evaluated up to a snap's width (half a subpixel each way) outside of
 * its triangle, stays within `limit` of the corners' values. limit <= 2^30. */
static int stays_near(const ew_basis *b, const numerators *n, uint32_t limit)
{
    /* (|nx| + |ny|) snap <= limit area, snap = 2^(11 - S) units of q20.12; both sides are
     * shifted so that the area keeps at most 32 bits, the left side rounded up */
    uint64_t area = ew_abs64(b->area);
    int shift = ew_clz64(area) < 32 ? 32 - ew_clz64(area) : 0;
    uint64_t sum = ew_abs64(n->x) + ew_abs64(n->y);                   /* <= 2^63 */
    uint64_t allowed = ew_mul_u32((uint32_t)(area >> shift), limit);  /* <= 2^62 */
    return (sum >> shift) + 1 <= allowed >> (11 - EW_SUBPIXEL_BITS);
}

/* n / area as a fraction of 2^64 where a unit of n is 2^-32: floor(n 2^32 / area), modulo
 * 2^64. The reciprocal's error, below 2^-29, scales all gradients of the triangle alike:
 * it moves a value by 2^-29 of its distance to corner 0's. 1/area = r 2^(zeros - 94). */
static uint64_t over_area(int64_t n, uint32_t r, int zeros)
{
    /* n = h 2^32 + l: n r = t 2^32 + low, exact in 96 bits; |h r| <= 2^61. */
    uint64_t low = ew_mul_u32((uint32_t)(uint64_t)n, r);
    int64_t t = (int64_t)(int32_t)EW_ASR(n, 32) * (int64_t)r + (int64_t)(low >> 32);
    int shift = 62 - zeros; /* -1 (area 1) to 60 */
    if (shift >= 32) return (uint64_t)EW_ASR(t, shift - 32);
    if (shift > 0) return ((uint64_t)t << (32 - shift)) | ((uint32_t)low >> shift);
    return ((uint64_t)t << 32 | (uint32_t)low) << -shift;
}

static void plane64_init(ew_plane64 *p, const ew_basis *b, uint32_t r, int zeros, uint32_t a0, int32_t d1, int32_t d2)
{
    const numerators n = numerators_of(b, d1, d2);
    uint64_t gx = over_area(n.x, r, zeros), gy = over_area(n.y, r, zeros);
    p->row = ((uint64_t)a0 << 32) + ew_wrap_mul64(gx, b->to_x) + ew_wrap_mul64(gy, b->to_y);
    p->dx = gx << 12;
    p->dy = gy << 12;
}

/* Where the finer positions' planes could leave the values of the corners too far, those of
 * the snapped ones are taken instead, which are never evaluated outside. */
static EW_OWN_FRAME void wide_planes(ew_triangle *t, ew_basis *b, const ew_corners *c, const ew_differences *of, uint32_t w_min)
{
    int near_enough = b->area != 0 && (b->area > 0) == c->positive;
    /* as much again as attributes have at the farthest corner */
    uint32_t attribute_limit = t->rung == EW_RUNG_AFFINE ? UINT32_C(1) << EW_BITS_MOST : w_min / 8;
    for (int i = 0; i <= t->attributes && near_enough; i++) {
        const numerators n = numerators_of(b, of->d[i][0], of->d[i][1]);
        near_enough = stays_near(b, &n, i == EW_PLANE_W ? w_min / 4 : attribute_limit);
    }
    if (!near_enough) basis_of_snapped(b, c);
    uint64_t area = ew_abs64(b->area);
    if (area == 0) area = 1; /* never: placing found that of the snapped corners not to be 0 */
    int zeros = ew_clz64(area);
    uint32_t r = ew_recip_newton((uint32_t)((area << zeros) >> 32));
    for (int i = 0; i <= t->attributes; i++) {
        plane64_init(&t->plane.wide[i], b, r, zeros, of->a0[i], of->d[i][0], of->d[i][1]);
    }
}

/* ---- affine triangles ---- */

/* Whether planes of 32 bits will do for the affine rung, and u and v packed: steps over all rows and columns lose
 * at most 1/128 texel as in steps_suffice (span.c), and packed ones 1/256. */
static int may_be_packed(const ew_triangle *t, const ew_corners *c)
{
    return t->walk == WALK_TEXTURE && t->rung == EW_RUNG_AFFINE && c->steps <= EW_LONGEST_RUN &&
           (uint32_t)c->steps << (t->uv_bits - EW_BITS_LEAST) <= UINT32_C(1) << (32 - EW_BITS_LEAST); /* 2^8 2^8 */
}

/* The upper halves of wide planes, in place. */
static void narrow_down(ew_triangle *t)
{
    for (int i = 0; i <= t->attributes; i++) { /* each lies at or in front of what it is made of */
        const ew_plane64 wide = t->plane.wide[i];
        t->plane.narrow[i] = (ew_plane32){ (uint32_t)(wide.row >> 32), (uint32_t)(wide.dx >> 32), (uint32_t)(wide.dy >> 32) };
    }
    t->is_wide = 0;
}

/* ---- the ladder ---- */

/* Never below the true length, at most 12 % above it; q20.12. */
static uint32_t length_of(uint32_t dx, uint32_t dy)
{
    dx = ew_abs32((int32_t)dx), dy = ew_abs32((int32_t)dy); /* <= 2^31 */
    return dx > dy ? dx + dy / 2 : dy + dx / 2;
}

static void sides_init(ew_sides *s, const ew_basis *b, const ew_raster_vertex *const v[3])
{
    s->dx[0] = b->dx1, s->dy[0] = b->dy1;
    s->dx[1] = b->dx2, s->dy[1] = b->dy2;
    s->dx[2] = ew_wrap_sub32(b->dx2, b->dx1), s->dy[2] = ew_wrap_sub32(b->dy2, b->dy1); /* <= 2^30: between two corners, too */
    s->dw[0] = (int32_t)(v[1]->w - v[0]->w); /* |dw| < 2^31 */
    s->dw[1] = (int32_t)(v[2]->w - v[0]->w);
    s->dw[2] = (int32_t)(v[2]->w - v[1]->w);
    for (int i = 0; i < 3; i++) s->length[i] = length_of((uint32_t)s->dx[i], (uint32_t)s->dy[i]);
}

/* With V = (the difference of 1/z) (that of positions) for each side, drawing attributes linearly
 * over a whole triangle displaces them by V / 4 w_min at most, and always along V. So they may be
 * drawn moved the other way by a share of the longest V: the displacement is then within the hull
 * of these combinations of V_ij, the longest, of V_ik and of V_kj, with i nearer than j, over
 * 64 w_min (docs/error-bound.md). */
static const int8_t moved_hull[][3] = { { -9, 17, 0 }, { -7, 0, 16 }, { 9, 0, 0 }, { -7, 16, 0 }, { -7, 17, -2 } };

/* Whether that hull lies within the tolerance, 4 t w_min = `allowed`; |V| is at most twice as large. */
static int hull_is_within(const ew_sides *s, int longest, uint64_t allowed)
{
    const int down = 54 - ew_clz64(allowed);
    //@ split longest;
    if (down < 0) return 0;
    /* a and b are the corners of the longest side, k is the third */
    const int a = longest > 1, b = longest > 0 ? 2 : 1, k = 2 - longest;
    const int i = s->dw[longest] < 0 ? a : b, j = a + b - i;
    const int side[3] = { longest, i + k - 1, j + k - 1 };
    uint32_t x[3], y[3]; /* signed ones, whose sums and products are taken modulo 2^32 */
    for (int n = 0; n < 3; n++) { /* of `allowed` 10 bits are left: 2^11 */
        x[n] = (uint32_t)EW_ASR(ew_mul_s32(s->dx[side[n]], s->dw[side[n]]), down);
        y[n] = (uint32_t)EW_ASR(ew_mul_s32(s->dy[side[n]], s->dw[side[n]]), down);
    }
    const uint32_t most = ((uint32_t)(allowed >> down) - 3u) * 16u; /* x and y are off by 1: 26 at most; 2^14 */
    for (unsigned n = 0; n < sizeof moved_hull / sizeof *moved_hull; n++) {
        const uint32_t of[3] = { (uint32_t)moved_hull[n][0], (uint32_t)moved_hull[n][1], (uint32_t)moved_hull[n][2] };
        const uint32_t mx = of[0] * x[0] + of[1] * x[1] + of[2] * x[2]; /* 26 2^11 in any direction: */
        const uint32_t my = of[0] * y[0] + of[1] * y[1] + of[2] * y[2]; /* the squares' sum is below 2^31.5 */
        if (mx * mx + my * my > most * most) return 0;
    }
    return 1;
}

/* Whether attributes drawn linearly over the whole triangle are displaced by at most the
 * tolerance, and how they are moved for that. */
static int affine_suffices(ew_affine_move *by, const ew_sides *s, uint32_t tolerance, uint32_t w_min, uint32_t w_max)
{
    const uint64_t allowed = ew_mul_u32(w_min, UINT32_C(1024) * tolerance); /* q12: 2^31 2^18 */
    uint64_t most = 0;
    by->side = 0;
    for (int i = 0; i < 3; i++) {
        const uint64_t product = ew_mul_u32(s->length[i], ew_abs32(s->dw[i])); /* 2^31.6 2^31 */
        if (product > most) most = product, by->side = (uint8_t)i;
    }
    if (most <= allowed) return 1;
    if (most > 2 * allowed || w_max - w_min > w_min / 8 + w_min / 16) return 0;
    if (!hull_is_within(s, by->side, allowed)) return 0;
    /* 7 |dw| / 64 w_min of 2^32; 1 / w_min = r 2^zeros / 2^62 */
    const int zeros = ew_clz32(w_min);
    const int32_t dw = s->dw[by->side];
    const uint32_t share = ew_mulh_u32(ew_abs32(dw) << zeros, ew_recip_table(w_min << zeros)) * 7u >> 4; /* 2^28 7 */
    by->share = dw < 0 ? -(int32_t)share : (int32_t)share;
    return 1;
}

/* Whether any point of the triangle is within the tolerance of every other. */
static int constant_suffices(const ew_sides *s, uint32_t tolerance)
{
    const uint32_t t = tolerance * 256u;
    return s->length[0] <= t && s->length[1] <= t && s->length[2] <= t;
}

static EW_OWN_FRAME uint8_t choose_rung(ew_raster *raster, const ew_raster_vertex *const v[3], uint32_t w_min,
                                        uint32_t w_max, uint8_t per_pixel)
{
    const ew_material *m = &raster->material;
    ew_sides *s = &raster->work.now.setup.sides;
    if (m->rung != EW_RUNG_AUTO) return m->rung;
    sides_init(s, &raster->work.now.setup.basis, v);
    if (m->tolerance > 0 && raster->texture.levels <= 1 && constant_suffices(s, m->tolerance)) return EW_RUNG_CONSTANT;
    if (affine_suffices(&raster->work.now.setup.move, s, m->tolerance, w_min, w_max)) return EW_RUNG_AFFINE;
    return m->tolerance > 0 ? EW_RUNG_RUNS : per_pixel;
}

/* A run of N pixels is displaced by at most N^2 |dw| / (4 w) (docs/error-bound.md). The
 * largest N is the root of 4 t w / |dw|; run.h takes (16 N)^2 as
 * (w' / 2^15) run_scale 2^run_exponent. |dw| = m 2^-zeros, m normalised; 0 for m = 0. */
static void run_scale_init(ew_triangle *t, uint32_t m, int zeros, uint32_t tolerance)
{
    t->run_scale = 0xFFFF; /* as long as they may be */
    t->run_exponent = 100;
    t->run_shift = 0;
    if (m == 0 || t->rung != EW_RUNG_RUNS) return;
    if (tolerance == 0) { /* no run at all */
        t->run_scale = 0;
        return;
    }
    /* 64 tolerance / |dw| = 64 k 2^15 2^zeros / 2^62 */
    uint32_t k = (ew_recip_table(m) >> 15) * tolerance; /* < 2^25; tolerance > 0, r > 2^30 */
    int up = ew_clz32(k);
    t->run_scale = (uint16_t)(((k << up) >> 16) - 1u); /* less than the table's error: 2^-17 */
    t->run_exponent = (int16_t)(zeros - up - 10);
    if (t->run_exponent < 0) t->run_shift = (uint8_t)smaller((uint32_t)-t->run_exponent, 31);
}

/* How many pixels of a wide triangle steps of 32 bits will do for, from where w' is smallest:
 * steps_suffice in span.c. */
static uint32_t sure_steps(const ew_triangle *t, uint32_t w_min)
{
    const uint32_t n = t->rung == EW_RUNG_AFFINE ? UINT32_C(1) << (32 - t->uv_bits) :
                                                   w_min >> (t->uv_bits - 1); /* n 2^bits <= 2 w' */
    return smaller(n, EW_LONGEST_RUN);
}

/* Up to how many pixels no span has to be asked whether it may be filled in one go. Outside
 * of the fine triangle w' is at least 3/4 of the corners' smallest, and a run's far end may be
 * one step beyond its own. dw is the step's size, a fraction of 2^64. */
static uint16_t sure_run_of(const ew_triangle *t, uint64_t dw, uint32_t w_min)
{
    uint32_t most = t->is_wide ? sure_steps(t, w_min - w_min / 4) : EW_LONGEST_RUN;
    if (t->rung == EW_RUNG_AFFINE) return (uint16_t)most;
    if (t->rung == EW_RUNG_RUNS) {
        const uint32_t step = (uint32_t)(dw >> 32) + 1u;
        const uint32_t far_end = w_min - w_min / 4 > step ? w_min - w_min / 4 - step : 0;
        const uint32_t n = ew_root16((far_end >> 15) * t->run_scale, t->run_exponent) >> 4;
        most = smaller(n, most);
    }
    return (uint16_t)smaller(most, t->longest);
}

static uint16_t longest_of(const ew_triangle *t, const ew_raster *raster)
{
    if (t->rung == EW_RUNG_RUNS_8) return 8;
    if (t->rung == EW_RUNG_RUNS_16) return 16;
    if (t->rung == EW_RUNG_RUNS_32) return 32;
    if (raster->texture.levels > 1) return 16; /* the level of a mip chain is a run's */
    /* a slope is off by at most half a unit: over the longest run by 1/128 texel */
    const int fraction = EW_FRACTION(t->uv_bits);
    return (uint16_t)(fraction < 15 ? UINT32_C(1) << (fraction - 6) : EW_LONGEST_RUN);
}

static void runs_init(ew_triangle *t, const ew_raster *raster, uint32_t w_min, uint8_t newton)
{
    const uint64_t dw = t->is_wide ? ew_abs64((int64_t)t->plane.wide[EW_PLANE_W].dx) :
                                     (uint64_t)ew_abs32((int32_t)t->plane.narrow[EW_PLANE_W].dx) << 32;
    const int automatic = raster->material.rung == EW_RUNG_AUTO;
    t->run_tolerance = t->sure_run = t->shortest = 0;
    if (t->walk == WALK_PACKED) return;
    if (t->rung == EW_RUNG_TABLE || t->rung == EW_RUNG_EXACT) {
        /* where 1/z does not change along rows, a run is exact whatever its length */
        if (dw != 0 || !automatic) return;
        t->rung = EW_RUNG_RUNS;
        t->newton = newton;
    }
    if (t->rung == EW_RUNG_AFFINE) t->sure_run = sure_run_of(t, dw, w_min);
    if (t->rung == EW_RUNG_AFFINE || t->rung == EW_RUNG_CONSTANT) return;
    t->longest = longest_of(t, raster);
    /* an explicit rung is taken at its word, but for runs of one pixel */
    t->shortest = automatic ? (uint16_t)larger(raster->shortest_run, 2) : 2;
    if (t->rung == EW_RUNG_RUNS) t->run_tolerance = raster->material.tolerance;
    const int zeros = dw ? ew_clz64(dw) : 0;
    run_scale_init(t, (uint32_t)((dw << zeros) >> 32), zeros, raster->material.tolerance);
    t->sure_run = sure_run_of(t, dw, w_min);
    if (t->walk == WALK_TEXTURE && !t->newton && t->rung != EW_RUNG_TABLE && t->run_scale > 0) t->walk = WALK_RUNS;
}

/* ---- attributes ---- */

/* Units of q20.12 that corners may be apart for the table to be off by 1/1024 texel (fixed.h has its errors),
 * and how many of these e has room for, pixel by pixel and in runs (docs/error-bound.md). */
#define TABLE_REACH (UINT32_C(4096) * (EW_RECIP_BITS == 4 ? 2 : EW_RECIP_BITS == 5 ? 7 : EW_RECIP_BITS == 6 ? 30 : \
                                       EW_RECIP_BITS == 7 ? 92 : 128))
enum { OF_PIXELS = 11, OF_RUNS = 6 };

/* d w' / 2^(3 + bits), |d| < 2^bits; or d itself with its fraction bits for the affine rung. */
static int32_t attribute(int32_t d, uint32_t w, int bits, int affine)
{
    //@ split bits;
    //@ assert within_bits: -(1 << bits) < d < 1 << bits;
    if (affine) return d * ((int32_t)1 << (EW_BITS_MOST - bits));
    return EW_ASR(ew_mulh_s32(d * ((int32_t)1 << (31 - bits)), (int32_t)w), 2); /* d w' 2^(31 - bits - 32 - 2) */
}

/* What the affine rung has at corner 0 instead of 0, from the differences of corners 1 and 2. */
static uint32_t moved(const int32_t d[2], const ew_affine_move *by)
{
    if (by->share == 0) return 0;
    const int32_t along = by->side == 0 ? d[0] : by->side == 1 ? d[1] : d[1] - d[0];
    return (uint32_t)ew_mulh_s32(along, by->share);
}

static uint8_t plainness(const ew_raster *raster, uint32_t w_min, uint32_t w_max)
{
    if (raster->loop != LOOP_TEXTURED) return PLAIN_NEVER;
    /* what lies outside of the corners (stays_near), and steps' rounding */
    return w_min >= 65536u && w_max <= 0x50000000u ? PLAIN_ALWAYS : PLAIN_SOMETIMES;
}

/* 256 is all of a channel; q20.12. */
static int32_t shade_of(uint8_t c) { return ((int32_t)c + (c >> 7)) * 4096; }

/* Attribute planes' values at the corners; the origin of each. */
static void textured(ew_triangle *t, ew_differences *of, const ew_raster *raster, const ew_corners *c, const uint32_t w[3],
                     int affine)
{
    int u_align = 32 - raster->log2_width, v_align = 32 - raster->log2_height; /* 21 at least */
    const ew_raster_vertex *a = c->v[0];
    t->u_shift = (uint8_t)(u_align - EW_FRACTION(t->uv_bits));
    t->v_shift = (uint8_t)(v_align - EW_FRACTION(t->uv_bits));
    t->u_base = (uint32_t)a->u << (u_align - 12);
    t->v_base = (uint32_t)a->v << (v_align - 12);
    t->u_origin = a->u;
    t->v_origin = a->v;
    for (int k = 0; k < 2; k++) {
        const ew_raster_vertex *b = c->v[k + 1];
        of->d[EW_PLANE_U][k] = attribute(b->u - a->u, w[k + 1], t->uv_bits, affine);
        of->d[EW_PLANE_V][k] = attribute(b->v - a->v, w[k + 1], t->uv_bits, affine);
    }
}

static void shaded(ew_triangle *t, ew_differences *of, const ew_corners *c, const uint32_t w[3], int affine)
{
    for (int k = 0; k < 3; k++) {
        const ew_colour888 *colour = &c->v[k]->colour;
        const int32_t shade[3] = { shade_of(colour->r), shade_of(colour->g), shade_of(colour->b) };
        for (int i = 0; i < 3; i++) {
            if (k == 0) t->shade_origin[i] = shade[i];
            else of->d[EW_PLANE_SHADE + i][k - 1] = attribute(shade[i] - t->shade_origin[i], w[k], EW_SHADE_BITS, affine);
        }
    }
}

/* w', of 31 bits. */
static uint32_t scaled(uint32_t w, int lead) { return (w << lead) >> 1; }

/* Planes begin at the box's first pixel and are taken from there in whole steps: wherever a scissor cuts, the
 * bits are the same. */
int ew_setup(ew_raster *raster)
{
    ew_triangle *t = &raster->work.triangle;
    const ew_corners *c = &raster->work.corners;
    ew_differences *of = &raster->work.now.setup.differences;
    ew_basis *b = &raster->work.now.setup.basis;
    uint32_t *w = raster->work.now.setup.w; /* below 2^31 / 1.5: outside of the corners w may exceed the largest by a quarter */
    EW_KEEP_ORDER(t);
    EW_KEEP_ORDER(c);
    EW_KEEP_ORDER(of);
    EW_KEEP_ORDER(b);
    EW_KEEP_ORDER(w);
    const ew_raster_vertex *const *v = c->v;
    const int has_texture = raster->texture.texels != NULL, has_shades = (raster->material.flags & EW_SHADED) != 0;
    uint32_t w_max = larger(larger(v[0]->w, v[1]->w), v[2]->w), w_min = smaller(smaller(v[0]->w, v[1]->w), v[2]->w);
    //@ split has_shades;
    //@ split has_texture;
    t->attributes = (uint8_t)(has_shades ? 5 : has_texture ? 2 : 0);
    t->uv_bits = has_shades ? EW_SHADE_BITS : EW_BITS_LEAST;
    uint32_t reach = has_shades ? UINT32_C(256) * 4096u : 0;
    if (has_texture) {
        for (int k = 1; k < 3; k++) { /* |u| < 2^30 */
            reach = larger(reach, larger(ew_abs32(v[k]->u - v[0]->u), ew_abs32(v[k]->v - v[0]->v)));
        }
        int bits = 32 - ew_clz32(reach);
        if (bits > EW_BITS_MOST) return EW_ERR_RANGE;
        if (bits > t->uv_bits) t->uv_bits = (uint8_t)bits;
    }
    basis_of_vertices(b, c);
    raster->work.now.setup.move.share = 0;
    const uint8_t per_pixel = reach <= OF_PIXELS * TABLE_REACH ? EW_RUNG_TABLE : EW_RUNG_EXACT;
    const uint8_t newton_in_runs = reach > OF_RUNS * TABLE_REACH;
    t->rung = t->attributes ? choose_rung(raster, v, w_min, w_max, per_pixel) : EW_RUNG_CONSTANT;
    t->newton = t->rung == EW_RUNG_EXACT || (t->rung != EW_RUNG_TABLE && newton_in_runs);

    t->w_lead = (uint8_t)smaller((uint32_t)ew_clz32(w_max + w_max / 2), 24);
    w[0] = scaled(v[0]->w, t->w_lead), w[1] = scaled(v[1]->w, t->w_lead), w[2] = scaled(v[2]->w, t->w_lead);
    const uint32_t least = scaled(w_min, t->w_lead), most = scaled(w_max, t->w_lead);
    of->d[EW_PLANE_W][0] = (int32_t)w[1] - (int32_t)w[0], of->d[EW_PLANE_W][1] = (int32_t)w[2] - (int32_t)w[0];
    const int affine = t->rung == EW_RUNG_AFFINE;
    if (has_texture) textured(t, of, raster, c, w, affine);
    else of->d[EW_PLANE_U][0] = of->d[EW_PLANE_V][0] = of->d[EW_PLANE_U][1] = of->d[EW_PLANE_V][1] = 0;
    if (has_shades) shaded(t, of, c, w, affine);
    of->a0[EW_PLANE_W] = w[0];
    for (int i = EW_PLANE_U; i <= t->attributes; i++) of->a0[i] = moved(of->d[i], &raster->work.now.setup.move);
    t->plain = plainness(raster, w_min, w_max);
    if (t->rung == EW_RUNG_CONSTANT) t->attributes = 0; /* corner 0's are taken everywhere */

    t->walk = t->plain == PLAIN_ALWAYS && t->attributes == 2 ? WALK_TEXTURE : WALK_ANY;
    t->column = (uint16_t)c->from;
    t->is_wide = (uint8_t)!is_narrow(b, c, least, most, t->uv_bits);
    if (t->is_wide) wide_planes(t, b, c, of, least);
    else narrow_planes(t, &raster->work.now.setup.weights, b, of);
    if (may_be_packed(t, c)) {
        if (t->is_wide) narrow_down(t);
        t->walk = WALK_PACKED;
        ew_planes_pack(t, &raster->work.packing);
    }
    if (c->from > c->x0 || c->first > c->y0) ew_planes_go(t, (uint32_t)(c->from - c->x0), (uint32_t)(c->first - c->y0));
    runs_init(t, raster, least, newton_in_runs);
    return EW_OK;
}
