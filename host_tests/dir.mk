# Tests: cmocka groups (unit/test_*.c), Python's unittest (cli/test_*.py), and the accuracy
# program, which links the core built once more with EW_TRACE = 1.

# ---- the core with its trace, and what judges it ----
TRACE_OBJS := $(CORE_SRCS:%.c=$(B)/trace/%.o)
$(TRACE_OBJS): $(B)/trace/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CORE_CFLAGS) $(CFLAGS) -DEW_TRACE=1 $(DEPFLAGS) -c -o $@ $<

REFEREE_OBJS := $(addprefix $(B)/host_tests/,reference/referee.o reference/scenes.o accuracy/measure.o \
  accuracy/standard_measure.o)
$(B)/host_tests/%.o: HOST_INC = -DEW_TRACE=1

$(BIN)/ew-accuracy: $(addprefix $(B)/host_tests/accuracy/,accuracy.o scene_measure.o) $(REFEREE_OBJS) \
  $(COMMON_OBJS) $(TRACE_OBJS)
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $^ -lpng -lz -lm

# ---- unit tests ----
T := $(B)/tests
UNIT := $(B)/host_tests/unit
UNIT_TESTS := $(addprefix $(T)/test_,fixed recip quaternion light raster fill draw2d attributes clip geometry accuracy scene display display_faults panel stream readme)

LINK_TEST = @mkdir -p $(@D); echo "LINK $@"; $(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $^ -lcmocka -lm
$(addprefix $(T)/test_,fixed recip quaternion light scene display display_faults panel): $(T)/test_%: $(UNIT)/test_%.o $(UNIT)/unit.o $(LIB)
	$(LINK_TEST)
$(T)/test_raster: $(UNIT)/test_raster.o $(UNIT)/unit.o $(B)/host_tests/reference/referee.o $(LIB)
	$(LINK_TEST)
$(T)/test_fill $(T)/test_draw2d: $(T)/test_%: $(UNIT)/test_%.o $(UNIT)/unit.o $(B)/host_tests/reference/ref_fill.o $(LIB)
	$(LINK_TEST)
$(T)/test_geometry $(T)/test_accuracy: $(T)/test_%: $(UNIT)/test_%.o $(UNIT)/unit.o $(REFEREE_OBJS) $(TRACE_OBJS)
	$(LINK_TEST)
$(T)/test_attributes $(T)/test_clip: $(T)/test_%: $(UNIT)/test_%.o $(UNIT)/unit.o $(TRACE_OBJS)
	$(LINK_TEST)
$(T)/test_stream: $(UNIT)/test_stream.o $(UNIT)/unit.o $(STREAM_TEST_OBJS) $(LIB)
	$(LINK_TEST) -pthread
# The program that README.md shows, cut out of it and compiled as it stands there.
$(T)/readme_example.c: README.md
	@mkdir -p $(@D)
	awk '/^```c$$/ { on = 1; next } /^```$$/ { on = 0 } on' $< > $@
$(T)/readme_example.o: $(T)/readme_example.c $(wildcard include/edgewalk/*.h)
	$(CC) -std=c99 -pedantic -Wall -Wextra -Dmain=readme_main -Iinclude -c -o $@ $<
$(T)/test_readme: $(UNIT)/test_readme.o $(T)/readme_example.o $(UNIT)/unit.o $(B)/host_tests/reference/referee.o $(LIB)
	$(LINK_TEST)

# ---- configurations: each needs a core of its own ----
# recip-N: the reciprocals with a table of 2^N entries; raster-N: coverage at N subpixel bits;
# geometry-pieces: products as on a core without a long multiply; visibility-without-SPANS, fill-without-X and
# draw2d-without-X: with EW_WITH_X = 0, under UBSan; SOME_LOOPS and OTHER_LOOPS share the loops,
# EVERYTHING is all of it.
FILL_PARTS := SHADING FOG BLENDS CUTOUTS BILINEAR MIPS WRAPS TEXTURE_FORMATS TARGET_FORMATS DITHER
SOME_LOOPS := LOOP_FLAT LOOP_NO_DEPTH LOOP_LIT LOOP_GREY4
OTHER_LOOPS := LOOP_GOURAUD LOOP_KEYED LOOP_BILINEAR
EVERYTHING := $(FILL_PARTS) $(SOME_LOOPS) $(OTHER_LOOPS)
CONFIG_TESTS := $(foreach n,4 5 6 7 9,$(T)/test_recip-$(n)) $(foreach n,4 6,$(T)/test_raster-$(n)) $(T)/test_geometry-pieces \
  $(T)/test_visibility-without-SPANS $(foreach part,$(FILL_PARTS) SOME_LOOPS OTHER_LOOPS EVERYTHING,$(T)/test_fill-without-$(part)) $(T)/test_draw2d-without-EVERYTHING
$(CONFIG_TESTS): $(wildcard include/edgewalk/*.h fixed/*.inc src/*/*.h src/*/*.inc $(addprefix host_tests/,unit/unit.h reference/*.h accuracy/*.h))
$(T)/test_recip-%: host_tests/unit/test_recip.c host_tests/unit/unit.c fixed/recip.c
	@mkdir -p $(@D); echo "CC $@"
	@$(CC) $(HOST_CFLAGS) -DEW_RECIP_BITS=$* -o $@ $(filter %.c,$^) -lcmocka -lm
$(T)/test_raster-%: host_tests/unit/test_raster.c host_tests/unit/unit.c host_tests/reference/referee.c \
  $(filter fixed/% src/raster/%,$(CORE_SRCS))
	@mkdir -p $(@D); echo "CC $@"
	@$(CC) $(HOST_CFLAGS) -DEW_SUBPIXEL_BITS=$* -o $@ $(filter %.c,$^) -lcmocka -lm
$(T)/test_geometry-pieces: $(addprefix host_tests/,unit/test_geometry.c unit/unit.c reference/referee.c \
  reference/scenes.c accuracy/measure.c) $(filter fixed/% src/raster/% src/geometry/%,$(CORE_SRCS))
	@mkdir -p $(@D); echo "CC $@"
	@$(CC) $(HOST_CFLAGS) -DEW_LONG_MULTIPLY=0 -DEW_TRACE=1 -o $@ $(filter %.c,$^) -lcmocka -lm
$(T)/test_visibility-without-SPANS: $(addprefix host_tests/,property/test_visibility.c property/random_scene.c property/pictures.c \
  property/cases.c unit/unit.c reference/scenes.c) $(filter fixed/% src/raster/% src/geometry/%,$(CORE_SRCS))
	@mkdir -p $(@D); echo "CC $@"
	@$(CC) $(HOST_CFLAGS) -Werror -DEW_WITH_SPANS=0 -o $@ $(filter %.c,$^) -lcmocka -lm -pthread
define test_without
$(T)/test_$(1)-without-%: host_tests/unit/test_$(1).c host_tests/unit/unit.c host_tests/reference/ref_fill.c \
  $(filter fixed/% src/raster/%,$(CORE_SRCS))
	@mkdir -p $$(@D); echo "CC $$@"
	@$$(CC) $$(HOST_CFLAGS) -Werror -DSHARE=8 -fsanitize=undefined -fno-sanitize-recover=all -o $$@ $$(filter %.c,$$^) -lcmocka -lm \
	  $$(patsubst %,-DEW_WITH_%=0,$$(if $$(filter SOME_LOOPS OTHER_LOOPS EVERYTHING,$$*),$$($$*),$$*))
endef
$(eval $(call test_without,fill))
$(eval $(call test_without,draw2d))

include host_tests/property/dir.mk
include host_tests/mesa/dir.mk
include host_tests/fuzz/dir.mk
include host_tests/static/dir.mk
include host_tests/prove/dir.mk

# ---- goals ----
accuracy: $(T)/test_accuracy  ## the referee's figures for the standard scenes, rung by rung
	@EW_PRINT=1 $<
.PHONY: accuracy

CLI_TESTS := $(sort $(wildcard host_tests/cli/test_*.py))
RUN := PYTHONDONTWRITEBYTECODE=1 $(PYTHON) host_tests/run.py

# Everything as it is shipped, then the C tests once more under the sanitizers.
test:  ## set up what is missing and run every host test
	@SETUP=$(SETUP) tools/setup/setup.sh test
	@$(MAKE) --no-print-directory test-programs
	-@$(MAKE) --no-print-directory --keep-going counted-programs
	@$(MAKE) --no-print-directory MODE=sanitize sanitize-programs
	@EW_BIN=$(BIN) $(RUN) $(UNIT_TESTS) $(PROPERTY_TESTS) $(MESA_TESTS) $(CONFIG_TESTS) $(STATIC_TESTS) $(CLI_TESTS) \
	  $(patsubst build/$(MODE)/%,build/sanitize/%,$(SANITIZE_TESTS))
# assertions are none elsewhere: test_rows needs them
SANITIZE_TESTS := $(filter-out $(T)/test_recip $(T)/test_readme,$(UNIT_TESTS)) $(T)/test_any_bits $(T)/test_rows
# for test_where, which says what could not be built here
COUNTED := $(patsubst %,$(C)/$(COUNT_BITS)/bench-%,$(filter m0plus m3 m4 m33 rv32imc,$(BIG_TARGETS)))
counted-programs: $(COUNTED) $(if $(COUNTED),$(C)/list $(C)/count.so)
test-programs: programs $(BIN)/ew-accuracy $(UNIT_TESTS) $(PROPERTY_TESTS) $(MESA_TESTS) $(CONFIG_TESTS) check-tables
sanitize-programs: $(SANITIZE_TESTS)
.PHONY: test test-programs counted-programs sanitize-programs
