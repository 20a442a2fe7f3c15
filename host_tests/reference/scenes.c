#include "scenes.h"

#include <math.h>
#include <string.h>

enum { UNIT = 512, UV = 16 };

static int16_t nearest(double a) { return (int16_t)lrint(a); } /* ties to even */

/* Left-handed corners (+z forward) to ours: z is negated here, windings by the caller. */
static void add_vertex(standard_scene *s, double x, double y, double z, double u, double v)
{
    ew_vertex16 *out = &s->vertices[s->vertex_count++];
    out->x = nearest(x);
    out->y = nearest(y);
    out->z = (int16_t)-nearest(z);
    out->u = nearest(UV * u);
    out->v = nearest(UV * v);
}

static void add_triangle(standard_scene *s, int a, int b, int c)
{
    s->indices[s->index_count++] = (uint16_t)a;
    s->indices[s->index_count++] = (uint16_t)c; /* clockwise to counter-clockwise */
    s->indices[s->index_count++] = (uint16_t)b;
}

/* A floor one unit below the eye: near and far edge given by half width and distance. */
static void add_floor(standard_scene *s, double near_x, double near_z, double far_x, double far_z,
                      double u_per_unit, double v_per_unit, double v_offset, double roll)
{
    const double corner[4][2] = { { -near_x, near_z }, { near_x, near_z }, { far_x, far_z }, { -far_x, far_z } };
    for (int i = 0; i < 4; i++) {
        double x = corner[i][0], z = corner[i][1], y = -UNIT;
        add_vertex(s, x * cos(roll) - y * sin(roll), x * sin(roll) + y * cos(roll), z,
                   128 + u_per_unit * x / UNIT, v_per_unit * z / UNIT + v_offset);
    }
    add_triangle(s, 0, 3, 2);
    add_triangle(s, 0, 2, 1);
}

static void add_sphere(standard_scene *s)
{
    enum { N = 32 };
    const double pi = acos(-1.0), tilt = 0.5;
    for (int j = 0; j <= N; j++) {
        for (int i = 0; i <= N; i++) {
            double theta = pi * j / N, phi = 2 * pi * i / N;
            double x = sin(theta) * cos(phi), y = cos(theta), z = sin(theta) * sin(phi);
            double yt = y * cos(tilt) - z * sin(tilt), zt = y * sin(tilt) + z * cos(tilt);
            add_vertex(s, UNIT * x, UNIT * yt, rint(UNIT * zt) + 973, 1 + 253.0 * i / N, 1 + 253.0 * j / N);
        }
    }
    for (int j = 0; j < N; j++) {
        for (int i = 0; i < N; i++) {
            int a = j * (N + 1) + i, b = a + 1, d = a + N + 1, c = d + 1;
            if (j > 0) add_triangle(s, a, b, j == N - 1 ? d : c);
            if (j < N - 1) add_triangle(s, a, c, d);
        }
    }
}

void standard_scene_init(standard_scene *s, char name)
{
    memset(s, 0, sizeof *s);
    s->name = name;
    s->uv_fraction_bits = 4;
    switch (name) {
    case 'A': add_floor(s, 664, 720, 11264, 12288, 5.5, 10, 0, 0); break;
    case 'B': add_sphere(s); break;
    case 'C': add_floor(s, 4096, -512, 4096, 8192, 12, 14, 20, 0); break;
    case 'D': add_floor(s, 270, 720, 4608, 12288, 13, 10, 0, acos(-1.0) / 3); break;
    default: add_floor(s, 20480, -512, 20480, 32767, 3, 3.75, 4, 0); break;
    }
}

void standard_model_view(ew_mat34 *fixed, double exact[3][4])
{
    /* q1.15 times 64 is 1/512 unit */
    for (int i = 0; i < 3; i++) {
        ew_row_from_q16_16(&fixed->row[i], i == 0 ? 64 << 16 : 0, i == 1 ? 64 << 16 : 0,
                           i == 2 ? 64 << 16 : 0, 0);
        for (int j = 0; j < 4; j++) exact[i][j] = i == j ? 64 : 0;
    }
}

void standard_texture(uint16_t texels[256 * 256])
{
    for (uint32_t v = 0; v < 256; v++) {
        for (uint32_t u = 0; u < 256; u++) {
            /* three small primes: texels up to several steps apart in any direction differ */
            uint32_t r = (u * 5 + v * 3) & 31, g = (u * 11 + v * 23) & 63, b = (u * 7 + v * 13 + (u * v >> 6)) & 31;
            texels[256 * v + u] = (uint16_t)(r << 11 | g << 5 | b);
        }
    }
}
