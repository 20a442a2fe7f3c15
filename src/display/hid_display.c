/* src/display/hid_display.c - the device's end of the wire protocol.
 *
 * A report is applied only when it is intact and next in sequence, so that a device
 * without a frame memory draws nothing but pixels of the frame that was sent. Whatever
 * breaks the chain - a lost, repeated, swapped or changed report, a lost frame, a
 * frame that does not fit - ends in give_up(): nothing is drawn from then on until a
 * key frame of the whole panel begins, since only that needs nothing from before.
 */
#include "edgewalk/display.h"

#include "edgewalk/error.h"
#include "wire.h"

/* What the next payload byte is. */
enum {
    BETWEEN,    /* no frame is being received                                */
    DROPPING,   /* the rest of a frame that was given up                     */
    IN_HEADER,  /* from here on a frame is being received                    */
    IN_OP,      /* from here on something of it may have been drawn          */
    IN_LONG_OP, /* second byte of a long op                                  */
    IN_COLOUR,  /* upper byte of a colour                                    */
    IN_COLOUR_LOW,
    IN_CRC,
    IN_CRC_HIGH,
    COMPLETE /* nothing: the CRC was right                                   */
};

enum {
    ENABLE_BIT = 0x01,
    CLEAR_BIT = 0x02,
    BIT_DEPTH_FORMAT = 0x10, /* 16 bits a pixel: unconfirmed, see the page        */
    PIXEL_FORMAT_RGB565_BE = 0x01,
    BLIT_DATA = 8 /* offset in report 3                                           */
};

typedef char state_is_small[sizeof(ew_hid_display) - sizeof(ew_hid_panel) <= 64 ? 1 : -1];
typedef char display_is_small[sizeof(ew_hid_display) <= 128 ? 1 : -1];

static void post_status(ew_hid_display *display, uint8_t status)
{
    int error_unread = display->status_pending && display->status != EW_STREAM_OK;
    if (status == EW_STREAM_NEED_KEY && error_unread) return;
    display->status = status;
    display->status_pending = 1;
}

static void refuse(ew_hid_display *display, uint8_t status)
{
    display->rejected++;
    post_status(display, status);
}

static void leave_frame(ew_hid_display *display)
{
    if (display->state >= IN_OP && display->panel.abandon != NULL)
        display->panel.abandon(display->panel.user);
    display->state = DROPPING;
    display->need_key = 1;
}

static void give_up(ew_hid_display *display, uint8_t status)
{
    leave_frame(display);
    refuse(display, status);
}

static void commit(ew_hid_display *display)
{
    if (display->panel.commit != NULL) display->panel.commit(display->panel.user);
}

/* The rectangle lies inside the panel, so that as many pixels are the whole of it. */
static int is_full_key(const ew_hid_display *display)
{
    return (display->flags & FLAG_KEY) != 0 &&
           display->pixels_left == (uint32_t)display->panel_width * display->panel_height;
}

/* Takes rectangle and frame number from the whole header. Returns the status. */
static uint8_t read_header(ew_hid_display *display)
{
    const uint8_t *header = display->header;
    uint16_t number = get_u16(header + HEADER_FRAME);
    uint16_t height = get_u16(header + HEADER_HEIGHT);
    if (header[HEADER_CHECK] != ew_wire_header_check(header)) return EW_STREAM_BAD_CHECK;
    if (header[HEADER_VERSION] != WIRE_VERSION) return EW_STREAM_UNSUPPORTED;
    if (display->refusal == EW_STREAM_OK && number != (uint16_t)(display->frame_number + 1))
        display->refusal = EW_STREAM_SEQUENCE_GAP;
    display->frame_number = number;
    display->x = get_u16(header + HEADER_X);
    display->y = get_u16(header + HEADER_Y);
    display->width = get_u16(header + HEADER_WIDTH);
    if ((display->width == 0) != (height == 0) ||
        (uint32_t)display->x + display->width > display->panel_width ||
        (uint32_t)display->y + height > display->panel_height)
        return EW_STREAM_BAD_RECT;
    display->pixels_left = (uint32_t)display->width * height; /* <= 2^24: inside the panel */
    return is_full_key(display) ? EW_STREAM_OK : display->refusal;
}

/* State for the next op, colour or CRC when the one before is done. */
static void expect_next(ew_hid_display *display)
{
    if (display->pixels_left == 0) {
        display->state = IN_CRC;
    } else if ((display->flags & FLAG_CODEC) == EW_CODEC_RAW << FLAG_CODEC_SHIFT) {
        display->state = IN_COLOUR;
        display->run = 1;
        display->literals = 1;
    } else {
        display->state = IN_OP;
    }
}

static void take_header_byte(ew_hid_display *display, uint8_t byte)
{
    display->header[display->header_length++] = byte;
    if (display->header_length < HEADER_BYTES) return;
    display->header_length = 0;
    uint8_t status = read_header(display);
    if (status != EW_STREAM_OK) {
        give_up(display, status);
        return;
    }
    display->column = 0;
    display->row = 0;
    expect_next(display);
}

/* Goes `count` <= pixels_left pixels on, drawing them when `draw` says so. */
static void advance(ew_hid_display *display, uint16_t count, int draw)
{
    display->pixels_left -= count;
    while (count > 0) {
        uint16_t n = (uint16_t)(display->width - display->column);
        if (n > count) n = count;
        if (draw)
            display->panel.fill(display->panel.user, (uint16_t)(display->x + display->column),
                                (uint16_t)(display->y + display->row), n, display->colour);
        count = (uint16_t)(count - n);
        display->column = (uint16_t)(display->column + n);
        if (display->column == display->width) {
            display->column = 0;
            display->row++;
        }
    }
}

static void begin_op(ew_hid_display *display, uint8_t kind, uint16_t count)
{
    if (count > display->pixels_left || (kind == OP_SKIP && (display->flags & FLAG_KEY) != 0)) {
        give_up(display, EW_STREAM_BAD_OP);
    } else if (kind == OP_SKIP) {
        advance(display, count, 0);
        expect_next(display);
    } else {
        display->run = kind == OP_RUN ? count : 1;
        display->literals = (uint8_t)(kind == OP_LITERAL ? count : 1); /* <= 64 */
        display->state = IN_COLOUR;
    }
}

static void take_op(ew_hid_display *display, uint8_t byte)
{
    uint8_t count = byte & OP_COUNT;
    if ((byte & OP_KIND) == OP_LONG) {
        display->run = count;
        display->state = IN_LONG_OP;
    } else {
        begin_op(display, byte & OP_KIND, (uint16_t)(count + 1));
    }
}

static void take_long_op(ew_hid_display *display, uint8_t byte)
{
    uint8_t kind = (display->run & OP_LONG_RUN) != 0 ? OP_RUN : OP_SKIP;
    uint16_t high = (uint16_t)((display->run & (OP_LONG_RUN - 1)) << 8);
    begin_op(display, kind, (uint16_t)((high | byte) + OP_LONG_LEAST)); /* <= 8256 */
}

static void take_colour_low(ew_hid_display *display, uint8_t byte)
{
    display->colour |= byte;
    advance(display, display->run, 1);
    display->literals--;
    if (display->literals > 0) display->state = IN_COLOUR;
    else expect_next(display);
}

static void take_crc_high(ew_hid_display *display, uint8_t byte)
{
    display->colour = (uint16_t)(display->colour | (uint16_t)byte << 8);
    if (display->colour == display->crc) display->state = COMPLETE;
    else give_up(display, EW_STREAM_BAD_CHECK);
}

/* One byte of the payload of a frame that is being received. */
static void take_byte(ew_hid_display *display, uint8_t byte)
{
    if (display->state < IN_CRC) display->crc = ew_crc16(display->crc, byte);
    switch (display->state) {
    case IN_HEADER: take_header_byte(display, byte); break;
    case IN_OP: take_op(display, byte); break;
    case IN_LONG_OP: take_long_op(display, byte); break;
    case IN_COLOUR:
        display->colour = (uint16_t)((uint16_t)byte << 8);
        display->state = IN_COLOUR_LOW;
        break;
    case IN_COLOUR_LOW: take_colour_low(display, byte); break;
    case IN_CRC:
        display->colour = byte;
        display->state = IN_CRC_HIGH;
        break;
    case IN_CRC_HIGH: take_crc_high(display, byte); break;
    default: /* COMPLETE: more data than the rectangle has pixels */
        give_up(display, EW_STREAM_BAD_OP);
        break;
    }
}

static void begin_frame(ew_hid_display *display, uint8_t flags, int in_sequence)
{
    if (display->state > DROPPING) /* the end of the frame before was lost */
        give_up(display, EW_STREAM_SEQUENCE_GAP);
    if (display->need_key) display->refusal = EW_STREAM_NEED_KEY;
    else display->refusal = in_sequence ? EW_STREAM_OK : EW_STREAM_SEQUENCE_GAP;
    display->state = IN_HEADER;
    display->header_length = 0;
    display->flags = flags;
    display->crc = WIRE_CRC_START;
    if ((flags & FLAG_CODEC) > EW_CODEC_SRL << FLAG_CODEC_SHIFT) give_up(display, EW_STREAM_UNSUPPORTED);
}

/* After the report that says it is the frame's last. */
static void end_frame(ew_hid_display *display)
{
    if (display->state == COMPLETE) {
        if (display->width > 0) commit(display);
        display->need_key = 0;
        display->accepted++;
        post_status(display, EW_STREAM_OK);
    } else if (display->state != DROPPING) {
        give_up(display, EW_STREAM_BAD_OP); /* less data than the rectangle has pixels */
    }
    display->state = BETWEEN;
}

/* Check and padding of a report whose length byte is possible. The check keeps the parity of what it covers, so with
 * the padding known to be zero an odd number of wrong bits is always found, be they in
 * the length byte itself. */
static int is_intact(const uint8_t *report, uint8_t length)
{
    uint8_t padding = 0;
    for (uint8_t i = length; i < EW_STREAM_PAYLOAD_BYTES; i++) padding |= report[WIRE_PAYLOAD + i];
    return padding == 0 && report[WIRE_CHECK] == ew_wire_report_check(report, length);
}

static void take_stream_report(ew_hid_display *display, const uint8_t *report)
{
    const uint8_t flags = report[WIRE_FLAGS], length = report[WIRE_LENGTH];
    display->idle_ms = 0;
    if (length > EW_STREAM_PAYLOAD_BYTES || !is_intact(report, length)) {
        give_up(display, EW_STREAM_BAD_CHECK);
        return;
    }
    int in_sequence = report[WIRE_SEQUENCE] == (uint8_t)(display->sequence + 1);
    display->sequence = report[WIRE_SEQUENCE];
    if ((flags & FLAG_RESERVED) != 0) give_up(display, EW_STREAM_UNSUPPORTED);
    else if ((flags & FLAG_SOF) != 0) begin_frame(display, flags, in_sequence);
    else if (display->state == BETWEEN || (display->state > DROPPING && !in_sequence))
        give_up(display, EW_STREAM_SEQUENCE_GAP);
    for (uint8_t i = 0; i < length && display->state > DROPPING; i++)
        take_byte(display, report[WIRE_PAYLOAD + i]);
    if ((flags & FLAG_EOF) != 0) end_frame(display);
}

static void take_blit(ew_hid_display *display, const uint8_t *report)
{
    uint16_t x1 = get_u16(report), y1 = get_u16(report + 2);
    uint16_t x2 = get_u16(report + 4), y2 = get_u16(report + 6);
    const uint8_t *data = report + BLIT_DATA;
    if (display->state > DROPPING) {
        refuse(display, EW_STREAM_UNSUPPORTED);
        return;
    }
    /* Sides at most 4096, where the corners lie inside: at most 2^24 pixels. */
    const uint32_t pixels = ((uint32_t)x2 - x1 + 1) * ((uint32_t)y2 - y1 + 1);
    if (x2 < x1 || y2 < y1 || x2 >= display->panel_width || y2 >= display->panel_height ||
        pixels > EW_HID_BLIT_DATA_BYTES / 2) {
        refuse(display, EW_STREAM_BAD_RECT);
        return;
    }
    uint16_t x = x1, y = y1;
    for (uint32_t i = 0; i < pixels; i++) {
        display->panel.fill(display->panel.user, x, y, 1, (uint16_t)((uint16_t)data[2 * i] << 8 | data[2 * i + 1]));
        if (x++ == x2) x = x1, y++;
    }
    commit(display);
}

int ew_hid_display_init(ew_hid_display *display, const ew_hid_panel *panel, ew_hid_profile profile,
                        uint16_t width, uint16_t height)
{
    if (width == 0 || height == 0 || width > WIRE_MOST_SIDE || height > WIRE_MOST_SIDE || panel->fill == NULL)
        return EW_ERR_ARGUMENT;
    if (profile != EW_HID_DIRECT && profile != EW_HID_BUFFERED) return EW_ERR_ARGUMENT;
    if (profile == EW_HID_BUFFERED && (panel->commit == NULL || panel->abandon == NULL))
        return EW_ERR_ARGUMENT;
    static const ew_hid_display none;
    *display = none;
    display->panel = *panel;
    display->panel_width = width;
    display->panel_height = height;
    display->state = BETWEEN;
    display->need_key = 1;
    return EW_OK;
}

void ew_hid_display_output(ew_hid_display *display, uint8_t id, const uint8_t *report, size_t length)
{
    if (length == EW_HID_OUT_BYTES && id == EW_HID_STREAM) take_stream_report(display, report);
    else if (length == EW_HID_OUT_BYTES && id == EW_HID_BLIT) take_blit(display, report);
    else give_up(display, EW_STREAM_BAD_CHECK);
}

static void write_attributes(const ew_hid_display *display, uint8_t report[EW_HID_ATTRIBUTES_BYTES])
{
    put_u16(report, display->panel_width);
    put_u16(report + 2, display->panel_height);
    put_u16(report + 4, EW_HID_BLIT_DATA_BYTES);
    report[6] = BIT_DEPTH_FORMAT;
    report[7] = 0; /* orientation */
}

static void write_capabilities(const ew_hid_display *display, uint8_t report[EW_HID_CAPABILITIES_BYTES])
{
    for (int i = 0; i < EW_HID_CAPABILITIES_BYTES; i++) report[i] = 0;
    report[0] = 'F';
    report[1] = 'B';
    report[2] = '1';
    report[3] = WIRE_VERSION;
    put_u16(report + 4, EW_HID_OUT_BYTES);
    report[6] = 1 << EW_CODEC_RAW | 1 << EW_CODEC_SRL;
    report[7] = PIXEL_FORMAT_RGB565_BE;
    put_u16(report + 8, display->panel_width);
    report[10] = 1; /* frames in flight */
}

int ew_hid_display_get_feature(const ew_hid_display *display, uint8_t id, uint8_t *report, size_t size)
{
    if (id == EW_HID_ATTRIBUTES) {
        if (size < EW_HID_ATTRIBUTES_BYTES) return EW_ERR_ROOM;
        write_attributes(display, report);
        return EW_HID_ATTRIBUTES_BYTES;
    }
    if (id == EW_HID_CAPABILITIES) {
        if (size < EW_HID_CAPABILITIES_BYTES) return EW_ERR_ROOM;
        write_capabilities(display, report);
        return EW_HID_CAPABILITIES_BYTES;
    }
    return EW_ERR_ARGUMENT;
}

int ew_hid_display_set_feature(ew_hid_display *display, uint8_t id, const uint8_t *report, size_t length)
{
    if (id != EW_HID_CONTROL || length != EW_HID_CONTROL_BYTES) return EW_ERR_ARGUMENT;
    int clear = (report[0] & CLEAR_BIT) != 0;
    if (clear) {
        if (display->state > DROPPING) leave_frame(display); /* its rest may still come */
        display->need_key = 1;
    }
    if (display->panel.control != NULL)
        display->panel.control(display->panel.user, (report[0] & ENABLE_BIT) != 0, clear, report[1]);
    return EW_OK;
}

int ew_hid_display_input(ew_hid_display *display, uint8_t report[EW_HID_STATUS_BYTES])
{
    if (!display->status_pending) return 0;
    display->status_pending = 0;
    report[0] = display->status;
    report[1] = display->sequence;
    put_u16(report + 2, display->frame_number);
    report[4] = display->accepted;
    report[5] = display->rejected;
    put_u16(report + 6, 0); /* the model has no clock to time decoding with */
    return EW_HID_STATUS_BYTES;
}

void ew_hid_display_tick(ew_hid_display *display, uint32_t ms)
{
    if (display->state == BETWEEN) return;
    if (ms < (uint32_t)(WIRE_TIMEOUT_MS - display->idle_ms)) {
        display->idle_ms = (uint16_t)(display->idle_ms + ms);
        return;
    }
    display->idle_ms = 0;
    if (display->state == DROPPING) display->state = BETWEEN;
    else give_up(display, EW_STREAM_SEQUENCE_GAP);
}
