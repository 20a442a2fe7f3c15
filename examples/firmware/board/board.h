/* What the examples ask of a board: a console, and how much stack was used. The start-up
 * code calls main and ends the emulator with what it returns. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Text to the console: semihosting on Arm and RISC-V, the first serial port on AVR, stdout
 * on the host. */
void board_print(const char *text);
void board_print_decimal(uint32_t n);
void board_print_hex(uint32_t n); /* eight digits */

/* Waits for one byte from the console. */
void board_wait(void);

/* The most bytes of stack in use at any time since reset; 0 where it is not measured. The
 * second prints it as `stack N`. */
uint32_t board_stack_used(void);
void board_print_stack(void);

/* Ends the program: with `code` as the emulator's exit status where it can have one. */
void board_exit(int code);

#endif
