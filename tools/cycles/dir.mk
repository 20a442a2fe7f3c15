# Counting instructions: a bench that is host program and firmware, and what counts it. There is
# a folder of images for each size of the reciprocal table, $(C)/4 to $(C)/9.
C := $(B)/cycles
CYCLES_CORE := $(filter fixed/% src/raster/% src/geometry/% src/scene/%,$(CORE_SRCS))
CYCLES_DEPS := tools/cycles/bench.c $(CYCLES_CORE) tools/cycles/cases.h tools/cycles/drawn.h tools/cycles/scene_data.h \
  $(wildcard include/edgewalk/*.h fixed/*.inc src/*/*.h)
COUNT_TARGETS ?= host m0plus m3 m4 m33 rv32imc
# what tools/cycles/goals.csv has aims for
GOAL_TARGETS ?= host m0plus m3 m4
COUNT_BITS := 8
# sample scenes that are drawn beside the standard ones
COUNT_SCENES := courtyard
COUNT_FILES := $(COUNT_SCENES:%=$(B)/scenes/%.ewb)

bench_flags := -std=gnu99 -O2 -g -Wall -Wextra
freestanding := -ffreestanding -ffunction-sections
# the emulated ones are those of examples/firmware/board/boards.mk
# the cost profile that a target's firmware would set; the generic one is drawn on all
profile_host := host
profile_m0plus := m0plus
profile_m3 := m3
profile_m4 := m3
profile_m33 := m3
bench_cost = $(if $(profile_$(1)),-DBENCH_COST=ew_cost_$(profile_$(1)))
bench_cc = $(if $(filter host,$(1)),$(CC) $(bench_flags),$(cc_$(1)) $(bench_flags) $(freestanding))

$(C)/scene_data: $(B)/tools/cycles/scene_data.o $(B)/host_tests/reference/scenes.o $(LIB)
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) -o $@ $^ -lm
$(C)/scene_data.c: $(C)/scene_data $(COUNT_FILES)
	$< $(foreach s,$(COUNT_SCENES),$(s)=$(B)/scenes/$(s).ewb) > $@
$(C)/count.so: tools/cycles/count.c
	@mkdir -p $(@D)
	$(CC) -std=gnu11 -O2 -Wall -Wextra -fPIC -shared -o $@ $<

# $(C)/BITS/bench-TARGET; the scenes' data is compiled once for each target
define bench_target
$(C)/data-$(1).o: $(C)/scene_data.c $(BOARD)/boards.mk
	@mkdir -p $$(@D); echo "CC $$@"; $$(call bench_cc,$(1)) $$(DEPFLAGS) -Iinclude -Itools/cycles -c -o $$@ $$<
$(C)/%/bench-$(1): $(CYCLES_DEPS) $(C)/data-$(1).o $(board_$(1)) $(wildcard $(BOARD)/*.ld $(BOARD)/*.h)
	@mkdir -p $$(@D); echo "CC $$@"
	@$$(call bench_cc,$(1)) -DEW_RECIP_BITS=$$* $$(call bench_cost,$(1)) -Iinclude -o $$@ $$(filter %.c %.S %.o,$$^) $$(link_$(1))
endef
$(foreach t,host m0plus m3 m4 m33 rv32imc,$(eval $(call bench_target,$(t))))
$(C)/list: $(CYCLES_DEPS) $(C)/data-host.o
	@echo "CC $@"
	@$(call bench_cc,host) -DEW_TRACE=1 -Iinclude -o $@ $(filter %.c %.o,$^)
# work-TARGET: cost against work, at the default size of the table. Its pictures need more memory than
# the SRAM of the boards: 16 MB of PSRAM.
WORK_TARGETS := host m0plus m3 rv32imc
work_link = $(if $(filter m0plus m3,$(1)),$(call memory,0,0x400000,0x21000000,0x1000000),$(link_$(1)))
define work_target
$(C)/work-$(1): tools/cycles/work.c $(CYCLES_DEPS) $(C)/data-$(1).o $(board_$(1)) $(wildcard $(BOARD)/*.ld $(BOARD)/*.h)
	@mkdir -p $$(@D); echo "CC $$@"
	@$$(call bench_cc,$(1)) -DEW_RECIP_BITS=$(COUNT_BITS) -Iinclude -Itools/cycles -o $$@ \
	  $$(filter-out tools/cycles/bench.c,$$(filter %.c %.S %.o,$$^)) $$(call work_link,$(1))
endef
$(foreach t,$(WORK_TARGETS),$(eval $(call work_target,$(t))))
$(C)/work-list: tools/cycles/work.c $(CYCLES_DEPS) $(C)/data-host.o
	@echo "CC $@"
	@$(call bench_cc,host) -DEW_TRACE=1 -Iinclude -Itools/cycles -o $@ $(filter-out tools/cycles/bench.c,$(filter %.c %.o,$^))
# visibility-TARGET: three ways to find what is seen, in as much memory
VISIBILITY_TARGETS := m3
define visibility_target
$(C)/visibility-$(1): tools/cycles/visibility.c $(CYCLES_DEPS) $(board_$(1)) $(wildcard $(BOARD)/*.ld $(BOARD)/*.h)
	@mkdir -p $$(@D); echo "CC $$@"
	@$$(call bench_cc,$(1)) -DEW_RECIP_BITS=$(COUNT_BITS) -Iinclude -o $$@ \
	  $$(filter-out tools/cycles/bench.c,$$(filter %.c %.S %.o,$$^)) $$(call work_link,$(1))
endef
$(foreach t,$(VISIBILITY_TARGETS),$(eval $(call visibility_target,$(t))))
$(C)/visibility-list: tools/cycles/visibility.c $(CYCLES_DEPS)
	@mkdir -p $(@D); echo "CC $@"
	@$(call bench_cc,host) -Iinclude -o $@ $(filter-out tools/cycles/bench.c,$(filter %.c,$^))
visibility_images = $(C)/visibility-list $(addprefix $(C)/visibility-,$(filter $(VISIBILITY_TARGETS),$(COUNT_TARGETS)))
work_images = $(C)/work-list $(addprefix $(C)/work-,$(filter $(WORK_TARGETS),$(COUNT_TARGETS)))

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
	@$(COUNT)count.py --build $(C) --bits $(COUNT_BITS) --csv build/report/counts.csv --memory build/report/memory.csv $(COUNT_TARGETS)
check-counts-run update-counts-run: $(call bench_images,$(COUNT_BITS))
	@$(COUNT)baseline.py $(firstword $(subst -, ,$@)) --build $(C) --bits $(COUNT_BITS) --baseline tools/cycles/baseline.csv $(COUNT_TARGETS)
goals:  ## what is aimed at against what is reached, and where instructions go where it is not (GOAL_TARGETS=)
	@SETUP=$(SETUP) tools/setup/setup.sh count
	@$(MAKE) --no-print-directory -j2 COUNT_TARGETS="$(GOAL_TARGETS)" goals-run
goals-run: $(call bench_images,$(COUNT_BITS)) report-size
	@mkdir -p build/report
	@$(COUNT)goals.py --build $(C) --bits $(COUNT_BITS) --goals tools/cycles/goals.csv --sizes build/report/size.csv \
	  --csv build/report/goals.csv --where build/report/where.csv $(COUNT_TARGETS)
.PHONY: goals goals-run
.PHONY: count check-counts update-counts count-run check-counts-run update-counts-run
