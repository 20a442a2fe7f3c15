# Counting instructions: a bench that is host program and firmware, and what counts it. There is
# a folder of images for each size of the reciprocal table, $(C)/4 to $(C)/9.
C := $(B)/cycles
CYCLES_CORE := $(filter fixed/% src/raster/% src/geometry/% src/scene/%,$(CORE_SRCS))
CYCLES_DEPS := tools/cycles/bench.c $(CYCLES_CORE) tools/cycles/cases.h tools/cycles/scene_data.h \
  $(wildcard include/edgewalk/*.h fixed/*.inc src/*/*.h)
COUNT_TARGETS ?= host m0plus m3 m4 m33 rv32imc
COUNT_BITS := 8
# sample scenes that are drawn beside the standard ones
COUNT_SCENES := courtyard
COUNT_FILES := $(COUNT_SCENES:%=$(B)/scenes/%.ewb)

cc_host := $(CC) -std=gnu99 -O2 -g -Wall -Wextra
nolibc := -ffreestanding -ffunction-sections -nostdlib -Wl,--gc-sections -Wl,--no-warn-rwx-segments
cc_m = arm-none-eabi-gcc -std=gnu99 -O2 -g -Wall -Wextra $(nolibc) -mthumb
cc_m0plus = $(cc_m) -mcpu=cortex-m0plus
cc_m3 = $(cc_m) -mcpu=cortex-m3
cc_m4 = $(cc_m) -mcpu=cortex-m4 -mfloat-abi=soft
cc_m33 = $(cc_m) -mcpu=cortex-m33 -mfloat-abi=soft
cc_rv32imc = riscv64-unknown-elf-gcc -std=gnu99 -O2 -g -Wall -Wextra $(nolibc) -march=rv32imc -mabi=ilp32 -mcmodel=medany
PORT := tools/cycles/port
port_m := $(PORT)/start_m.c $(PORT)/semihost.c
place = -T $(PORT)/m.ld -Wl,--defsym=_flash=$(1) -Wl,--defsym=_ram=$(2) -lgcc
$(foreach t,m0plus m3 m4,$(eval port_$t := $(port_m))$(eval link_$t := $(call place,0,0x20000000)))
port_m33 := $(port_m)
link_m33 := $(call place,0x10000000,0x38000000)
port_rv32imc := $(PORT)/start_rv.S $(PORT)/semihost.c
link_rv32imc := -T $(PORT)/rv.ld -lgcc

$(C)/scene_data: tools/cycles/scene_data.c host_tests/reference/scenes.c fixed/matrix.c fixed/arithmetic.c fixed/recip.c
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) -o $@ $^ -lm
$(C)/scene_data.c: $(C)/scene_data $(COUNT_FILES)
	$< $(foreach s,$(COUNT_SCENES),$(s)=$(B)/scenes/$(s).ewb) > $@
$(C)/count.so: tools/cycles/count.c
	@mkdir -p $(@D)
	$(CC) -std=gnu11 -O2 -Wall -Wextra -fPIC -shared -o $@ $<

# $(C)/BITS/bench-TARGET; the scenes' data is compiled once for each target
define bench_target
$(C)/data-$(1).o: $(C)/scene_data.c tools/cycles/scene_data.h
	@mkdir -p $$(@D); echo "CC $$@"; $$(filter-out -nostdlib -Wl$$(,)%,$$(cc_$(1))) -Iinclude -Itools/cycles -c -o $$@ $$<
$(C)/%/bench-$(1): $(CYCLES_DEPS) $(C)/data-$(1).o $(port_$(1)) $(wildcard $(PORT)/*.ld $(PORT)/*.h)
	@mkdir -p $$(@D); echo "CC $$@"
	@$$(cc_$(1)) -DEW_RECIP_BITS=$$* -Iinclude -o $$@ $$(filter %.c %.S %.o,$$^) $$(link_$(1))
endef
, := ,
$(foreach t,host m0plus m3 m4 m33 rv32imc,$(eval $(call bench_target,$(t))))
$(C)/list: $(CYCLES_DEPS) $(C)/data-host.o
	@echo "CC $@"
	@$(cc_host) -DEW_TRACE=1 -Iinclude -o $@ $(filter %.c %.o,$^)
bench_images = $(C)/list $(C)/count.so $(foreach b,$(1),$(foreach t,$(COUNT_TARGETS),$(C)/$(b)/bench-$(t)))

COUNT := PYTHONDONTWRITEBYTECODE=1 $(PYTHON) tools/cycles/
count:  ## instructions and modelled cycles per fragment, host and emulated cores (COUNT_TARGETS=)
check-counts:  ## fail where a count has grown by more than 1 % since tools/cycles/baseline.csv
update-counts:  ## write today's counts into tools/cycles/baseline.csv
count check-counts update-counts:
	@SETUP=$(SETUP) tools/setup/setup.sh count
	@$(MAKE) --no-print-directory -j2 $@-run
count-run: $(call bench_images,$(COUNT_BITS))
	@mkdir -p build/report
	@$(COUNT)count.py --build $(C) --bits $(COUNT_BITS) --csv build/report/counts.csv $(COUNT_TARGETS)
check-counts-run update-counts-run: $(call bench_images,$(COUNT_BITS))
	@$(COUNT)baseline.py $(firstword $(subst -, ,$@)) --build $(C) --bits $(COUNT_BITS) --baseline tools/cycles/baseline.csv $(COUNT_TARGETS)
.PHONY: count check-counts update-counts count-run check-counts-run update-counts-run
