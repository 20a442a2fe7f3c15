/* Start-up of an RV32 board, machine mode, one hart: .bss, the painted stack, main. */
#include "stack.h"
    .option arch, +zicsr
    .section .init
    .globl reset
reset:
    .option push
    .option norelax
    la gp, __global_pointer$
    .option pop
    la sp, _estack
    la t0, fault
    csrw mtvec, t0
    la t0, _sbss
    la t1, _ebss
    j 2f
1:  sw zero, 0(t0)
    addi t0, t0, 4
2:  bltu t0, t1, 1b
    li t2, STACK_PAINT
    j 4f
3:  sw t2, 0(t0)
    addi t0, t0, 4
4:  bltu t0, sp, 3b
    call main
    call board_exit
    .balign 4
fault:
    li a0, 99
    call board_exit
