/* src/raster/run.h: lengths of runs, for every 1/z, slope and tolerance. */
#include "runs.h"
#include "unknown.h"

#include "src/raster/run.h" /* of the tree that is analysed: planted faults, too */

static ew_triangle t;
static ew_run_limit limit;

void prove_runs(void)
{
    any_bytes(&t, sizeof t);
    t.rung = (uint8_t)between(1, EW_RUNG_COUNT - 1);
    t.run_tolerance = (uint16_t)any_of(EW_TOLERANCE_MAX + 1);
    t.run_exponent = (int16_t)between(-100, 100), t.run_shift = (uint8_t)any_of(32);
    t.longest = (uint16_t)any_of(EW_LONGEST_RUN + 1);
    (void)ew_root16(any32(), between(-131, 131));
    (void)ew_one_run_suffices(&t, any32(), any32(), between(0, 63), between(1, 256));
    ew_run_limit_init(&limit, &t, any32(), between(0, 63), any_of(2));
    switch (any_of(3)) {
    case 0: (void)ew_run_first(&limit, any32()); break;
    case 1: (void)ew_run_near(&limit, any32(), between(0, INT32_MAX)); break;
    default: (void)ew_run_after(&limit, any32(), between(0, EW_LONGEST_RUN)); break;
    }
}
