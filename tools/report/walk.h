/* One step of a walk: a picture with a margin that must stay untouched, held against the referee, and
 * the CSV row that comes of it. */
#ifndef EW_REPORT_WALK_H
#define EW_REPORT_WALK_H

#include "../../host_tests/accuracy/measure.h"
#include "../cycles/cases.h"

/* include/edgewalk/fixed.h: the table reciprocal's error is 2^-walk_promised[EW_RECIP_BITS - 4]. */
static const double walk_promised[] = { 11.02, 12.97, 14.91, 16.53, 17.00, 17.00 };
static const double walk_e = 1.0 / 64, walk_snap = 1.0 / 256, walk_no_limit = -1;

/* A method at the tolerance of 1/4 px, if it takes one. */
typedef struct pen {
    const bench_method *method;
    uint16_t tolerance;
} pen;

typedef struct canvas {
    ew_target target;
    ew_raster raster;
    uint16_t *memory[2];
    int width, height, error;
} canvas;

/* Begins a picture, drawn with a texture of width x height texels (2,048 at most). Rows are longer than the
 * picture: drawing must leave their margin alone. */
void walk_begin(canvas *c, const pen *p, int width, int height, int texture_width, int texture_height);
void walk_triangle(canvas *c, const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *d);
void walk_quad(canvas *c, const ew_raster_vertex v[4]);
/* Draws a quadrilateral through the geometry layer, alone: the eye at the origin, near distance 1, the picture ends
 * at x = z and y = z / 1.5. Vertices, as q1.15, are scaled by `size` and moved up by `up`. */
void walk_floor(canvas *c, const ew_vertex16 v[4], double size, double up);
/* Sets the transform for a picture of such an eye. Returns EW_OK or an error. */
int walk_view(ew_transform *t, int width, int height, double size, double up);
/* Returns what was measured; the margin's loss ends the program. */
measures walk_end(canvas *c);

/* 256 x 256 texels that differ from their neighbours. */
const ew_texture *walk_texture(void);

/* A corner at (x, y) px, with near/z and texels. */
ew_raster_vertex walk_at(double x, double y, double w, double u, double v);

/* Whether the method draws in lengths of its own, without asking how far that puts it off. */
int walk_careless(const pen *p);
/* px that the method may be off. */
double walk_allowed(const pen *p);

/* Prints a row: of any figures, and of what was measured. `state` is ok, degraded or refused. */
void walk_row(const char *axis, const char *method, double x, double err_px, double err_lsb, long wrong, double limit,
              const char *state);
void walk_report(const char *axis, const pen *p, double x, const canvas *c, const measures *m, long more_wrong, double limit);

/* The axes of memory_axes.c and link_axes.c, and of more_axes.c those that are walked once and those of each method. */
void memory_axes(void);
void link_axes(void);
void more_axes(void);
void more_axes_of(const pen *p);
/* Prints cells of the heat maps, map,x,y,value,limit_y: of the one that depends on the size of the reciprocal
 * table, or of all others. */
void maps(int recip);

#endif
