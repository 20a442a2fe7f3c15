#include "board.h"

void board_print_decimal(uint32_t n)
{
    char text[11];
    char *p = text + sizeof text - 1;
    *p = '\0';
    do {
        *--p = (char)('0' + n % 10);
        n /= 10;
    } while (n);
    board_print(p);
}

void board_print_hex(uint32_t n)
{
    char text[9];
    for (int i = 7; i >= 0; i--, n >>= 4) text[i] = "0123456789abcdef"[n & 15];
    text[8] = '\0';
    board_print(text);
}

void board_print_stack(void)
{
    board_print("stack ");
    board_print_decimal(board_stack_used());
    board_print("\n");
}
