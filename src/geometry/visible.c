/* What is seen of a row, found by comparing spans and not pixels: scanline rendering without a depth
 * buffer (J. Kautz, *Coping with Depth*, lecture notes).
 *
 * The row is a list of what is seen so far, from left to right. Spans come in the order of drawing;
 * each is held against what it overlaps, at both ends of the overlap. 1/z is linear, so where one is
 * nearer at both ends it is nearer between them; where the ends disagree the two triangles pass through
 * one another, and the overlap is cut where they do. So what is seen at a pixel depends on the triangles
 * alone: the nearest, of equal ones the one that comes first.
 */
#include "picture.h"

#if EW_WITH_SPANS

/* ---- memory ---- */

size_t ew_row_init(ew_picture_work *w, void *memory, size_t bytes)
{
    /* as many as there may be on a row, and the one that waits; else two for each triangle, for which there are
     * 256 bytes (ew_picture_bytes) */
    enum { SHARE = 256 / (2 * sizeof(ew_seen)) };
    ew_row_work *row = w->row = (ew_row_work *)memory;
    size_t count = EW_SEEN_LEAST + (bytes - EW_ROW_LEAST) / SHARE / sizeof(ew_seen);
    if (count > w->picture->width + 1u) count = w->picture->width > EW_SEEN_LEAST ? w->picture->width + 1u : EW_SEEN_LEAST;
    row->count = row->unused_count = (uint16_t)count;
    for (uint16_t i = 0; i < row->count; i++) row->seen[i].span.next = (uint16_t)(i + 1u);
    row->seen[count - 1u].span.next = EW_NOT_SEEN;
    row->unused = 0;
    row->first = row->late_first = EW_NOT_SEEN;
    return (sizeof *row + count * sizeof *row->seen + 7u) / 8u * 8u;
}

/* Forgets the right half of what is seen: the section ends there. */
static EW_OWN_FRAME void cut_section(ew_row_work *row)
{
    uint16_t *link = &row->first;
    for (unsigned left = (row->count - row->unused_count) / 2u; left > 0; left--) link = &row->seen[*link].span.next;
    row->to = row->seen[*link].span.from;
    while (*link != EW_NOT_SEEN) ew_forget(row, link);
}

/* ---- comparing ---- */

static int sign_of(int64_t a, int64_t b) { return (a > b) - (a < b); }

/* 1 where a is nearer at pixel x, -1 where b is, 0 where they are equally near: less apart than the coarser one's
 * last bit, which is 2^-31 of 1/z's range or less. Along a row the result changes in one direction only,
 * so it does not matter at which pixels it is asked for. */
static EW_OWN_FRAME int nearer(const ew_active_span *a, const ew_active_span *b, int32_t x)
{
    const int64_t wa = (int64_t)(a->w + ew_wrap_mul64(a->dw, x)), wb = (int64_t)(b->w + ew_wrap_mul64(b->dw, x));
    const int down = a->lead - b->lead;
    return down >= 0 ? sign_of(EW_ASR(wa, down), wb) : sign_of(wa, EW_ASR(wb, -down));
}

/* The first pixel behind `from` where what is nearer differs from what is at `from`; at `last` it
 * does. */
static EW_OWN_FRAME int32_t find_crossing(const ew_active_span *a, const ew_active_span *b, int32_t from, int32_t last)
{
    const int before = nearer(a, b, from) > 0;
    while (last - from > 1) {
        const int32_t middle = (from + last) / 2;
        if ((nearer(a, b, middle) > 0) == before) from = middle;
        else last = middle;
    }
    return last;
}

/* Of the pixels *from <= x < *to of both spans, those where `now` is nearer. */
static void nearer_part(ew_picture_work *w, const ew_active_span *other, int32_t *from, int32_t *to)
{
    const ew_active_span *now = &w->row->now.span;
    const int first = nearer(now, other, *from), last = *to - *from > 1 ? nearer(now, other, *to - 1) : first;
    w->crossings += first * last < 0;
    if (first > 0 && last > 0) return;
    if (first <= 0 && last <= 0) *to = *from;
    else if (first > 0) *to = find_crossing(now, other, *from, *to - 1);
    else *from = find_crossing(now, other, *from, *to - 1);
}

/* ---- the list ---- */

/* What leads to the first that ends right of x. */
static uint16_t *find(ew_row_work *row, int32_t x)
{
    uint16_t *link = &row->first;
    if (row->hint != EW_NOT_SEEN && row->seen[row->hint].span.to <= x) link = &row->seen[row->hint].span.next;
    else row->hint = EW_NOT_SEEN; /* `now` may take its place */
    while (*link != EW_NOT_SEEN && row->seen[*link].span.to <= x) {
        row->hint = *link;
        link = &row->seen[*link].span.next;
    }
    return link;
}

static ew_seen *insert(ew_row_work *row, uint16_t *link, const ew_seen *seen, int32_t from, int32_t to)
{
    const uint16_t i = row->unused;
    ew_seen *s = &row->seen[i];
    row->unused = s->span.next;
    row->unused_count--;
    *s = *seen;
    s->span.from = (uint16_t)from, s->span.to = (uint16_t)to;
    s->span.next = *link;
    *link = i;
    return s;
}

/* `now` is seen in these columns, before what *link leads to. Returns what leads there then. */
static uint16_t *give(ew_row_work *row, uint16_t *link, int32_t from, int32_t to)
{
    if (row->last != EW_NOT_SEEN && row->seen[row->last].span.to == from) {
        row->seen[row->last].span.to = (uint16_t)to;
        return link;
    }
    ew_seen *s = insert(row, link, &row->now, from, to);
    row->last = *link;
    return &s->span.next;
}

/* The same in columns that are a part of what *link leads to: what is left of that stays. Takes two unused
 * ones at most. */
static uint16_t *take(ew_row_work *row, uint16_t *link, int32_t from, int32_t to)
{
    ew_seen *other = &row->seen[*link];
    const int32_t end = other->span.to;
    if (from == other->span.from) {
        if (to == end) ew_forget(row, link);
        else other->span.from = (uint16_t)to;
        return give(row, link, from, to);
    }
    other->span.to = (uint16_t)from;
    link = &other->span.next;
    if (to < end) insert(row, link, other, to, end);
    return give(row, link, from, to);
}

/* Goes on with `now` from column x to `to`, as long as there are two unused ones. Returns where it
 * came to. */
static int32_t show_some(ew_picture_work *w, int32_t x, int32_t to)
{
    ew_row_work *row = w->row;
    uint16_t *link = find(row, x);
    row->last = EW_NOT_SEEN;
    while (x < to && row->unused_count >= 2) {
        const ew_seen *other = *link == EW_NOT_SEEN ? NULL : &row->seen[*link];
        const int32_t begin = other && other->span.from < to ? other->span.from : to;
        if (x < begin) {
            link = give(row, link, x, begin);
            x = begin;
            continue;
        }
        const int32_t end = other->span.to < to ? other->span.to : to;
        int32_t first = x, behind = end;
        nearer_part(w, &other->span, &first, &behind);
        if (first < behind) {
            link = take(row, link, first, behind);
            x = behind;
        } else {
            link = &row->seen[*link].span.next;
            x = end;
        }
    }
    return x;
}

void ew_show(ew_picture_work *w, ew_active *active, ew_place place, unsigned part)
{
    ew_row_work *row = w->row;
    ew_seen *now = &row->now;
    if (!ew_raster_find_span(w->geometry->raster, active, &now->span)) return;
    now->span.part = (uint8_t)part;
    now->number = active->number;
    now->place = place;
    int32_t x = now->span.from > row->from ? now->span.from : row->from;
    for (;;) {
        const int32_t to = now->span.to < row->to ? now->span.to : row->to;
        if (x >= to) return;
        x = show_some(w, x, to);
        if (x < to) cut_section(row);
    }
}

/* ---- a row ---- */

static int is_same(const ew_seen *a, const ew_seen *b) { return a->number == b->number && a->span.part == b->span.part; }

static int32_t end_of_row(const ew_picture_work *w) { return w->geometry->raster->scissor.x1; }

/* Joins what touches and belongs to one triangle, and gives each triangle what is seen of it. What touches
 * the end of a section that is not the row's waits. */
static EW_OWN_FRAME void share_out(ew_picture_work *w)
{
    ew_row_work *row = w->row;
    while (row->first != EW_NOT_SEEN) {
        ew_seen *s = &row->seen[row->first];
        while (s->span.next != EW_NOT_SEEN && is_same(s, &row->seen[s->span.next]) &&
               row->seen[s->span.next].span.from == s->span.to) {
            s->span.to = row->seen[s->span.next].span.to;
            ew_forget(row, &s->span.next);
        }
        if (s->span.to == row->to && row->to < end_of_row(w)) return;
        uint16_t *link = s->place == EW_NO_PLACE ? &row->late_first : &ew_kept_at(w, s->place)->active.at.seen;
        const uint16_t i = row->first;
        row->first = s->span.next;
        s->span.next = *link;
        *link = i;
    }
}

/* The next section begins at `from`. */
static EW_OWN_FRAME void start_section(ew_picture_work *w, uint16_t from)
{
    ew_row_work *row = w->row;
    row->from = from;
    row->to = (uint16_t)end_of_row(w);
    row->hint = EW_NOT_SEEN;
}

/* Goes to the next section. Returns 0 behind the last. */
static EW_OWN_FRAME int next_section(ew_picture_work *w)
{
    if (w->row->to == end_of_row(w)) return 0;
    w->sections++;
    start_section(w, w->row->to);
    return 1;
}

/* Below this lie the deepest calls. */
int ew_draw_visible(ew_picture_work *w)
{
    int error;
    start_section(w, w->geometry->raster->scissor.x0);
    do {
        error = ew_show_spans(w);
        if (error) return error;
        share_out(w);
        error = ew_draw_seen(w);
        if (!error) error = ew_draw_late(w);
        if (error) return error;
    } while (next_section(w));
    ew_step_kept(w);
    return EW_OK;
}

#endif
