# Frama-C's Eva over parts of the raster core and the display's device end; docs/proofs.md.
# Without Frama-C it is skipped with the reason; PROVE_REQUIRE=1 makes that a failure.
PROVE_REQUIRE ?=
prove:  ## no undefined behaviour in parts of the core, for all inputs, by Frama-C (docs/proofs.md)
	@SETUP=$(SETUP) tools/setup/setup.sh prove || true
	@if ! command -v frama-c >/dev/null || ! command -v z3 >/dev/null; then \
	  echo "prove: skipped: frama-c (package frama-c-base) and z3 are not there" >&2; test -z "$(PROVE_REQUIRE)"; exit; \
	fi; \
	mkdir -p build; $(MAKE) --no-print-directory $(addprefix $(T)/test_,recip fixed) >build/prove-tests.log 2>&1 || \
	  { cat build/prove-tests.log >&2; exit 1; }; \
	PYTHONDONTWRITEBYTECODE=1 $(PYTHON) host_tests/prove/prove.py --tests $(T) $(PARTS)
.PHONY: prove
