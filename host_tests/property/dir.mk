# Properties of random cases: a slice in `make test`, all of them in `make fuzz`.
PROPERTY := $(B)/host_tests/property
CASES := $(addprefix $(PROPERTY)/,cases.o triangles.o) $(UNIT)/unit.o
PROPERTY_TESTS := $(addprefix $(T)/test_,coverage coverage_hits meshes displacement rows modes)

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
$(T)/test_rows $(T)/test_modes: $(T)/test_%: $(PROPERTY)/test_%.o $(PROPERTY)/pictures.o $(CASES) $(LIB)
	$(LINK_TEST) -pthread
