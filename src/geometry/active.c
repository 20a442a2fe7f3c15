/* Triangles that reach over more bands than one: kept where there is room, else set up again. */
#include "picture.h"

/* ---- places ---- */

static void init_places(ew_picture_work *w, size_t bytes)
{
    const size_t places = bytes / EW_PLACE_BYTES < EW_NO_PLACE ? bytes / EW_PLACE_BYTES : EW_NO_PLACE - 1u;
    w->kept = w->gaps = EW_NO_PLACE;
    if (places == 0) return;
    w->gaps = 0;
    ew_kept_at(w, 0)->gap.places = (uint16_t)places;
    ew_kept_at(w, 0)->gap.next = EW_NO_PLACE;
}

void ew_active_init(ew_picture_work *w)
{
    enum { SHARE = 8 }; /* of it for vertices: most of a slot for each triangle of 112 bytes */
    uint8_t *at = (uint8_t *)(w->entries + (w->entry_count + 1u) / 2u * 2u); /* aligned to 8 */
    size_t rest = (size_t)(w->end_of_memory - at);
    if (EW_WITH_SPANS && w->picture->visibility == EW_DEPTH_SPANS) {
        const size_t used = ew_row_init(w, at, rest);
        at += used;
        rest -= used;
    }
    w->slots = (ew_slot *)(void *)at;
    size_t slots = rest / SHARE / sizeof *w->slots;
    if (slots > UINT16_MAX) slots = UINT16_MAX;
    w->slot_count = (uint16_t)(slots < w->vertices ? slots : w->vertices);
    w->hand = 0;
    for (uint32_t i = 0; i < w->slot_count; i++) {
        w->slots[i].vertex.y = -EW_GUARD_PX * 4096; /* above everything */
        w->slots[i].number = EW_NO_VERTEX;
    }
    w->list.places = at + (w->slot_count * sizeof *w->slots + EW_PLACE_BYTES - 1u) / EW_PLACE_BYTES * EW_PLACE_BYTES;
    w->list.ended = EW_NO_PLACE;
    init_places(w, (size_t)(w->end_of_memory - w->list.places));
}

/* The first gap that is large enough gives its end. */
static ew_place take_places(ew_picture_work *w, uint16_t places)
{
    for (ew_place *at = &w->gaps; *at != EW_NO_PLACE; at = &ew_kept_at(w, *at)->gap.next) {
        ew_kept *gap = ew_kept_at(w, *at);
        if (gap->gap.places < places) continue;
        const ew_place taken = (ew_place)(*at + gap->gap.places - places);
        gap->gap.places = (uint16_t)(gap->gap.places - places);
        if (gap->gap.places == 0) *at = gap->gap.next;
        return taken;
    }
    return EW_NO_PLACE;
}

/* Gaps stand in order, and no two touch. */
static void give_places(ew_picture_work *w, ew_place place, uint16_t places)
{
    ew_kept *before = NULL, *gap = ew_kept_at(w, place);
    ew_place *at = &w->gaps;
    ew_place before_place = 0;
    while (*at != EW_NO_PLACE && *at < place) {
        before_place = *at;
        before = ew_kept_at(w, *at);
        at = &before->gap.next;
    }
    gap->gap.places = places;
    gap->gap.next = *at;
    *at = place;
    if (gap->gap.next == place + places) {
        const ew_kept *after = ew_kept_at(w, gap->gap.next);
        gap->gap.places = (uint16_t)(places + after->gap.places);
        gap->gap.next = after->gap.next;
    }
    if (before && before_place + before->gap.places == place) {
        before->gap.places = (uint16_t)(before->gap.places + gap->gap.places);
        before->gap.next = gap->gap.next;
    }
}

/* Takes the kept triangle out that *link leads to. */
static void drop(ew_picture_work *w, ew_place *link)
{
    const ew_place place = *link;
    const ew_active *active = &ew_kept_at(w, place)->active;
    const uint16_t places = active->places;
    *link = active->next;
    give_places(w, place, places);
    w->active--;
}

/* Keeps the triangle that was begun, before the one that *link leads to. Returns where it leads on,
 * or NULL where there is no room. */
static ew_place *keep(ew_picture_work *w, ew_place *link)
{
    const uint16_t places = (uint16_t)(ew_active_bytes(&w->geometry->raster->work.triangle) / EW_PLACE_BYTES); /* <= 35 */
    const ew_place place = take_places(w, places);
    if (place == EW_NO_PLACE) return NULL;
    ew_active *active = &ew_kept_at(w, place)->active;
    ew_raster_keep(w->geometry->raster, active);
    active->number = w->number;
    active->places = (uint8_t)places;
    if (EW_WITH_SPANS && w->row) active->at.seen = EW_NOT_SEEN;
    active->next = *link;
    *link = place;
    w->active++;
    return &active->next;
}

/* ---- vertices ---- */

static EW_OWN_FRAME void take_slot(ew_picture_work *w, uint32_t number, const ew_screen_vertex *v)
{
    enum { TRIES = 16 };
    const uint32_t tries = w->slot_count < TRIES ? w->slot_count : TRIES;
    for (uint32_t i = 0; i < tries; i++) {
        if (++w->hand >= w->slot_count) w->hand = 0;
        ew_slot *slot = &w->slots[w->hand];
        /* no triangle begins below its own vertices */
        if (ew_row_of(slot->vertex.y) >= w->top) continue;
        slot->vertex = *v;
        slot->number = number;
        /* those of vertices without a place begin in the first band there is */
        if (ew_is_placeless(v->outcode)) slot->vertex.y = (ew_q20_12)w->top * 4096;
        w->map[number] = w->hand;
        return;
    }
}

/* Corners of the triangle at hand. */
static const uint16_t *corners_of(const ew_picture_work *w)
{
    return w->at->mesh.indices + (size_t)(w->number - w->first_triangle) * 3u;
}

/* A vertex of the object at hand, where it is, or else in *out. */
static inline const ew_screen_vertex *find_vertex(ew_picture_work *w, const ew_mesh *mesh, uint16_t vertex, ew_screen_vertex *out)
{
    if (mesh->screen) return &mesh->screen[vertex];
    const uint32_t number = w->first_vertex + vertex;
    const uint16_t at = w->map[number];
    if (at < w->slot_count && w->slots[at].number == number) return &w->slots[at].vertex;
    ew_transform_vertices(&w->at->transform, &mesh->vertices[vertex], 1, out);
    w->transformed++;
    take_slot(w, number, out);
    return out;
}

/* ---- triangles ---- */

/* Makes a triangle's object the one at hand: numbers grow within a band. Returns EW_OK or an error of the
 * raster's. */
static EW_OWN_FRAME int go_on(ew_picture_work *w, uint32_t number)
{
    const ew_object *object = &w->objects[w->object];
    while (number - w->first_triangle >= object->mesh.index_count / 3u) {
        w->first_triangle += object->mesh.index_count / 3u;
        if (!object->mesh.screen) w->first_vertex += object->vertex_count;
        object = &w->objects[++w->object];
    }
    w->at = object;
    w->behind = w->first_triangle + object->mesh.index_count / 3u;
    if (w->used == w->object) return EW_OK;
    w->used = w->object;
    for (int k = 0; k < 3; k++) w->geometry->at_hand.corner[k].colour = ew_white; /* without colours in the mesh they stay */
    return ew_raster_set_material(w->geometry->raster, &object->material);
}

/* The same for the triangle itself. */
static inline int go_to(ew_picture_work *w, uint32_t number)
{
    w->number = number;
    return number < w->behind ? EW_OK : go_on(w, number);
}

/* What becomes of a triangle in the band at hand: there is nothing to be drawn; it is kept, to be drawn next;
 * what the raster has set up is to be drawn, and that was all or the rest is late; the
 * triangles of a fan are to be drawn, one after the other, and are late, too. With EW_DEPTH_SPANS nothing
 * is over before the whole row is known: even what ends on it is kept or late. */
enum { DONE, KEPT, DRAW, DRAW_LATE, DRAW_FAN };

static int begin_with(ew_picture_work *w, const ew_raster_vertex *third)
{
    const int result = ew_raster_begin(w->geometry->raster, w->geometry->at_hand.corner, third - 1, third, w->end);
    w->set_up += result > 0;
    return result;
}

static int begin(ew_picture_work *w) { return begin_with(w, &w->geometry->at_hand.corner[2]); }

/* Each triangle of a clipped one's fan: all of them are kept, or none. */
static EW_OWN_FRAME int keep_fan(ew_picture_work *w)
{
    ew_place *const link = w->list.link, *to = link;
    const ew_place behind = *link;
    for (const ew_raster_vertex *third; (third = ew_clip_next(w->geometry));) {
        const int result = begin_with(w, third);
        if (result < 0) return result;
        if (result == 0) continue;
        to = keep(w, to);
        if (to) continue;
        while (*link != behind) drop(w, link);
        w->geometry->corner_next = 2;
        return DRAW_FAN;
    }
    return *link == behind ? DONE : KEPT;
}

/* Sets the next triangle of the fan up: 1, 0 behind the last, or an error. */
static EW_OWN_FRAME int next_of_fan(ew_picture_work *w)
{
    for (const ew_raster_vertex *third; (third = ew_clip_next(w->geometry));) {
        const int result = begin_with(w, third);
        if (result) return result;
    }
    return 0;
}

/* Makes the triangle at hand ready. Returns DONE, DRAW for `begin` or DRAW_FAN for next_of_fan. */
static EW_OWN_FRAME int make_ready(ew_picture_work *w)
{
    const ew_mesh *mesh = &w->at->mesh;
    const uint16_t *const index = corners_of(w);
    const int32_t uv_unit = (int32_t)1 << (12 - mesh->uv_fraction_bits);
    ew_raster_vertex *const v = w->geometry->at_hand.corner;
    uint8_t outcode[3];
    for (int k = 0; k < 3; k++) {
        ew_screen_vertex made;
        const ew_screen_vertex *from = find_vertex(w, mesh, index[k], &made);
        ew_corner_from(&v[k], &mesh->vertices[index[k]], from, uv_unit);
        if (mesh->colours) v[k].colour = mesh->colours[index[k]];
        outcode[k] = from->outcode;
    }
    const int any = outcode[0] | outcode[1] | outcode[2];
    if (!any) return DRAW; /* one that faces away is seen to by the raster */
    if (outcode[0] & outcode[1] & outcode[2] & ~EW_OUT_GUARD) return DONE;
    if (!ew_is_placeless(any)) return DRAW;
    ew_clip_triangle(w->geometry, &w->at->transform, mesh, index, ew_placeless(outcode[0], outcode[1], outcode[2]));
    return DRAW_FAN;
}

/* Sets up what make_ready has made; kept ones stand at *list.link then. Returns one of the above or an
 * error. */
static inline int start(ew_picture_work *w, int how)
{
    if (how == DRAW_FAN) return keep_fan(w);
    if (how == DRAW) how = begin(w);
    if (how <= 0) return how;
    if (!w->row && ew_raster_begun_end(w->geometry->raster) <= w->bottom) return DRAW;
    return keep(w, w->list.link) ? KEPT : DRAW_LATE;
}

/* ---- a band ---- */

/* The number of the next late triangle. */
static uint32_t number_of_late(const ew_picture_work *w)
{
    return w->late_next < w->late_count ? w->entries[w->late_next] : EW_NO_TRIANGLE;
}

/* That of the next triangle that begins in the band. */
static uint32_t number_of_next(const ew_picture_work *w)
{
    if (w->next == w->entry_count) return EW_NO_TRIANGLE;
    const uint32_t entry = w->entries[w->next];
    return entry >> EW_NUMBER_BITS == w->band ? entry & EW_NUMBER_MASK : EW_NO_TRIANGLE;
}

/* The smaller one: none of those that are kept has it. */
static inline uint32_t number_ahead(const ew_picture_work *w)
{
    const uint32_t late = number_of_late(w), next = number_of_next(w);
    return late < next ? late : next;
}

/* Takes a late triangle, or else the next to begin, out of its list. */
static inline int take(ew_picture_work *w, uint32_t number, int is_late)
{
    if (is_late) {
        w->late_next++;
        w->active--;
        w->again++;
    } else {
        w->next++;
    }
    return go_to(w, number);
}

/* The triangle at hand is late, behind those that are already: there is room where it came from. */
static void put_late(ew_picture_work *w, int is_late)
{
    if (is_late) w->entries[w->late_left++] = w->number;
    else w->entries[w->late_begun + w->late_new++] = w->number;
    w->active++;
}

static void start_late(ew_picture_work *w)
{
    w->late_next = w->late_left = w->late_new = 0;
    w->late_begun = w->next;
}

/* Those that the band has added, among the others, by number. */
static void merge_late(ew_picture_work *w)
{
    uint32_t *entries = w->entries;
    w->late_count = w->late_left;
    for (uint32_t i = 0; i < w->late_new; i++) {
        const uint32_t number = entries[w->late_begun + i];
        uint32_t at = w->late_count++;
        for (; at > 0 && entries[at - 1u] > number; at--) entries[at] = entries[at - 1u];
        entries[at] = number;
    }
}

/* Gives back the places of those that ended. */
static EW_OWN_FRAME void give_ended(ew_picture_work *w)
{
    ew_place place = w->list.ended;
    while (place != EW_NO_PLACE) {
        const ew_active *active = &ew_kept_at(w, place)->active;
        const ew_place next = active->next;
        give_places(w, place, active->places);
        w->active--;
        place = next;
    }
    w->list.ended = EW_NO_PLACE;
}

/* Draws what was kept of triangles before `number`. Returns EW_OK or an error. */
static inline int draw_kept(ew_picture_work *w, uint32_t number)
{
    for (;;) {
        ew_raster_draw_list(w->geometry->raster, &w->list, number < w->behind ? number : w->behind);
        if (w->list.ended != EW_NO_PLACE) give_ended(w);
        if (*w->list.link == EW_NO_PLACE) return EW_OK;
        const uint32_t next = ew_kept_at(w, *w->list.link)->active.number;
        if (next >= number) return EW_OK;
        const int error = go_on(w, next);
        if (error) return error;
    }
}

/* The next triangle before which no kept one comes, `number`, as make_ready leaves it: not below start_next,
 * since the deepest calls lie below it. Returns what start_next asks for, or an error. */
static inline int get_next(ew_picture_work *w, uint32_t number, int is_late)
{
    const int error = take(w, number, is_late);
    return error ? error : make_ready(w);
}

/* Starts it. */
static EW_OWN_FRAME int start_next(ew_picture_work *w, int how, int is_late)
{
    const int result = start(w, how);
    if (result >= DRAW_LATE) put_late(w, is_late);
    return result;
}

/* Back to the first object. */
static void start_over(ew_picture_work *w)
{
    if (w->object) w->object = w->first_triangle = w->first_vertex = w->behind = 0;
}

int ew_draw_band(ew_picture_work *w)
{
    int result = EW_OK;
    w->list.link = &w->kept;
    start_late(w);
    start_over(w);
    while (result >= 0) {
        const uint32_t number = number_ahead(w);
        result = draw_kept(w, number);
        if (number == EW_NO_TRIANGLE || result < 0) break;
        const int is_late = number == number_of_late(w);
        result = get_next(w, number, is_late);
        if (result > 0) result = start_next(w, result, is_late);
        if (result == DRAW_FAN) {
            while ((result = next_of_fan(w)) > 0) ew_raster_draw_begun(w->geometry->raster);
        } else if (result >= DRAW) {
            ew_raster_draw_begun(w->geometry->raster);
        }
    }
    merge_late(w);
    if (w->active > w->most_active) w->most_active = w->active;
    return result < 0 ? result : EW_OK;
}

#if EW_WITH_SPANS

/* ---- a row of EW_DEPTH_SPANS ---- */

/* Shows what was kept of triangles before `number`. */
static void show_kept(ew_picture_work *w, uint32_t number)
{
    ew_place *link = w->list.link;
    uint32_t before = EW_NO_TRIANGLE;
    unsigned part = 0;
    while (*link != EW_NO_PLACE) {
        ew_active *active = &ew_kept_at(w, *link)->active;
        if (active->number >= number) break;
        part = active->number == before ? part + 1u : 0;
        before = active->number;
        ew_show(w, active, *link, part);
        link = &active->next;
    }
    w->list.link = link;
}

/* Shows what was kept of triangles before the next that is not, and returns the number of that. */
static EW_OWN_FRAME uint32_t show_until_next(ew_picture_work *w)
{
    const uint32_t number = number_ahead(w);
    show_kept(w, number);
    return number;
}

/* Goes on with the triangle that was set up without room for it. */
static ew_active *begun(ew_picture_work *w)
{
    ew_active *active = &w->row->late;
    ew_raster_keep(w->geometry->raster, active);
    active->number = w->number;
    return active;
}

/* Shows one that is late, `how` as start has it. Returns EW_OK or an error. */
static EW_OWN_FRAME int show_late(ew_picture_work *w, int how)
{
    unsigned part = 0;
    if (how == DRAW_LATE) ew_show(w, begun(w), EW_NO_PLACE, 0);
    if (how != DRAW_FAN) return EW_OK;
    for (; (how = next_of_fan(w)) > 0; part++) ew_show(w, begun(w), EW_NO_PLACE, part);
    return how;
}

static EW_OWN_FRAME void start_showing(ew_picture_work *w)
{
    w->list.link = &w->kept;
    start_late(w);
    start_over(w);
}

static EW_OWN_FRAME void end_showing(ew_picture_work *w)
{
    merge_late(w);
    if (w->active > w->most_active) w->most_active = w->active;
}

/* Small: the deepest calls lie below it. */
int ew_show_spans(ew_picture_work *w)
{
    int result = EW_OK;
    start_showing(w);
    while (result >= 0) {
        const uint32_t number = show_until_next(w);
        if (number == EW_NO_TRIANGLE) break;
        const int is_late = number == number_of_late(w);
        result = get_next(w, number, is_late);
        if (result > 0) result = start_next(w, result, is_late);
        if (result > 0) result = show_late(w, result);
    }
    end_showing(w);
    return result < 0 ? result : EW_OK;
}

/* Draws what is seen of a late triangle, or of a part of one. */
static void draw_begun(ew_picture_work *w, unsigned part)
{
    const ew_active *active = begun(w);
    for (uint16_t *link = &w->row->late_first; *link != EW_NOT_SEEN;) {
        ew_seen *s = &w->row->seen[*link];
        if (s->number == w->number && s->span.part == part) {
            ew_raster_draw_columns(w->geometry->raster, active, s->span.from, s->span.to);
            ew_forget(w->row, link);
        } else {
            link = &s->span.next;
        }
    }
}

static int is_seen(const ew_row_work *row, uint32_t number)
{
    uint16_t i = row->late_first;
    while (i != EW_NOT_SEEN && row->seen[i].number != number) i = row->seen[i].span.next;
    return i != EW_NOT_SEEN;
}

/* Draws what is seen of the late triangle at hand, `how` as make_ready has it. Returns what is below 0 for an
 * error. */
static EW_OWN_FRAME int draw_ready(ew_picture_work *w, int how)
{
    if (how == DRAW && (how = begin(w)) > 0) draw_begun(w, 0);
    else if (how == DRAW_FAN) for (unsigned part = 0; (how = next_of_fan(w)) > 0; part++) draw_begun(w, part);
    return how;
}

int ew_draw_late(ew_picture_work *w)
{
    int result = EW_OK;
    if (w->row->late_first == EW_NOT_SEEN) return EW_OK;
    start_over(w);
    for (uint32_t i = 0; i < w->late_count && result >= 0; i++) {
        if (!is_seen(w->row, w->entries[i])) continue;
        result = go_to(w, w->entries[i]);
        if (result) break;
        w->again++;
        result = draw_ready(w, make_ready(w));
    }
    return result < 0 ? result : EW_OK;
}

int ew_draw_seen(ew_picture_work *w)
{
    ew_row_work *row = w->row;
    start_over(w);
    for (ew_place place = w->kept; place != EW_NO_PLACE;) {
        ew_active *active = &ew_kept_at(w, place)->active;
        place = active->next;
        if (active->at.seen == EW_NOT_SEEN) continue;
        if (active->number >= w->behind) {
            const int error = go_on(w, active->number);
            if (error) return error;
        }
        while (active->at.seen != EW_NOT_SEEN) {
            const ew_active_span *span = &row->seen[active->at.seen].span;
            ew_raster_draw_columns(w->geometry->raster, active, span->from, span->to);
            ew_forget(row, &active->at.seen);
        }
    }
    return EW_OK;
}

void ew_step_kept(ew_picture_work *w)
{
    for (ew_place *link = &w->kept; *link != EW_NO_PLACE;) {
        ew_active *active = &ew_kept_at(w, *link)->active;
        if (active->row == w->top) ew_active_step(active);
        if (active->row < active->end) link = &active->next;
        else drop(w, link);
    }
}

#endif
