/* src/raster/setup.c for all corners that triangle.c lets through. */
#include "seams.h"

static ew_raster raster;

void prove_setup(void)
{
    any_context(&raster);
    any_corners(&raster);
    const int error = ew_setup(&raster);
    if (error == EW_OK) check_triangle(&raster);
}
