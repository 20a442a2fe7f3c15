/* Exact edge walking (private to the raster layer).
 *
 * An edge from (xa, ya) down to (xb, yb) meets the centre line of row j, at
 * yc = ONE j + HALF in subpixels, at x = xa + (yc - ya) dx / dy. A span begins or ends at
 * the first pixel whose centre is not left of that:
 *
 *     i = ceil((x - HALF) / ONE)
 *
 * taken for left and right edges alike, so that a centre exactly on an edge belongs to the
 * span that begins there (the left half of the top-left rule; rows do the other half by
 * the same ceil). The walker keeps i and an integer remainder; it never drifts.
 */
#ifndef EW_RASTER_EDGE_H
#define EW_RASTER_EDGE_H

#include "edgewalk/raster_work.h"

enum { EW_ONE = 1 << EW_SUBPIXEL_BITS, EW_HALF = EW_ONE / 2 };


/* First row whose centre is at or below y. */
static inline int32_t ew_row_at(ew_snapped y) { return EW_ASR(y + EW_HALF - 1, EW_SUBPIXEL_BITS); }

/* Starts the edge on `row`, whose centre lies from ya to below yb; ya < yb. */
void ew_edge_start(ew_edge *edge, ew_snapped xa, ew_snapped ya, ew_snapped xb, ew_snapped yb, int32_t row);

/* Goes to the next row. x grows by dx/dy pixels: both the whole part and the remainder
 * of dx ONE / (dy ONE) are those of dx / dy. */
static inline void ew_edge_step(ew_edge *edge)
{
    edge->x += edge->step;
    edge->remainder += edge->rise;
    if (edge->remainder >= 0) {
        edge->x++;
        edge->remainder -= edge->dy;
    }
}

#endif
