# What can be known without running: sizes, stacks, what linters say.
STATIC_TESTS := host_tests/static/test_static.py

BASE ?= HEAD
size:  ## text, data, bss and stacks cross-built, and their change (BASE=revision) to build/report/
	@SETUP=$(SETUP) tools/setup/setup.sh cross
	@PYTHONDONTWRITEBYTECODE=1 $(PYTHON) host_tests/static/size.py --build build/size --base $(BASE)
.PHONY: size

# The core, and those tests that judge it. cppcheck takes the address of a structure that is about to be
# filled for a use of it (uninitvar): gcc and clang-tidy look for those.
LINT_CORE := fixed src
LINT_HOST := $(addprefix host_tests/,fuzz mesa property reference)
CPPCHECK = cppcheck --quiet --enable=warning,portability,performance --suppress=uninitvar --suppress=ctuuninitvar --error-exitcode=1
TIDY = clang-tidy --quiet --config-file=host_tests/static/clang-tidy.yml
lint:  ## cppcheck, clang-tidy and stricter warnings over the core and what judges it
	@SETUP=$(SETUP) tools/setup/setup.sh lint
	@mkdir -p $(B)
	$(CPPCHECK) --std=c99 --platform=unix32 -Iinclude $(LINT_CORE)
	$(CPPCHECK) --std=c11 --suppress=shiftNegativeLHS -DEW_TRACE=1 -Iinclude -I. $(LINT_HOST)
	@for f in $(CORE_SRCS); do \
	  $(CC) $(CORE_CFLAGS) -Wcast-align=strict -Wcast-qual -Wundef -Wvla -Wdouble-promotion -Werror -c -o $(B)/lint.o $$f || exit 1; \
	done; rm -f $(B)/lint.o
	@$(TIDY) $(CORE_SRCS) -- -std=c99 -Iinclude 2>$(B)/lint.log || { cat $(B)/lint.log >&2; exit 1; }
	@$(TIDY) $(wildcard $(addsuffix /*.c,$(LINT_HOST))) -- -std=gnu11 -Iinclude -I. -DEW_TRACE=1 2>$(B)/lint.log || \
	  { cat $(B)/lint.log >&2; exit 1; }
	@echo "lint: clean"
.PHONY: lint
