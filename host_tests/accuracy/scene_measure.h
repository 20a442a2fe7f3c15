/* A baked scene's frame held against the referee. */
#ifndef EW_SCENE_MEASURE_H
#define EW_SCENE_MEASURE_H

#include "edgewalk/scene.h"
#include "measure.h"

/* Draws the scene with `camera` at time_ms into `target`, triangle by triangle, as
 * ew_scene_draw does, and judges it. The referee works out nodes, tracks and the camera in
 * double from the baked numbers. `tolerance` replaces the materials' (1/16 px), -1 keeps
 * it; `rung` too, EW_RUNG_AUTO keeps it. `cost` is for the automatic choice, NULL the generic
 * one. Returns 0 or an error of the core. */
int measure_scene(const ew_scene *scene, const ew_scene_camera *camera, uint32_t time_ms,
                  const ew_target *target, uint16_t background, int tolerance, ew_rung rung, const ew_cost *cost,
                  measures *result);

#endif
