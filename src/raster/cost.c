/* What rungs cost, as data. From `make count`: `pixel` and `run_pixel` are scene A's fragments on
 * the table rung and in one run a span; `run` is what is left of scene D's at t = 1/4 px, over
 * the number of its runs. */
#include "edgewalk/raster.h"

const ew_cost ew_cost_generic = { 180, 16, 80 };
const ew_cost ew_cost_m0plus = { 440, 26, 171 };
const ew_cost ew_cost_m3 = { 165, 15, 64 };
const ew_cost ew_cost_host = { 240, 23, 85 };

int ew_raster_set_cost(ew_raster *raster, const ew_cost *cost)
{
    const int32_t saved = (int32_t)cost->pixel - cost->run_pixel; /* on each pixel of a run */
    if (!cost->run || !cost->run_pixel || saved <= 0) return EW_ERR_ARGUMENT;
    /* a run of n pixels is cheaper when run < n saved */
    uint32_t n = cost->run / (uint32_t)saved + 1u;
    raster->shortest_run = (uint16_t)n;
    return EW_OK;
}
