/* A picture while it is drawn (private to the geometry layer).
 *
 * All triangles that may be seen stand in a list sorted by the band that they begin in, then by
 * number: their place in the order of drawing. A band draws, by number, those that begin in it and
 * those that reach into it. Of the latter some were kept (active.c): set up, ready to go on. Those
 * that found no room are late: set up again for each band. Merging the three by number is what
 * makes the picture independent of bands.
 */
#ifndef EW_GEOMETRY_PICTURE_H
#define EW_GEOMETRY_PICTURE_H

#include "edgewalk/picture.h"
#include "project.h"

/* Entries of the list: a triangle's number, and above it the band that it begins in. */
enum { EW_NUMBER_BITS = 20 };
#define EW_NUMBER_MASK ((UINT32_C(1) << EW_NUMBER_BITS) - 1u)
#define EW_NO_TRIANGLE EW_NUMBER_MASK
#define EW_NO_VERTEX UINT32_MAX

/* What stands in a place: a kept triangle, or a gap with the next one behind it. */
typedef union ew_kept {
    ew_active active;
    struct {
        uint16_t places;
        ew_place next;
    } gap;
} ew_kept;

/* A vertex that later triangles will need. */
typedef struct ew_slot {
    ew_screen_vertex vertex;
    uint32_t number;
} ew_slot;

/* ---- visible.c: EW_DEPTH_SPANS ---- */

/* Columns of a row in which a triangle is seen, as far as is known yet. `span.next` leads to the right;
 * among those that are drawn to the triangle's next; else to the next unused one. `span.part` counts
 * the triangles of a clipped one's fan. */
typedef struct ew_seen {
    ew_active_span span;
    uint32_t number; /* of the triangle                                                     */
    ew_place place;  /* where it is kept, or none: it is late                                */
} ew_seen;
#define EW_NOT_SEEN UINT16_C(0xFFFF)

/* The row at hand. Where there is no room for all that is seen on it, it is cut into sections, one
 * after the other. What is seen up to a section's end may go on behind it, and waits. */
typedef struct ew_row_work {
    ew_active late;   /* one that is not kept                                                */
    ew_seen now;      /* what is held against the others                                     */
    uint16_t from, to; /* columns of the section                                             */
    uint16_t first;   /* the leftmost that is seen                                           */
    uint16_t hint;    /* one to the left of where `now` began last, or none                  */
    uint16_t last;    /* the rightmost of `now`, or none                                     */
    uint16_t late_first; /* of those that are drawn and not kept                              */
    uint16_t unused, unused_count, count;
    ew_seen seen[];   /* `count` of them                                                   */
} ew_row_work;

/* The first row whose centre is at or below y: where a triangle may begin. */
static inline int32_t ew_row_of_snapped(ew_snapped y)
{
    const int32_t half = 1 << (EW_SUBPIXEL_BITS - 1);
    return EW_ASR(y + half - 1, EW_SUBPIXEL_BITS);
}
static inline int32_t ew_row_of(ew_q20_12 y) { return ew_row_of_snapped(ew_snapped_from_q20_12(y)); }

/* Whether nothing of the triangle of three vertices can be seen. */
static inline int ew_is_hidden(const ew_screen_vertex *a, const ew_screen_vertex *b, const ew_screen_vertex *c, int both_sides)
{
    const int any = a->outcode | b->outcode | c->outcode, all = a->outcode & b->outcode & c->outcode;
    if (any & (EW_OUT_NEAR | EW_OUT_GUARD)) return all & ~EW_OUT_GUARD;
    return all || (!both_sides && !ew_faces_the_eye(a, b, c));
}

static inline ew_kept *ew_kept_at(const ew_picture_work *w, ew_place place)
{
    return (ew_kept *)(void *)ew_active_in(&w->list, place);
}

/* ---- active.c ---- */

/* Divides what memory the list leaves. */
void ew_active_init(ew_picture_work *w);

/* Draws what lies in the band at hand. Returns EW_OK or an error. */
int ew_draw_band(ew_picture_work *w);

/* The same with EW_DEPTH_SPANS, where a band is a row. */
int ew_draw_visible(ew_picture_work *w);

/* What ew_draw_visible asks of active.c: shows all spans of the row to visible.c, once for each section;
 * draws what is seen of kept ones, and of late ones; takes out what ended on this row. */
int ew_show_spans(ew_picture_work *w);
int ew_draw_seen(ew_picture_work *w);
int ew_draw_late(ew_picture_work *w);
void ew_step_kept(ew_picture_work *w);

/* ---- visible.c ---- */

/* What w->row takes at least, in bytes. */
enum { EW_SEEN_LEAST = 8 };
#define EW_ROW_LEAST (sizeof(ew_row_work) + EW_SEEN_LEAST * sizeof(ew_seen))

/* Makes w->row, in a share of that memory. Returns how much it takes. */
size_t ew_row_init(ew_picture_work *w, void *memory, size_t bytes);

/* Holds a triangle's next row against what was seen so far: where it is nearer, it is seen. */
void ew_show(ew_picture_work *w, ew_active *active, ew_place place, unsigned part);

/* Takes out of a list what *link leads to. */
static inline void ew_forget(ew_row_work *row, uint16_t *link)
{
    const uint16_t i = *link;
    *link = row->seen[i].span.next;
    row->seen[i].span.next = row->unused;
    row->unused = i;
    row->unused_count++;
}

#endif
