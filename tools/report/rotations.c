#include "rotations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../host_tests/reference/affine.h"

/* ---- rotations ---- */

static void unit(double q[4])
{
    double square = 0;
    for (int i = 0; i < 4; i++) square += q[i] * q[i];
    for (int i = 0; i < 4; i++) q[i] /= sqrt(square);
}

static void random_unit(double q[4])
{
    do {
        for (int i = 0; i < 4; i++) q[i] = 2 * drand48() - 1;
    } while (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] > 1);
    unit(q);
}

static ew_quat rounded(const double q[4], int bits, double length)
{
    int32_t c[4];
    for (int i = 0; i < 4; i++) c[i] = (int32_t)ldexp(rint(ldexp(length * q[i], bits)), 30 - bits);
    ew_quat r = { c[0], c[1], c[2], c[3] };
    return r;
}

/* Twice the angle between two unit quaternions, q and -q being the same rotation: from the chord, which is
 * exact where it is short. */
static double turned_by(const double a[4], const double b[4])
{
    double plus = 0, minus = 0;
    for (int i = 0; i < 4; i++) plus += (a[i] + b[i]) * (a[i] + b[i]), minus += (a[i] - b[i]) * (a[i] - b[i]);
    return 4 * asin(fmin(1, sqrt(fmin(plus, minus)) / 2));
}

double rotations_worst(double angle, int bits, double length, int trials)
{
    double worst = 0;
    srand48(3);
    for (int n = 0; n < trials; n++) {
        double from[4], side[4], to[4], exact[4], along = 0;
        random_unit(from), random_unit(side);
        for (int i = 0; i < 4; i++) along += from[i] * side[i];
        for (int i = 0; i < 4; i++) side[i] -= along * from[i];
        unit(side);
        const uint32_t t = (uint32_t)(drand48() * 2147483648.0);
        const double half = angle / 2, part = half * ldexp(t, -31);
        for (int i = 0; i < 4; i++) {
            to[i] = cos(half) * from[i] + sin(half) * side[i];
            exact[i] = cos(part) * from[i] + sin(part) * side[i];
            if (n & 1) to[i] = -to[i]; /* the same rotation */
        }
        if (n & 1) for (int i = 0; i < 4; i++) to[i] = cos(half) * -from[i] + sin(half) * -side[i];
        const ew_quat a = rounded(from, bits, length), b = rounded(to, bits, 1);
        ew_quat out;
        if (ew_quat_slerp(&out, &a, &b, t) != EW_OK) return acos(-1.0);
        double drawn[4] = { out.x, out.y, out.z, out.w };
        unit(drawn);
        worst = fmax(worst, turned_by(drawn, exact));
    }
    return worst;
}

/* ---- chains ---- */

static int random_matrix(ew_mat34 *out, int kind, int number)
{
    double q[4], size[3];
    int32_t t[3], s[3];
    int e = 0;
    random_unit(q);
    const ew_quat turn = rounded(q, 30, 1);
    for (int i = 0; i < 3; i++) {
        size[i] = kind == 1 ? (number % 2 ? 1e-4 : 1e4) : kind == 2 ? (0.5 + drand48()) * (drand48() < 0.5 ? -1 : 1) : kind == 3 ? 1e4 : 1;
        t[i] = (int32_t)((drand48() - 0.5) * 1e9);
    }
    for (int i = 0, of; i < 3; i++) {
        (void)frexp(size[i], &of);
        e = i == 0 || of > e ? of : e;
    }
    for (int i = 0; i < 3; i++) s[i] = (int32_t)rint(ldexp(size[i], 30 - e));
    return ew_mat34_from_trs(out, t, 0, &turn, s, (int16_t)e);
}

static double image(const ref_affine *m, const double p[3], int row)
{
    return m->m[row][0] * p[0] + m->m[row][1] * p[1] + m->m[row][2] * p[2] + m->m[row][3];
}

int rotations_chain(int n, int kind, double *off)
{
    double worst = 0;
    srand48(4);
    for (int trial = 0; trial < 20; trial++) {
        ew_mat34 chain, next;
        int error = random_matrix(&chain, kind, 0);
        ref_affine exact = ref_affine_of(&chain);
        for (int i = 1; i < n && !error; i++) {
            error = random_matrix(&next, kind, i);
            const ref_affine of_next = ref_affine_of(&next);
            exact = ref_affine_times(&exact, &of_next);
            if (!error) error = ew_mat34_mul(&chain, &chain, &next);
        }
        if (error) return error;
        const ref_affine drawn = ref_affine_of(&chain);
        double most = 0, largest = 0;
        for (int corner = 0; corner < 8; corner++) {
            const double p[3] = { corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1 };
            for (int i = 0; i < 3; i++) {
                most = fmax(most, fabs(image(&drawn, p, i) - image(&exact, p, i)));
                largest = fmax(largest, fabs(image(&exact, p, i)));
            }
        }
        worst = fmax(worst, most / largest);
    }
    *off = worst;
    return 0;
}
