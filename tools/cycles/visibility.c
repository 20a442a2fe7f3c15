/* Three ways to find what is seen - a depth buffer, one row of depth, spans - against the size of triangles and
 * depth complexity: sheets of equal triangles, one behind the other, each of which fills the picture. Everything
 * counts: clearing, listing, set-up, drawing. Each picture is drawn between bench_draw and bench_end.
 *
 * On the host: `visibility --list` names the cases. */
#include "edgewalk/picture.h"
#include "drawn.h"

enum { W = 256, H = 128, LEAST_EDGE = 4, SHEETS = 16, TOLERANCE = 4, MEMORY = 1 << 21 };

static const uint16_t edges[] = { 4, 8, 16, 32, 64, 128 }; /* of a right-angled triangle, px */
static const uint16_t complexities[] = { 1, 2, 4, 8, 16 };

typedef struct way {
    const char *name;
    uint16_t rows;
    uint8_t visibility;
} way;
static const way ways[] = { { "full z", H, EW_DEPTH_BUFFER }, { "1-D z", 1, EW_DEPTH_BUFFER }, { "spans", 1, EW_DEPTH_SPANS } };

#define COUNT_OF(a) ((int)(sizeof(a) / sizeof *(a)))

enum { MOST_ACROSS = W / LEAST_EDGE + 2, MOST_DOWN = H / LEAST_EDGE + 2 };
static ew_vertex16 vertices[(MOST_ACROSS + 1) * (MOST_DOWN + 1)];
static uint16_t indices[MOST_ACROSS * MOST_DOWN * 6];
static uint16_t texels[256 * 256];
static ew_object objects[SHEETS];
static ew_raster raster;
static ew_geometry geometry;
static uint8_t memory[MEMORY];
static uint32_t band_hash;

__attribute__((noinline, noclone)) int bench_draw(const ew_picture *picture, uint32_t count, size_t bytes, ew_picture_counts *counts);
__attribute__((noinline, noclone)) void bench_end(void);

int bench_draw(const ew_picture *picture, uint32_t count, size_t bytes, ew_picture_counts *counts)
{
    return ew_picture_draw(picture, objects, count, &geometry, memory, bytes, counts);
}
void bench_end(void) { __asm__ volatile(""); }

static void no_band(void *user, const ew_target *band) { (void)user, (void)band; }
static void hash_band(void *user, const ew_target *band)
{
    (void)user;
    band_hash = drawn_hash(band_hash, band->colour, NULL, (uint32_t)W * band->height);
}

/* Cells of edge x edge px, two triangles each, and one more on each side; x and y in units of 1/64 px from the
 * picture's middle. */
static void make_sheet(ew_mesh *mesh, uint32_t *vertex_count, int edge)
{
    const int across = W / edge + 2, down = H / edge + 2;
    uint32_t at = 0, n = 0;
    for (int j = 0; j <= down; j++) {
        for (int i = 0; i <= across; i++) {
            const int x = (2 * i - across) * edge * 32, y = (2 * j - down) * edge * 32;
            /* a texel for each pixel, 3 fraction bits */
            vertices[n++] = (ew_vertex16){ (int16_t)x, (int16_t)-y, 0, (int16_t)(x / 8), (int16_t)(y / 8) };
            if (i == across || j == down) continue;
            const uint16_t corner = (uint16_t)(j * (across + 1) + i), below = (uint16_t)(corner + across + 1);
            const uint16_t six[] = { corner, below, (uint16_t)(corner + 1), (uint16_t)(corner + 1), below, (uint16_t)(below + 1) };
            for (int k = 0; k < 6; k++) indices[at++] = six[k];
        }
    }
    *mesh = (ew_mesh){ vertices, NULL, NULL, indices, at, 3 };
    *vertex_count = n;
}

/* Sheet k of count: at distance d = 2 + place/8, all of them as large on the screen, leaning back by a tenth of the
 * distance over the picture's height. Places are in no order. */
static int make_object(ew_object *o, const ew_texture *texture, uint32_t k, uint32_t count)
{
    const int32_t place = (int32_t)((k * 5u + 2u) % count), d = 131072 + place * 8192; /* q16.16 */
    /* focal length 1 of half the width; x = 1/64 px times d: 64 W/2 units of q1.15 at distance d */
    const ew_projection projection = { 131072, 65536, { INT32_C(1) << 29, -1 } };
    const ew_viewport viewport = { 0, 0, W, H };
    const int32_t scale = d * 4; /* 32768 / (64 W / 2) = 4 */
    ew_mat34 m;
    ew_row_from_q16_16(&m.row[0], scale, 0, 0, 0);
    ew_row_from_q16_16(&m.row[1], 0, scale, 0, 0);
    ew_row_from_q16_16(&m.row[2], 0, -scale / 10, 0, -d);
    o->material = (ew_material){ .texture = texture, .tolerance = TOLERANCE };
    return ew_transform_set(&o->transform, &projection, &m, &viewport);
}

static int run(const way *by, int edge, uint32_t complexity, ew_picture_counts *counts)
{
    const ew_texture texture = { .texels = texels, .width = 256, .height = 256 };
    ew_picture p = { .width = W, .height = H, .rows = by->rows, .visibility = by->visibility, .buffers = 1, .end_row = H,
                     .scissor = { 0, 0, W, H }, .band = hash_band };
    ew_mesh sheet;
    uint32_t vertex_count;
    int error = EW_OK;
    make_sheet(&sheet, &vertex_count, edge);
    for (uint32_t k = 0; k < complexity && !error; k++) {
        objects[k].mesh = sheet;
        objects[k].vertex_count = vertex_count;
        error = make_object(&objects[k], &texture, k, complexity);
    }
    ew_geometry_init(&geometry, &raster);
    band_hash = DRAWN_START;
    if (!error) error = ew_picture_draw(&p, objects, complexity, &geometry, memory, sizeof memory, counts);
    p.band = no_band;
    if (!error) error = bench_draw(&p, complexity, sizeof memory, counts);
    bench_end();
    if (error || counts->again || counts->crossings || counts->sections) return 1;
    return 0;
}

static int run_all(void (*done)(const char *way, int edge, uint32_t complexity, const ew_picture_counts *counts))
{
    ew_picture_counts counts;
    for (uint32_t i = 0; i < 256 * 256; i++) texels[i] = (uint16_t)(i * 40503u >> 3);
    for (int w = 0; w < COUNT_OF(ways); w++) {
        for (int e = 0; e < COUNT_OF(edges); e++) {
            for (int c = 0; c < COUNT_OF(complexities); c++) {
                if (run(&ways[w], edges[e], complexities[c], &counts)) {
                    bench_line("cannot draw the sheets\n");
                    return 1;
                }
                done(ways[w].name, edges[e], complexities[c], &counts);
            }
        }
    }
    return 0;
}

static void print_case(const char *way, int edge, uint32_t complexity, const ew_picture_counts *counts)
{
    (void)way, (void)edge, (void)complexity, (void)counts;
    drawn_print(band_hash);
}

#if __STDC_HOSTED__
static void list_case(const char *way, int edge, uint32_t complexity, const ew_picture_counts *counts)
{
    printf("%s,%d,%u,%d,%u\n", way, edge, (unsigned)complexity, W * H, (unsigned)counts->most_active);
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--list") == 0) return run_all(list_case);
    return argc > 1 ? 2 : run_all(print_case);
}
#else
int main(void) { return run_all(print_case); }
#endif
