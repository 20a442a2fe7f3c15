/* The core's matrices as numbers in double precision, exactly. */
#ifndef EW_REFERENCE_AFFINE_H
#define EW_REFERENCE_AFFINE_H

#include <math.h>

#include "edgewalk/fixed.h"

typedef struct ref_affine {
    double m[3][4];
} ref_affine;

static inline ref_affine ref_affine_of(const ew_mat34 *fixed)
{
    ref_affine r;
    for (int i = 0; i < 3; i++) {
        const ew_row *row = &fixed->row[i];
        for (int j = 0; j < 4; j++) r.m[i][j] = ldexp(row->m[j], (j < 3 ? row->e : row->e_last) - 30);
    }
    return r;
}

/* b first, then a. */
static inline ref_affine ref_affine_times(const ref_affine *a, const ref_affine *b)
{
    ref_affine r;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            r.m[i][j] = j == 3 ? a->m[i][3] : 0;
            for (int k = 0; k < 3; k++) r.m[i][j] += a->m[i][k] * b->m[k][j];
        }
    }
    return r;
}

#endif
