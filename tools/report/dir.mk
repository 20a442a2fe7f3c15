# The report: every method counted on every target and judged by the referee, as tables, charts and
# a page.
REPORT_BITS ?= 4 5 6 7 8 9
REPORT := build/report
JUDGE_SRCS := tools/report/judge.c $(addprefix host_tests/,accuracy/measure.c accuracy/scene_measure.c \
  accuracy/standard_measure.c   reference/referee.c reference/scenes.c) $(addprefix tools/common/,image.c player.c whole_file.c)
$(C)/%/judge: $(JUDGE_SRCS) $(CORE_SRCS) tools/cycles/cases.h \
  $(wildcard include/edgewalk/*.h host_tests/*/*.h tools/common/*.h fixed/*.inc src/*/*.h)
	@mkdir -p $(@D); echo "CC $@"
	@$(CC) $(HOST_CFLAGS) -DEW_TRACE=1 -DEW_RECIP_BITS=$* -o $@ $(filter %.c,$^) -lpng -lz -lm

report:  ## speed against accuracy: tables, charts and a page in build/report (REPORT_BITS=, COUNT_TARGETS=)
	@SETUP=$(SETUP) tools/setup/setup.sh report
	@$(MAKE) --no-print-directory -j2 report-run
.PHONY: report report-run

# The walks run under the sanitizers: no axis may end in a write outside or undefined behaviour.
STABILITY_SRCS := $(addprefix tools/report/,stability.c walk.c more_axes.c memory_axes.c link_axes.c rotations.c maps.c) host_tests/reference/exact.c $(filter-out tools/% host_tests/accuracy/scene_measure.c host_tests/accuracy/standard_measure.c,$(JUDGE_SRCS)) \
  $(filter-out src/scene/%,$(CORE_SRCS))
$(C)/%/stability: $(STABILITY_SRCS) tools/cycles/cases.h $(wildcard tools/report/*.h include/edgewalk/*.h host_tests/*/*.h fixed/*.inc src/*/*.h)
	@mkdir -p $(@D); echo "CC $@"
	@$(CC) $(HOST_CFLAGS) -g -fsanitize=address,undefined -fno-sanitize-recover=all -include assert.h '-DEW_ASSERT=assert' \
	  -DEW_TRACE=1 -DEW_RECIP_BITS=$* -o $@ $(filter %.c,$^) -lm
STABILITY := $(foreach b,$(COUNT_BITS) $(filter-out $(COUNT_BITS),$(REPORT_BITS)),$(C)/$(b)/stability)
stability:  ## the axes along which methods fail, walked until they do: build/report/stability.csv
	@SETUP=$(SETUP) tools/setup/setup.sh report
	@$(MAKE) --no-print-directory -j2 stability-run
ATLAS = mkdir -p $(REPORT) && PYTHONDONTWRITEBYTECODE=1 $(PYTHON) tools/report/atlas.py --out $(REPORT) $(STABILITY)
stability-run: $(STABILITY)
	@$(ATLAS)
# The report shows limits that disagree, and does not stop at them.
report-atlas: $(STABILITY)
	@$(ATLAS) >$(C)/stability.log || [ $$? = 3 ] || { cat $(C)/stability.log; exit 2; }
report-size:
	@mkdir -p $(REPORT) $(C)
	@PYTHONDONTWRITEBYTECODE=1 $(PYTHON) host_tests/static/size.py --build build/size --base none --report $(REPORT) >$(C)/size.log
report-worst: $(BIN)/search_worst
	@mkdir -p $(REPORT)
	@$(BIN)/search_worst --tries 3000 >$(REPORT)/worst.txt || [ $$? = 1 ] || exit 2
report-run: $(call bench_images,$(REPORT_BITS)) $(work_images) $(visibility_images) $(foreach b,$(REPORT_BITS),$(C)/$(b)/judge) report-atlas report-size report-worst
	@PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=tools/cycles $(PYTHON) tools/report/report.py --build $(C) --out $(REPORT) --goals tools/cycles/goals.csv \
	  --bits "$(REPORT_BITS)" --scenes "$(foreach s,$(COUNT_SCENES),$(s)=$(B)/scenes/$(s).ewb)" $(COUNT_TARGETS)
# The three ways alone.
visibility: $(visibility_images) $(C)/count.so
	@mkdir -p $(REPORT)
	@PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=tools/cycles $(PYTHON) tools/report/visibility.py --build $(C) --out $(REPORT)
.PHONY: visibility
.PHONY: stability stability-run report-atlas report-size report-worst
