/* src/display/crc.c - the checks of the wire protocol.
 *
 * Both CRCs take a byte at a time without a table: a byte shifted out at the top
 * comes back multiplied by the low part of the polynomial, and for these two
 * polynomials that product is a few shifts.
 */
#include "edgewalk/display.h"

#include "wire.h"

uint16_t ew_crc16(uint16_t crc, uint8_t byte)
{
    /* x^16 = x^12 + x^5 + 1. Times x^12 the upper four bits of `out` leave at the top
     * again and come back four bits lower: folded in first, by out >> 4. */
    uint16_t out = (uint16_t)((crc >> 8) ^ byte);
    out = (uint16_t)(out ^ (out >> 4));
    return (uint16_t)((uint16_t)(crc << 8) ^ (uint16_t)(out << 12) ^ (uint16_t)(out << 5) ^ out);
}

uint8_t ew_crc8(uint8_t crc, uint8_t byte)
{
    /* x^8 = x^2 + x + 1: the product has ten bits, the upper two come back once more. */
    uint16_t out = (uint16_t)(crc ^ byte);
    out = (uint16_t)(out ^ (out << 1) ^ (out << 2));
    uint16_t over = (uint16_t)(out >> 8);
    return (uint8_t)((out ^ over ^ (over << 1) ^ (over << 2)) & 0xFF);
}

uint8_t ew_wire_header_check(const uint8_t header[HEADER_BYTES])
{
    uint8_t sum = 0;
    for (uint8_t i = 0; i < HEADER_CHECK; i++) sum = (uint8_t)(sum + header[i]);
    return (uint8_t)(sum ^ 0xFF);
}

uint8_t ew_wire_report_check(const uint8_t *report, uint8_t length)
{
    uint8_t crc = 0;
    for (uint8_t i = 0; i < WIRE_CHECK; i++) crc = ew_crc8(crc, report[i]);
    for (uint8_t i = 0; i < length; i++) crc = ew_crc8(crc, report[WIRE_PAYLOAD + i]);
    return crc;
}
