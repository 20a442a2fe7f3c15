/* Exact coverage of a whole picture, counted in two ways that share nothing: one bit for
 * each pixel. Corners are in 2^-EW_SUBPIXEL_BITS px, |.| <= 2^26; the rule is that of
 * docs/conventions.md. */
#ifndef EW_REF_COVERAGE_H
#define EW_REF_COVERAGE_H

#include <stdint.h>

enum { COVER_PIXELS = 4096 * 32 }; /* the largest picture */

/* Bit x & 63 of bits[y * words + x / 64]; bits at and beyond `width` are 0. */
typedef struct cover {
    int width, height, words;
    uint64_t bits[COVER_PIXELS / 64 + 4096];
} cover;

/* An empty picture of that size. */
void cover_begin(cover *c, int width, int height);
/* Whether a pixel is covered. */
int cover_at(const cover *c, int x, int y);
/* How many are. */
long cover_count(const cover *c);

/* Adds a triangle of either orientation by its three edge functions, each pixel by itself:
 * exact, in 64-bit integers. */
void cover_by_edges(cover *c, const int64_t sx[3], const int64_t sy[3]);

/* Turns over every pixel that a polygon's border passes an odd number of times on its left,
 * by the exact rational where each edge meets each row's centre line: a polygon that does
 * not cross itself is covered by that. */
void cover_by_rows(cover *c, const int64_t *sx, const int64_t *sy, int corners);

#endif
