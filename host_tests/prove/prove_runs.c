/* src/raster/run.h: lengths of runs, for every 1/z, slope and tolerance. */
#include "unknown.h"

#include "runs.h"

#include "src/raster/run.h"

static ew_triangle t;
static ew_run_limit limit;

void prove_runs(void)
{
    any_bytes(&t, sizeof t);
    any_runs(&t);
    (void)ew_root16(any32(), between(-131, 131));
    (void)ew_one_run_suffices(&t, any32(), any32(), between(0, 63), between(1, 256));
    ew_run_limit_init(&limit, &t, any32(), between(0, 63), any_of(2));
    if (any_of(2)) (void)ew_run_first(&limit, any32());
    else (void)ew_run_next(&limit, any32(), between(0, 256));
}
