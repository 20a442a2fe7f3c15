/* Which rows of a frame are not what the panel shows. */
#include "edgewalk/panel.h"

/* Bytes of a row from its first to behind its last one that differ; none where from = to. */
typedef struct difference {
    uint32_t from, to;
} difference;

static difference compare(const uint8_t *a, const uint8_t *b, uint32_t n)
{
    difference d = { 0, n };
    while (d.from < n && a[d.from] == b[d.from]) d.from++;
    while (d.to > d.from && a[d.to - 1] == b[d.to - 1]) d.to--;
    return d;
}

/* Fowler, Noll and Vo's hash 1a. */
static uint32_t hash_of(const uint8_t *bytes, uint32_t n)
{
    uint32_t h = UINT32_C(0x811C9DC5);
    for (uint32_t i = 0; i < n; i++) h = (h ^ bytes[i]) * UINT32_C(0x01000193);
    return h;
}

/* What of a row has changed. Its hash is brought up to date. */
static difference look_at(const ew_frame_rows *frame, uint32_t row)
{
    const size_t at = (size_t)row * (size_t)frame->stride;
    const uint8_t *bytes = (const uint8_t *)frame->pixels + at;
    const uint32_t n = (uint32_t)frame->columns * frame->column_bytes;
    if (frame->previous) return compare(bytes, (const uint8_t *)frame->previous + at, n);
    const uint32_t hash = hash_of(bytes, n);
    const difference d = { 0, frame->hashes[row] == hash ? 0 : n };
    frame->hashes[row] = hash;
    return d;
}

int ew_changed_next(const ew_frame_rows *frame, uint16_t from, ew_changed *found)
{
    if (!frame->pixels || !frame->previous == !frame->hashes || !frame->column_bytes ||
        frame->stride < (uint32_t)frame->columns * frame->column_bytes || from > frame->rows) {
        return EW_ERR_ARGUMENT;
    }
    difference all = { 0, 0 };
    uint32_t unchanged = 0; /* rows since the last changed one */
    for (uint32_t row = from; row < frame->rows; row++) {
        const difference d = look_at(frame, row);
        if (d.from < d.to) {
            if (!all.to) {
                all = d;
                found->y0 = (uint16_t)row;
            }
            if (d.from < all.from) all.from = d.from;
            if (d.to > all.to) all.to = d.to;
            found->y1 = (uint16_t)(row + 1);
            unchanged = 0;
        } else if (all.to && ++unchanged > frame->gap) {
            break; /* rows looked at behind found->y1 are all unchanged: no hash of a changed one is lost */
        }
    }
    if (!all.to) return 0;
    found->x0 = (uint16_t)(all.from / frame->column_bytes);
    found->x1 = (uint16_t)((all.to - 1u) / frame->column_bytes + 1u);
    return 1;
}
