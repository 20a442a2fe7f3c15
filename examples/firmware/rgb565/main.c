/* RV32IMC with a linear 320x240 RGB565 frame buffer: the scene is drawn right into the memory
 * that the display shows. On QEMU's `virt` board that memory belongs to the PCI device
 * `bochs-display`; on a chip it is what the LCD controller reads. */
#include "../board/board.h"
#include "../player.h"

enum { WIDTH = 320, HEIGHT = 240, FRAMES = 4, FRAME_MS = 250 };

#define FRAME_BUFFER UINT32_C(0x40000000) /* where we put the device's two windows */
#define REGISTERS UINT32_C(0x41000000)
#define REGISTER16(address) (*(volatile uint16_t *)(uintptr_t)(address))
#define REGISTER32(address) (*(volatile uint32_t *)(uintptr_t)(address))

static uint16_t depth[WIDTH * HEIGHT];
static player show;

/* Sources: QEMU, docs/specs/standard-vga.txt; PCI Local Bus Specification, chapter 6. */
static int display_init(void)
{
    enum { XRES = 1, YRES, BITS, ENABLE, VIRTUAL_WIDTH = 6, COMMAND = 0x04, BAR0 = 0x10, BAR2 = 0x18 };
    const uint32_t configuration = UINT32_C(0x30000000), one_device = UINT32_C(1) << 15;
    const uint32_t end = configuration + 32 * one_device;
    uint32_t device = configuration;
    while (device < end && REGISTER32(device) != UINT32_C(0x11111234)) device += one_device;
    if (device == end) return -1;
    REGISTER32(device + BAR0) = FRAME_BUFFER;
    REGISTER32(device + BAR2) = REGISTERS;
    REGISTER32(device + COMMAND) = 6; /* answers memory accesses, may start its own */
    const uint32_t mode = REGISTERS + 0x500;
    REGISTER16(mode + 2 * XRES) = WIDTH;
    REGISTER16(mode + 2 * YRES) = HEIGHT;
    REGISTER16(mode + 2 * BITS) = 16;
    REGISTER16(mode + 2 * VIRTUAL_WIDTH) = WIDTH;
    REGISTER16(mode + 2 * ENABLE) = 0x41; /* on, linear */
    return 0;
}

int main(void)
{
    const ew_target target = { .colour = (uint16_t *)(uintptr_t)FRAME_BUFFER, .depth = depth,
                               .width = WIDTH, .height = HEIGHT, .stride = WIDTH };
    if (display_init() || player_open(&show, &target)) return 1;
    for (uint32_t i = 0; i < FRAMES; i++) {
        if (player_draw(&show, i * FRAME_MS) < 0) return 2;
        board_print("frame\n");
        board_wait();
    }
    board_print_stack();
    return 0;
}
