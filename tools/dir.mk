# Programs. Packages are asked for in recipes only, so that `make` alone needs none.
COMMON_OBJS := $(addprefix $(B)/tools/common/,image.o options.o picture_options.o player.o whole_file.o)

PROGRAMS += $(BIN)/ew-render
$(BIN)/ew-render: $(B)/tools/render/render.o $(COMMON_OBJS) $(LIB)
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $^ -lpng -lz -lm

include tools/bake/dir.mk
include tools/stream/dir.mk
include tools/lab/dir.mk
include tools/cycles/dir.mk
include tools/report/dir.mk

setup-demo setup-test setup-lab setup-count setup-report setup-firmware setup-cross setup-lint setup-prove: setup-%:  ## install the packages of that goal
	@SETUP=$(SETUP) tools/setup/setup.sh $*
.PHONY: setup-demo setup-test setup-lab setup-count setup-report setup-firmware setup-cross setup-lint setup-prove
