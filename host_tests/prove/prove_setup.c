/* src/raster/setup.c for all corners that triangle.c lets through. */
#include "seams.h"

/* span.c: planes become others, and nothing else does. */
void ew_planes_pack(ew_triangle *t, const ew_packing *packing)
{
    //@ assert packing_there: \valid(t) && \valid_read(packing);
    any_bytes(&t->plane, sizeof t->plane);
}

void ew_planes_go(ew_triangle *t, uint32_t columns, uint32_t rows)
{
    (void)columns, (void)rows;
    any_bytes(&t->plane, sizeof t->plane);
}

static ew_raster raster;

void prove_setup(void)
{
    any_context(&raster);
    any_triangle(&raster); /* of before: what a triangle does not need stays */
    any_corners(&raster);
    const int error = ew_setup(&raster);
    if (error == EW_OK) check_triangle(&raster);
}
