/* The board's console and end by semihosting: requests to the debugger, or to QEMU.
 * Source of the numbers: Arm, "Semihosting for AArch32 and AArch64", and "RISC-V
 * Semihosting", which takes them over. */
#include <stddef.h>

#include "board.h"

enum { SYS_WRITE0 = 0x04, SYS_READC = 0x07, SYS_EXIT_EXTENDED = 0x20 };

uintptr_t semihost(uintptr_t operation, const void *block);
#if defined(__riscv)
/* The three are found by their pattern: not compressed, and in one page. */
__asm__(".text\n .globl semihost\n .balign 16\n .option push\n .option norvc\n"
        "semihost:\n slli zero, zero, 0x1f\n ebreak\n srai zero, zero, 7\n ret\n .option pop\n");
#else
__asm__(".text\n .syntax unified\n .thumb\n .globl semihost\n .type semihost, %function\n"
        ".thumb_func\nsemihost:\n bkpt 0xab\n bx lr\n");
#endif

void board_print(const char *text) { semihost(SYS_WRITE0, text); }
void board_wait(void) { semihost(SYS_READC, NULL); }

void board_exit(int code)
{
    const uintptr_t block[2] = { 0x20026u, (uintptr_t)code }; /* ADP_Stopped_ApplicationExit */
    semihost(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}
