/* What bench.c, work.c and visibility.c share: hashes of pictures, and the host's counting of fragments. */
#ifndef EW_CYCLES_DRAWN_H
#define EW_CYCLES_DRAWN_H

#include <stdint.h>

/* What the port gives: the board in firmware, the end of this file on the host. */
void bench_line(const char *text);

#define DRAWN_START UINT32_C(2166136261) /* FNV-1a over 16-bit units */
/* Of colours and depths; z may be NULL, which is 0 everywhere. */
static uint32_t drawn_hash(uint32_t h, const uint16_t *c, const uint16_t *z, uint32_t pixels)
{
    for (uint32_t i = 0; i < pixels; i++) h = (((h ^ c[i]) * 16777619u) ^ (z ? z[i] : 0u)) * 16777619u;
    return h;
}

static void drawn_print(uint32_t h)
{
    char text[10] = { 0 };
    for (int i = 0; i < 8; i++) text[i] = "0123456789abcdef"[h >> (28 - 4 * i) & 15];
    text[8] = '\n';
    bench_line(text);
}

#if __STDC_HOSTED__
#include <stdio.h>
#include <string.h>

static int drawn_quiet;
void bench_line(const char *text)
{
    if (!drawn_quiet) fputs(text, stdout);
}

#if EW_TRACE
static long drawn_fragments;
void ew_trace_triangle(const ew_raster_vertex *a, const ew_raster_vertex *b, const ew_raster_vertex *c, int rung)
{
    (void)a, (void)b, (void)c, (void)rung;
}
void ew_trace_fragment(uint16_t x, uint16_t y, uint16_t d, ew_q20_12 u, ew_q20_12 v)
{
    (void)x, (void)y, (void)d, (void)u, (void)v;
    drawn_fragments++;
}
#endif
#else
#include "../../examples/firmware/board/board.h"

void bench_line(const char *text) { board_print(text); }
#endif

#endif
