/* Start-up of QEMU's riscv32 virt board: machine mode, one hart. */
    .option arch, +zicsr
    .section .init
    .globl _start
_start:
    .option push
    .option norelax
    la gp, __global_pointer$
    .option pop
    la sp, _estack
    la t0, trap
    csrw mtvec, t0
    la t0, _sbss
    la t1, _ebss
1:  bgeu t0, t1, 2f
    sw zero, 0(t0)
    addi t0, t0, 4
    j 1b
2:  call main
    call port_finish
    .balign 4
trap:
    li a0, 99
    call port_finish
