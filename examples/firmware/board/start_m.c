/* Start-up of a Cortex-M board: vectors, .data, .bss, the painted stack, main. No libc. */
#include "board.h"
#include "stack.h"

extern uint32_t _estack[], _sdata[], _edata[], _sbss[], _ebss[];
extern const uint32_t _sidata[];
int main(void);
void reset(void);
void fault(void);

#if defined(__ARM_FP) || defined(__ARM_FEATURE_MVE)
#define CPACR (*(volatile uint32_t *)0xE000ED88u)
static void start_fpu(void)
{
    CPACR |= UINT32_C(0xF) << 20; /* coprocessors 10 and 11, for all */
    __asm__ volatile("dsb\n\tisb" : : : "memory");
}
#else
static void start_fpu(void) {}
#endif

void reset(void)
{
    start_fpu();
    const uint32_t *from = _sidata;
    for (uint32_t *to = _sdata; to < _edata;) *to++ = *from++;
    for (uint32_t *to = _sbss; to < _ebss;) *to++ = 0;
    const uint32_t *in_use = (uint32_t *)__builtin_frame_address(0) - 16;
    for (uint32_t *to = _ebss; to < in_use;) *to++ = STACK_PAINT;
    board_exit(main());
}

void fault(void) { board_exit(99); }

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {
    _estack, (void *)reset, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault,
    (void *)fault, 0, 0, 0, (void *)fault, (void *)fault, 0, (void *)fault, (void *)fault
};
