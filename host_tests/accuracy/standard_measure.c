#include "standard_measure.h"

#include "../reference/scenes.h"

int measure_standard(char name, ew_rung rung, uint16_t tolerance, const ew_cost *cost, const ew_target *target,
                     uint16_t background, measures *result)
{
    static standard_scene scene;
    static ew_screen_vertex screen[33 * 33];
    static uint16_t texels[256 * 256];
    const ew_texture texture = { .texels = texels, .width = 256, .height = 256 };
    const ew_material material = { .texture = &texture, .tolerance = tolerance, .rung = (uint8_t)rung };
    /* focal length 160 px both ways: a square picture, of which the target shows the middle */
    const ew_viewport viewport = { 0, -40, 320, 320 };
    const ref_camera eye = { 1, 1, 0.25, 0, -40, 320, 320 };
    const ew_projection projection = { 65536, 65536, { 1 << 29, -1 } };
    ew_raster raster;
    ew_geometry geometry;
    ew_mat34 model_view;
    double exact[3][4];

    standard_texture(texels);
    standard_scene_init(&scene, name);
    standard_model_view(&model_view, exact);
    int error = ew_raster_init(&raster, target);
    if (error) return error;
    if (cost) error = ew_raster_set_cost(&raster, cost);
    if (error) return error;
    ew_raster_clear(&raster, background);
    ew_geometry_init(&geometry, &raster);
    error = ew_raster_set_material(&raster, &material);
    if (!error) error = ew_transform_set(&geometry.transform, &projection, &model_view, &viewport);
    if (error) return error;
    ew_transform_vertices(&geometry.transform, scene.vertices, scene.vertex_count, screen);
    const ew_mesh mesh = { scene.vertices, screen, NULL, scene.indices, scene.index_count, scene.uv_fraction_bits };
    measure_begin(target, &eye, background);
    error = measure_mesh(&geometry, exact, &mesh);
    measure_end(result, 0.125);
    return error;
}
