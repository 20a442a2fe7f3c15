/* A whole picture: the memory that it takes, triangles sorted by band, one band after the other. */
#include "picture.h"


/* ---- memory ---- */

enum { ALIGNMENT = 8 };

/* What a picture needs, in the order in which it lies in memory. */
typedef struct memory_plan {
    uint32_t stride, rows, bands;  /* rows of a band, and how many bands there are            */
    uint32_t is_listed;            /* triangles are sorted: there are several bands, or EW_DEPTH_SPANS */
    uint32_t triangles, vertices;  /* to be linked and mapped, 0 where nothing is listed       */
    uint32_t screen;               /* vertices to be kept while an object is drawn, where it is not */
    uint32_t colour, depth;        /* bytes of a band                                         */
    uint32_t least;                /* with what alignment may take; below 2^28                 */
} memory_plan;

static uint32_t aligned(uint32_t bytes) { return (bytes + ALIGNMENT - 1u) / ALIGNMENT * ALIGNMENT; }

static int is_valid(const ew_picture *p)
{
    return p->width >= 1 && p->width <= EW_TARGET_MAX && p->height >= 1 && p->height <= EW_TARGET_MAX &&
           p->format <= EW_TARGET_MONO && p->visibility <= EW_DEPTH_SPANS && p->buffers >= 1 && p->buffers <= 2 &&
           p->rows >= 1 && p->rows <= p->height && p->first_row < p->end_row && p->end_row <= p->height &&
           p->scissor.x0 <= p->scissor.x1 && p->scissor.y0 <= p->scissor.y1 && p->scissor.x1 <= p->width &&
           p->scissor.y1 <= p->height && p->fog_far <= p->fog_near;
}

/* Returns 0 for what cannot be drawn. */
static int count_objects(memory_plan *plan, const ew_object *objects, uint32_t count)
{
    uint32_t triangles = 0, vertices = 0, most = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t of_this = objects[i].mesh.index_count / 3u;
        if (of_this >= EW_NO_TRIANGLE - triangles) return 0;
        triangles += of_this;
        if (objects[i].mesh.screen) continue;
        if (objects[i].vertex_count > most) most = objects[i].vertex_count;
        if (objects[i].vertex_count >= UINT32_C(0xFFFFFF) - vertices) return 0;
        vertices += objects[i].vertex_count;
    }
    plan->triangles = plan->is_listed ? triangles : 0;
    plan->vertices = plan->is_listed ? vertices : 0;
    plan->screen = plan->is_listed ? 0 : most;
    return 1;
}

/* Returns 0 for what cannot be drawn. */
static int plan_init(memory_plan *plan, const ew_picture *picture, const ew_object *objects, uint32_t count)
{
    static const uint8_t log2_bits[] = { 4, 4, 3, 3, 2, 0 }; /* of a pixel, by format */
    if (!is_valid(picture)) return 0;
    const uint32_t all = (uint32_t)(picture->end_row - picture->first_row), bits = log2_bits[picture->format];
    plan->stride = bits < 3 ? (picture->width + 7u) / 8u * 8u : picture->width; /* whole bytes */
    plan->rows = picture->rows < all ? picture->rows : all;
    plan->bands = (all + plan->rows - 1u) / plan->rows;
    plan->is_listed = plan->bands > 1 || picture->visibility == EW_DEPTH_SPANS;
    if (!count_objects(plan, objects, count)) return 0;
    const uint32_t pixels = plan->stride * plan->rows; /* <= 2^24 */
    plan->colour = aligned((pixels << bits) / 8u);
    plan->depth = picture->visibility == EW_DEPTH_BUFFER ? aligned(pixels * 2u) : 0;
    plan->least = ALIGNMENT - 1u + plan->colour * picture->buffers + plan->depth + (plan->is_listed ? 0 : aligned(sizeof(ew_mesh))) +
                  aligned(plan->screen * (uint32_t)sizeof(ew_screen_vertex)) + aligned(plan->triangles * 4u) +
                  aligned(plan->vertices * 2u) + (picture->visibility == EW_DEPTH_SPANS ? aligned((uint32_t)EW_ROW_LEAST) : 0);
    return sizeof(size_t) > 2 || plan->least <= UINT16_MAX;
}

size_t ew_picture_least(const ew_picture *picture, const ew_object *objects, uint32_t count)
{
    memory_plan plan;
    return plan_init(&plan, picture, objects, count) ? (size_t)plan.least : 0;
}

size_t ew_picture_bytes(const ew_picture *picture, const ew_object *objects, uint32_t count, uint32_t active)
{
    enum { AND = 408, AND_EACH = 124 };
    const uint32_t more = active <= AND / AND_EACH ? AND_EACH * active : AND;
    const uint32_t of_active = picture->visibility == EW_DEPTH_SPANS ? 256 : 112;
    memory_plan plan;
    if (!plan_init(&plan, picture, objects, count)) return 0;
    if (!plan.is_listed) return (size_t)plan.least;
    const uint32_t most = SIZE_MAX < INT32_MAX ? (uint32_t)SIZE_MAX : INT32_MAX;
    if (plan.least > most - more) return (size_t)plan.least;
    const uint32_t fit = (most - more - plan.least) / of_active;
    const uint32_t bytes = plan.least + more + (active < fit ? active : fit) * of_active; /* <= most */
    return (size_t)bytes;
}

/* Lays out the memory. */
static void work_init(ew_picture_work *w, const memory_plan *plan, const ew_picture *picture, void *memory, size_t bytes)
{
    uint8_t *at = (uint8_t *)memory + (ALIGNMENT - (uintptr_t)memory % ALIGNMENT) % ALIGNMENT;
    w->picture = picture;
    w->rows = (uint16_t)plan->rows, w->bands = (uint16_t)plan->bands, w->stride = (uint16_t)plan->stride; /* <= 4096 */
    w->bands_at_once = 1;
    if (picture->visibility == EW_DEPTH_SPANS) { /* row by row, whatever is handed over */
        w->bands_at_once = w->rows;
        w->bands = (uint16_t)(picture->end_row - picture->first_row);
        w->rows = 1;
    }
    w->is_listed = (uint8_t)plan->is_listed;
    w->is_narrow = picture->scissor.x0 > 0 || picture->scissor.x1 < picture->width;
    w->row = NULL;
    w->colour = at;
    w->colour_bytes = plan->colour;
    at += plan->colour * picture->buffers;
    w->depth = plan->depth ? (uint16_t *)(void *)at : NULL;
    at += plan->depth;
    w->map = (uint16_t *)(void *)at;
    w->vertices = plan->vertices;
    at += aligned(plan->vertices * 2u);
    w->entries = (uint32_t *)(void *)at;
    at += aligned(plan->triangles * 4u);
    w->slots = (ew_slot *)(void *)at; /* where there is one band, an object's mesh, then its vertices */
    w->end_of_memory = (uint8_t *)memory + bytes;
    w->set_up = w->again = w->transformed = w->most_active = w->crossings = w->sections = 0;
    w->entry_count = w->next = w->late_count = w->active = 0;
}

/* ---- sorting ---- */

enum { BATCH = 16 };

/* While triangles are listed, vertices pass through the memory that triangles will be kept in: a ring, where
 * the next ones take the oldest ones' slots. There x and y are snapped, and w is the vertex's number. */
static ew_screen_vertex *ring_of(const ew_picture_work *w) { return (ew_screen_vertex *)(void *)w->slots; }

/* What the map has of a vertex meanwhile: its slot, below NOWHERE; or that and NOWHERE, beyond the near plane or
 * the guard band. Once the slot is taken: NO_SLOT and the row that it may begin, within those that are drawn; or
 * that it has none. Or nothing yet. */
#define NOWHERE UINT16_C(0x4000)
#define NO_SLOT UINT16_C(0x8000)
#define NEAR UINT16_C(0xFFFF)
#define UNKNOWN UINT16_C(0xFFFE)
#define NOT_YET UINT16_C(0xFFFD)

static void init_listing(ew_picture_work *w)
{
    const size_t slots = (size_t)(w->end_of_memory - (uint8_t *)w->slots) / sizeof(ew_screen_vertex);
    w->slot_count = slots < NOWHERE ? (uint16_t)slots : NOWHERE;
    if (slots < EW_FEW) {
        w->slots = (ew_slot *)(void *)w->geometry->at_hand.few;
        w->slot_count = EW_FEW;
    }
    w->hand = 0;
    for (uint32_t i = 0; i < w->slot_count; i++) ring_of(w)[i].w = EW_NO_VERTEX;
    for (uint32_t i = 0; i < w->vertices; i++) w->map[i] = NOT_YET;
}

/* What the map has of a vertex that is snapped, but in no slot. */
static uint16_t without_slot(const ew_picture_work *w, int outcode, ew_snapped y)
{
    if (outcode & EW_OUT_NEAR) return NEAR;
    if (outcode & EW_OUT_GUARD) return UNKNOWN;
    const int32_t row = ew_row_of_snapped(y);
    return (uint16_t)(NO_SLOT | (row < w->first ? w->first : row > w->end ? w->end : row));
}

/* Takes the next n slots of the ring. */
static ew_screen_vertex *take_slots(ew_picture_work *w, uint32_t n)
{
    ew_screen_vertex *const slot = ring_of(w) + w->hand;
    for (uint32_t i = 0; i < n && slot[i].w != EW_NO_VERTEX; i++) {
        w->map[slot[i].w] = without_slot(w, slot[i].outcode, slot[i].y);
    }
    w->hand = (uint16_t)(w->hand + n);
    if (w->hand == w->slot_count) w->hand = 0;
    return slot;
}

/* How many vertices without a place in the map there are from map[0] on, of `most`. */
static uint32_t count_new(const uint16_t *map, uint32_t most)
{
    uint32_t n = 1;
    while (n < most && map[n] == NOT_YET) n++;
    return n;
}

/* Transforms a vertex that no triangle had before, and others behind it, which are likely to come
 * next. */
static EW_OWN_FRAME void transform_some(ew_picture_work *w, const ew_object *object, uint32_t vertex)
{
    uint32_t number = w->first_vertex + vertex, at = w->hand, n = w->slot_count - at;
    if (n > BATCH) n = BATCH;
    if (n > object->vertex_count - vertex) n = object->vertex_count - vertex;
    uint16_t *map = w->map + number;
    n = count_new(map, n);
    ew_screen_vertex *v = take_slots(w, n);
    ew_transform_vertices(&object->transform, &object->mesh.vertices[vertex], n, v);
    w->transformed += n;
    for (const ew_screen_vertex *const end = v + n; v < end; v++) {
        v->w = number++;
        v->x = ew_snapped_from_q20_12(v->x);
        v->y = ew_snapped_from_q20_12(v->y);
        *map++ = (uint16_t)(v->outcode & (EW_OUT_NEAR | EW_OUT_GUARD) ? NOWHERE | at : at);
        at++;
    }
}

/* Appends a triangle that begins on row `first` to the list. */
static inline void append(ew_picture_work *w, uint32_t number, int32_t first)
{
    const uint32_t below = (uint32_t)(first - w->picture->first_row);
    const uint32_t band = w->rows == 1 ? below : below / w->rows;
    w->entries[w->entry_count++] = number | band << EW_NUMBER_BITS;
}

/* The row that a triangle begins in, from what the map would have of its corners without slots, or -1 when it
 * covers no row. */
static int32_t first_row_of(const ew_picture_work *w, uint16_t a, uint16_t b, uint16_t c)
{
    uint16_t low = a < b ? a : b, high = a < b ? b : a;
    if (c < low) low = c;
    if (c > high) high = c;
    if (high < NOT_YET) return low < high ? (int32_t)(low - NO_SLOT) : -1;
    return low == NEAR ? -1 : (int32_t)w->first;
}

/* Appends a triangle of which the map has this, unless it is surely not seen. */
static EW_OWN_FRAME void append_unsure(ew_picture_work *w, uint32_t number, uint16_t a, uint16_t b, uint16_t c)
{
    uint16_t row[3] = { a, b, c };
    int all = (a | b | c) & NO_SLOT ? 0 : 0xFF;
    for (int k = 0; k < 3; k++) {
        if (row[k] >= NO_SLOT) continue;
        const ew_screen_vertex *v = ring_of(w) + row[k] % NOWHERE;
        all &= v->outcode;
        row[k] = without_slot(w, v->outcode, v->y);
    }
    const int32_t first = first_row_of(w, row[0], row[1], row[2]);
    if (first >= 0 && !(all & ~EW_OUT_GUARD)) append(w, number, first);
}

/* The same with three corners in the ring and somewhere. */
static EW_OWN_FRAME void append_front(ew_picture_work *w, uint32_t number, const ew_screen_vertex *a, const ew_screen_vertex *b,
                                      const ew_screen_vertex *c)
{
    if (a->outcode & b->outcode & c->outcode) return;
    ew_snapped low = a->y < b->y ? a->y : b->y, high = a->y < b->y ? b->y : a->y;
    if (c->y < low) low = c->y;
    if (c->y > high) high = c->y;
    int32_t first = ew_row_of_snapped(low), end = ew_row_of_snapped(high);
    if (first < w->first) first = w->first;
    if (end > w->end) end = w->end;
    if (first < end) append(w, number, first);
}

/* Appends an object's triangles that may be seen, from w->number on: what hides them is looked at where their
 * vertices are at hand, the rest is seen to when they begin. Returns a vertex that has to be
 * transformed before it can go on, or EW_NO_VERTEX behind the last triangle. */
static EW_OWN_FRAME uint32_t list_some(ew_picture_work *w, const ew_object *object)
{
    const ew_mesh *mesh = &object->mesh;
    uint32_t number = w->number;
    const uint16_t *index = mesh->indices + (size_t)(number - w->first_triangle) * 3u;
    const uint16_t *const end = mesh->indices + mesh->index_count, *const map = w->map + w->first_vertex;
    const ew_screen_vertex *const ring = ring_of(w);
    const int one_sided = !(object->material.flags & EW_DOUBLE_SIDED);
    for (; index < end; index += 3, number++) {
        const uint16_t a = map[index[0]], b = map[index[1]], c = map[index[2]];
        if ((a | b | c) & (NO_SLOT | NOWHERE)) {
            if (a == NOT_YET || b == NOT_YET || c == NOT_YET) {
                w->number = number;
                return a == NOT_YET ? index[0] : b == NOT_YET ? index[1] : index[2];
            }
            append_unsure(w, number, a, b, c);
            continue;
        }
        const ew_screen_vertex *va = &ring[a], *vb = &ring[b], *vc = &ring[c];
        const int32_t x = va->x, y = va->y;
        const int is_front = ew_product_less(vb->x - x, vc->y - y, vc->x - x, vb->y - y); /* |d| <= 2^26 */
        if (is_front || !one_sided) append_front(w, number, va, vb, vc);
    }
    return EW_NO_VERTEX;
}

/* The same where all vertices are on the screen already. */
static EW_OWN_FRAME void list_transformed(ew_picture_work *w, const ew_object *object)
{
    const ew_mesh *mesh = &object->mesh;
    const ew_screen_vertex *const screen = mesh->screen;
    const int both_sides = object->material.flags & EW_DOUBLE_SIDED;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        uint16_t row[3];
        const ew_screen_vertex *v[3];
        for (uint32_t k = 0; k < 3; k++) {
            v[k] = &screen[mesh->indices[i + k]];
            row[k] = without_slot(w, v[k]->outcode, ew_snapped_from_q20_12(v[k]->y));
        }
        const int32_t first = first_row_of(w, row[0], row[1], row[2]);
        if (first >= 0 && !ew_is_hidden(v[0], v[1], v[2], both_sides)) append(w, w->first_triangle + i / 3u, first);
    }
}

/* In numbers' order triangles are already: sorts them by band, where there is room behind the list for
 * a copy and a count of each band. Returns whether there was. */
static int sort_by_counting(ew_picture_work *w)
{
    const uint32_t count = w->entry_count, bands = w->bands;
    uint32_t *const entries = w->entries, *const copy = entries + count;
    if ((size_t)(w->end_of_memory - (uint8_t *)copy) / sizeof *copy < count + bands) return 0;
    uint32_t *const place = copy + count;
    for (uint32_t i = 0; i < bands; i++) place[i] = 0;
    for (uint32_t i = 0; i < count; i++) {
        copy[i] = entries[i];
        place[copy[i] >> EW_NUMBER_BITS]++;
    }
    for (uint32_t i = 0, next = 0; i < bands; i++) {
        const uint32_t in_band = place[i];
        place[i] = next;
        next += in_band;
    }
    for (uint32_t i = 0; i < count; i++) entries[place[copy[i] >> EW_NUMBER_BITS]++] = copy[i];
    return 1;
}

/* D. L. Shell, "A high-speed sorting procedure", 1959; steps by D. E. Knuth: (3^k - 1) / 2. */
static void sort_in_place(uint32_t *entries, uint32_t count)
{
    uint32_t step = 1;
    while (step < count / 3u) step = 3u * step + 1u;
    for (; step > 0; step /= 3u) {
        for (uint32_t i = step; i < count; i++) {
            const uint32_t entry = entries[i];
            uint32_t at = i;
            for (; at >= step && entries[at - step] > entry; at -= step) entries[at] = entries[at - step];
            entries[at] = entry;
        }
    }
}

/* Makes the list of triangles. */
static EW_OWN_FRAME void list(ew_picture_work *w)
{
    if (w->first >= w->end) return;
    init_listing(w);
    w->first_triangle = w->first_vertex = 0;
    for (uint32_t i = 0; i < w->count; i++) {
        const ew_object *object = &w->objects[i];
        w->number = w->first_triangle;
        if (object->mesh.screen) list_transformed(w, object);
        else for (uint32_t vertex; (vertex = list_some(w, object)) != EW_NO_VERTEX;) transform_some(w, object, vertex);
        w->first_triangle += object->mesh.index_count / 3u;
        if (!object->mesh.screen) w->first_vertex += object->vertex_count;
    }
}

/* Sorts them, and makes of what memory is left room for vertices and for kept ones. */
static EW_OWN_FRAME void sort(ew_picture_work *w)
{
    w->first_triangle = w->first_vertex = w->behind = 0;
    if (!sort_by_counting(w)) sort_in_place(w->entries, w->entry_count);
    ew_active_init(w);
}

/* ---- drawing ---- */

static ew_mesh *mesh_at_hand(const ew_picture_work *w) { return (ew_mesh *)(void *)w->slots; }

/* The next object of a picture that is drawn at once, where nothing has to be sorted: its mesh is ready
 * behind the bands. Returns 1, 0 behind the last, or an error. */
static EW_OWN_FRAME int next_mesh(ew_picture_work *w)
{
    if (w->object == w->count) return 0;
    const ew_object *object = &w->objects[w->object++];
    ew_mesh *mesh = mesh_at_hand(w);
    const int error = ew_raster_set_material(w->geometry->raster, &object->material);
    if (error) return error;
    w->geometry->transform = object->transform;
    *mesh = object->mesh;
    if (!mesh->screen) {
        ew_screen_vertex *screen = (ew_screen_vertex *)(void *)((uint8_t *)w->slots + aligned(sizeof *mesh));
        ew_transform_vertices(&object->transform, mesh->vertices, object->vertex_count, screen);
        w->transformed += object->vertex_count;
        mesh->screen = screen;
    }
    return 1;
}

/* The first row below `count` bands from the one at hand on, which begins on `row`. */
static int32_t end_of_bands(const ew_picture_work *w, int32_t row, uint32_t count)
{
    const int32_t rows = (int32_t)(w->rows * count), left = w->picture->end_row - row;
    return rows < left ? row + rows : w->picture->end_row;
}

static EW_OWN_FRAME void set_scissor(const ew_picture_work *w, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    const ew_rect rect = { (uint16_t)x0, (uint16_t)y0, (uint16_t)x1, (uint16_t)y1 };
    ew_raster_set_scissor(w->geometry->raster, &rect);
}

/* Whether a band is the first of those that are handed over together. */
static int begins(const ew_picture_work *w, uint32_t band) { return w->bands_at_once == 1 || band % w->bands_at_once == 0; }

/* Goes to the memory of the bands that begin on `row`, and clears it. */
static EW_OWN_FRAME void start_colours(ew_picture_work *w, int32_t row)
{
    ew_raster *raster = w->geometry->raster;
    const ew_picture *p = w->picture;
    const int32_t end = end_of_bands(w, row, w->bands_at_once);
    const int second = p->buffers > 1 && w->band / w->bands_at_once & 1u;
    ew_raster_set_rows(raster, w->colour + (second ? w->colour_bytes : 0), w->depth, (uint16_t)row, (uint16_t)(end - row));
    /* of the band before, or of its callback */
    if (raster->scissor.x0 > 0 || raster->scissor.x1 < p->width) set_scissor(w, 0, row, p->width, end);
    ew_raster_clear(raster, p->background);
}

/* Goes to the band at hand; the scissor is what of the picture's lies in it. Returns whether that is
 * anything. */
static EW_OWN_FRAME int start_band(ew_picture_work *w)
{
    const ew_picture *p = w->picture;
    const int32_t row = p->first_row + (int32_t)(w->band * w->rows), end = end_of_bands(w, row, 1);
    if (begins(w, w->band)) start_colours(w, row);
    const int32_t top = row > w->first ? row : w->first, bottom = end < w->end ? end : w->end;
    w->top = (uint16_t)top;
    w->bottom = (uint16_t)bottom;
    if (top >= bottom) return 0;
    /* ew_raster_set_rows has chosen all rows */
    if (w->is_narrow || top > row || bottom < end || w->bands_at_once > 1) {
        set_scissor(w, p->scissor.x0, top, p->scissor.x1, bottom);
    }
    return 1;
}

/* Whether what is behind the raster's material is never seen, and what is in front of it always is. */
static int is_opaque(const ew_raster *raster)
{
    const ew_material *m = &raster->material;
    const int cuts = m->texture ? EW_COLOUR_KEY | EW_ALPHA_MASK : 0;
    return !m->blend && !(m->flags & (cuts | EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE));
}

static EW_OWN_FRAME int init_raster(const ew_picture_work *w)
{
    const ew_picture *p = w->picture;
    ew_raster *raster = w->geometry->raster;
    const ew_target target = { .colour = w->colour, .depth = w->depth, .width = p->width, .height = (uint16_t)(w->rows * w->bands_at_once),
                               .stride = (uint16_t)w->stride, .format = p->format, .dither = p->dither,
                               .first_row = p->first_row };
    int error = ew_raster_init(raster, &target);
    if (!error && p->cost) error = ew_raster_set_cost(raster, p->cost);
    if (!error && p->fog_near) error = ew_raster_set_fog(raster, p->fog_colour, p->fog_near, p->fog_far);
    for (uint32_t i = 0; i < w->count && !error; i++) {
        error = ew_raster_set_material(raster, &w->objects[i].material);
        if (!error && p->visibility == EW_DEPTH_SPANS && !is_opaque(raster)) error = EW_ERR_UNSUPPORTED;
    }
    return error;
}

/* Makes everything ready in the memory. Returns EW_OK or an error. */
static EW_OWN_FRAME int prepare(const ew_picture *picture, const ew_object *objects, uint32_t count, ew_geometry *geometry,
                                void *memory, size_t bytes)
{
    memory_plan plan;
    if (!plan_init(&plan, picture, objects, count)) return EW_ERR_ARGUMENT;
    if (!EW_WITH_SPANS && picture->visibility == EW_DEPTH_SPANS) return EW_ERR_UNSUPPORTED;
    if (bytes < plan.least) return EW_ERR_ROOM;
    ew_picture_work *w = &geometry->work.picture;
    work_init(w, &plan, picture, memory, bytes);
    w->objects = objects;
    w->count = count;
    w->geometry = geometry;
    w->object = 0;
    w->band = 0;
    w->used = UINT32_MAX;
    w->first = picture->scissor.y0 > picture->first_row ? picture->scissor.y0 : picture->first_row;
    w->end = picture->scissor.y1 < picture->end_row ? picture->scissor.y1 : picture->end_row;
    return init_raster(w);
}

/* Hands over the band at hand with those before it, if it is the last of these. */
static EW_OWN_FRAME void hand_over(const ew_picture_work *w)
{
    const uint32_t behind = w->band + 1u;
    if (behind == w->bands || begins(w, behind)) w->picture->band(w->picture->user, &w->geometry->raster->target);
}

static inline int draw_meshes(ew_picture_work *w)
{
    int error;
    while ((error = next_mesh(w)) > 0) {
        const int32_t drawn = ew_draw_triangles(w->geometry, mesh_at_hand(w));
        if (drawn < 0) return (int)drawn;
    }
    return error;
}

/* One band after the other, in the caller's frame: below this lie the deepest calls. */
static inline int draw(ew_picture_work *w)
{
    int error = EW_OK;
    if (w->is_listed) {
        list(w);
        sort(w);
    }
    for (; w->band < w->bands && error >= 0; w->band++) {
        if (start_band(w)) {
            if (EW_WITH_SPANS && w->row) error = ew_draw_visible(w);
            else if (w->is_listed) error = ew_draw_band(w);
            else error = draw_meshes(w);
        }
        if (error >= 0) hand_over(w);
    }
    return error < 0 ? error : EW_OK;
}

static EW_OWN_FRAME void tell(ew_picture_counts *counts, const ew_picture_work *w)
{
    const ew_picture_counts all = { w->set_up, w->again, w->transformed, w->most_active, w->crossings, w->sections };
    *counts = all;
}

int ew_picture_draw(const ew_picture *picture, const ew_object *objects, uint32_t count, ew_geometry *geometry,
                    void *memory, size_t bytes, ew_picture_counts *counts)
{
    const int error = prepare(picture, objects, count, geometry, memory, bytes);
    if (error) return error;
    ew_picture_work *w = &geometry->work.picture;
    const int result = draw(w);
    if (counts) tell(counts, w);
    return result;
}
