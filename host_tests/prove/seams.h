/* What the parts of src/raster/ promise each other, once as what a part may find (any_...), for the
 * run that proves the part, and once as what has to hold (check_...), for the run that proves the
 * part before it. */
#ifndef EW_PROVE_SEAMS_H
#define EW_PROVE_SEAMS_H

#include "../../src/raster/loops.h"
#include "unknown.h"

enum { SNAPPED_LOG2 = 17 + EW_SUBPIXEL_BITS };

static inline void check_snapped(ew_snapped a)
{
    //@ assert snapped: -(1 << SNAPPED_LOG2) <= a <= (1 << SNAPPED_LOG2);
}

static inline void any_vertex(ew_raster_vertex *v)
{
    const int32_t guard = EW_GUARD_PX * 4096, uv = (INT32_C(1) << 30) - 1;
    v->x = between(-guard, guard), v->y = between(-guard, guard);
    v->w = (uint32_t)Frama_C_unsigned_long_interval(1, 0x80000000u);
    v->u = between(-uv, uv), v->v = between(-uv, uv);
    v->colour.r = any8(), v->colour.g = any8(), v->colour.b = any8();
}
static inline void check_vertex(const ew_raster_vertex *v)
{
    //@ assert position: -(1 << 29) <= v->x <= (1 << 29) && -(1 << 29) <= v->y <= (1 << 29);
    //@ assert attributes: 0 < v->w <= 0x80000000 && -(1 << 30) < v->u < (1 << 30) && -(1 << 30) < v->v < (1 << 30);
}

static uint16_t one_texel[1], one_pixel[1];

/* A context that the entry functions let through. Its memory is none of the concern of who uses this. */
static inline void any_context(ew_raster *raster)
{
    const uint16_t height = (uint16_t)between(1, 4096), width = (uint16_t)between(1, 4096);
    any_bytes(raster, sizeof *raster);
    raster->target.colour = one_pixel;
    raster->target.depth = perhaps(one_pixel);
    raster->target.width = width, raster->target.height = height;
    raster->scissor.x0 = (uint16_t)between(0, 4096), raster->scissor.x1 = (uint16_t)between(0, 4096);
    raster->scissor.y0 = (uint16_t)between(0, 4096), raster->scissor.y1 = (uint16_t)between(0, 4096);
    raster->material.texture = perhaps(&raster->texture);
    raster->texture.texels = perhaps(one_texel);
    raster->material.tolerance = (uint16_t)any_of(EW_TOLERANCE_MAX + 1);
    raster->material.rung = (uint8_t)any_of(EW_RUNG_COUNT);
    raster->texture.levels = (uint8_t)any_of(EW_LEVELS_MAX + 1);
    raster->log2_width = (uint8_t)any_of(12), raster->log2_height = (uint8_t)any_of(12);
    raster->loop = (uint8_t)any_of(LOOP_COUNT);
}

static inline void check_context(const ew_raster *raster)
{
    //@ assert scissor: raster->scissor.x0 <= 4096 && raster->scissor.x1 <= 4096;
    //@ assert scissor_rows: raster->scissor.y0 <= 4096 && raster->scissor.y1 <= 4096;
    //@ assert texture: raster->material.texture == \null || raster->material.texture == &raster->texture;
    //@ assert material: raster->material.rung < EW_RUNG_COUNT && raster->material.tolerance <= EW_TOLERANCE_MAX;
    //@ assert levels: raster->texture.levels <= EW_LEVELS_MAX;
    //@ assert logarithms: raster->log2_width <= 11 && raster->log2_height <= 11 && raster->loop < LOOP_COUNT;
}

/* ---- work.corners, as ew_setup finds them ---- */

static inline void any_corners(ew_raster *raster)
{
    static ew_raster_vertex v[3];
    ew_corners *c = &raster->work.corners;
    for (int i = 0; i < 3; i++) {
        any_vertex(&v[i]);
        c->v[i] = &v[i];
        c->x[i] = between(-(INT32_C(1) << SNAPPED_LOG2), INT32_C(1) << SNAPPED_LOG2);
        c->y[i] = between(-(INT32_C(1) << SNAPPED_LOG2), INT32_C(1) << SNAPPED_LOG2);
    }
    c->x0 = between(-(INT32_C(1) << 17), INT32_C(1) << 17), c->y0 = between(-(INT32_C(1) << 17), INT32_C(1) << 17);
    c->steps = between(-(INT32_C(1) << 20), INT32_C(1) << 20);
    c->first = between(0, 4095), c->end = between(1, 4096);
    c->from = between(0, 4095), c->to = between(1, 4096);
    c->positive = (uint8_t)any_of(2);
}
static inline void check_corners(const ew_raster *raster)
{
    const ew_corners *c = &raster->work.corners;
    for (int i = 0; i < 3; i++) {
        check_vertex(c->v[i]);
        check_snapped(c->x[i]), check_snapped(c->y[i]);
    }
    //@ assert box: 0 <= c->first < 4096 && 0 < c->end <= 4096 && 0 <= c->from < 4096 && 0 < c->to <= 4096;
    /*@ assert box_in_scissor: c->first >= raster->scissor.y0 && c->from >= raster->scissor.x0 &&
          c->to <= raster->scissor.x1; */
    //@ assert uncut: -(1 << 17) <= c->x0 <= 1 << 17 && -(1 << 17) <= c->y0 <= 1 << 17;
    //@ assert steps: -(1 << 20) <= c->steps <= 1 << 20;
    //@ assert flags: c->positive <= 1 && c->longest <= 1 && c->top <= 2 && c->middle <= 2 && c->bottom <= 2;
}

/* ---- products of pieces, which Eva would take apart: lemma product_of_pieces ---- */

/*@ assigns \result \from a, b;
    ensures product_of_pieces: \result == a * b; */
uint64_t ew_mul_u32_pieces(uint32_t a, uint32_t b);
/*@ assigns \result \from a, b;
    ensures product_of_pieces: \result == a * b; */
int64_t ew_mul_s32_pieces(int32_t a, int32_t b);

/* ---- work.triangle, as ew_setup leaves it ---- */

static inline void any_triangle(ew_raster *raster)
{
    ew_triangle *t = &raster->work.triangle;
    any_bytes(t, sizeof *t);
    any_bytes(&raster->work.now, sizeof raster->work.now);
    t->rung = (uint8_t)between(1, EW_RUNG_COUNT - 1);
    t->run_tolerance = (uint16_t)between(0, EW_TOLERANCE_MAX);
    t->run_exponent = (int16_t)between(-100, 100);
    t->run_shift = (uint8_t)any_of(32);
    t->longest = (uint16_t)between(0, EW_LONGEST_RUN), t->sure_run = (uint16_t)between(0, EW_LONGEST_RUN);
    t->column = (uint16_t)any_of(4096);
    t->attributes = (uint8_t)Frama_C_nondet(any_of(2) * 2, 5);
    t->is_wide = (uint8_t)any_of(2), t->newton = (uint8_t)any_of(2);
    t->plain = (uint8_t)any_of(3);
    t->w_lead = (uint8_t)any_of(32);
    t->uv_bits = (uint8_t)between(EW_BITS_LEAST, EW_BITS_MOST);
    t->u_shift = (uint8_t)any_of(32), t->v_shift = (uint8_t)any_of(32);
    t->shade_origin[0] = between(0, INT32_C(1) << 20);
    t->shade_origin[1] = between(0, INT32_C(1) << 20);
    t->shade_origin[2] = between(0, INT32_C(1) << 20);
}
static inline void check_triangle(const ew_raster *raster)
{
    const ew_triangle *t = &raster->work.triangle;
    //@ assert attributes_known: t->attributes <= 5 && t->is_wide <= 1 && t->plain <= 2 && t->column < 4096;
    //@ assert rung_known: 1 <= t->rung < EW_RUNG_COUNT && t->newton <= 1;
    //@ assert runs_known: t->run_tolerance <= 256 && -100 <= t->run_exponent <= 100 && t->run_shift <= 31;
    //@ assert run_lengths_known: t->sure_run <= 256 && t->longest <= 256;
    //@ assert shifts_known: t->w_lead <= 31 && 19 <= t->uv_bits <= 27 && t->u_shift <= 31 && t->v_shift <= 31;
    //@ assert shades_known: \forall integer i; 0 <= i < 3 ==> 0 <= t->shade_origin[i] <= 1 << 20;
}

#endif
