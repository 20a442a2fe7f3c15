/* A baked scene, loaded and drawn frame by frame by the fixed-point core into memory of
 * its own. Functions print one line `tool: path: what: why` on stderr when they fail. */
#ifndef EW_TOOLS_PLAYER_H
#define EW_TOOLS_PLAYER_H

#include <stdint.h>

#include "edgewalk/picture.h"
#include "edgewalk/scene.h"

typedef struct ew_player ew_player;

/* Opens a scene for pictures of width x height, 1 to 4096 each. NULL on failure. */
ew_player *ew_player_open(const char *tool, const char *path, unsigned width, unsigned height);
void ew_player_close(ew_player *player);

/* Draws from now on in bands of that many rows, in as little memory as that takes with `active`
 * triangles reaching from one band into the next. 0 or -1. */
int ew_player_use_bands(ew_player *player, unsigned rows, unsigned active, ew_visibility visibility);

/* Draws frame i of n: where the scene has an animation its time is i/fps seconds (fps = 0
 * counts as 30), else the camera goes round the scene once in n frames. 0 or -1. */
int ew_player_draw(ew_player *player, unsigned i, unsigned n, double fps);

/* The picture, width * height, rows without gaps. */
const uint16_t *ew_player_pixels(const ew_player *player);

/* For checks of the picture: the scene, what the last frame was drawn with, and the number
 * of triangles that reached a pixel. */
const ew_scene *ew_player_scene(const ew_player *player);
const ew_scene_camera *ew_player_camera(const ew_player *player);
uint32_t ew_player_time_ms(const ew_player *player);
int32_t ew_player_drawn(const ew_player *player);

/* With bands: the memory of ew_picture_draw, and what happened in the last frame. */
size_t ew_player_memory(const ew_player *player, ew_picture_counts *counts);

enum { EW_PLAYER_BACKGROUND = 0x6D7B }; /* RGB565, a pale sky */

#endif
