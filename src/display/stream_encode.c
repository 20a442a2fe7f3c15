/* src/display/stream_encode.c - the sender's end of the wire protocol.
 *
 * A frame is header, pixel data and CRC, made a few bytes at a time into `pending` and
 * cut into reports as they are asked for, so a frame of any size needs no buffer. Ops
 * are chosen greedily with a look ahead of at most three pixels: no table and no second
 * copy of the frame, and no more above raw than a byte for every 64 pixels begun.
 */
#include "edgewalk/display.h"


#include "edgewalk/error.h"
#include "wire.h"

enum { STAGE_PIXELS, STAGE_END };

typedef struct srl_op {
    uint8_t kind;   /* OP_LITERAL, OP_RUN or OP_SKIP          */
    uint16_t count; /* of a literal 1 to 64, else 1 to 8256   */
} srl_op;

static void step(const ew_stream_frame *frame, ew_stream_cursor *at)
{
    at->left--;
    at->column++;
    at->offset++;
    if (at->column == frame->width) {
        at->column = 0;
        at->offset += (uint32_t)frame->stride - frame->width;
    }
}

static void step_by(const ew_stream_frame *frame, ew_stream_cursor *at, uint16_t count)
{
    while (count-- > 0) step(frame, at);
}

/* Pixels from `at` on that the frame before has too, at most `most`. */
static uint16_t skip_length(const ew_stream_frame *frame, ew_stream_cursor at, uint16_t most)
{
    uint16_t n = 0;
    if (frame->previous == NULL) return 0;
    while (n < most && at.left > 0 && frame->pixels[at.offset] == frame->previous[at.offset]) {
        step(frame, &at);
        n++;
    }
    return n;
}

/* Pixels from `at` on that have the colour of the one there, at most `most`. */
static uint16_t run_length(const ew_stream_frame *frame, ew_stream_cursor at, uint16_t most)
{
    uint16_t colour = frame->pixels[at.offset];
    uint16_t n = 0;
    while (n < most && at.left > 0 && frame->pixels[at.offset] == colour) {
        step(frame, &at);
        n++;
    }
    return n;
}

/* Does another op at `at` take fewer bytes than going on with a literal? A pixel inside
 * a literal costs two bytes, a new literal one more. So a skip of 2 pays (1 + 1 bytes
 * for 4), a run of 3 does (3 + 1 for 6), and one less of either where nothing follows. */
static int literal_ends(const ew_stream_frame *frame, ew_stream_cursor at)
{
    uint16_t skip = skip_length(frame, at, 2);
    uint16_t run = run_length(frame, at, 3);
    return skip == 2 || run == 3 || (skip == 1 && at.left == 1) || (run == 2 && at.left == 2);
}

static uint16_t literal_length(const ew_stream_frame *frame, ew_stream_cursor at)
{
    uint16_t n = 0;
    do {
        step(frame, &at);
        n++;
    } while (n < OP_SHORT_MOST && at.left > 0 && !literal_ends(frame, at));
    return n;
}

/* The op for the pixels from `at` on, of which there is at least one. */
static srl_op choose_op(const ew_stream_frame *frame, ew_stream_cursor at)
{
    srl_op op;
    uint16_t skip = skip_length(frame, at, OP_LONG_MOST);
    uint16_t run = run_length(frame, at, OP_LONG_MOST);
    if (skip >= run) {
        op.kind = OP_SKIP;
        op.count = skip;
    } else if (run >= 2) {
        op.kind = OP_RUN;
        op.count = run;
    } else {
        op.kind = OP_LITERAL;
        op.count = literal_length(frame, at);
    }
    return op;
}

/* Bytes of an op: op byte or bytes, and the colours after it. */
static uint8_t op_bytes(srl_op op)
{
    if (op.kind == OP_LITERAL) return (uint8_t)(1 + 2 * op.count); /* <= 129 */
    return (uint8_t)((op.count > OP_SHORT_MOST ? 2 : 1) + (op.kind == OP_RUN ? 2 : 0));
}

/* Is the frame smaller as skips, runs and literals than raw? */
static int srl_is_smaller(const ew_stream_frame *frame, ew_stream_cursor at)
{
    uint32_t raw = 2 * at.left; /* <= 2^25 */
    uint32_t srl = 0;
    while (at.left > 0 && srl < raw) {
        srl_op op = choose_op(frame, at);
        srl += op_bytes(op);
        step_by(frame, &at, op.count);
    }
    return srl < raw;
}

static void put_byte(ew_stream_encoder *encoder, uint8_t byte)
{
    encoder->pending[encoder->pending_length++] = byte;
}

static void put_pixel(ew_stream_encoder *encoder)
{
    uint16_t colour = encoder->frame.pixels[encoder->cursor.offset];
    put_byte(encoder, (uint8_t)(colour >> 8));
    put_byte(encoder, (uint8_t)(colour & 0xFF));
}

static void put_op(ew_stream_encoder *encoder)
{
    srl_op op = choose_op(&encoder->frame, encoder->cursor);
    if (op.count > OP_SHORT_MOST) {
        uint16_t beyond = (uint16_t)(op.count - OP_LONG_LEAST); /* < 2^13 */
        put_byte(encoder, (uint8_t)((unsigned)(OP_LONG | (op.kind == OP_RUN ? OP_LONG_RUN : 0)) | beyond >> 8));
        put_byte(encoder, (uint8_t)(beyond & 0xFF));
    } else {
        put_byte(encoder, (uint8_t)(op.kind | (op.count - 1)));
    }
    if (op.kind == OP_LITERAL) {
        encoder->literals_left = (uint8_t)op.count;
    } else {
        if (op.kind == OP_RUN) put_pixel(encoder);
        step_by(&encoder->frame, &encoder->cursor, op.count);
    }
}

/* Makes the next bytes of the frame, 1 to 12, in the emptied `pending`. All bytes made
 * before are in the CRC by now. */
static void make_more(ew_stream_encoder *encoder)
{
    encoder->pending_length = 0;
    encoder->pending_used = 0;
    if (encoder->cursor.left == 0) {
        put_u16(encoder->pending, encoder->crc);
        encoder->pending_length = 2;
        encoder->stage = STAGE_END;
    } else if (encoder->codec == EW_CODEC_SRL && encoder->literals_left == 0) {
        put_op(encoder);
    } else {
        put_pixel(encoder);
        step(&encoder->frame, &encoder->cursor);
        if (encoder->codec == EW_CODEC_SRL) encoder->literals_left--;
    }
}

static int all_taken(const ew_stream_encoder *encoder)
{
    return encoder->stage == STAGE_END && encoder->pending_used == encoder->pending_length;
}

static void put_header(ew_stream_encoder *encoder)
{
    const ew_stream_frame *frame = &encoder->frame;
    uint8_t *header = encoder->pending;
    put_u16(header + HEADER_FRAME, encoder->frame_number);
    put_u16(header + HEADER_X, frame->x);
    put_u16(header + HEADER_Y, frame->y);
    put_u16(header + HEADER_WIDTH, frame->width);
    put_u16(header + HEADER_HEIGHT, frame->height);
    header[HEADER_VERSION] = WIRE_VERSION;
    header[HEADER_CHECK] = ew_wire_header_check(header);
    encoder->pending_length = HEADER_BYTES;
    encoder->pending_used = 0;
}

void ew_stream_encoder_init(ew_stream_encoder *encoder)
{
    static const ew_stream_encoder none;
    *encoder = none;
    encoder->stage = STAGE_END;
}

static int is_sendable(const ew_stream_frame *frame)
{
    if ((frame->width == 0) != (frame->height == 0)) return 0;
    if ((uint32_t)frame->x + frame->width > WIRE_MOST_SIDE ||
        (uint32_t)frame->y + frame->height > WIRE_MOST_SIDE)
        return 0;
    return frame->width == 0 || (frame->pixels != NULL && frame->stride >= frame->width);
}

int ew_stream_begin(ew_stream_encoder *encoder, const ew_stream_frame *frame, ew_codec codec)
{
    if ((codec != EW_CODEC_RAW && codec != EW_CODEC_SRL && codec != EW_CODEC_AUTO) || !is_sendable(frame))
        return EW_ERR_ARGUMENT;
    encoder->frame = *frame;
    encoder->cursor.offset = 0;
    encoder->cursor.left = (uint32_t)frame->width * frame->height; /* <= 2^24 */
    encoder->cursor.column = 0;
    encoder->literals_left = 0;
    encoder->codec = (uint8_t)codec;
    if (codec == EW_CODEC_AUTO)
        encoder->codec = srl_is_smaller(frame, encoder->cursor) ? EW_CODEC_SRL : EW_CODEC_RAW;
    encoder->flags = (uint8_t)(encoder->codec << FLAG_CODEC_SHIFT);
    if (frame->previous == NULL && frame->width > 0) encoder->flags |= FLAG_KEY;
    put_header(encoder);
    encoder->frame_number++;
    encoder->crc = WIRE_CRC_START;
    encoder->stage = STAGE_PIXELS;
    encoder->first = 1;
    encoder->payload_bytes = 0;
    encoder->reports = 0;
    return EW_OK;
}

int ew_stream_next(ew_stream_encoder *encoder, uint8_t report[EW_HID_OUT_BYTES])
{
    uint8_t length = 0;
    if (all_taken(encoder)) return 0;
    for (int i = 0; i < EW_HID_OUT_BYTES; i++) report[i] = 0;
    while (length < EW_STREAM_PAYLOAD_BYTES && !all_taken(encoder)) {
        if (encoder->pending_used == encoder->pending_length) make_more(encoder);
        uint8_t byte = encoder->pending[encoder->pending_used++];
        encoder->crc = ew_crc16(encoder->crc, byte);
        report[WIRE_PAYLOAD + length++] = byte;
    }
    report[WIRE_FLAGS] =
        (uint8_t)(encoder->flags | (encoder->first ? FLAG_SOF : 0) | (all_taken(encoder) ? FLAG_EOF : 0));
    report[WIRE_SEQUENCE] = encoder->sequence++;
    report[WIRE_LENGTH] = length;
    report[WIRE_CHECK] = ew_wire_report_check(report, length);
    encoder->first = 0;
    encoder->payload_bytes += length;
    encoder->reports++;
    return 1;
}
