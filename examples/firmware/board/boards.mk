# The machines that firmware is built for here: QEMU's boards, and the host. For each target:
# cc_T the compiler with its options for the core, board_T start-up and console, link_T what
# ends a link command.
BOARD := examples/firmware/board
board_semihosting := $(addprefix $(BOARD)/,semihost.c stack.c memory.c text.c)
board_arm := $(BOARD)/start_m.c $(board_semihosting)

arm = arm-none-eabi-gcc -mthumb -mfloat-abi=soft -mcpu=$(1)
# with an FPU compilers have other registers to spill to, and other trouble with machine code
arm_fpu = arm-none-eabi-gcc -mthumb -mfloat-abi=hard -mfpu=auto -mcpu=$(1)
# flash and its size, RAM and its size; the linker refuses what does not fit
memory = -T $(BOARD)/m.ld -Wl,--defsym=_flash=$(1),--defsym=_flash_bytes=$(2),--defsym=_ram=$(3),--defsym=_ram_bytes=$(4) \
  -nostdlib -Wl,--gc-sections -Wl,--no-warn-rwx-segments -lgcc

ARM_TARGETS := microbit lm3s6965evb m0plus m3 m3_hot m4 m7 m33 m55
# its flash has 64 KB
cc_microbit = $(call arm,cortex-m0) -DEW_WITH_SPANS=0
cc_lm3s6965evb = $(call arm,cortex-m3)
cc_m0plus = $(call arm,cortex-m0plus)
cc_m3 = $(call arm,cortex-m3)
cc_m4 = $(call arm,cortex-m4)
cc_m7 = $(call arm_fpu,cortex-m7)
cc_m33 = $(call arm,cortex-m33)
cc_m55 = $(call arm_fpu,cortex-m55)
link_microbit = $(call memory,0,0x40000,0x20000000,0x4000)
link_lm3s6965evb = $(call memory,0,0x40000,0x20000000,0x10000)
link_m3 = $(call memory,0,0x400000,0x20000000,0x400000)
link_m0plus = $(link_m3)
# the same with rows, pixels and their tables in RAM
cc_m3_hot = $(cc_m3) '-DEW_HOT=__attribute__((section(".ew_hot")))' '-DEW_HOT_TABLE=__attribute__((section(".ew_hot_table")))'
link_m3_hot = $(link_m3)
link_m4 = $(link_m3)
link_m7 = $(link_m3)
link_m33 = $(call memory,0x10000000,0x400000,0x38000000,0x200000)
link_m55 = $(call memory,0,0x80000,0x20000000,0x80000)
$(foreach t,$(ARM_TARGETS),$(eval board_$(t) := $(board_arm)))

cc_rv32imc = riscv64-unknown-elf-gcc -march=rv32imc -mabi=ilp32 -mcmodel=medany
board_rv32imc := $(BOARD)/start_rv.S $(board_semihosting)
link_rv32imc = -T $(BOARD)/rv.ld -nostdlib -Wl,--gc-sections -Wl,--no-warn-rwx-segments -lgcc

cc_avr = avr-gcc -mmcu=atmega2560
board_avr := $(BOARD)/avr.c $(BOARD)/text.c
link_avr = -Wl,--gc-sections
