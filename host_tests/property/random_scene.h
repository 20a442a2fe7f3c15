/* Random pictures of objects, for tests of the memory modes. */
#ifndef EW_TEST_RANDOM_SCENE_H
#define EW_TEST_RANDOM_SCENE_H

#include "edgewalk/picture.h"
#include "pictures.h"

enum { SCENE_OBJECTS = 4, SCENE_VERTICES = 48, SCENE_TRIANGLES = 60 };

typedef struct random_scene {
    ew_picture picture; /* all of it, without bands */
    ew_object object[SCENE_OBJECTS];
    ew_vertex16 vertex[SCENE_OBJECTS][SCENE_VERTICES];
    ew_colour888 colours[SCENE_OBJECTS][SCENE_VERTICES];
    uint16_t index[SCENE_OBJECTS][3 * SCENE_TRIANGLES];
    ew_screen_vertex screen[SCENE_OBJECTS][SCENE_VERTICES]; /* of all vertices */
    uint32_t count;
} random_scene;

/* Any target, objects with vertices anywhere around the camera, any materials. */
void random_scene_init(random_scene *scene);

/* Pixels from one row of it to the next. */
uint32_t random_scene_stride(const random_scene *scene);

/* The rows above `border`, or those from it on, in bands of any height. */
void random_half(ew_picture *half, const ew_picture *whole, uint16_t border, int lower);

#endif
