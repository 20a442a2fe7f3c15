/* Triangles that come near to breaking a promise: judged, and read from and printed as rows of
 * worst_triangles.inc. */
#ifndef EW_TEST_WORST_H
#define EW_TEST_WORST_H

#include "promise.h"

typedef struct worst_case {
    const char *way; /* of promise_ways, or "depth"                                            */
    uint16_t width, height, texture_width, texture_height;
    ew_raster_vertex v[3];
} worst_case;

typedef struct worst_verdict {
    double used;     /* promise_used of the worst fragment; of depth: units off beyond the disc.
                        Above 1 is broken; -1 where nothing is promised or drawn                */
    int x, y;        /* the pixel                                                              */
    double drawn, exact;
} worst_verdict;

/* Draws and judges a triangle, `part` of its fragments: 1 is all of them. */
worst_verdict worst_judge(const worst_case *c, int part);

/* The case as a row of the list. */
void worst_print(const worst_case *c, const worst_verdict *v);

#endif
