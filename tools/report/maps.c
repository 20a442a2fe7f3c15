/* Heat maps of the stability atlas: pairs of axes, a cell for each pair, and where the formula says that the first
 * stops being ok: limit_y, for that x. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "rotations.h"
#include "walk.h"

static void cell(const char *map, double x, double y, double value, double limit_y)
{
    printf("%s,%.6g,%.6g,%.6g,%.6g\n", map, x, y, value, limit_y);
}

static const bench_method *method_of(ew_rung rung)
{
    for (int i = 0; i < BENCH_METHODS; i++) {
        if (bench_methods[i].rung == rung) return &bench_methods[i];
    }
    abort();
}

/* One affine run: its length in px, and farthest over nearest z along it, less 1. Displacement in px; the line is at 1/4. */
static void ratio_and_length(void)
{
    const pen p = { method_of(EW_RUNG_AFFINE), 0 };
    for (double length = 4; length < 600; length *= sqrt(2)) {
        const int n = (int)rint(length);
        const double limit = pow((n + 0.25) / (n - 0.25), 2) - 1;
        for (double y = 1e-4; y < 2e4; y *= sqrt(10)) {
            canvas c;
            walk_begin(&c, &p, n, 1, 256, 256);
            const double w = 1 / (1 + y), u = 200;
            const ew_raster_vertex v[4] = { walk_at(0, 0, 1, 0, 0), walk_at(0, 1, 1, 0, 0), walk_at(n, 1, w, u, 0), walk_at(n, 0, w, u, 0) };
            walk_quad(&c, v);
            measures m = walk_end(&c);
            cell("depth_ratio_and_run_length", length, y, m.disp_max, limit);
        }
    }
}

/* Bits of the reciprocal table, and texels from side to side. Texels by which the table rung is off; the line is at
 * e = 1/64. */
static void bits_and_range(void)
{
    const pen p = { method_of(EW_RUNG_TABLE), 0 };
    for (double u = 8; u <= 1 << 15; u *= sqrt(2)) {
        canvas c;
        walk_begin(&c, &p, 320, 48, 2048, 2048);
        const ew_raster_vertex v[4] = { walk_at(40, 4, 0.9, 0, 0), walk_at(40, 44, 0.9, 0, u), walk_at(280, 44, 0.45, u, u), walk_at(280, 4, 0.45, u, 0) };
        walk_quad(&c, v);
        measures m = walk_end(&c);
        cell("recip_bits_and_uv_range", EW_RECIP_BITS, u, fmax(m.u_max, m.v_max), walk_e * exp2(walk_promised[EW_RECIP_BITS - 4]));
    }
}

/* Distance of a wall over the near distance, and how far a second one stands before it, both in near distances. Per cent
 * of its pixels that are lost. */
static void distance_and_separation(void)
{
    const pen p = { method_of(EW_RUNG_EXACT), 0 };
    for (double z = 2; z < 6e3; z *= sqrt(2)) {
        for (double d = ldexp(1, -14); d < 1e3; d *= sqrt(2)) {
            enum { SIDE = 32 };
            long lost = 0, all = 0;
            if (d >= z - 1) continue;
            for (int i = 0; i < 4; i++) {
                const double far = z * (1 + 0.1 * i), w = 1 / far, nearer = 1 / (far - d);
                canvas c;
                walk_begin(&c, &p, SIDE, SIDE, 256, 256);
                const ew_raster_vertex v[4] = { walk_at(0, 0, w, 0, 0), walk_at(0, SIDE, w, 0, 0), walk_at(SIDE, SIDE, w * 0.97, 0, 0), walk_at(SIDE, 0, w * 0.97, 0, 0) };
                ew_raster_vertex n[4];
                for (int k = 0; k < 4; k++) n[k] = v[k], n[k].w += (uint32_t)llrint(ldexp(nearer - w, 31));
                walk_quad(&c, v);
                uint16_t before[SIDE * SIDE];
                for (int k = 0; k < SIDE * SIDE; k++) before[k] = c.target.depth[k / SIDE * c.target.stride + k % SIDE];
                walk_quad(&c, n);
                for (int k = 0; k < SIDE * SIDE; k++) lost += c.target.depth[k / SIDE * c.target.stride + k % SIDE] == before[k];
                all += SIDE * SIDE;
                walk_end(&c);
            }
            cell("distance_and_separation", z, d, 100.0 * (double)lost / (double)all, z * z / 65536);
        }
    }
}

/* The angle between two keys in radians against the keys' fraction bits: the error as a part of that angle, and the line where
 * the keys' own rounding (one unit of length, twice that of angle) is as large as the angle. And what is missing to half a
 * turn: by how much a point at 160 px is displaced, and the line where the roundings of the dot product, 3.5 standard deviations
 * of 8 of them, may turn its sign. */
static void angle_and_format(void)
{
    for (int bits = 6; bits <= 30; bits += 2) {
        for (double x = 1e-8; x < 3; x *= sqrt(10)) {
            cell("slerp_angle_and_key_bits", x, bits, rotations_worst(x, bits, 1, 300) / x, log2(2 / x));
            cell("slerp_half_turn_and_key_bits", x, bits, 160 * rotations_worst(acos(-1.0) - x, bits, 1, 300), log2(7 * sqrt(1.0 / 6) / x));
        }
    }
}

void maps(int recip)
{
    if (!recip) {
        ratio_and_length();
        distance_and_separation();
        angle_and_format();
    } else {
        bits_and_range();
    }
}
