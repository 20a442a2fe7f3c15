/* Any bits at all through the public functions of the raster and geometry layers: an error
 * code or a drawing, nothing written outside of the target. Built with the sanitizers, which
 * watch what is read too: every block of memory that a structure points at is exactly as
 * large as the structure says.
 *
 * Structures are filled as bytes, so that fields that are added later are filled too. Only
 * pointers, and promises that no function checks, are mended afterwards.
 */
#include "../property/cases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    uint8_t *colour, *depth, *texels;
    size_t texel_bytes;
    ew_target target;
    ew_rect scissor;
    ew_raster raster;
} now;

static size_t target_elements(const ew_target *t)
{
    return t->height ? (size_t)t->stride * (t->height - 1u) + t->width : 0;
}

/* Nothing beside the rows of the target was written. */
static void check_borders(void)
{
    const ew_target *t = &now.target;
    for (uint32_t y = 0; y + 1 < t->height; y++) {
        for (uint32_t x = t->width; x < t->stride; x++) {
            for (uint32_t k = 0; k < 2; k++) {
                size_t at = 2 * ((size_t)y * t->stride + x) + k;
                assert_int_equal(now.colour[at], MARK);
                if (now.depth) assert_int_equal(now.depth[at], MARK);
            }
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

/* Bytes of the texels that a texture describes. */
static size_t texture_bytes(const ew_texture *t) { return (size_t)t->width * t->height * 2; }

/* Remembers the colours, and holds those outside of the scissor to it. */
static uint16_t before[MOST_PIXELS];

static void remember_colours(void) { memcpy(before, now.colour, 2 * target_elements(&now.target)); }

static void check_scissor(void)
{
    const ew_target *t = &now.target;
    const ew_rect *r = &now.scissor;
    for (int y = 0; y < t->height; y++) {
        for (int x = 0; x < t->width; x++) {
            if (x >= r->x0 && x < r->x1 && y >= r->y0 && y < r->y1) continue;
            assert_int_equal(t->colour[(size_t)y * t->stride + (size_t)x], before[(size_t)y * t->stride + (size_t)x]);
        }
    }
}

/* ---- the calls ---- */

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
    spoil(&t, sizeof t);
    int with_depth = pick(4) != 0;
    size_t elements = target_elements(&t);
    if (elements > MOST_PIXELS) { /* large ones are asked about, but not drawn to */
        static uint16_t somewhere[1];
        ew_raster other;
        t.colour = somewhere, t.depth = NULL;
        int error = ew_raster_init(&other, &t);
        assert_true(error == EW_OK || error == EW_ERR_ARGUMENT);
        return;
    }
    uint8_t *colour = block_of(2 * elements), *depth = with_depth ? block_of(2 * elements) : NULL;
    t.colour = pick(50) ? (uint16_t *)(void *)colour : NULL, t.depth = (uint16_t *)(void *)depth;
    ew_raster made;
    memset(&made, MARK, sizeof made);
    int error = ew_raster_init(&made, &t);
    assert_true(error == EW_OK || error == EW_ERR_ARGUMENT);
    if (error) {
        free(colour);
        free(depth);
        return;
    }
    forget_target();
    now.colour = colour, now.depth = depth;
    now.target = t;
    now.raster = made;
    now.scissor = (ew_rect){ 0, 0, t.width, t.height };
}

static void new_scissor(void)
{
    ew_rect r = { 0, 0, now.target.width, now.target.height };
    if (pick(4) == 0) {
        r.x0 = (uint16_t)pick(r.x1 + 1u), r.y0 = (uint16_t)pick(r.y1 + 1u);
        r.x1 = (uint16_t)(r.x0 + pick(r.x1 + 1u - r.x0)), r.y1 = (uint16_t)(r.y0 + pick(r.y1 + 1u - r.y0));
    }
    spoil(&r, sizeof r);
    int error = ew_raster_set_scissor(&now.raster, &r);
    assert_true(error == EW_OK || error == EW_ERR_ARGUMENT);
    if (!error) now.scissor = r;
}

static void new_material(void)
{
    ew_texture texture;
    ew_material m;
    memset(&texture, 0, sizeof texture);
    memset(&m, 0, sizeof m);
    texture.width = (uint16_t)(1u << pick(pick(200) ? 6 : 12));
    texture.height = (uint16_t)(1u << pick(pick(200) ? 6 : 12));
    spoil(&texture, sizeof texture);
    if (texture_bytes(&texture) > 1 << 16 && pick(32)) texture.width = 1; /* large ones take time */
    m.tolerance = (uint16_t)(pick(2) ? 0 : pick(EW_TOLERANCE_MAX + 1));
    m.rung = (uint8_t)pick(EW_RUNG_COUNT);
    m.flags = (uint8_t)(pick(8) | (pick(2) ? EW_DOUBLE_SIDED : 0));
    spoil(&m, sizeof m);
    size_t bytes = texture_bytes(&texture);
    uint8_t *texels = bytes <= 2u * EW_TEXTURE_MAX * EW_TEXTURE_MAX ? block_of(bytes) : block_of(1);
    texture.texels = pick(50) ? texels : NULL;
    m.texture = pick(4) ? &texture : NULL;
    int error = ew_raster_set_material(&now.raster, &m);
    assert_true(error == EW_OK || error == EW_ERR_ARGUMENT);
    if (error) {
        free(texels);
        return;
    }
    free(now.texels);
    now.texels = texels;
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

static void any_bits(void **state)
{
    (void)state;
    enum { CALLS = 50 }; /* of each context */
    long calls = 0, drawn = 0;
    for (cases c = cases_of("any bits", 300000 / CALLS, 10000000 / CALLS); cases_next(&c);) {
        test_context("EW_CASE=%ld", c.number);
        do new_target();
        while (!now.colour);
        for (int k = 0; k < CALLS; k++, calls++) {
            uint32_t which = pick(16), watched = which > 3 && pick(16) == 0;
            if (watched) remember_colours();
            switch (which) {
            case 0: new_target(); break;
            case 1: new_scissor(); break;
            case 2:
            case 3: new_material(); break;
            case 4: ew_raster_clear(&now.raster, (uint16_t)test_random()); break;
            case 5:
            case 6:
            case 7: drawn += draw_mesh(); break;
            default: drawn += draw_triangle(); break;
            }
            if (watched) check_scissor();
        }
        forget_target();
        free(now.texels);
        now.texels = NULL;
    }
    assert_true(drawn > calls / 8 || cases_alone()); /* much is refused, but not all */
    cases_figure("any bits", "calls", calls, drawn, 0, NAN, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = { TEST(any_bits) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
