/* An animated textured scene from flash on a 128x64 OLED of 16 greys: a Cortex-M3 with 64 KB
 * of RAM. */
#include "../board/board.h"
#include "../player.h"
#include "ssd0323.h"

enum { FRAMES = 20, FRAME_MS = 100 };

static uint8_t pixels[PANEL_ROW_BYTES * PANEL_HEIGHT];
static uint16_t depth[PANEL_WIDTH * PANEL_HEIGHT];
static player show;

int main(void)
{
    /* The target's format is the panel's: two pixels to a byte, the left one in the high bits. */
    const ew_target target = { .colour = pixels, .depth = depth,
                               .width = PANEL_WIDTH, .height = PANEL_HEIGHT, .stride = PANEL_WIDTH,
                               .format = EW_TARGET_GREY4, .dither = 1 };
    if (player_open(&show, &target)) return 1;
    panel_init();
    for (uint32_t i = 0; i < FRAMES; i++) {
        if (player_draw(&show, i * FRAME_MS) < 0) return 2;
        panel_show(pixels);
        /* A product would wait for its timer here; the test compares the panel with the host. */
        board_print("frame\n");
        board_wait();
    }
    board_print_stack();
    return 0;
}
