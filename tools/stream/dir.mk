# ew-stream, and the same against hidapi's libusb back end for the lab.
STREAM_OBJS := $(addprefix $(B)/tools/stream/,frame_source.o gpio_gpiod.o hid.o link.o panel_lines.o sender.o \
  sim.o sim_panel.o stream.o stream_options.o stream_output.o)

$(B)/tools/stream/hid.o: HOST_INC = $$($(PKG_CONFIG) --cflags hidapi-hidraw)
$(B)/tools/stream/gpio_gpiod.o: HOST_INC = $$($(PKG_CONFIG) --cflags libgpiod 2>/dev/null) -DEW_GPIOD_MAJOR=$$( \
  $(PKG_CONFIG) --exists 'libgpiod >= 2' && echo 2 || { $(PKG_CONFIG) --exists libgpiod && echo 1 || echo 0; })

LINK_STREAM = $(CC) $(HOST_CFLAGS) $(LDFLAGS) -pthread -o $@ $^ $$($(PKG_CONFIG) --libs $(1)) \
  $$($(PKG_CONFIG) --libs libgpiod 2>/dev/null) -lpng -lz -lm

# What test_stream links: all but drivers of real devices and the program itself.
STREAM_TEST_OBJS := $(addprefix $(B)/tools/stream/,link.o panel_lines.o sender.o sim.o sim_panel.o)

PROGRAMS += $(BIN)/ew-stream
$(BIN)/ew-stream: $(STREAM_OBJS) $(COMMON_OBJS) $(LIB)
	@mkdir -p $(@D)
	$(call LINK_STREAM,hidapi-hidraw)
$(BIN)/ew-stream-libusb: $(STREAM_OBJS) $(COMMON_OBJS) $(LIB)
	@mkdir -p $(@D)
	$(call LINK_STREAM,hidapi-libusb)
