/* src/raster/triangle.c: corners of every bit pattern, and what its checks and its placing leave to
 * the parts behind, which stand here as contracts. */
#include "edgewalk/raster.h"

#include "seams.h"

/* setup.c and span.c: what they may rely on, and that anything may come back. */
int ew_setup(ew_raster *raster)
{
    check_corners(raster);
    any_triangle(raster);
    return any_of(2) ? EW_OK : EW_ERR_RANGE;
}

int ew_rows_of_texture(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    //@ assert rows_in_scissor: 0 <= row < 4096 && end <= raster->scissor.y1;
    //@ assert edges_valid: \valid(edge + (0..1)) && \valid(t);
    any_bytes(edge, 2 * sizeof *edge);
    return any_of(2);
}

int ew_rows_packed(ew_raster *raster, ew_triangle *t, ew_edge *edge, int32_t row, int32_t end)
{
    return ew_rows_of_texture(raster, t, edge, row, end);
}

int ew_rows_of_any(ew_raster *raster, int32_t row, int32_t end)
{
    return ew_rows_of_texture(raster, &raster->work.triangle, raster->work.edge, row, end);
}

static ew_raster raster;
static ew_active active;

static ew_raster_vertex v[3];

/* Eva compares with a scissor's numbers only while they are known. */
static void scissor_is(uint16_t x0, uint16_t y0, uint16_t x1, uint16_t y1)
{
    any_context(&raster);
    raster.scissor.x0 = x0, raster.scissor.y0 = y0;
    raster.scissor.x1 = x1, raster.scissor.y1 = y1;
    any_bytes(v, sizeof v);
}

static void any_vertices(void)
{
    any_vertex(&v[0]), any_vertex(&v[1]), any_vertex(&v[2]);
}

/* By itself or in a list, where its row may lag behind. */
static void draw_on(void)
{
    uint16_t first = 0;
    ew_active_list list = { .places = (uint8_t *)&active, .link = &first, .ended = EW_NO_PLACE };
    if (any_of(2)) {
        (void)ew_raster_draw_active(&raster, &active);
        return;
    }
    active.number = 0;
    active.next = EW_NO_PLACE;
    ew_raster_draw_list(&raster, &list, 1);
    if (first == 0) active.row = raster.scissor.y1; /* else it is done */
}

static void begun(void)
{
    any_vertices();
    if (ew_raster_begin(&raster, &v[0], &v[1], &v[2], (uint16_t)between(0, 4096)) != 1) return;
    (void)ew_raster_begun_end(&raster);
    (void)ew_active_bytes(&raster.work.triangle);
    if (any_of(2)) {
        (void)ew_raster_draw_begun(&raster);
    } else {
        ew_raster_keep(&raster, &active);
        while (active.row < active.end) {
            raster.scissor.y0 = active.row; /* it begins with the triangle's next row */
            draw_on();
        }
    }
}

/* Ways of drawing beside each other, not one after the other: fewer states for Eva to keep apart. */
static void triangle_in(uint16_t x0, uint16_t y0, uint16_t x1, uint16_t y1)
{
    scissor_is(x0, y0, x1, y1);
    switch (any_of(3)) {
    case 0: (void)ew_raster_triangle(&raster, &v[0], &v[1], &v[2]); break;
    case 1:
        any_vertices();
        (void)ew_raster_triangle_in_range(&raster, &v[0], &v[1], &v[2]);
        break;
    default: begun(); break;
    }
}

void prove_triangle(void)
{
    triangle_in(0, 0, 4096, 4096);
#ifndef EW_PROVE_SHORT
    triangle_in(0, 0, 1, 1);
    triangle_in(17, 240, 320, 248);
    triangle_in(4095, 4095, 4096, 4096);
#endif
}
