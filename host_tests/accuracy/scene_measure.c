#include "scene_measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../reference/affine.h"

/* ---- baked numbers in double ---- */

static double number(const uint8_t *p, int bytes)
{
    uint32_t u = 0;
    for (int i = 0; i < bytes; i++) u |= (uint32_t)p[i] << 8 * i;
    return bytes == 2 ? (int16_t)u : (int32_t)u;
}

/* The rotation a part f along the arc between two keys: both unit vectors of the plane that
 * holds it, turned by a part of the angle. */
static void rotation_between(double turn[4], const uint8_t *a, const uint8_t *b, double f)
{
    double from[4], side[4], size_a = 0, size_b = 0, along = 0, across = 0;
    for (int i = 0; i < 4; i++) {
        from[i] = number(a + 2 * i, 2);
        side[i] = number(b + 2 * i, 2);
        size_a += from[i] * from[i];
        size_b += side[i] * side[i];
    }
    for (int i = 0; i < 4; i++) {
        from[i] /= sqrt(size_a);
        side[i] /= sqrt(size_b);
        along += from[i] * side[i];
    }
    for (int i = 0; i < 4; i++) {
        side[i] -= along * from[i];
        across += side[i] * side[i];
    }
    across = sqrt(across);
    double angle = f * atan2(across, along);
    for (int i = 0; i < 4; i++) turn[i] = cos(angle) * from[i] + (across > 0 ? sin(angle) / across * side[i] : 0);
}

/* docs/scene-format.md, "movement". */
static ref_affine track_matrix(const ew_scene *scene, int track, uint32_t time_ms)
{
    const uint8_t *t = scene->section[EW_SECTION_TRAK].records + 12 * track;
    double at = time_ms / (double)(uint16_t)number(t + 6, 2), last = (uint16_t)number(t + 4, 2) - 1.0;
    if (at > last) at = last;
    double k = floor(at), f = at - k;
    const uint8_t *a = scene->section[EW_SECTION_KEYS].records + 32 * ((size_t)number(t, 4) + (size_t)k);
    const uint8_t *b = f > 0 ? a + 32 : a;
    double v[6]; /* translation, scale */
    for (int i = 0; i < 6; i++) {
        int offset = i < 3 ? 4 * i : 20 + 4 * (i - 3);
        v[i] = number(a + offset, 4) * (1 - f) + number(b + offset, 4) * f;
    }
    double turn[4];
    rotation_between(turn, a + 12, b + 12, f);
    double x = turn[0], y = turn[1], z = turn[2], w = turn[3];
    double r[3][3] = { { 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y) },
                       { 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x) },
                       { 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y) } };
    ref_affine m;
    for (int i = 0; i < 3; i++) {
        m.m[i][3] = ldexp(v[i], (int)number(t + 8, 2) - 30);
        for (int j = 0; j < 3; j++) m.m[i][j] = r[i][j] * ldexp(v[3 + j], (int)number(t + 10, 2) - 30);
    }
    return m;
}

static void pose(const ew_scene *scene, uint32_t time_ms, ref_affine *world)
{
    for (uint32_t i = 0; i < scene->section[EW_SECTION_NODE].count; i++) {
        ew_scene_node node;
        ew_scene_get_node(scene, i, &node);
        ref_affine local = node.track >= 0 ? track_matrix(scene, node.track, time_ms) : ref_affine_of(&node.local);
        world[i] = node.parent >= 0 ? ref_affine_times(&world[node.parent], &local) : local;
    }
}

/* ---- one picture ---- */

static int measure_primitive(const ew_scene *scene, uint32_t number_of, const ew_projection *projection,
                             const ew_mat34 *node_view, const ref_affine *node_view_exact, const ew_viewport *viewport,
                             ew_geometry *geometry, ew_screen_vertex *scratch, int tolerance, ew_rung rung)
{
    ew_scene_primitive p;
    ew_material material;
    ew_texture texture;
    ew_mat34 model_view;
    ew_scene_get_primitive(scene, number_of, &p);
    ew_scene_get_material(scene, p.material, &material, &texture);
    if (tolerance >= 0) material.tolerance = (uint16_t)tolerance;
    if (rung != EW_RUNG_AUTO && material.texture) material.rung = (uint8_t)rung;
    int error = ew_mat34_mul(&model_view, node_view, &p.dequantise);
    if (!error) error = ew_raster_set_material(geometry->raster, &material);
    if (!error) error = ew_transform_set(&geometry->transform, projection, &model_view, viewport);
    if (error) return error;
    ew_transform_vertices(&geometry->transform, p.vertices, p.vertex_count, scratch);
    ref_affine box = ref_affine_of(&p.dequantise), mv = ref_affine_times(node_view_exact, &box);
    const ew_mesh mesh = { p.vertices, scratch, NULL, p.indices, p.index_count, p.uv_fraction_bits };
    return measure_mesh(geometry, mv.m, &mesh);
}

int measure_scene(const ew_scene *scene, const ew_scene_camera *camera, uint32_t time_ms, const ew_target *target,
                  uint16_t background, int tolerance, ew_rung rung, const ew_cost *cost, measures *result)
{
    uint32_t nodes = scene->section[EW_SECTION_NODE].count;
    ew_mat34 *world = calloc(nodes, sizeof *world), node_view;
    ref_affine *world_exact = calloc(nodes, sizeof *world_exact), view = ref_affine_of(&camera->view);
    ew_screen_vertex *scratch = calloc(scene->largest_primitive, sizeof *scratch);
    ew_raster raster;
    ew_geometry geometry;
    if (!world || !world_exact || !scratch) abort();

    /* the same numbers for both: the focal ratios as the core rounds them */
    int32_t focal_x = (int32_t)(((int64_t)camera->focal * target->height + target->width / 2) / target->width);
    const ref_camera eye = { focal_x / 65536.0, camera->focal / 65536.0,
                             ldexp(camera->near_z.m, camera->near_z.e - 30), 0, 0, target->width, target->height };
    const ew_viewport viewport = { 0, 0, target->width, target->height };
    const ew_projection projection = { focal_x, camera->focal, camera->near_z };
    int error = ew_raster_init(&raster, target);
    if (!error && cost) error = ew_raster_set_cost(&raster, cost);
    if (!error) error = ew_scene_pose(scene, time_ms, world);
    if (!error) {
        ew_raster_clear(&raster, background);
        ew_geometry_init(&geometry, &raster);
        pose(scene, time_ms, world_exact);
        measure_begin(target, &eye, background);
        for (uint32_t i = 0; i < nodes && !error; i++) {
            ew_scene_node node;
            ew_scene_get_node(scene, i, &node);
            ref_affine exact_view = ref_affine_times(&view, &world_exact[i]);
            error = ew_mat34_mul(&node_view, &camera->view, &world[i]);
            for (uint32_t k = 0; k < node.primitive_count && !error; k++) {
                error = measure_primitive(scene, node.first_primitive + k, &projection, &node_view, &exact_view,
                                          &viewport, &geometry, scratch, tolerance, rung);
            }
        }
        measure_end(result, 0.125);
    }
    free(world);
    free(world_exact);
    free(scratch);
    return error;
}
