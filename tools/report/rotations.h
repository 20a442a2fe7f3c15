/* Rotations and chains of matrices of the core against double precision. */
#ifndef EW_REPORT_ROTATIONS_H
#define EW_REPORT_ROTATIONS_H

/* Radians by which the core's slerp is farthest from the exact arc between the exact keys: random keys `angle`
 * apart, rounded to `bits` fraction bits, the first of that length, at random times. From a fixed seed. */
double rotations_worst(double angle, int bits, double length, int trials);

/* A chain of n random matrices of a kind: turned (0), turned and scaled by 10^4 and 10^-4 in turns (1), unevenly
 * and mirrored (2), scaled by 10^4 each (3). *off becomes the largest error of an image of a corner of the unit cube, over
 * the largest image. Returns 0 or the core's error. */
int rotations_chain(int n, int kind, double *off);

#endif
