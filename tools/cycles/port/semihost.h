/* Semihosting of Arm and RISC-V, and what the compiler calls even in freestanding code. */
#ifndef EW_CYCLES_SEMIHOST_H
#define EW_CYCLES_SEMIHOST_H

#include <stdint.h>

/* Ends the emulator with that exit status. */
void port_finish(uintptr_t status);

#endif
