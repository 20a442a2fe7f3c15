# Counting instructions: a bench that is host program and firmware, and what counts it.
C := $(B)/cycles
CYCLES_CORE := $(filter fixed/% src/raster/% src/geometry/%,$(CORE_SRCS))
CYCLES_DEPS := tools/cycles/bench.c tools/cycles/bench_cases.inc $(C)/scene_data.h $(CYCLES_CORE) \
  $(wildcard include/edgewalk/*.h fixed/*.inc src/*/*.h)
COUNT_TARGETS ?= host m0plus m3 m4
cpu_m0plus := -mcpu=cortex-m0plus
cpu_m3 := -mcpu=cortex-m3
cpu_m4 := -mcpu=cortex-m4 -mfloat-abi=soft
cpu_m33 := -mcpu=cortex-m33 -mfloat-abi=soft
place_m33 := -Wl,--defsym=_flash=0x10000000,--defsym=_ram=0x38000000
place = $(or $(place_$(1)),-Wl$(,)--defsym=_flash=0$(,)--defsym=_ram=0x20000000)
, := ,

$(C)/scene_data.h: tools/cycles/scene_data.c host_tests/reference/scenes.c fixed/matrix.c fixed/arithmetic.c fixed/recip.c
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) -o $(C)/scene_data $^ -lm
	$(C)/scene_data > $@
$(C)/bench-host: $(CYCLES_DEPS)
	$(CC) -std=c99 -O2 -g -Iinclude -I$(C) -o $@ $(filter %.c,$^)
$(C)/bench-%.elf: $(CYCLES_DEPS) tools/cycles/port/start_m.c tools/cycles/port/m.ld
	arm-none-eabi-gcc -std=gnu99 -O2 -g -ffreestanding -ffunction-sections -mthumb $(cpu_$*) -Iinclude -I$(C) \
	  -o $@ $(filter %.c,$^) -T tools/cycles/port/m.ld $(call place,$*) -nostdlib -Wl,--gc-sections -Wl,--no-warn-rwx-segments -lgcc
$(C)/count.so: tools/cycles/count.c
	@mkdir -p $(@D)
	$(CC) -std=gnu11 -O2 -Wall -Wextra -fPIC -shared -o $@ $<

count:  ## instructions per fragment, host and emulated Cortex-M (COUNT_TARGETS=)
	@SETUP=$(SETUP) tools/setup/setup.sh count
	@$(MAKE) --no-print-directory count-run
count-run: $(C)/bench-host $(C)/count.so $(patsubst %,$(C)/bench-%.elf,$(filter-out host,$(COUNT_TARGETS)))
	@mkdir -p build/report
	$(PYTHON) tools/cycles/count.py --build $(C) --csv build/report/counts.csv $(COUNT_TARGETS)
.PHONY: count count-run
