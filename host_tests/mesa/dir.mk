# Mesa as a second referee. Without libosmesa6-dev the test says so and skips.
MESA := $(B)/host_tests/mesa
MESA_TESTS := $(T)/test_mesa
MESA_OBJS := $(MESA)/test_mesa.o $(addprefix $(B)/host_tests/reference/,coverage.o exact.o scenes.o) $(CASES) $(TRACE_OBJS)
MESA_SCENES := $(addprefix $(B)/scenes/,courtyard.ewb crate.ewb) # drawn whole, and triangle by triangle

# Remembers whether the library is there, so that installing it makes the test anew.
$(MESA)/found: FORCE
	@mkdir -p $(@D); $(PKG_CONFIG) --exists osmesa && echo yes > $@.new || echo no > $@.new
	@cmp -s $@ $@.new || cp $@.new $@
$(T)/test_mesa: $(MESA)/found $(MESA_SCENES) host_tests/mesa/test_mesa.c $(filter-out $(MESA)/test_mesa.o,$(MESA_OBJS)) $(MESA)/no_mesa.o
	@mkdir -p $(@D); echo "LINK $@"
	@if grep -q yes $(MESA)/found; then $(MAKE) --no-print-directory $(MESA)/test_mesa.o && \
	  $(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $(MESA_OBJS) -lcmocka -lm -lOSMesa; \
	else $(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $(MESA)/no_mesa.o $(UNIT)/unit.o -lcmocka; fi
FORCE:
.PHONY: FORCE
