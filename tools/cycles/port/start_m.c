/* Start-up of a Cortex-M board in QEMU: vectors, .data, .bss, main, and the end through
 * semihosting. */
#include <stdint.h>

#include "semihost.h"

extern uint32_t _estack, _sdata, _edata, _sidata, _sbss, _ebss;
int main(void);
void reset(void);
void fault(void);

void reset(void)
{
    const uint32_t *from = &_sidata;
    for (uint32_t *to = &_sdata; to < &_edata;) *to++ = *from++;
    for (uint32_t *to = &_sbss; to < &_ebss;) *to++ = 0;
    port_finish((uintptr_t)main());
}

void fault(void) { port_finish(99); }

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {
    &_estack, (void *)reset, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault,
    0, 0, 0, (void *)fault, (void *)fault, 0, (void *)fault, (void *)fault
};
