# Properties of random cases: a slice in `make test`, all of them in `make fuzz`.
PROPERTY := $(B)/host_tests/property
CASES := $(addprefix $(PROPERTY)/,cases.o triangles.o) $(UNIT)/unit.o
PROPERTY_TESTS := $(addprefix $(T)/test_,coverage coverage_hits meshes)

# The core as it is shipped, and with its trace.
$(PROPERTY)/test_coverage.o: HOST_INC =
$(PROPERTY)/test_coverage_hits.o: host_tests/property/test_coverage.c
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) $(CFLAGS) -DEW_TRACE=1 $(DEPFLAGS) -c -o $@ $<
$(T)/test_coverage $(T)/test_meshes: $(T)/test_%: $(PROPERTY)/test_%.o $(CASES) $(B)/host_tests/reference/coverage.o $(LIB)
	$(LINK_TEST)
$(T)/test_coverage_hits: $(PROPERTY)/test_coverage_hits.o $(CASES) $(B)/host_tests/reference/coverage.o $(TRACE_OBJS)
	$(LINK_TEST)

# FUZZ=0.1 runs a tenth. Figures go to build/report/witness.csv.
FUZZ ?= 1
FUZZ_TESTS = $(PROPERTY_TESTS) $(MESA_TESTS)
fuzz:  ## the random tests at full length (FUZZ=0.1: a tenth)
	@SETUP=$(SETUP) tools/setup/setup.sh test
	@$(MAKE) --no-print-directory fuzz-programs
	@mkdir -p build/report
	@echo 'check,class,cases,judged,wrong,value,unit' > build/report/witness.csv
	@failed=; for t in $(FUZZ_TESTS); do \
	  EW_FUZZ=$(FUZZ) EW_FIGURES=build/report/witness.csv $$t || failed="$$failed $$t"; \
	done; test -z "$$failed" || { echo "fuzz: failed:$$failed" >&2; exit 1; }
fuzz-programs: $(FUZZ_TESTS)
.PHONY: fuzz fuzz-programs
