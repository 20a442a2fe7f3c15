# Firmware for emulated boards: the examples here, and same_bits of host_tests/firmware. An
# image is called PROGRAM-TARGET; board/boards.mk has the targets.
F := $(B)/firmware

# The host counts as targets of its own: two compilers, three levels.
HOST_TARGETS := $(foreach c,gcc clang,$(foreach o,O0 O2 O3,host-$(c)-$(o)))
$(foreach o,O0 O2 O3,$(eval cc_host-gcc-$(o) = gcc -$(o))$(eval cc_host-clang-$(o) = clang -$(o)))
$(foreach t,$(HOST_TARGETS),$(eval board_$(t) := $(BOARD)/host.c $(BOARD)/text.c))

# What can be built here; firmware-test says what could not, and why.
COMPILERS := $(shell for c in gcc clang arm-none-eabi-gcc riscv64-unknown-elf-gcc avr-gcc; do command -v $$c; done)
here = $(if $(filter %/$(firstword $(cc_$(1))),$(COMPILERS)),$(1))
BIG_TARGETS := $(foreach t,$(HOST_TARGETS) m0plus m3 m4 m7 m33 m55 rv32imc,$(call here,$(t)))
LITTLE_TARGETS := $(foreach t,microbit lm3s6965evb,$(call here,$(t)))
FIRMWARE_TARGETS := $(BIG_TARGETS) $(LITTLE_TARGETS) $(call here,avr)

# ---- the core, once for each target ----
optimise = $(if $(filter host-%,$(1)),,-O2)
define firmware_core
$(CORE_SRCS:%.c=$(F)/$(1)/%.o): $(F)/$(1)/%.o: %.c $(BOARD)/boards.mk
	@mkdir -p $$(@D)
	$$(cc_$(1)) $$(call optimise,$(1)) -std=c99 -pedantic -ffreestanding -ffunction-sections -fdata-sections $$(WARN) \
	  $$(EW_CONFIG) -Iinclude $$(DEPFLAGS) -c -o $$@ $$<
$(F)/$(1)/libedgewalk.a: $(CORE_SRCS:%.c=$(F)/$(1)/%.o)
	rm -f $$@
	$$(patsubst %gcc,%gcc-ar,$$(patsubst clang,ar,$$(firstword $$(cc_$(1))))) rcs $$@ $$^
endef
HOT_TARGETS := $(call here,m3_hot)
$(foreach t,$(FIRMWARE_TARGETS) $(HOT_TARGETS),$(eval $(call firmware_core,$(t))))

# ---- images ----
# $(call image,PROGRAM,TARGET,SOURCES,DEFINITIONS)
FIRMWARE_HEADERS := $(wildcard examples/firmware/*.h examples/firmware/*/*.h host_tests/firmware/*.h include/edgewalk/*.h)
define firmware_image
FIRMWARE_IMAGES += $(F)/$(1)-$(2).elf
$(F)/$(1)-$(2).elf: $(3) $$(board_$(2)) $(F)/$(2)/libedgewalk.a $$(wildcard $(BOARD)/*.ld) $$(FIRMWARE_HEADERS)
	$$(cc_$(2)) $$(call optimise,$(2)) -g -std=gnu99 -ffunction-sections -fdata-sections -Wall -Wextra \
	  $$(if $$(filter host-% avr,$(2)),,-ffreestanding) $(4) $$(EW_CONFIG) -Iinclude -o $$@ $$(filter %.c %.S %.a,$$^) $$(link_$(2))
endef
image = $(eval $(call firmware_image,$(1),$(2),$(3),$(4)))

# A baked scene as C source, which a firmware links, and as a file for ew-render.
BAKE_FIRMWARE = @mkdir -p $(@D); $(BIN)/ew-bake $< --key-interval 100 -o $@
$(F)/%.c: $(B)/scenes/%.glb $(BIN)/ew-bake
	$(BAKE_FIRMWARE) --c-array
$(F)/%.ewb: $(B)/scenes/%.glb $(BIN)/ew-bake
	$(BAKE_FIRMWARE)

PLAYER := examples/firmware/player.c
OLED := $(addprefix examples/firmware/oled/,main.c ssd0323.c) $(PLAYER) $(F)/crate.c
HASH := examples/firmware/hash/main.c examples/firmware/picture_hash.c $(PLAYER)
CRATE_ROOM := -DPLAYER_NODES=2 -DPLAYER_VERTICES=16
$(foreach t,$(call here,lm3s6965evb),$(call image,oled,$(t),$(OLED),$(CRATE_ROOM)))
# wired or set up wrongly on purpose: firmware-test must notice
$(foreach t,$(call here,lm3s6965evb),$(call image,oled_no_dc,$(t),$(OLED),$(CRATE_ROOM) -DPANEL_DC_PIN=6))
$(foreach t,$(call here,lm3s6965evb),$(call image,oled_window,$(t),$(OLED),$(CRATE_ROOM) -DPANEL_FIRST_COLUMN=1))
$(foreach t,$(call here,rv32imc),$(call image,rgb565,$(t),examples/firmware/rgb565/main.c $(PLAYER) $(F)/courtyard.c))
$(foreach t,$(BIG_TARGETS),$(call \
  image,hash,$(t),$(HASH) $(F)/courtyard.c))
$(foreach t,$(BIG_TARGETS) $(LITTLE_TARGETS) $(HOT_TARGETS),$(call \
  image,hash64x48,$(t),$(HASH) $(F)/crate.c,\
  $(CRATE_ROOM) -DPICTURE_WIDTH=64 -DPICTURE_HEIGHT=48))
$(foreach t,$(BIG_TARGETS) $(LITTLE_TARGETS),$(call \
  image,lines,$(t),examples/firmware/lines/main.c examples/firmware/picture_hash.c $(F)/crate.c,$(CRATE_ROOM)))

# what each has room for: host_tests/firmware/same_bits.h
room_avr := 0
room_microbit := 1
room_lm3s6965evb := 2
SAME_BITS := $(wildcard host_tests/firmware/*.c) examples/firmware/picture_hash.c
$(F)/standard_scenes.c: $(C)/scene_data
	@mkdir -p $(@D)
	$< > $@
$(foreach t,$(FIRMWARE_TARGETS),$(call image,same_bits,$(t),$(SAME_BITS) \
  $(if $(filter avr,$(t)),,$(F)/standard_scenes.c),-Itools/cycles -DSAME_BITS_ROOM=$(or $(room_$(t)),3)))
$(filter $(F)/same_bits-%,$(FIRMWARE_IMAGES)): tools/cycles/cases.h tools/cycles/scene_data.h

firmware:  ## set up what is missing; build the firmware examples for their boards: build/*/firmware/*.elf
	@SETUP=$(SETUP) tools/setup/setup.sh firmware
	@$(MAKE) --no-print-directory firmware-images
firmware-images: $(FIRMWARE_IMAGES)
	@:
firmware-test: firmware  ## run them on emulated boards: pictures and hashes equal the host's
	@$(MAKE) --no-print-directory firmware-test-tools
	@EW_BIN=$(BIN) EW_FIRMWARE=$(F) EW_COUNT=$(C)/count.so $(RUN) host_tests/firmware/test_firmware.py
firmware-test-tools: $(C)/count.so $(C)/list $(BIN)/ew-render $(F)/crate.ewb $(F)/courtyard.ewb
	@:
.PHONY: firmware firmware-images firmware-test-tools firmware-test
