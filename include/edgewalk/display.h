/* edgewalk/display.h - sending frames to a USB HID display, both ends.
 *
 * The wire protocol is described byte by byte in docs/wire-protocol.md. The sender's
 * end turns a frame into 63-byte stream reports; the device's end takes reports in
 * whatever state they arrive and shows only pixels that some frame really had.
 *
 * Everything here is freestanding: the encoder runs on a host or on a chip that is a
 * USB host, the device model runs in firmware, in the built-in simulated display and
 * in the kernel lab's virtual USB device. No function allocates or blocks.
 *
 * Pixels are RGB565 in the machine's own byte order wherever they are uint16_t; on
 * the wire they are big-endian, the order that panel controllers take.
 */
#ifndef EW_DISPLAY_H
#define EW_DISPLAY_H

#include <stddef.h>
#include <stdint.h>

#include "error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Report ids. Lengths below do not count the id byte. */
enum {
    EW_HID_ATTRIBUTES = 1,   /* feature, read  */
    EW_HID_CONTROL = 2,      /* feature, write */
    EW_HID_BLIT = 3,         /* output         */
    EW_HID_STREAM = 4,       /* output         */
    EW_HID_STATUS = 5,       /* input          */
    EW_HID_CAPABILITIES = 6  /* feature, read  */
};
enum {
    EW_HID_OUT_BYTES = 63, /* of reports 3 and 4 */
    EW_HID_ATTRIBUTES_BYTES = 8,
    EW_HID_CONTROL_BYTES = 2,
    EW_HID_STATUS_BYTES = 8,
    EW_HID_CAPABILITIES_BYTES = 16,
    EW_HID_DESCRIPTOR_BYTES = 166,
    EW_STREAM_PAYLOAD_BYTES = 59,  /* of a stream report, at most */
    EW_HID_BLIT_DATA_BYTES = 55
};

/* The report descriptor a display with these reports has. */
extern const uint8_t ew_hid_descriptor[EW_HID_DESCRIPTOR_BYTES];

typedef enum ew_codec {
    EW_CODEC_RAW = 0, /* every pixel                                                */
    EW_CODEC_SRL = 1, /* skip / run / literal against the frame before              */
    EW_CODEC_AUTO = 2 /* sender only: whichever of the two takes fewer bytes        */
} ew_codec;

/* Status codes of report 5, byte 0. */
typedef enum ew_stream_status {
    EW_STREAM_OK = 0,
    EW_STREAM_NEED_KEY = 1,
    EW_STREAM_SEQUENCE_GAP = 2,
    EW_STREAM_BAD_CHECK = 3,
    EW_STREAM_BAD_OP = 4,
    EW_STREAM_BAD_RECT = 5,
    EW_STREAM_UNSUPPORTED = 6
} ew_stream_status;

/* ---- the sender's end ---- */

typedef struct ew_stream_frame {
    const uint16_t *pixels;   /* top-left pixel of the rectangle                      */
    const uint16_t *previous; /* the same rectangle of what the display shows, or NULL:
                                 then the frame is a key frame                        */
    uint16_t stride;          /* pixels from one row to the next, of both             */
    uint16_t x, y;            /* where the rectangle lies on the panel                */
    uint16_t width, height;   /* 0 x 0 is a keep-alive: a frame without pixels. Right
                                 and lower edge (x + width, y + height) at most 4096  */
} ew_stream_frame;

/* Where the encoder stands in the rectangle. */
typedef struct ew_stream_cursor {
    uint32_t offset; /* of the next pixel from frame.pixels; < 4096 * 65536 = 2^28 */
    uint32_t left;   /* pixels still to come, at most 2^24                         */
    uint16_t column;
} ew_stream_cursor;

/* Fields are the encoder's own, but for the counters at the end. */
typedef struct ew_stream_encoder {
    ew_stream_frame frame;
    ew_stream_cursor cursor;
    uint16_t frame_number; /* of the next frame                                 */
    uint16_t crc;
    uint8_t pending[12]; /* bytes made but not yet put into a report          */
    uint8_t pending_length, pending_used;
    uint8_t literals_left; /* pixels of the literal being sent, 0 to 64         */
    uint8_t flags;         /* of every report of the frame, without SOF and EOF */
    uint8_t first;         /* the next report is the frame's first              */
    uint8_t sequence;      /* of the next report                                */
    uint8_t stage;
    uint8_t codec;          /* of the frame: EW_CODEC_RAW or EW_CODEC_SRL        */
    uint32_t payload_bytes; /* of the frame so far, header and CRC included      */
    uint32_t reports;       /* of the frame so far                               */
} ew_stream_encoder;

/* Prepares an encoder; the first frame number and sequence number are 0. */
void ew_stream_encoder_init(ew_stream_encoder *encoder);

/* Begins a frame. A frame that was begun and not sent to its end is given up: the
 * device will ask for a key frame. The frame's pixels, and those of `previous`, must
 * stay as they are until ew_stream_next has returned 0.
 *
 * A device that asks for a key frame (any status but EW_STREAM_OK) takes nothing but
 * one whose rectangle is the whole panel. `previous` must be the frame sent last; it
 * is read with the offsets of `pixels`, and only for EW_CODEC_SRL and _AUTO. A
 * keep-alive reads neither pointer and is never a key frame.
 *
 * EW_CODEC_AUTO reads the rectangle once more, here, to count; raw is taken when both
 * codecs need the same.
 * Returns EW_OK, or EW_ERR_ARGUMENT for a stride below the width, pixels that are
 * NULL with a non-empty rectangle, one side of 0 and the other not, a rectangle that
 * ends beyond 4096, or an unknown codec; the encoder is unchanged then. */
int ew_stream_begin(ew_stream_encoder *encoder, const ew_stream_frame *frame, ew_codec codec);

/* Writes the next stream report, without its id byte and always EW_HID_OUT_BYTES
 * long, zero-padded. Returns 1, or 0 when the frame has been sent whole (nothing is
 * written then). */
int ew_stream_next(ew_stream_encoder *encoder, uint8_t report[EW_HID_OUT_BYTES]);

/* ---- the device's end ---- */

typedef enum ew_hid_profile {
    EW_HID_DIRECT = 0,  /* no frame memory: pixels go to the panel as they arrive       */
    EW_HID_BUFFERED = 1 /* the panel's owner swaps when `commit` is called: never torn   */
} ew_hid_profile;

/* What the device's owner does. All calls come from ew_hid_display_output, _tick or
 * _set_feature and must not call the display back. `user` is passed through. */
typedef struct ew_hid_panel {
    void *user;
    /* n pixels of one colour in one row, from (x, y) to the right; always inside the panel. */
    void (*fill)(void *user, uint16_t x, uint16_t y, uint16_t n, uint16_t rgb565);
    /* A frame or a blit is complete and its CRC is right: a buffered panel shows what
     * it collected. The next frame's skips leave pixels of this one: a panel with two
     * buffers copies, or draws on, but does not merely exchange them. Not called for a
     * frame without pixels. May be NULL with EW_HID_DIRECT. */
    void (*commit)(void *user);
    /* The frame being received is given up; a buffered panel drops what it collected
     * and goes on from what it shows. May be NULL with EW_HID_DIRECT. */
    void (*abandon)(void *user);
    /* Report 2: `enable` and `clear` are 0 or 1; clearing is the owner's work. May be
     * NULL. */
    void (*control)(void *user, int enable, int clear, uint8_t brightness);
} ew_hid_panel;

/* Fields are the device's own. Beside the panel at most 64 bytes, whatever arrives. */
typedef struct ew_hid_display {
    ew_hid_panel panel;
    uint32_t pixels_left; /* of the frame being received, at most 2^24          */
    uint16_t panel_width, panel_height;
    uint16_t x, y, width;  /* the frame's rectangle, inside the panel            */
    uint16_t column, row;  /* of the next pixel, counted from x and y            */
    uint16_t run;          /* how often the next colour is drawn, 1 to 8256      */
    uint16_t colour;       /* its first byte, once that is there, in bits 15..8  */
    uint16_t crc;
    uint16_t idle_ms;      /* since the last stream report, below the time-out   */
    uint16_t frame_number; /* of the newest whole header                         */
    uint8_t header[12];
    uint8_t header_length;
    uint8_t state;
    uint8_t literals; /* colours still to come in this op, 1 to 64          */
    uint8_t flags;    /* of the frame's first report                        */
    uint8_t refusal;  /* why the frame is refused unless it is a full key   */
    uint8_t need_key;
    uint8_t sequence; /* of the newest intact report                        */
    uint8_t status, status_pending, accepted, rejected;
} ew_hid_display;

/* Prepares a display of width x height pixels, each 1 to 4096. `panel` is copied.
 * Returns EW_OK, or EW_ERR_ARGUMENT for a size out of that range, an unknown profile,
 * or a callback that is NULL and must not be. A new display needs a key frame: until
 * a key frame of the whole panel is complete, every other one is refused. */
int ew_hid_display_init(ew_hid_display *display, const ew_hid_panel *panel, ew_hid_profile profile,
                        uint16_t width, uint16_t height);

/* Takes output report `id` (3 or 4) of `length` bytes, the id byte not among them.
 * Any bytes in any order are safe. A report of the wrong id or length counts as a
 * broken one. Work per byte is constant, but for one step for every panel row that a
 * run or a skip touches. A blit is refused while a frame is being received; it leaves
 * the stream as it was, so what the next skips leave is the sender's business. */
void ew_hid_display_output(ew_hid_display *display, uint8_t id, const uint8_t *report, size_t length);

/* Reads feature report `id` (1 or 6) into `report`. Returns its length, or
 * EW_ERR_ARGUMENT for an unknown id, EW_ERR_ROOM when `size` is too small. */
int ew_hid_display_get_feature(const ew_hid_display *display, uint8_t id, uint8_t *report, size_t size);

/* Takes feature report 2. Returns EW_OK or EW_ERR_ARGUMENT for another id or length.
 * Clear gives up the frame being received and makes the display need a key frame, so
 * a sender that clears when it opens meets no rest of an earlier sender's frame. */
int ew_hid_display_set_feature(ew_hid_display *display, uint8_t id, const uint8_t *report, size_t length);

/* Writes input report 5 if there is one to send. Returns EW_HID_STATUS_BYTES or 0.
 * There is one place: a newer status takes the place of one not yet read, but
 * EW_STREAM_NEED_KEY does not take that of the error that led to it. */
int ew_hid_display_input(ew_hid_display *display, uint8_t report[EW_HID_STATUS_BYTES]);

/* Tells the display that `ms` milliseconds went by: a frame of which nothing was
 * heard for 500 ms is given up. */
void ew_hid_display_tick(ew_hid_display *display, uint32_t ms);

/* CRC-16/CCITT-FALSE (polynomial 0x1021, start 0xFFFF) of one more byte. */
uint16_t ew_crc16(uint16_t crc, uint8_t byte);
/* CRC-8 (polynomial 0x07, start 0) of one more byte. */
uint8_t ew_crc8(uint8_t crc, uint8_t byte);

#ifdef __cplusplus
}
#endif

#endif
