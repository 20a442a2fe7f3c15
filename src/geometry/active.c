/* Triangles that reach over more bands than one: kept where there is room, else set up again. */
#include "picture.h"

/* ---- places ---- */

enum { PLACE_BYTES = 8 };

static ew_kept *kept_at(const ew_picture_work *w, ew_place place)
{
    return (ew_kept *)(void *)(w->places + (size_t)place * PLACE_BYTES);
}

void ew_places_init(ew_picture_work *w, size_t bytes)
{
    const size_t places = bytes / PLACE_BYTES < EW_NO_PLACE ? bytes / PLACE_BYTES : EW_NO_PLACE - 1u;
    w->kept = w->gaps = EW_NO_PLACE;
    if (places == 0) return;
    w->gaps = 0;
    kept_at(w, 0)->gap.places = (uint16_t)places;
    kept_at(w, 0)->gap.next = EW_NO_PLACE;
}

/* The first gap that is large enough gives its end. */
static ew_place take_places(ew_picture_work *w, uint16_t places)
{
    for (ew_place *at = &w->gaps; *at != EW_NO_PLACE; at = &kept_at(w, *at)->gap.next) {
        ew_kept *gap = kept_at(w, *at);
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
    ew_kept *before = NULL, *gap = kept_at(w, place);
    ew_place *at = &w->gaps;
    ew_place before_place = 0;
    while (*at != EW_NO_PLACE && *at < place) {
        before_place = *at;
        before = kept_at(w, *at);
        at = &before->gap.next;
    }
    gap->gap.places = places;
    gap->gap.next = *at;
    *at = place;
    if (gap->gap.next == place + places) {
        const ew_kept *after = kept_at(w, gap->gap.next);
        gap->gap.places = (uint16_t)(places + after->gap.places);
        gap->gap.next = after->gap.next;
    }
    if (before && before_place + before->gap.places == place) {
        before->gap.places = (uint16_t)(before->gap.places + gap->gap.places);
        before->gap.next = gap->gap.next;
    }
}

static uint16_t places_of(const ew_triangle *t) { return (uint16_t)(ew_active_bytes(t) / PLACE_BYTES); }

/* Takes the kept triangle out that *link leads to. */
static void drop(ew_picture_work *w, ew_place *link)
{
    const ew_place place = *link;
    const ew_active *active = &kept_at(w, place)->active;
    const uint16_t places = places_of(&active->triangle);
    *link = active->next;
    give_places(w, place, places);
    w->active--;
}

/* Keeps the triangle that was begun, before the one that *link leads to. Returns where it leads on,
 * or NULL where there is no room. */
static ew_place *keep(ew_picture_work *w, ew_place *link)
{
    const ew_place place = take_places(w, places_of(&w->geometry->raster->work.triangle));
    if (place == EW_NO_PLACE) return NULL;
    ew_active *active = &kept_at(w, place)->active;
    ew_raster_keep(w->geometry->raster, active);
    active->number = w->number;
    active->next = *link;
    *link = place;
    w->active++;
    return &active->next;
}

/* ---- vertices ---- */

static void take_slot(ew_picture_work *w, uint32_t number, const ew_screen_vertex *v)
{
    enum { TRIES = 16 };
    const uint32_t tries = w->slot_count < TRIES ? w->slot_count : TRIES;
    for (uint32_t i = 0; i < tries; i++) {
        if (++w->hand >= w->slot_count) w->hand = 0;
        ew_slot *slot = &w->slots[w->hand];
        /* no triangle begins below its own vertices */
        if (ew_row_of(slot->y) >= w->top) continue;
        slot->w = v->w, slot->x = v->x;
        /* those of vertices without a place begin in the first band there is */
        slot->y = v->outcode & (EW_OUT_NEAR | EW_OUT_GUARD) ? w->top * 4096 : v->y;
        slot->tag = number << 8 | v->outcode;
        w->map[number] = (uint16_t)w->hand;
        return;
    }
}

/* Corner k of the triangle at hand, to w->screen. */
static EW_OWN_FRAME void fetch(ew_picture_work *w, int k)
{
    const ew_object *object = w->at;
    const uint16_t vertex = object->mesh.indices[(size_t)(w->number - w->first_triangle) * 3u + (unsigned)k];
    ew_screen_vertex *out = &w->screen[k];
    if (object->mesh.screen) {
        *out = object->mesh.screen[vertex];
        return;
    }
    const uint32_t number = w->first_vertex + vertex;
    const uint16_t at = w->map[number];
    if (at < w->slot_count && w->slots[at].tag >> 8 == number) {
        const ew_slot *slot = &w->slots[at];
        out->w = slot->w, out->x = slot->x, out->y = slot->y;
        out->outcode = (uint8_t)slot->tag;
        return;
    }
    ew_transform_vertices(&object->transform, &object->mesh.vertices[vertex], 1, out);
    w->counts->transformed++;
    take_slot(w, number, out);
}

/* ---- triangles ---- */

/* Makes a triangle and its object the ones at hand: numbers grow within a band. Returns EW_OK or an
 * error of the raster's. */
static int go_to(ew_picture_work *w, uint32_t number)
{
    const ew_object *object = &w->objects[w->object];
    w->number = number;
    while (number - w->first_triangle >= object->mesh.index_count / 3u) {
        w->first_triangle += object->mesh.index_count / 3u;
        if (!object->mesh.screen) w->first_vertex += object->vertex_count;
        object = &w->objects[++w->object];
    }
    w->at = object;
    if (w->used == w->object) return EW_OK;
    w->used = w->object;
    return ew_raster_set_material(w->geometry->raster, &object->material);
}

/* What becomes of a triangle in the band at hand: there is nothing to be drawn; it is kept; there is none
 * any more; what the raster has set up is to be drawn, and that was all or the rest is late; the
 * triangles of a fan are to be drawn, one after the other, and are late, too. */
enum { DONE, KEPT, BAND_DONE, DRAW, DRAW_LATE, DRAW_FAN };

static int begin(ew_picture_work *w)
{
    ew_raster_vertex *const v = w->geometry->corner;
    const int result = ew_raster_begin(w->geometry->raster, &v[0], &v[1], &v[2], (uint16_t)w->end);
    w->counts->set_up += result > 0;
    return result;
}

/* Each triangle of a clipped one's fan: all of them are kept, or none. */
static EW_OWN_FRAME int keep_fan(ew_picture_work *w)
{
    ew_place *const link = w->kept_link, *to = link;
    const ew_place behind = *link;
    while (ew_clip_next(w->geometry)) {
        const int result = begin(w);
        if (result < 0) return result;
        if (result == 0) continue;
        to = keep(w, to);
        if (to) continue;
        while (*link != behind) drop(w, link);
        w->geometry->clipped_next = 0;
        return DRAW_FAN;
    }
    return *link == behind ? DONE : KEPT;
}

/* Sets the next triangle of the fan up: 1, 0 behind the last, or an error. */
static EW_OWN_FRAME int next_of_fan(ew_picture_work *w)
{
    while (ew_clip_next(w->geometry)) {
        const int result = begin(w);
        if (result) return result;
    }
    return 0;
}

static EW_OWN_FRAME int clipped(ew_picture_work *w, const uint16_t *index)
{
    for (int k = 0; k < 3; k++) w->geometry->clip_screen[k] = &w->screen[k];
    w->geometry->transform = w->at->transform;
    ew_clip_triangle(w->geometry, &w->at->mesh, index);
    return keep_fan(w);
}

/* Sets the triangle at hand up, with its corners in w->screen; kept ones stand at *kept_link then.
 * Returns one of the above or an error. */
static EW_OWN_FRAME int start(ew_picture_work *w)
{
    const ew_object *object = w->at;
    const ew_mesh *mesh = &object->mesh;
    const uint16_t *index = mesh->indices + (size_t)(w->number - w->first_triangle) * 3u;
    const ew_screen_vertex *const s = w->screen;
    const int any = s[0].outcode | s[1].outcode | s[2].outcode, all = s[0].outcode & s[1].outcode & s[2].outcode;
    if (any & (EW_OUT_NEAR | EW_OUT_GUARD)) return all & ~EW_OUT_GUARD ? DONE : clipped(w, index);
    if (all || (!(object->material.flags & EW_DOUBLE_SIDED) && !ew_faces_the_eye(&s[0], &s[1], &s[2]))) return DONE;

    const int32_t uv_unit = (int32_t)1 << (12 - mesh->uv_fraction_bits);
    ew_raster_vertex *const v = w->geometry->corner;
    for (int k = 0; k < 3; k++) {
        ew_corner_from(&v[k], &mesh->vertices[index[k]], &s[k], uv_unit);
        v[k].colour = mesh->colours ? mesh->colours[index[k]] : ew_white;
    }
    const int result = begin(w);
    if (result <= 0) return result;
    if (ew_raster_begun_end(w->geometry->raster) <= w->bottom) return DRAW;
    return keep(w, w->kept_link) ? KEPT : DRAW_LATE;
}

/* ---- a band ---- */

/* The number of the triangle that *link leads to. */
static uint32_t number_at(const ew_picture_work *w, ew_place link)
{
    return link == EW_NO_PLACE ? EW_NO_TRIANGLE : kept_at(w, link)->active.number;
}

/* Takes a late triangle, or else the next to begin, out of its list. */
static EW_OWN_FRAME int take(ew_picture_work *w, uint32_t number, int is_late)
{
    if (is_late) {
        *w->late_link = w->link[number];
        w->active--;
        w->counts->again++;
    } else {
        w->next = w->link[number];
    }
    return go_to(w, number);
}

static void put_late(ew_picture_work *w)
{
    uint32_t *link = &w->link[w->number];
    *link = *w->late_link;
    *w->late_link = w->number;
    w->late_link = link;
    w->active++;
}

/* Makes the next triangle ready to be drawn: returns it where it was kept, else says in *result
 * what is to be done, or an error. */
static EW_OWN_FRAME ew_active *next_triangle(ew_picture_work *w, int *result)
{
    for (;;) {
        const uint32_t k = number_at(w, *w->kept_link), l = *w->late_link;
        const uint32_t s = w->next >> EW_NUMBER_BITS == w->band ? w->next & EW_NUMBER_MASK : EW_NO_TRIANGLE;
        if (k <= l && k <= s) {
            *result = k == EW_NO_TRIANGLE ? BAND_DONE : go_to(w, k);
            return *result ? NULL : &kept_at(w, *w->kept_link)->active;
        }
        *result = take(w, l < s ? l : s, l < s);
        if (*result < 0) return NULL;
        for (int i = 0; i < 3; i++) fetch(w, i);
        *result = start(w);
        if (*result >= DRAW_LATE) put_late(w);
        if (*result < 0 || *result >= DRAW) return NULL;
        /* what was kept is drawn next: it stands at *kept_link */
    }
}

int ew_draw_band(ew_picture_work *w)
{
    int result;
    w->kept_link = &w->kept;
    w->late_link = &w->late;
    w->object = w->first_triangle = w->first_vertex = 0;
    do {
        ew_active *active = next_triangle(w, &result);
        if (active) {
            ew_raster_draw_active(w->geometry->raster, active);
            if (active->row < active->end) w->kept_link = &active->next;
            else drop(w, w->kept_link);
        } else if (result == DRAW_FAN) {
            while ((result = next_of_fan(w)) > 0) ew_raster_draw_begun(w->geometry->raster);
        } else if (result >= DRAW) {
            ew_raster_draw_begun(w->geometry->raster);
        }
    } while (result >= 0 && result != BAND_DONE);
    if (w->active > w->counts->most_active) w->counts->most_active = w->active;
    return result < 0 ? result : EW_OK;
}
