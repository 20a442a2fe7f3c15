/* edgewalk/light.h - colours of vertices from light: ambient and directional, diffuse.
 *
 * The result is what ew_mesh takes as `colours`. Arithmetic is done on the encoded (sRGB)
 * values, as everywhere at run time. A vertex gets
 *
 *   own * material * (ambient + sum over lights of colour * max(0, n . l))
 *
 * with colours as fractions of 255, and is cut at 255 after everything else.
 *
 * Lights are turned into the model's space, once for each model, so that a vertex costs three
 * small products for each light. Normals are stored in three bytes: that moves a brightness by
 * at most 1.8 of 255 for a light of full strength, less than half a step of RGB565.
 */
#ifndef EW_LIGHT_H
#define EW_LIGHT_H

#include <stdint.h>

#include "error.h"
#include "fixed.h"
#include "raster.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EW_LIGHTS_MAX = 4 };

/* A unit normal as it lies in flash: 127 is 1. */
typedef struct ew_normal8 {
    int8_t x, y, z;
} ew_normal8;

/* A light that is infinitely far away. */
typedef struct ew_light {
    ew_vec3 direction;   /* towards the light; any length but 0                            */
    ew_colour888 colour;
} ew_light;

/* Lights and a material, for one model. Made by ew_lighting_set. */
typedef struct ew_lighting {
    int32_t normal[3][3];                  /* takes normals to the lights' space; |.| <= 2^22 */
    int16_t direction[EW_LIGHTS_MAX][3];   /* 2^21 / 127 is 1                                 */
    uint16_t colour[EW_LIGHTS_MAX][3];     /* uq8.8, times the material                       */
    uint16_t ambient[3];                   /* likewise                                        */
    uint8_t count, renormalise;
} ew_lighting;

/* Makes the lights ready for a model. `model_to_lights` takes the model to the space that the
 * directions are given in: the model-view matrix for lights that are fixed to the camera, the
 * world matrix for lights in the world. Its translation does not count.
 *
 * With a rotation, a uniform scale and mirroring, normals keep their length: `renormalise` 0
 * is right. With another scale, 0 still finds the right border between light and shade, but
 * brightness is that of a stretched normal; 1 divides each normal's length out, for one square
 * root and one division a vertex. A normal that the matrix takes to nothing (a model scaled to
 * a plane or a line), or one that is null, gets ambient light only.
 *
 * Returns EW_OK, or EW_ERR_ARGUMENT for more than EW_LIGHTS_MAX lights or a null direction. */
int ew_lighting_set(ew_lighting *lighting, const ew_mat34 *model_to_lights, ew_colour888 ambient,
                    const ew_light *lights, uint32_t count, ew_colour888 material, int renormalise);

/* Lights `count` vertices. `own` are the vertices' own colours, or NULL; `out` may be `own`.
 * Against the formula above with the normal as stored, a channel is off by at most half a unit
 * and 1/64 for each light; with `renormalise`, 1/32 for each light where the scales along the
 * axes are within 1 : 1000. */
void ew_light_vertices(const ew_lighting *lighting, const ew_normal8 *normals, const ew_colour888 *own,
                       uint32_t count, ew_colour888 *out);

#ifdef __cplusplus
}
#endif

#endif
