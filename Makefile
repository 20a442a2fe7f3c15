# edgewalk: `make help` lists what can be made.
#
#   make            the freestanding library, nothing but a C compiler needed
#   make demo       a baked scene through the core to a (simulated) HID display
#   make test       every test that runs on this machine
#
# Each folder brings a fragment, dir.mk, that adds its sources to the lists below.
# Outputs go to build/$(MODE)/; a fragment never writes beside the sources.

MODE      ?= release
SETUP     ?= 1
CC        ?= cc
CXX       ?= c++
AR        ?= ar
PYTHON    ?= python3
PKG_CONFIG ?= pkg-config
EW_CONFIG ?=                 # -D options for include/edgewalk/config.h
-include config.mk           # optional and local: overrides of the lines above

B   := build/$(MODE)
BIN := $(B)/bin

WARN := -Wall -Wextra -Wconversion -Wcast-align -Wshadow
OPTIMISE_release  := -O2
OPTIMISE_debug    := -O0 -g
OPTIMISE_sanitize := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
OPTIMISE := $(OPTIMISE_$(MODE))
ifeq ($(strip $(OPTIMISE)),)
$(error MODE is release, debug or sanitize, not '$(MODE)')
endif
# Host programs check what callers promise; the library that is shipped does not.
ASSERT := $(if $(filter sanitize debug,$(MODE)),-include assert.h '-DEW_ASSERT=assert')

CORE_CFLAGS := -std=c99 -pedantic -ffreestanding $(WARN) $(OPTIMISE) $(EW_CONFIG) $(ASSERT) -Iinclude
HOST_CFLAGS := -std=gnu11 $(WARN) $(OPTIMISE) $(EW_CONFIG) -Iinclude -I.
HOST_CXXFLAGS := -std=c++17 -Wall -Wextra $(OPTIMISE) -Iinclude -I.
DEPFLAGS = -MMD -MP

LIB := $(B)/libedgewalk.a

all: $(LIB)  ## the freestanding library (the default)

CORE_SRCS :=
PROGRAMS  :=
include fixed/dir.mk
include src/dir.mk
include examples/firmware/board/boards.mk
include tools/dir.mk
include examples/dir.mk
include host_tests/dir.mk

CORE_OBJS := $(CORE_SRCS:%.c=$(B)/%.o)

$(LIB): $(CORE_OBJS)
	rm -f $@
	$(AR) rcs $@ $^
$(CORE_OBJS): $(B)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CORE_CFLAGS) $(CFLAGS) $(DEPFLAGS) -c -o $@ $<
$(B)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) $(CFLAGS) $(HOST_INC) $(DEPFLAGS) -c -o $@ $<
$(B)/%.o: %.cpp
	@mkdir -p $(@D)
	$(CXX) $(HOST_CXXFLAGS) $(CXXFLAGS) $(HOST_INC) $(DEPFLAGS) -c -o $@ $<

programs: $(PROGRAMS)  ## ew-bake, ew-render, ew-stream (needs the packages of `make setup-demo`)

install: programs $(LIB)  ## library, headers and programs under $(DESTDIR)$(PREFIX)
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/lib $(DESTDIR)$(PREFIX)/include/edgewalk
	install -m 755 $(PROGRAMS) $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(LIB) $(DESTDIR)$(PREFIX)/lib
	install -m 644 include/edgewalk/*.h $(DESTDIR)$(PREFIX)/include/edgewalk
PREFIX ?= /usr/local

clean:  ## remove everything that was made
	rm -rf build

help:  ## this list
	@awk -F ':.*## ' '/^[a-z][a-z -]*:.*## / { printf "  make %-16s %s\n", $$1, $$2 }' $(filter %Makefile %dir.mk,$(MAKEFILE_LIST))
	@echo "  MODE=release|debug|sanitize   SETUP=0 (only say what is missing)   PREFIX=$(PREFIX)"

.PHONY: all programs install clean help
.DELETE_ON_ERROR:
-include $(shell find $(B) -name '*.d' 2>/dev/null)
