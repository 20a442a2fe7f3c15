#include "coverage.h"

#include <stdlib.h>
#include <string.h>

#include "edgewalk/config.h"

enum { ONE = 1 << EW_SUBPIXEL_BITS, HALF = ONE / 2 };
__extension__ typedef __int128 int128;

void cover_begin(cover *c, int width, int height)
{
    c->width = width;
    c->height = height;
    c->words = (width + 63) / 64;
    size_t all = (size_t)c->words * (size_t)height;
    if (all > sizeof c->bits / sizeof *c->bits) abort();
    memset(c->bits, 0, all * sizeof *c->bits);
}

int cover_at(const cover *c, int x, int y) { return (int)(c->bits[y * c->words + x / 64] >> (x & 63) & 1); }

long cover_count(const cover *c)
{
    long n = 0;
    for (int i = 0; i < c->words * c->height; i++) n += __builtin_popcountll(c->bits[i]);
    return n;
}

void cover_by_edges(cover *c, const int64_t sx[3], const int64_t sy[3])
{
    int64_t area = (sx[1] - sx[0]) * (sy[2] - sy[0]) - (sx[2] - sx[0]) * (sy[1] - sy[0]);
    int64_t at[3], right[3], down[3]; /* |products| <= 2^27 2^27, sums of 2^12 steps of 2^35 beside them */
    if (area == 0) return;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, sign = area > 0 ? 1 : -1;
        /* the edge in the direction that has the inside where the function is positive */
        int64_t dx = sign * (sx[j] - sx[i]), dy = sign * (sy[j] - sy[i]);
        int owned = (dy == 0 && dx > 0) || dy < 0; /* top, left: centres on it belong */
        at[i] = dx * (HALF - sy[i]) - dy * (HALF - sx[i]) - !owned;
        right[i] = -dy * ONE;
        down[i] = dx * ONE;
    }
    for (int y = 0; y < c->height; y++) {
        int64_t e0 = at[0], e1 = at[1], e2 = at[2];
        for (int x = 0; x < c->width; x += 64) {
            int n = c->width - x < 64 ? c->width - x : 64;
            uint64_t word = 0;
            for (int k = 0; k < n; k++) {
                word |= (uint64_t)((e0 | e1 | e2) >= 0) << k;
                e0 += right[0], e1 += right[1], e2 += right[2];
            }
            c->bits[y * c->words + x / 64] |= word;
        }
        for (int i = 0; i < 3; i++) at[i] += down[i];
    }
}

/* Turns over the pixels of a row from x on. */
static void turn_from(cover *c, int y, int x)
{
    uint64_t *row = &c->bits[y * c->words];
    for (int word = x / 64; word < c->words; word++) {
        int first = x - word * 64, last = c->width - word * 64; /* of this word, last excluded */
        uint64_t mask = first > 0 ? ~UINT64_C(0) << first : ~UINT64_C(0);
        if (last < 64) mask &= (UINT64_C(1) << last) - 1;
        row[word] ^= mask;
    }
}

void cover_by_rows(cover *c, const int64_t *sx, const int64_t *sy, int corners)
{
    for (int i = 0; i < corners; i++) {
        int j = i + 1 == corners ? 0 : i + 1;
        int a = sy[i] < sy[j] ? i : j, b = a == i ? j : i; /* a is the upper one */
        int64_t dx = sx[b] - sx[a], dy = sy[b] - sy[a];
        for (int y = 0; y < c->height && dy > 0; y++) {
            int64_t centre = (int64_t)y * ONE + HALF;
            if (centre < sy[a]) continue;
            if (centre >= sy[b]) break; /* a row through a lower end is not the edge's: bottom edges own nothing */
            /* x = xa + (centre - ya) dx / dy; the first pixel whose centre is at or right of it */
            int128 above = (int128)(sx[a] - HALF) * dy + (int128)(centre - sy[a]) * dx, below = (int128)ONE * dy;
            int128 first = above / below + (above % below > 0); /* division cuts towards 0: that is up when negative */
            if (first < c->width) turn_from(c, y, first < 0 ? 0 : (int)first);
        }
    }
}
