# Properties of random cases: a slice in `make test`, all of them in `make fuzz`.
PROPERTY := $(B)/host_tests/property
CASES := $(addprefix $(PROPERTY)/,cases.o triangles.o) $(UNIT)/unit.o
PROPERTY_TESTS := $(addprefix $(T)/test_,coverage coverage_hits meshes displacement rows modes visibility)

# The core as it is shipped, and with its trace.
$(PROPERTY)/test_coverage.o: HOST_INC =
$(PROPERTY)/test_coverage_hits.o: host_tests/property/test_coverage.c
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) $(CFLAGS) -DEW_TRACE=1 $(DEPFLAGS) -c -o $@ $<
$(T)/test_coverage $(T)/test_meshes: $(T)/test_%: $(PROPERTY)/test_%.o $(CASES) $(B)/host_tests/reference/coverage.o $(LIB)
	$(LINK_TEST)
$(T)/test_coverage_hits: $(PROPERTY)/test_coverage_hits.o $(CASES) $(B)/host_tests/reference/coverage.o $(TRACE_OBJS)
	$(LINK_TEST)
$(T)/test_displacement: $(PROPERTY)/test_displacement.o $(PROPERTY)/promise.o $(CASES) \
  $(addprefix $(B)/host_tests/reference/,exact.o referee.o scenes.o) $(TRACE_OBJS)
	$(LINK_TEST)
$(T)/test_rows $(T)/test_modes: $(T)/test_%: $(PROPERTY)/test_%.o $(PROPERTY)/pictures.o $(PROPERTY)/random_scene.o $(CASES) $(LIB)
	$(LINK_TEST) -pthread
$(T)/test_visibility: $(addprefix $(PROPERTY)/,test_visibility.o pictures.o random_scene.o) $(CASES) \
  $(B)/host_tests/reference/scenes.o $(LIB)
	$(LINK_TEST) -pthread

# The search for the triangle that uses most of its promise, and those that it found.
WORST_OBJS := $(addprefix $(PROPERTY)/,worst.o promise.o) $(CASES) $(addprefix $(B)/host_tests/reference/,exact.o referee.o) $(TRACE_OBJS)
PROPERTY_TESTS += $(T)/test_worst
$(T)/test_worst: $(PROPERTY)/test_worst.o $(WORST_OBJS)
	$(LINK_TEST)
$(BIN)/search_worst: $(PROPERTY)/search_worst.o $(WORST_OBJS)
	@mkdir -p $(@D); echo "LINK $@"; $(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $^ -lcmocka -lm
TRIES ?= 100000
worst: $(BIN)/search_worst  ## look for the triangle that comes nearest to breaking each promise (TRIES=, EW_SEED=)
	@$< --tries $(TRIES)
.PHONY: worst
