/* A picture larger than the chip's memory: 320x240 with depth, line by line. The hash takes each
 * line's colour and depth where another program would send them to a panel. */
#include "../board/board.h"
#include "../picture_hash.h"
#include "../player.h"
#include "edgewalk/picture.h"

enum { WIDTH = 320, HEIGHT = 240, SKY = 0x6D7B, FRAMES = 4, FRAME_MS = 250, OBJECTS = 4, MEMORY = 5000 };

static ew_scene shown;
static ew_scene_camera camera;
static ew_raster raster;
static ew_geometry geometry;
static ew_mat34 world[PLAYER_NODES];
static ew_object objects[OBJECTS];
static uint8_t memory[MEMORY];
static uint32_t hash;

static void take_line(void *user, const ew_target *line)
{
    (void)user;
    hash = picture_hash(hash, line->colour, line->width);
    hash = picture_hash(hash, line->depth, line->width);
}

static int open_scene(void)
{
    int error = ew_scene_open(&shown, scene, scene_size);
    if (error) return error;
    if (shown.section[EW_SECTION_NODE].count > PLAYER_NODES || ew_scene_object_count(&shown) > OBJECTS) return EW_ERR_ROOM;
    ew_scene_get_camera(&shown, &camera);
    ew_geometry_init(&geometry, &raster);
    return EW_OK;
}

int draw_picture(uint32_t time_ms);
int draw_picture(uint32_t time_ms) /* what host_tests/firmware counts */
{
    const ew_viewport whole = { 0, 0, WIDTH, HEIGHT };
    const ew_picture picture = { .width = WIDTH, .height = HEIGHT, .buffers = 1, .rows = 1, .end_row = HEIGHT,
                                 .background = SKY, .scissor = { 0, 0, WIDTH, HEIGHT }, .band = take_line };
    int error = ew_scene_pose(&shown, time_ms, world);
    if (!error) error = ew_scene_objects(&shown, &camera, world, &whole, &geometry, objects);
    hash = PICTURE_HASH_START;
    return error ? error : ew_picture_draw(&picture, objects, ew_scene_object_count(&shown), &geometry, memory, sizeof memory, NULL);
}

int main(void)
{
    int error = open_scene();
    for (uint32_t i = 0; i < FRAMES && !error; i++) {
        error = draw_picture(shown.duration_ms ? i * FRAME_MS % shown.duration_ms : 0);
        if (error) break;
        board_print("frame ");
        board_print_decimal(i);
        board_print(" ");
        board_print_hex(hash);
        board_print("\n");
    }
    if (error) {
        board_print("cannot draw the scene: ");
        board_print(ew_error_text(error));
        board_print("\n");
        return 1;
    }
    board_print_stack();
    return 0;
}
