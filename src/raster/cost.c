/* What rungs cost, as data. From `make count`: `pixel` and `run_pixel` are scene A's fragments on
 * the table rung and in one run a span; `run` is what a run of scene D takes beyond its pixels, less
 * what single pixels take to leave the runs and to come back to them: the shortest run that follows
 * from it, 2 pixels everywhere, is the one with which scene D counts least from t = 1/16 to 1/4 px. */
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
