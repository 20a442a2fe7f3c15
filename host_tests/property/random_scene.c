#include "random_scene.h"

#include <assert.h>
#include <string.h>

#include "cases.h"

static int32_t entry(int bits) { return (int32_t)pick(UINT32_C(2) << bits) - (INT32_C(1) << bits); }

/* Vertices anywhere around the camera: near plane and guard band are crossed often. */
static void random_transform(ew_transform *t, const ew_picture *whole)
{
    const ew_projection projection = { entry(15) + 98304, entry(15) + 98304, { INT32_C(1) << 29, -1 } };
    do {
        const ew_viewport viewport = pick(2) ? (ew_viewport){ 0, 0, whole->width, whole->height } :
                                               (ew_viewport){ (int16_t)entry(5), (int16_t)entry(5), (uint16_t)(1 + pick(120)), (uint16_t)(1 + pick(90)) };
        const int size = 14 + (int)pick(5);
        ew_mat34 m;
        for (int i = 0; i < 3; i++) {
            const int32_t from = i == 2 ? -(int32_t)pick(pick(2) ? 3u << 18 : 3u << 15) : entry(size);
            ew_row_from_q16_16(&m.row[i], entry(size), entry(size), entry(size), from);
        }
        if (ew_transform_set(t, &projection, &m, &viewport) == EW_OK) return;
    } while (1);
}

static void random_mesh(random_scene *scene, int i)
{
    ew_object *o = &scene->object[i];
    o->vertex_count = 3 + pick(SCENE_VERTICES - 2);
    for (uint32_t v = 0; v < o->vertex_count; v++) {
        ew_vertex16 *a = &scene->vertex[i][v];
        a->x = (int16_t)test_random(), a->y = (int16_t)test_random(), a->z = (int16_t)test_random();
        a->u = (int16_t)pick(4096), a->v = (int16_t)pick(4096);
        scene->colours[i][v] = (ew_colour888){ (uint8_t)pick(256), (uint8_t)pick(256), (uint8_t)pick(256) };
    }
    assert(o->vertex_count > 0);
    const uint32_t triangles = pick(SCENE_TRIANGLES + 1), spread = 1 + pick(o->vertex_count);
    for (uint32_t k = 0; k < 3 * triangles; k++) { /* neighbours in a strip, or anybody */
        scene->index[i][k] = (uint16_t)((k / 3 + pick(spread)) % o->vertex_count);
    }
    o->mesh = (ew_mesh){ .vertices = scene->vertex[i], .colours = pick(2) ? scene->colours[i] : NULL, .indices = scene->index[i],
                         .index_count = 3 * triangles, .uv_fraction_bits = (uint8_t)pick(9) };
    ew_transform_vertices(&o->transform, scene->vertex[i], o->vertex_count, scene->screen[i]);
    if (pick(3) == 0) o->mesh.screen = scene->screen[i];
}

void random_scene_init(random_scene *scene)
{
    static const ew_cost dear = { 440, 26, 81 }; /* runs of 9 pixels at least */
    ew_target target;
    random_target(&target);
    ew_picture *p = &scene->picture;
    memset(p, 0, sizeof *p);
    p->width = target.width, p->height = target.height;
    p->format = target.format, p->dither = target.dither;
    p->visibility = target.depth ? EW_DEPTH_BUFFER : EW_DEPTH_NONE;
    p->background = (uint16_t)test_random();
    random_scissor(&p->scissor, &target);
    p->end_row = p->height;
    if (pick(3) == 0) p->fog_near = UINT32_C(1) << 31, p->fog_far = UINT32_C(1) << 27, p->fog_colour = (uint16_t)test_random();
    if (pick(3) == 0) p->cost = &dear;
    scene->count = pick(SCENE_OBJECTS + 1);
    for (uint32_t i = 0; i < scene->count; i++) {
        ew_object *o = &scene->object[i];
        random_transform(&o->transform, p);
        random_mesh(scene, (int)i);
        random_material(&o->material, &o->texture);
        if (pick(3)) o->material.flags &= (uint8_t)~EW_DOUBLE_SIDED;
    }
}

uint32_t random_scene_stride(const random_scene *scene) { return (scene->picture.width + 7u) / 8u * 8u; }

void random_half(ew_picture *half, const ew_picture *whole, uint16_t border, int lower)
{
    *half = *whole;
    half->buffers = (uint8_t)(1 + pick(2));
    half->first_row = lower ? border : 0;
    half->end_row = lower ? whole->height : border;
    half->rows = (uint16_t)(1 + pick(whole->height));
}
