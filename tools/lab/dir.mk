# The kernel lab: a virtual USB display and the tests that run in a QEMU guest.
$(BIN)/usbip_display: $(B)/tools/lab/usbip_display.o $(B)/tools/stream/sim_panel.o $(LIB)
	@mkdir -p $(@D)
	$(CC) $(HOST_CFLAGS) $(LDFLAGS) -o $@ $^

LAB_PROGRAMS := $(BIN)/ew-stream $(BIN)/ew-stream-libusb $(BIN)/usbip_display
# LAB_SCENE: any baked scene whose camera or objects move.
lab-test: setup-lab  ## ew-stream against the kernel's own USB HID and GPIO, in QEMU
	@$(MAKE) --no-print-directory $(LAB_PROGRAMS) $(LAB_SCENE)
	@EW_BIN=$(BIN) EW_SCENE=$(LAB_SCENE) tools/lab/run-tests.sh
.PHONY: lab-test
