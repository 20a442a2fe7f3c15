/* edgewalk/panel.h - for panels behind a slow bus: pixels in the widths that their controllers take,
 * and which rows of a frame have changed, so that only those are sent.
 *
 * Rows belong to the caller, and so does what is written. Needs nothing of the other layers. A
 * panel that takes RGB565 needs no packing: it is a target's format, in both byte orders.
 */
#ifndef EW_PANEL_H
#define EW_PANEL_H

#include <stddef.h>
#include <stdint.h>

#include "error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- packing ---- */

/* Packs n pixels of RGB565 in the machine's order as RGB666: three bytes for each pixel, red, green,
 * blue, each in bits 7 to 2 of its byte; bits 1 and 0 are 0. Controllers: ST7735 and ILI9341 with
 * COLMOD (3Ah) 06h and 66h; the ILI9486 and ILI9488, which take no 16-bit pixels over SPI (layout:
 * ST7735 data sheet V1.7, 9.7.4). 5 bits become the nearest of 6, 2 c + floor(c / 16).
 * Writes 3 n bytes to `out`, which must not overlap the pixels, and returns their number. */
size_t ew_pack_rgb666(const uint16_t *rgb565, size_t n, uint8_t *out);

/* Packs them as RGB444: two pixels in three bytes, R1 G1, B1 R2, G2 B2, the first one of each in
 * the high bits. Controllers: ST7735 and ST7789 with COLMOD 03h (ST7735 data sheet V1.7, 9.7.2).
 * Each channel becomes the nearest of 4 bits: floor(c / 2) of 5, floor((61 c + 121) / 256) of 6.
 * Writes ceil(3 n / 2) bytes to `out`, which must not overlap the pixels, and returns their
 * number. After an odd pixel the last four bits are 0: a panel takes rows without a gap between
 * them, so pack an even number of pixels but for the last ones of a window. */
size_t ew_pack_rgb444(const uint16_t *rgb565, size_t n, uint8_t *out);

/* ---- what has changed ---- */

/* A frame, or a band of it, in any format, and what is known of the one that the panel shows: the
 * frame itself or a hash of each row. A column is what a panel's window counts: a pixel of two
 * bytes, or a byte of two or eight pixels.
 *
 * Hashes are FNV-1a with 32 bits (RFC 9923). Rows that differ within one byte never have the same
 * one. Others may: about one changed row in 2^32 is taken for unchanged, and stays so until it
 * changes again. That is once in three days where 240 rows change 60 times a second; where
 * that is too often, give `previous`, or send everything now and then. */
typedef struct ew_frame_rows {
    const void *pixels;   /* top left column                                               */
    const void *previous; /* the frame shown, of the same shape; or NULL                   */
    uint32_t *hashes;     /* one for each row, read and written; NULL if there is `previous`.
                             Before the first frame they hold anything: pass over it once, and
                             send all of it whatever is found                             */
    uint32_t stride;      /* bytes from one row to the next, of both; at least columns times
                             column_bytes. Bytes beyond those are not looked at            */
    uint16_t columns, rows;
    uint16_t gap;         /* unchanged rows, at most, between changed ones that are sent in
                             one; 65535: one rectangle holds all changes                  */
    uint8_t column_bytes; /* 1 to 255                                                      */
} ew_frame_rows;

/* Columns x0 <= x < x1, rows y0 <= y < y1; all columns where hashes tell. */
typedef struct ew_changed {
    uint16_t x0, y0, x1, y1;
} ew_changed;

/* Finds the first rows that have changed at row `from` or below, and the rectangle of them that
 * has. Returns 1, or 0 if there are none, or EW_ERR_ARGUMENT for pixels that are NULL, both or
 * neither of `previous` and `hashes`, a stride too small, columns of 0 bytes, or `from` beyond
 * `rows`. The whole frame, each row looked at about once:
 *
 *     for (uint16_t from = 0; ew_changed_next(&frame, from, &found) > 0; from = found.y1) send(&found);
 *
 * Over the wire protocol of display.h there is no need: its encoder skips what has not changed. */
int ew_changed_next(const ew_frame_rows *frame, uint16_t from, ew_changed *found);

#ifdef __cplusplus
}
#endif

#endif
