/* An animated textured scene from flash on a 128x64 OLED of 16 greys: a Cortex-M3 with 64 KB
 * of RAM. */
#include "../board/board.h"
#include "../player.h"
#include "ssd0323.h"

enum { FRAMES = 20, FRAME_MS = 100 };

static uint16_t colour[PANEL_WIDTH * PANEL_HEIGHT], depth[PANEL_WIDTH * PANEL_HEIGHT];
static player show;

/* Luma of ITU-R BT.601 in 16 steps, with the channels at 5, 6 and 5 bits: the weights
 * 0.299/31, 0.587/63 and 0.114/31 times 16 * 2^12, so that white is 15.99. */
static uint8_t grey4(uint16_t rgb565)
{
    uint32_t r = rgb565 >> 11, g = rgb565 >> 5 & 63u, b = rgb565 & 31u;
    return (uint8_t)((632u * r + 610u * g + 241u * b) >> 12); /* <= 65493 */
}

static void send_frame(void)
{
    uint8_t row[PANEL_ROW_BYTES];
    panel_home();
    for (int y = 0; y < PANEL_HEIGHT; y++) {
        const uint16_t *pixel = &colour[PANEL_WIDTH * y];
        for (int i = 0; i < PANEL_ROW_BYTES; i++, pixel += 2) {
            row[i] = (uint8_t)(grey4(pixel[0]) << 4 | grey4(pixel[1]));
        }
        panel_row(row);
    }
}

int main(void)
{
    const ew_target target = { .colour = colour, .depth = depth,
                               .width = PANEL_WIDTH, .height = PANEL_HEIGHT, .stride = PANEL_WIDTH };
    if (player_open(&show, &target)) return 1;
    panel_init();
    for (uint32_t i = 0; i < FRAMES; i++) {
        if (player_draw(&show, i * FRAME_MS) < 0) return 2;
        send_frame();
        /* A product would wait for its timer here; the test compares the panel with the host. */
        board_print("frame\n");
        board_wait();
    }
    board_print_stack();
    return 0;
}
