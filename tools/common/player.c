#include "player.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "whole_file.h"

struct ew_player {
    const char *tool;
    char *path;
    void *bytes;
    ew_scene scene;
    ew_scene_camera still, camera;
    ew_mat34 *world;
    ew_screen_vertex *scratch;
    ew_target target;
    ew_raster raster;
    ew_geometry geometry;
    uint32_t time_ms;
    int32_t drawn;
    unsigned rows, active; /* of bands, 0: none */
    ew_visibility visibility;
    ew_object *objects;
    uint8_t *memory;
    size_t memory_bytes;
    ew_picture_counts counts;
};

/* A baked scene is for a chip; a file beyond this is something else. */
enum { LARGEST_FILE = 1 << 28 };

static int complain(const ew_player *p, const char *what, const char *why)
{
    fprintf(stderr, "%s: %s: %s: %s\n", p->tool, p->path, what, why);
    return -1;
}

static int load(ew_player *p, size_t *size)
{
    struct stat st;
    FILE *file = fopen(p->path, "rb");
    if (!file) return complain(p, "cannot open the scene", strerror(errno));
    if (fstat(fileno(file), &st) != 0 || !S_ISREG(st.st_mode)) {
        fclose(file);
        return complain(p, "cannot read the scene", S_ISDIR(st.st_mode) ? "it is a directory" : "not a file");
    }
    ew_whole_file_spare(fileno(file));
    if (st.st_size > LARGEST_FILE) {
        fclose(file);
        return complain(p, "cannot read the scene", "larger than 256 MiB");
    }
    *size = (size_t)st.st_size;
    p->bytes = malloc(*size ? *size : 1);
    size_t got = p->bytes ? fread(p->bytes, 1, *size, file) : 0;
    fclose(file);
    if (got != *size) return complain(p, "cannot read the scene", p->bytes ? "read error" : strerror(ENOMEM));
    return 0;
}

static int prepare(ew_player *p, unsigned width, unsigned height)
{
    size_t size;
    if (load(p, &size)) return -1;
    if (size == 0) return complain(p, "not a baked scene", "the file is empty");
    if (size >= 4 && memcmp(p->bytes, "glTF", 4) == 0) return complain(p, "not a baked scene", "a glTF model, for ew-bake to bake");
    int error = ew_scene_open(&p->scene, p->bytes, size);
    if (error) return complain(p, "not a usable baked scene", ew_error_text(error));
    ew_scene_get_camera(&p->scene, &p->still);
    p->camera = p->still;
    p->world = calloc(p->scene.section[EW_SECTION_NODE].count, sizeof *p->world);
    p->scratch = calloc(p->scene.largest_primitive, sizeof *p->scratch);
    p->target.colour = calloc((size_t)width * height, sizeof(uint16_t));
    p->target.depth = calloc((size_t)width * height, sizeof(uint16_t));
    if (!p->world || !p->scratch || !p->target.colour || !p->target.depth) {
        return complain(p, "cannot load the scene", strerror(ENOMEM));
    }
    p->target.width = p->target.stride = (uint16_t)width;
    p->target.height = (uint16_t)height;
    error = ew_raster_init(&p->raster, &p->target);
    if (error) return complain(p, "cannot draw", ew_error_text(error));
    ew_geometry_init(&p->geometry, &p->raster);
    return 0;
}

ew_player *ew_player_open(const char *tool, const char *path, unsigned width, unsigned height)
{
    ew_player *p = calloc(1, sizeof *p);
    char *copy = strdup(path);
    if (!p || !copy) {
        fprintf(stderr, "%s: %s: cannot load the scene: %s\n", tool, path, strerror(ENOMEM));
        free(p);
        free(copy);
        return NULL;
    }
    p->tool = tool;
    p->path = copy;
    if (prepare(p, width, height)) {
        ew_player_close(p);
        return NULL;
    }
    return p;
}

void ew_player_close(ew_player *p)
{
    free(p->target.colour);
    free(p->target.depth);
    free(p->scratch);
    free(p->objects);
    free(p->memory);
    free(p->world);
    free(p->bytes);
    free(p->path);
    free(p);
}

/* The camera turned about the upright axis through the middle of the scene's sphere:
 * view * T(c) R T(-c). */
static int orbit(ew_player *p, double angle)
{
    ew_row middle;
    ew_scene_get_bounds(&p->scene, &middle);
    static const int32_t one[3] = { 1 << 30, 1 << 30, 1 << 30 };
    const ew_quat turn = { 0, (int32_t)lrint(ldexp(sin(angle / 2), 30)), 0,
                           (int32_t)lrint(ldexp(cos(angle / 2), 30)) };
    const ew_quat none = { 0, 0, 0, 1 << 30 };
    const int32_t back[3] = { -middle.m[0], -middle.m[1], -middle.m[2] };
    ew_mat34 from, to;
    int error = ew_mat34_from_trs(&from, back, middle.e, &none, one, 0);
    if (!error) error = ew_mat34_from_trs(&to, middle.m, middle.e, &turn, one, 0);
    if (!error) error = ew_mat34_mul(&to, &to, &from);
    if (!error) error = ew_mat34_mul(&p->camera.view, &p->still.view, &to);
    return error;
}

int ew_player_use_bands(ew_player *p, unsigned rows, unsigned active, ew_visibility visibility)
{
    const uint32_t count = ew_scene_object_count(&p->scene);
    p->rows = rows < p->target.height ? rows : p->target.height;
    p->active = active;
    p->visibility = visibility;
    free(p->objects);
    p->objects = calloc(count ? count : 1, sizeof *p->objects);
    return p->objects ? 0 : complain(p, "cannot draw in bands", strerror(ENOMEM));
}

/* A finished band goes where the whole picture is. */
static void take_band(void *user, const ew_target *band)
{
    const ew_player *p = user;
    const size_t at = (size_t)band->first_row * p->target.stride, bytes = (size_t)band->height * band->stride * sizeof(uint16_t);
    memcpy((uint16_t *)p->target.colour + at, band->colour, bytes);
    if (band->depth) memcpy(p->target.depth + at, band->depth, bytes);
}

static int draw_in_bands(ew_player *p, const ew_viewport *whole)
{
    const uint16_t width = p->target.width, height = p->target.height;
    const ew_picture picture = { .width = width, .height = height, .buffers = 1, .rows = (uint16_t)p->rows, .end_row = height,
                                 .background = EW_PLAYER_BACKGROUND, .scissor = { 0, 0, width, height },
                                 .visibility = (uint8_t)p->visibility, .band = take_band, .user = p };
    const uint32_t count = ew_scene_object_count(&p->scene);
    int error = ew_scene_objects(&p->scene, &p->camera, p->world, whole, &p->geometry, p->objects);
    if (error) return error;
    p->memory_bytes = ew_picture_bytes(&picture, p->objects, count, p->active);
    free(p->memory);
    p->memory = malloc(p->memory_bytes);
    if (!p->memory || !p->memory_bytes) return EW_ERR_ROOM;
    return ew_picture_draw(&picture, p->objects, count, &p->geometry, p->memory, p->memory_bytes, &p->counts);
}

int ew_player_draw(ew_player *p, unsigned i, unsigned n, double fps)
{
    int error = EW_OK;
    p->time_ms = 0;
    p->camera = p->still;
    if (p->scene.duration_ms) {
        double ms = 1000.0 * i / (fps > 0 ? fps : 30.0);
        p->time_ms = (uint32_t)fmod(floor(ms + 0.5), p->scene.duration_ms);
    } else if (n > 1) {
        error = orbit(p, 2 * acos(-1.0) * i / n);
    }
    if (!error) error = ew_scene_pose(&p->scene, p->time_ms, p->world);
    if (error) return complain(p, "cannot pose the scene", ew_error_text(error));
    const ew_viewport whole = { 0, 0, p->target.width, p->target.height };
    if (p->rows) {
        error = draw_in_bands(p, &whole);
        return error ? complain(p, "cannot draw the scene in bands", ew_error_text(error)) : 0;
    }
    ew_raster_clear(&p->raster, EW_PLAYER_BACKGROUND);
    p->drawn = ew_scene_draw(&p->scene, &p->camera, p->world, &whole, &p->geometry, p->scratch);
    if (p->drawn < 0) return complain(p, "cannot draw the scene", ew_error_text(p->drawn));
    return 0;
}

const uint16_t *ew_player_pixels(const ew_player *p) { return p->target.colour; }
const ew_scene *ew_player_scene(const ew_player *p) { return &p->scene; }
const ew_scene_camera *ew_player_camera(const ew_player *p) { return &p->camera; }
uint32_t ew_player_time_ms(const ew_player *p) { return p->time_ms; }
int32_t ew_player_drawn(const ew_player *p) { return p->drawn; }
size_t ew_player_memory(const ew_player *p, ew_picture_counts *counts)
{
    *counts = p->counts;
    return p->memory_bytes;
}
