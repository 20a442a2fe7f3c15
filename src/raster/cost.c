/* What rungs cost, as data. From `make count`: `pixel` and `run_pixel` are scene A's fragments on
 * the table rung and in one run a span. `run` is fitted, not counted: a run of scene D takes about
 * 128 instructions beyond its pixels on a Cortex-M3, but single pixels also have to leave the runs
 * and to come back to them. So it is set for a shortest run of 2 pixels, with which scene D counts
 * least, or within 2 % of it, of 2, 3 and 4 at t = 1/16, 1/8 and 1/4 px on M0+, M3 and host. */
#include "edgewalk/raster.h"

const ew_cost ew_cost_generic = { 100, 15, 75 };
const ew_cost ew_cost_m0plus = { 280, 26, 175 };
const ew_cost ew_cost_m3 = { 90, 14, 64 };
const ew_cost ew_cost_host = { 105, 21, 77 };

int ew_raster_set_cost(ew_raster *raster, const ew_cost *cost)
{
    const int32_t saved = (int32_t)cost->pixel - cost->run_pixel; /* on each pixel of a run */
    if (!cost->run || !cost->run_pixel || saved <= 0) return EW_ERR_ARGUMENT;
    /* a run of n pixels is cheaper when run < n saved */
    uint32_t n = cost->run / (uint32_t)saved + 1u;
    raster->shortest_run = (uint16_t)n;
    return EW_OK;
}
