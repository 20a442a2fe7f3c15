/* The board that is the desk's own machine. */
#include <stdio.h>
#include <stdlib.h>

#include "board.h"

void board_print(const char *text) { fputs(text, stdout); }
void board_wait(void) { getchar(); }
uint32_t board_stack_used(void) { return 0; }
void board_exit(int code) { exit(code); }
