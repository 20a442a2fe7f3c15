/* The smallest firmware: draws a baked scene from flash into memory, with nothing but a
 * console to show for it. Prints a hash of each frame's colour and depth: the same on every
 * chip and at the desk. */
#include "../board/board.h"
#include "../picture_hash.h"
#include "../player.h"

#ifndef PICTURE_WIDTH
#define PICTURE_WIDTH 320
#define PICTURE_HEIGHT 240
#endif
enum { FRAMES = 4, FRAME_MS = 250, PIXELS = PICTURE_WIDTH * PICTURE_HEIGHT };

static uint16_t colour[PIXELS], depth[PIXELS];
static player show;

static int fail(const char *what, int code)
{
    board_print(what);
    board_print(ew_error_text(code));
    board_print("\n");
    return 1;
}

int main(void)
{
    const ew_target target = { .colour = colour, .depth = depth,
                               .width = PICTURE_WIDTH, .height = PICTURE_HEIGHT, .stride = PICTURE_WIDTH };
    int error = player_open(&show, &target);
    if (error) return fail("cannot open the scene: ", error);
    for (uint32_t i = 0; i < FRAMES; i++) {
        int32_t drawn = player_draw(&show, i * FRAME_MS);
        if (drawn < 0) return fail("cannot draw the scene: ", (int)drawn);
        uint32_t hash = picture_hash(PICTURE_HASH_START, colour, PIXELS);
        board_print("frame ");
        board_print_decimal(i);
        board_print(" ");
        board_print_hex(picture_hash(hash, depth, PIXELS));
        board_print("\n");
    }
    board_print_stack();
    return 0;
}
