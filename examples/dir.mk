# The sample scene, and the demo that takes a scene all the way to a display.
COURTYARD := $(B)/scenes/courtyard.ewb
LAB_SCENE ?= $(COURTYARD)
$(B)/scenes/%.glb: examples/scenes/%.py examples/scenes/glb.py
	@mkdir -p $(@D)
	$(PYTHON) -B $< -o $@
$(B)/scenes/%.ewb: $(B)/scenes/%.glb $(BIN)/ew-bake
	$(BIN)/ew-bake $< -o $@

# The demo's settings reach its script through the environment: a name may hold anything.
# 120 frames at 30 a second are one turn of the courtyard's knot.
SCENE       ?= $(B)/scenes/courtyard.glb
DISPLAY_DEV ?= sim:320x240
DEMO_FRAMES ?= 120
demo-run: export SCENE := $(SCENE)
demo-run: export DEVICE := $(DISPLAY_DEV)
demo-run: export FRAMES := $(DEMO_FRAMES)
demo-run: export OUT := build/demo
demo-run: export BIN := $(BIN)

demo:  ## set up what is missing; bake SCENE=file.glb, draw it, stream it to DISPLAY_DEV= (simulated)
	@SETUP=$(SETUP) tools/setup/setup.sh demo
	@$(MAKE) --no-print-directory demo-run
demo-run: $(PROGRAMS) $(BIN)/ew-accuracy $(COURTYARD:.ewb=.glb)
	@examples/demo.sh
.PHONY: demo demo-run

example-fills: build/fills.png  ## a sheet of all fills: build/fills.png
build/fills.png: $(BIN)/fills
	$(BIN)/fills $@
$(BIN)/fills: $(B)/examples/fills.o $(addprefix $(B)/tools/common/,image.o whole_file.o) $(LIB)
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $^ -lpng -lz
.PHONY: example-fills

example-hud: build/hud.png  ## a HUD over a crate: build/hud.png
build/hud.png: $(BIN)/hud $(B)/scenes/crate.ewb
	$(BIN)/hud $(B)/scenes/crate.ewb $@
$(BIN)/hud: $(B)/examples/hud.o $(COMMON_OBJS) $(LIB)
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $^ -lpng -lz -lm
.PHONY: example-hud

include examples/firmware/dir.mk
