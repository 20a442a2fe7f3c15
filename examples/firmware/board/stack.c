#include "board.h"
#include "stack.h"

extern const uint32_t _ebss[], _estack[];

/* The stack grows down to _ebss: the lowest word that has lost its paint is as far as it came. */
uint32_t board_stack_used(void)
{
    const uint32_t *lowest = _ebss;
    while (lowest < _estack && *lowest == STACK_PAINT) lowest++;
    return (uint32_t)((uintptr_t)_estack - (uintptr_t)lowest);
}
