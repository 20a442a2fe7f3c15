# Any bits through the public functions; the sanitizers are what judges.
ANY_BITS := host_tests/fuzz/test_any_bits
$(T)/test_any_bits: $(B)/$(ANY_BITS).o $(PROPERTY)/cases.o $(UNIT)/unit.o $(LIB)
	$(LINK_TEST)

# ---- at full length ----
# FUZZ=0.1 runs a tenth. Figures go to build/report/witness.csv.
FUZZ ?= 1
FUZZ_TESTS := $(PROPERTY_TESTS) $(MESA_TESTS) build/sanitize/tests/test_any_bits
FIGURES := build/report/witness.csv
fuzz:  ## the random tests at full length, about 20 minutes (FUZZ=0.1: a tenth)
	@SETUP=$(SETUP) tools/setup/setup.sh test
	@$(MAKE) --no-print-directory $(PROPERTY_TESTS) $(MESA_TESTS)
	@$(MAKE) --no-print-directory MODE=sanitize build/sanitize/tests/test_any_bits
	@mkdir -p $(dir $(FIGURES)); echo 'check,kind,cases,judged,wrong,value,unit' > $(FIGURES)
	@failed=; for t in $(FUZZ_TESTS); do \
	  EW_FUZZ=$(FUZZ) EW_FIGURES=$(FIGURES) $$t || failed="$$failed $$t"; \
	done; test -z "$$failed" || { echo "fuzz: failed:$$failed" >&2; exit 1; }
.PHONY: fuzz
