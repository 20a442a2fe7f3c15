/* A baked scene in flash, drawn frame by frame into a target: what every example here does. */
#ifndef PLAYER_H
#define PLAYER_H

#include "edgewalk/scene.h"

/* Room for the scene, set for each program: `ew-bake` prints the number of nodes, and
 * ew_scene_open finds the vertices of the largest primitive. */
#ifndef PLAYER_NODES
#define PLAYER_NODES 4
#endif
#ifndef PLAYER_VERTICES
#define PLAYER_VERTICES 512
#endif

typedef struct player {
    ew_scene scene;
    ew_scene_camera camera;
    ew_raster raster;
    ew_geometry geometry;
    ew_mat34 world[PLAYER_NODES];
    ew_screen_vertex scratch[PLAYER_VERTICES];
} player;

/* What `ew-bake --c-array` writes. */
extern const uint32_t scene[];
extern const size_t scene_size;

/* Opens the baked scene that is linked to the program. Returns EW_OK or an ew_error;
 * EW_ERR_ROOM when the player's memory is too small for the scene. */
int player_open(player *p, const ew_target *target);

/* Draws the scene as it is at a time; the animation starts again at its end. Returns the
 * number of triangles drawn or an ew_error. */
int32_t player_draw(player *p, uint32_t time_ms);

#endif
