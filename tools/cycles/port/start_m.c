/* Start-up of a Cortex-M board in QEMU: vectors, .data, .bss, main, and the end through
 * semihosting. No libc. */
#include <stddef.h>
#include <stdint.h>

extern uint32_t _estack, _sdata, _edata, _sidata, _sbss, _ebss;
int main(void);
void reset(void);
void fault(void);

static void finish(uintptr_t code)
{
    /* SYS_EXIT_EXTENDED with ADP_Stopped_ApplicationExit: the code becomes QEMU's status */
    uintptr_t block[2] = { 0x20026u, code };
    register uintptr_t op __asm__("r0") = 0x20;
    register uintptr_t *arg __asm__("r1") = block;
    __asm__ volatile("bkpt 0xab" : : "r"(op), "r"(arg) : "memory");
    for (;;) {
    }
}

void reset(void)
{
    const uint32_t *from = &_sidata;
    for (uint32_t *to = &_sdata; to < &_edata;) *to++ = *from++;
    for (uint32_t *to = &_sbss; to < &_ebss;) *to++ = 0;
    finish((uintptr_t)main());
}

void fault(void) { finish(99); }

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {
    &_estack, (void *)reset, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault,
    0, 0, 0, (void *)fault, (void *)fault, 0, (void *)fault, (void *)fault
};

/* The compiler may call these even in freestanding code. */
void *memset(void *to, int c, size_t n)
{
    for (unsigned char *p = to; n--;) {
        *p++ = (unsigned char)c;
        __asm__ volatile("" ::: "memory"); /* or the loop becomes a call of itself */
    }
    return to;
}
void *memcpy(void *restrict to, const void *restrict from, size_t n)
{
    const unsigned char *q = from;
    for (unsigned char *p = to; n--;) {
        *p++ = *q++;
        __asm__ volatile("" ::: "memory");
    }
    return to;
}
