/* src/display/wire.h - the numbers of the wire protocol that both ends need.
 *
 * docs/wire-protocol.md explains them. Private to src/display.
 */
#ifndef EW_DISPLAY_WIRE_H
#define EW_DISPLAY_WIRE_H

#include <stdint.h>

/* A stream report: four bytes, then the payload, then zeros. */
enum { WIRE_FLAGS = 0, WIRE_SEQUENCE = 1, WIRE_LENGTH = 2, WIRE_CHECK = 3, WIRE_PAYLOAD = 4 };

/* Byte 0 of a stream report. Bits 0x88 are zero. */
enum {
    FLAG_SOF = 0x01,
    FLAG_EOF = 0x02,
    FLAG_KEY = 0x04,
    FLAG_CODEC = 0x70,
    FLAG_CODEC_SHIFT = 4,
    FLAG_RESERVED = 0x88
};

/* The frame header at the start of a frame's payload. */
enum {
    HEADER_FRAME = 0,
    HEADER_X = 2,
    HEADER_Y = 4,
    HEADER_WIDTH = 6,
    HEADER_HEIGHT = 8,
    HEADER_VERSION = 10,
    HEADER_CHECK = 11,
    HEADER_BYTES = 12
};

/* Ops of EW_CODEC_SRL: two bits of kind, six of count. */
enum {
    OP_LITERAL = 0x00,
    OP_RUN = 0x40,
    OP_SKIP = 0x80,
    OP_LONG = 0xC0,
    OP_KIND = 0xC0,
    OP_COUNT = 0x3F,
    OP_LONG_RUN = 0x20, /* in a long op's six bits: a run, else a skip            */
    OP_SHORT_MOST = 64, /* a short op counts 1 to 64 pixels                       */
    OP_LONG_LEAST = 65, /* a long one 65 to 8256 = 65 + 2^13 - 1                  */
    OP_LONG_MOST = 8256
};

enum { WIRE_VERSION = 1, WIRE_MOST_SIDE = 4096, WIRE_TIMEOUT_MS = 500 };

/* No enumerator: 0xFFFF is no int where that has 16 bits. */
#define WIRE_CRC_START ((uint16_t)0xFFFFu)

static inline uint16_t get_u16(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] | (uint16_t)((uint16_t)bytes[1] << 8));
}

static inline void put_u16(uint8_t *bytes, uint16_t value)
{
    bytes[0] = (uint8_t)(value & 0xFF);
    bytes[1] = (uint8_t)(value >> 8);
}

/* The header's last byte: the sum of the others, inverted. */
uint8_t ew_wire_header_check(const uint8_t header[HEADER_BYTES]);

/* CRC-8 of a report whose payload is `length` bytes, at most 59. */
uint8_t ew_wire_report_check(const uint8_t *report, uint8_t length);

#endif
