/* Axes of the stability atlas: line by line with more triangles active on a row than there is room for. err_px
 * is how often a triangle is set up beyond the first time, on the average: what less memory costs. The picture stays
 * the same, bit for bit, or the program ends. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edgewalk/picture.h"
#include "walk.h"

enum { W = 160, H = 64, MOST = 512, KEPT_BYTES = 144 /* of a narrow triangle: docs/memory-modes.md */ };

/* Triangles that cross each other and reach over all rows: as many are active on each row. */
static struct {
    ew_object object;
    ew_vertex16 vertices[3 * MOST];
    ew_screen_vertex screen[3 * MOST];
    uint16_t indices[3 * MOST];
} crowd;

typedef struct image {
    uint16_t colour[W * H], depth[W * H];
} image;

/* 1 unit of a vertex is 1/1000 near; the picture ends at y = z / 1.5. */
static int crowd_init(void)
{
    srand48(5);
    for (int i = 0; i < 3 * MOST; i++) {
        const double z = 2000 + 6000 * drand48(), side = i % 3 == 2 ? -1 : 1; /* two corners above, one below */
        const double x = i % 3 == 1 ? crowd.vertices[i - 1].x + 0.2 * z : (2 * drand48() - 1) * z;
        const double y = side * (i / 3 % 2 ? -0.9 : 0.9) * z;
        crowd.vertices[i] = (ew_vertex16){ (int16_t)x, (int16_t)y, (int16_t)-z, (int16_t)(200 * drand48()), (int16_t)(200 * drand48()) };
        crowd.indices[i] = (uint16_t)i;
    }
    crowd.object = (ew_object){ .mesh = { crowd.vertices, crowd.screen, NULL, crowd.indices, 0, 0 }, .vertex_count = 3 * MOST,
                                .material = { .texture = walk_texture(), .tolerance = 4, .rung = EW_RUNG_AUTO, .flags = EW_DOUBLE_SIDED } };
    const int error = walk_view(&crowd.object.transform, W, H, 32.768, 0);
    if (!error) ew_transform_vertices(&crowd.object.transform, crowd.vertices, 3 * MOST, crowd.screen);
    return error;
}

static void take_band(void *user, const ew_target *band)
{
    image *to = user;
    memcpy(to->colour + W * band->first_row, band->colour, 2u * W * band->height);
    memcpy(to->depth + W * band->first_row, band->depth, 2u * W * band->height);
}

static ew_picture picture_of(int rows, image *to)
{
    return (ew_picture){ .width = W, .height = H, .buffers = 1, .rows = (uint16_t)rows, .end_row = H, .scissor = { 0, 0, W, H },
                         .band = take_band, .user = to };
}

/* Draws the first `triangles`, into memory that ends where it was said to. */
static int draw(int rows, int triangles, size_t bytes, image *to, ew_picture_counts *counts)
{
    const ew_picture picture = picture_of(rows, to);
    ew_raster raster;
    ew_geometry geometry;
    uint8_t *memory = malloc(bytes);
    if (!memory) abort();
    crowd.object.mesh.index_count = 3u * (uint32_t)triangles;
    ew_geometry_init(&geometry, &raster);
    measure_pause(1);
    const int error = ew_picture_draw(&picture, &crowd.object, 1, &geometry, memory, bytes, counts);
    measure_pause(0);
    free(memory);
    return error;
}

/* Line by line in so many bytes. *more: set-ups beyond the first for each triangle. */
static int draw_lines(int triangles, size_t bytes, const image *whole, double *more)
{
    static image lines;
    ew_picture_counts counts;
    const int error = draw(1, triangles, bytes, &lines, &counts);
    *more = error ? 0 : counts.again / (double)triangles;
    if (!error && memcmp(&lines, whole, sizeof lines) != 0) {
        fprintf(stderr, "stability: %d triangles line by line in %zu bytes: another picture\n", triangles, bytes);
        abort();
    }
    return error;
}

static size_t bytes_for(int rows, int triangles, int active)
{
    const ew_picture picture = picture_of(rows, NULL);
    crowd.object.mesh.index_count = 3u * (uint32_t)triangles;
    return ew_picture_bytes(&picture, &crowd.object, 1, (uint32_t)active);
}

static void draw_whole(int triangles, image *to)
{
    ew_picture_counts counts;
    if (draw(H, triangles, bytes_for(H, triangles, 0), to, &counts)) abort();
}

/* Triangles that are active on every row, with the memory that ew_picture_bytes says for a smaller number of them:
 * 112 bytes for each and 408, of which each takes 144. Beyond, those that found no room are set up for every row. */
static void active_triangles(void)
{
    static const int rooms[] = { 16, 64, 256 };
    static image whole;
    for (int r = 0; r < 3; r++) {
        char name[32];
        snprintf(name, sizeof name, "room for %d", rooms[r]);
        for (double x = 4; x <= MOST; x *= 1.189207115002721) {
            const int n = (int)x;
            double more;
            draw_whole(n, &whole);
            if (draw_lines(n, bytes_for(1, n, rooms[r]), &whole, &more)) abort();
            walk_row("line_active_triangles", name, n, more, 0, 0, (408 + 112 * rooms[r]) / (double)KEPT_BYTES, more > 0 ? "degraded" : "ok");
        }
    }
}

/* Bytes for 200 active triangles, down to less than the least: set up once down to 144 bytes for each, drawn down
 * to ew_picture_least. */
static void line_memory(void)
{
    enum { ACTIVE = 200 };
    static image whole;
    const ew_picture lines = picture_of(1, NULL);
    crowd.object.mesh.index_count = 3 * ACTIVE;
    const double least = (double)ew_picture_least(&lines, &crowd.object, 1);
    draw_whole(ACTIVE, &whole);
    for (int picture = 0; picture < 2; picture++) {
        for (double bytes = 48 * least; bytes > 0.5 * least; bytes /= 1.0905077326652577) {
            double more;
            const int error = draw_lines(ACTIVE, (size_t)bytes, &whole, &more);
            walk_row("line_memory_bytes", picture ? "drawn at all" : "set up once", (double)(size_t)bytes, more, 0, 0,
                     picture ? least : least + ACTIVE * KEPT_BYTES, error ? "refused" : more > 0 && !picture ? "degraded" : "ok");
        }
    }
}

void memory_axes(void)
{
    if (crowd_init()) abort();
    active_triangles();
    line_memory();
}
