/* Any bits at all through the public functions of the raster, 2D and geometry layers: an error
 * code or a drawing, nothing written outside of the target. Built with the sanitizers, which
 * watch what is read too: every block of memory that a structure points at is exactly as
 * large as the structure says.
 *
 * Structures are filled as bytes, so that fields that are added later are filled too. Only
 * pointers, and promises that no function checks, are mended afterwards.
 */
#include "../property/cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "edgewalk/draw2d.h"
#include "edgewalk/geometry.h"
#include "edgewalk/light.h"

enum { MOST_PIXELS = 1 << 16, MARK = 0xA5 };

/* ---- bytes ---- */

static void fill(void *structure, size_t size)
{
    for (size_t i = 0; i < size; i++) ((uint8_t *)structure)[i] = (uint8_t)test_random();
}

/* Leaves a structure as it is, spoils some of its bytes, or all. Small numbers are frequent:
 * they are what enumerations accept. */
static void spoil(void *structure, size_t size)
{
    uint8_t *bytes = structure;
    uint32_t how = pick(8), count = how < 3 ? 0 : how < 7 ? 1 + pick(3) : (uint32_t)size;
    for (uint32_t i = 0; i < count; i++) {
        size_t at = how == 7 ? i : pick((uint32_t)size);
        bytes[at] = (uint8_t)(pick(2) ? test_random() : pick(12));
    }
}

/* ---- memory that ends where it should ---- */

static uint8_t *block_of(size_t bytes)
{
    uint8_t *block = malloc(bytes ? bytes : 1);
    if (!block) abort();
    memset(block, MARK, bytes);
    return block;
}

/* The target at hand; its memory is NULL before there is one. */
static struct {
    uint8_t *colour, *depth;
    uint8_t *texture[3]; /* texels, palette, mask */
    ew_target target;
    ew_rect scissor;
    ew_raster raster;
} now;

static uint32_t pixel_bits(const ew_target *t)
{
    static const uint8_t bits[] = { 16, 16, 8, 8, 4, 1 }; /* by ew_target_format */
    return t->format < sizeof bits ? bits[t->format] : 16;
}

static size_t target_elements(const ew_target *t)
{
    return t->height ? (size_t)t->stride * (t->height - 1u) + t->width : 0;
}

static size_t target_bytes(const ew_target *t) { return (target_elements(t) * pixel_bits(t) + 7) / 8; }

/* The bits of a pixel, left ones high, as they lie in memory. */
static uint32_t pixel_at(const uint8_t *colour, size_t index)
{
    uint32_t bits = pixel_bits(&now.target);
    if (bits >= 8) return bits == 8 ? colour[index] : (uint32_t)colour[2 * index] << 8 | colour[2 * index + 1];
    size_t at = index * bits;
    return (uint32_t)(colour[at / 8] >> (8 - bits - at % 8)) & ((1u << bits) - 1u);
}

/* Nothing beside the rows of the target was written: what lies between them is as it was. */
static void check_borders(void)
{
    static const uint8_t mark[4] = { MARK, MARK, MARK, MARK };
    const ew_target *t = &now.target;
    for (uint32_t y = 0; y + 1 < t->height; y++) {
        for (uint32_t x = t->width; x < t->stride; x++) {
            size_t at = (size_t)y * t->stride + x;
            uint32_t in_mark = pixel_bits(t) >= 8 ? 0 : (uint32_t)(at * pixel_bits(t) % 8 / pixel_bits(t));
            assert_int_equal(pixel_at(now.colour, at), pixel_at(mark, in_mark));
            if (now.depth) assert_true(now.depth[2 * at] == MARK && now.depth[2 * at + 1] == MARK);
        }
    }
}

static void forget_target(void)
{
    if (now.colour) check_borders();
    free(now.colour);
    free(now.depth);
    now.colour = now.depth = NULL;
}

/* Bytes of all levels of a texture whose rows begin with a new byte. */
static size_t texture_bytes(const ew_texture *t, uint32_t bits)
{
    size_t bytes = 0, width = t->width, height = t->height;
    for (int level = 0; level < (t->levels ? t->levels : 1) && level < EW_LEVELS_MAX; level++) {
        bytes += (width * bits + 7) / 8 * height;
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    }
    return bytes;
}

static uint32_t texel_bits(const ew_texture *t)
{
    static const uint8_t bits[] = { 16, 8, 8, 8, 4, 1 }; /* by ew_texture_format */
    return t->format < sizeof bits ? bits[t->format] : 16;
}

/* Remembers the colours, and holds those outside of the scissor to it. */
static uint8_t before[2 * MOST_PIXELS];

static void remember_colours(void) { memcpy(before, now.colour, target_bytes(&now.target)); }

static void check_scissor(void)
{
    const ew_target *t = &now.target;
    const ew_rect *r = &now.scissor;
    for (int y = 0; y < t->height; y++) {
        for (int x = 0; x < t->width; x++) {
            const int row = y + t->first_row;
            if (x >= r->x0 && x < r->x1 && row >= r->y0 && row < r->y1) continue;
            size_t at = (size_t)y * t->stride + (size_t)x;
            assert_int_equal(pixel_at(now.colour, at), pixel_at(before, at));
        }
    }
}

/* ---- the calls ---- */

/* What a function that sets something up may say. */
static int is_answer(int error)
{
    return error == EW_OK || error == EW_ERR_ARGUMENT || error == EW_ERR_UNSUPPORTED;
}

static void new_target(void)
{
    ew_target t;
    memset(&t, 0, sizeof t);
    t.width = (uint16_t)(1 + pick(pick(8) ? 64 : 4096)), t.height = (uint16_t)(1 + pick(t.width > 64 ? 8 : 64));
    if (pick(8) == 0) {
        uint16_t swap = t.width;
        t.width = t.height, t.height = swap;
    }
    t.stride = (uint16_t)(t.width + pick(9));
    if (pick(4)) t.format = (uint8_t)pick(6), t.dither = (uint8_t)pick(2);
    if (pick(4) == 0) t.first_row = (uint16_t)pick(40);
    if (t.format >= EW_TARGET_GREY4) t.stride = (uint16_t)((t.stride + 7) & ~7);
    spoil(&t, sizeof t);
    int with_depth = pick(4) != 0;
    size_t elements = target_elements(&t);
    if (elements > MOST_PIXELS) { /* large ones are asked about, but not drawn to */
        static uint16_t somewhere[1];
        ew_raster other;
        t.colour = somewhere, t.depth = NULL;
        assert_true(is_answer(ew_raster_init(&other, &t)));
        return;
    }
    uint8_t *colour = block_of(target_bytes(&t)), *depth = with_depth ? block_of(2 * elements) : NULL;
    t.colour = pick(50) ? colour : NULL, t.depth = (uint16_t *)(void *)depth;
    ew_raster made;
    memset(&made, MARK, sizeof made);
    int error = ew_raster_init(&made, &t);
    assert_true(is_answer(error));
    if (error) {
        free(colour);
        free(depth);
        return;
    }
    forget_target();
    now.colour = colour, now.depth = depth;
    now.target = t;
    now.raster = made;
    now.scissor = (ew_rect){ 0, t.first_row, t.width, (uint16_t)(t.first_row + t.height) };
}

static void new_scissor(void)
{
    const uint16_t first = now.target.first_row;
    ew_rect r = { 0, first, now.target.width, (uint16_t)(first + now.target.height) };
    if (pick(4) == 0) {
        r.x0 = (uint16_t)pick(r.x1 + 1u), r.y0 = (uint16_t)(first + pick(now.target.height + 1u));
        r.x1 = (uint16_t)(r.x0 + pick(r.x1 + 1u - r.x0)), r.y1 = (uint16_t)(r.y0 + pick(r.y1 + 1u - r.y0));
    }
    spoil(&r, sizeof r);
    int error = ew_raster_set_scissor(&now.raster, &r);
    assert_true(error == EW_OK || error == EW_ERR_ARGUMENT);
    if (!error) now.scissor = r;
}

static void any_texture(ew_texture *t)
{
    uint32_t log2_most = pick(200) ? 6 : 12, powers = pick(3);
    memset(t, 0, sizeof *t);
    t->width = (uint16_t)(powers ? 1u << pick(log2_most) : 1 + pick(1u << log2_most));
    t->height = (uint16_t)(powers ? 1u << pick(log2_most) : 1 + pick(1u << log2_most));
    t->format = (uint8_t)(pick(2) ? 0 : pick(6));
    t->wrap_u = (uint8_t)(pick(2) ? 0 : pick(3)), t->wrap_v = (uint8_t)(pick(2) ? 0 : pick(3));
    t->levels = (uint8_t)(pick(2) ? 0 : pick(8));
    t->key = (uint16_t)pick(256);
    spoil(t, sizeof *t);
    if (texture_bytes(t, 16) > 1 << 16 && pick(32)) t->width = 1; /* large ones take time */
}

/* Memory as large as a texture says: texels, palette, mask, each of them missing now and then. */
static void give_memory(ew_texture *t, uint8_t *made[3])
{
    /* sizes that a texture cannot have are not worth their memory: they have to be refused */
    int possible = t->width <= EW_TEXTURE_MAX && t->height <= EW_TEXTURE_MAX;
    size_t entries = (size_t)1 << (texel_bits(t) <= 8 ? texel_bits(t) : 0);
    made[0] = block_of(possible ? texture_bytes(t, texel_bits(t)) : 1);
    made[1] = block_of(2 * entries);
    made[2] = block_of(possible ? texture_bytes(t, 1) : 1);
    fill(made[0], possible ? texture_bytes(t, texel_bits(t)) % 4096 : 1);
    t->texels = pick(50) ? made[0] : NULL;
    t->palette = pick(50) ? (const uint16_t *)(const void *)made[1] : NULL;
    t->mask = pick(50) ? made[2] : NULL;
}

static void new_material(void)
{
    ew_texture t;
    ew_material m;
    uint8_t *made[3];
    any_texture(&t);
    memset(&m, 0, sizeof m);
    m.tolerance = (uint16_t)(pick(2) ? 0 : pick(EW_TOLERANCE_MAX + 1));
    m.rung = (uint8_t)pick(EW_RUNG_COUNT);
    m.flags = (uint8_t)((pick(2) ? pick(8) : pick(128)) | (pick(2) ? EW_DOUBLE_SIDED : 0));
    m.blend = (uint8_t)(pick(2) ? 0 : pick(3)), m.filter = (uint8_t)(pick(2) ? 0 : pick(3));
    m.colour = (uint16_t)test_random();
    spoil(&m, sizeof m);
    give_memory(&t, made);
    m.texture = pick(4) ? &t : NULL;
    int error = ew_raster_set_material(&now.raster, &m);
    assert_true(is_answer(error));
    for (int i = 0; i < 3; i++) {
        uint8_t *unused = error ? made[i] : now.texture[i];
        if (!error) now.texture[i] = made[i];
        free(unused);
    }
}

static void new_fog(void)
{
    uint32_t near_w = pick(2) ? test_random() : test_random() >> pick(32), far_w = pick(2) ? test_random() : pick(1u << 20);
    assert_true(is_answer(ew_raster_set_fog(&now.raster, (uint16_t)test_random(), near_w, far_w)));
}

static int32_t any_position(int size)
{
    switch (pick(32)) {
    case 0: return (int32_t)test_random();
    case 1: return test_awkward();
    default: return (int32_t)(pick((uint32_t)(size + 20) * 4096)) - 10 * 4096;
    }
}

static long draw_triangle(void)
{
    ew_raster_vertex v[3];
    memset(v, 0, sizeof v);
    for (int i = 0; i < 3; i++) {
        v[i].x = any_position(now.target.width), v[i].y = any_position(now.target.height);
        v[i].w = pick(32) ? 1 + (test_random() >> 1 >> pick(31)) : (uint32_t)test_awkward();
        v[i].u = test_awkward() >> pick(16), v[i].v = test_awkward() >> pick(16);
    }
    if (pick(2)) spoil(v, sizeof v);
    int result = ew_raster_triangle(&now.raster, &v[0], &v[1], &v[2]);
    assert_true(result == 0 || result == 1 || result == EW_ERR_RANGE);
    return result > 0;
}

/* ---- the 2D layer ---- */

static int16_t any_pixel(int size) { return (int16_t)(pick(4) ? (int)pick((uint32_t)size + 40) - 20 : (int)pick(65536)); }

static int draw_sprite(int16_t x, int16_t y)
{
    ew_texture t;
    ew_sprite s;
    uint8_t *made[3];
    any_texture(&t);
    t.levels = 1;
    memset(&s, 0, sizeof s);
    s.flags = (uint8_t)(pick(2) ? pick(128) : 16 * pick(4)), s.blend = (uint8_t)pick(4);
    if (pick(2)) s.part.x1 = t.width, s.part.y1 = (uint16_t)pick(t.height + 1u), s.part.x0 = (uint16_t)pick(t.width + 1u);
    spoil(&s.part, sizeof s.part);
    give_memory(&t, made);
    s.texture = pick(50) ? &t : NULL;
    int error = ew_draw_sprite(&now.raster, &s, x, y);
    for (int i = 0; i < 3; i++) free(made[i]);
    return error;
}

static int draw_text(int16_t x, int16_t y)
{
    ew_font f;
    memset(&f, 0, sizeof f);
    f.width = (uint8_t)(1 + pick(12)), f.height = (uint8_t)(1 + pick(12)), f.gap = 1, f.line = f.height;
    f.first = (uint8_t)pick(256), f.last = (uint8_t)pick(256), f.unknown = (uint8_t)pick(256);
    if (pick(2)) f.first = 32, f.last = 126, f.unknown = 63;
    spoil(&f, sizeof f);
    size_t bytes = f.first <= f.last ? (f.last - f.first + 1u) * (1u + f.height * ((f.width + 7u) / 8u)) : 0;
    uint8_t *glyphs = block_of(bytes);
    char *text = (char *)block_of(21);
    fill(glyphs, bytes), fill(text, 20);
    text[20] = 0;
    f.glyphs = pick(50) ? glyphs : NULL;
    int error = ew_draw_text(&now.raster, &f, x, y, text, (uint16_t)test_random());
    int32_t width = ew_text_width(&f, text);
    assert_true(error ? width == error : width >= 0);
    free(glyphs), free(text);
    return error;
}

static void draw_2d(void)
{
    const int16_t x = any_pixel(now.target.width), y = any_pixel(now.target.height);
    const uint16_t colour = (uint16_t)test_random();
    int error = EW_OK;
    switch (pick(4)) {
    case 0: error = ew_draw_rect(&now.raster, x, y, (uint16_t)any_pixel(100), (uint16_t)any_pixel(100), colour, (uint8_t)pick(4)); break;
    case 1: ew_draw_line(&now.raster, x, y, any_pixel(now.target.width), any_pixel(now.target.height), colour); break;
    case 2: error = draw_sprite(x, y); break;
    default: error = draw_text(x, y); break;
    }
    assert_true(is_answer(error));
}

/* ---- the geometry layer ---- */

static void any_row(ew_row *row)
{
    memset(row, 0, sizeof *row);
    for (int k = 0; k < 4; k++) row->m[k] = (int32_t)(test_random() >> 1) - (1 << 30); /* |m| <= 2^30 is promised */
    row->e = (int16_t)(pick(4) ? (int)pick(40) - 20 : (int)pick(2001) - 1000);
    row->e_last = (int16_t)(pick(4) ? row->e + (int)pick(9) - 4 : (int)pick(2001) - 1000);
}

/* Any lights, any normals. */
static void light(ew_colour888 *colours, uint32_t count)
{
    enum { VERTICES = 8 };
    ew_lighting lighting;
    ew_light lights[EW_LIGHTS_MAX];
    ew_normal8 normals[VERTICES];
    ew_colour888 ambient, material;
    ew_mat34 matrix;
    for (int i = 0; i < 3; i++) any_row(&matrix.row[i]);
    fill(lights, sizeof lights), fill(normals, sizeof normals), fill(&ambient, sizeof ambient);
    fill(&material, sizeof material), fill(colours, count * sizeof *colours);
    int error = ew_lighting_set(&lighting, &matrix, ambient, lights, pick(EW_LIGHTS_MAX + 2), material, (int)pick(2));
    assert_true(error == EW_OK || error == EW_ERR_ARGUMENT);
    if (!error) ew_light_vertices(&lighting, normals, pick(2) ? colours : NULL, count, colours);
}

static long draw_mesh(void)
{
    enum { VERTICES = 6, INDICES = 12 };
    ew_geometry geometry;
    ew_vertex16 v[VERTICES];
    ew_screen_vertex screen[VERTICES];
    uint16_t indices[INDICES];
    ew_colour888 colours[VERTICES];
    ew_projection projection;
    ew_viewport viewport = { 0, 0, now.target.width, now.target.height };
    ew_mat34 model_view;
    memset(&projection, 0, sizeof projection);
    projection.focal_x = (int32_t)(1 + pick(1 << 18)), projection.focal_y = (int32_t)(1 + pick(1 << 18));
    projection.near_z.m = 1 << 29, projection.near_z.e = (int16_t)((int)pick(8) - 6);
    if (pick(4) == 0) spoil(&projection, sizeof projection);
    if (pick(4) == 0) spoil(&viewport, sizeof viewport);
    int before_the_eye = pick(3) != 0, scale = (int)pick(6);
    for (int i = 0; i < 3; i++) {
        if (!before_the_eye) any_row(&model_view.row[i]);
        else ew_row_from_q16_16(&model_view.row[i], i == 0 ? 65536 << scale >> 2 : (int32_t)pick(4096),
                                i == 1 ? 65536 : 0, i == 2 ? 65536 : 0, i == 2 ? -(int32_t)pick(1 << 18) : 0);
    }
    fill(v, sizeof v);
    for (int i = 0; i < INDICES; i++) indices[i] = (uint16_t)pick(VERTICES);
    memset(&geometry, MARK, sizeof geometry);
    ew_geometry_init(&geometry, &now.raster);
    int error = ew_transform_set(&geometry.transform, &projection, &model_view, &viewport);
    assert_true(error == EW_OK || error == EW_ERR_ARGUMENT || error == EW_ERR_RANGE);
    if (error) return 0;
    ew_transform_vertices(&geometry.transform, v, VERTICES, screen);
    const ew_mesh mesh = { .vertices = v, .screen = screen, .colours = pick(2) ? colours : NULL, .indices = indices,
                           .index_count = INDICES, .uv_fraction_bits = (uint8_t)pick(13) };
    light(colours, VERTICES);
    int32_t result = ew_draw_triangles(&geometry, &mesh);
    assert_true((result >= 0 && result <= INDICES / 3) || result == EW_ERR_RANGE);
    return result > 0 ? result : 0;
}

/* ---- the whole ---- */

static long *case_at_hand; /* shared with the parent, which outlives what the sanitizers end */

static void any_bits(void **state)
{
    (void)state;
    enum { CALLS = 50 }; /* of each context */
    long calls = 0, drawn = 0;
    for (cases c = cases_of("any bits", 300000 / CALLS, 10000000 / CALLS); cases_next(&c);) {
        test_context("EW_CASE=%ld", c.number);
        *case_at_hand = c.number;
        do new_target();
        while (!now.colour);
        for (int k = 0; k < CALLS; k++, calls++) {
            uint32_t which = pick(17), watched = which > 3 && pick(16) == 0;
            if (watched) remember_colours();
            switch (which) {
            case 0: new_target(); break;
            case 1: new_scissor(); break;
            case 2:
            case 3: new_material(); break;
            case 4:
                if (pick(2)) ew_raster_clear(&now.raster, (uint16_t)test_random());
                else new_fog();
                break;
            case 5:
            case 6:
            case 7: drawn += draw_mesh(); break;
            case 8: draw_2d(); break;
            default: drawn += draw_triangle(); break;
            }
            if (watched) check_scissor();
        }
        forget_target();
        for (int i = 0; i < 3; i++) {
            free(now.texture[i]);
            now.texture[i] = NULL;
        }
    }
    assert_true(drawn > calls / 8 || cases_alone()); /* much is refused, but not all */
    cases_figure("any bits", "calls", calls, drawn, 0, NAN, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(any_bits) };
    int status;
    case_at_hand = mmap(NULL, sizeof *case_at_hand, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (case_at_hand == MAP_FAILED) abort();
    pid_t child = fork();
    if (child == 0) return cmocka_run_group_tests(tests, NULL, NULL);
    if (child < 0 || waitpid(child, &status, 0) != child) abort();
    if (status) printf("# ended at EW_CASE=%ld\n", *case_at_hand);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}
