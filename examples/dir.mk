# The sample scene, and the demo that takes a scene all the way to a display.
COURTYARD := $(B)/scenes/courtyard.ewb
LAB_SCENE ?= $(COURTYARD)
$(B)/scenes/%.glb: examples/scenes/%.py
	@mkdir -p $(@D)
	$(PYTHON) $< -o $@
$(B)/scenes/%.ewb: $(B)/scenes/%.glb $(BIN)/ew-bake
	$(BIN)/ew-bake $< -o $@

SCENE      ?= $(B)/scenes/courtyard.glb
DISPLAY_DEV ?= sim:320x240
DEMO_FRAMES ?= 60
DEMO := build/demo

demo:  ## set up what is missing; bake SCENE=file.glb, draw it, stream it to DISPLAY_DEV= (simulated)
	@SETUP=$(SETUP) tools/setup/setup.sh demo
	@$(MAKE) --no-print-directory demo-run
demo-run: $(PROGRAMS) $(BIN)/ew-accuracy $(SCENE)
	@BIN=$(BIN) SCENE='$(SCENE)' DEVICE='$(DISPLAY_DEV)' FRAMES=$(DEMO_FRAMES) OUT=$(DEMO) examples/demo.sh
.PHONY: demo demo-run
