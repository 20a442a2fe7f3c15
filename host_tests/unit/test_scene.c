/* The baked scene reader: what it accepts, what it refuses, how it moves and draws. The
 * scene is written here by hand from docs/scene-format.md. */
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "edgewalk/scene.h"

enum { ROOM = 2048, W = 48, H = 32 };

typedef struct writer {
    uint8_t bytes[ROOM];
    uint32_t size, entry;
} writer;

static void put(writer *w, uint32_t at, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++) w->bytes[at + (uint32_t)i] = (uint8_t)(value >> 8 * i);
}
static void add(writer *w, uint32_t value, int bytes)
{
    put(w, w->size, value, bytes);
    w->size += (uint32_t)bytes;
}
static void add_row(writer *w, int32_t a, int32_t b, int32_t c, int32_t d, int e)
{
    add(w, (uint32_t)a, 4), add(w, (uint32_t)b, 4), add(w, (uint32_t)c, 4), add(w, (uint32_t)d, 4);
    add(w, (uint32_t)e, 2), add(w, (uint32_t)e, 2);
}
static void add_identity(writer *w)
{
    const int32_t one = 1 << 29; /* with e = 1 */
    add_row(w, one, 0, 0, 0, 1), add_row(w, 0, one, 0, 0, 1), add_row(w, 0, 0, one, 0, 1);
}
static void section(writer *w, const char *tag, uint32_t count, uint32_t each)
{
    while (w->size % 4) add(w, 0, 1);
    memcpy(w->bytes + w->entry, tag, 4);
    put(w, w->entry + 4, w->size, 4), put(w, w->entry + 8, count, 4), put(w, w->entry + 12, each, 4);
    w->entry += 16;
}

/* The plain bitwise form of the format page's CRC-32. */
static uint32_t crc32_of(const uint8_t *p, uint32_t size)
{
    uint32_t crc = 0xFFFFFFFFu;
    for (uint32_t i = 0; i < size; i++) {
        crc ^= i >= 12 && i < 16 ? 0u : p[i];
        for (int k = 0; k < 8; k++) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    }
    return ~crc;
}
static void seal(writer *w) { put(w, 12, crc32_of(w->bytes, w->size), 4); }

static uint32_t offset_of(const writer *w, const char *tag)
{
    for (uint32_t at = 32; at < w->entry; at += 16) {
        if (memcmp(w->bytes + at, tag, 4) == 0) return w->bytes[at + 4] | (uint32_t)w->bytes[at + 5] << 8;
    }
    abort();
}

enum { SECTIONS = 13 };

/* Two nodes: a still textured triangle three units away, and a child that moves and has a
 * flat one; and a section that a reader may ignore. */
static void write_scene(writer *w)
{
    const int32_t one = 1 << 29;
    memset(w, 0, sizeof *w);
    memcpy(w->bytes, "EWB\x1A", 4);
    put(w, 4, 1, 2), put(w, 6, 32, 2), put(w, 16, SECTIONS, 2);
    w->entry = 32;
    w->size = 32 + 16 * SECTIONS;
    section(w, "CAMR", 1, 72);
    add_identity(w);
    add(w, 65536, 4), add(w, (uint32_t)one, 4), add(w, (uint32_t)-1, 2), add(w, 0, 2); /* near 1/4 */
    section(w, "BOUN", 1, 20);
    add_row(w, 0, 0, -3 * (one / 4), one, 2);
    section(w, "NODE", 2, 68);
    add(w, 0xFFFF, 2), add(w, 0xFFFF, 2), add(w, 0, 2), add(w, 1, 2);
    add_identity(w);
    add(w, 0, 2), add(w, 0, 2), add(w, 1, 2), add(w, 1, 2);
    add_identity(w);
    section(w, "PRIM", 2, 40);
    for (uint32_t k = 0; k < 2; k++) {
        add(w, 3 * k, 4), add(w, 3, 2), add(w, k, 2), add(w, 3 * k, 4), add(w, 3, 4);
        add_row(w, 0, 0, -3 * (one / 2), one, 2); /* 3 units away, 2 units wide each way */
        add(w, 4, 1), add(w, 0, 3);
    }
    section(w, "VERT", 6, 10);
    const int16_t v[6][5] = { { -30000, -20000, 0, 0, 0 }, { 30000, -20000, 0, 512, 0 }, { 0, 20000, 0, 256, 512 },
                              { -3000, -3000, 3000, 0, 0 }, { 3000, -3000, 3000, 0, 0 }, { 0, 3000, 3000, 0, 0 } };
    for (int i = 0; i < 30; i++) add(w, (uint16_t)v[i / 5][i % 5], 2);
    section(w, "INDX", 6, 2);
    for (uint32_t i = 0; i < 6; i++) add(w, i % 3, 2);
    section(w, "MATL", 2, 8);
    add(w, 0xFFFF, 2), add(w, 0, 2), add(w, 0, 2), add(w, 4, 2);
    add(w, 0xF81F, 2), add(w, 0xFFFF, 2), add(w, 1, 2), add(w, 0, 2);
    section(w, "TEXR", 1, 8);
    add(w, 0, 4), add(w, 2, 1), add(w, 1, 1), add(w, 0, 2);
    section(w, "TEXL", 8, 2);
    for (uint32_t i = 0; i < 8; i++) add(w, 0x1111 * (i + 1), 2);
    section(w, "TRAK", 2, 12);
    add(w, 0, 4), add(w, 3, 2), add(w, 100, 2), add(w, 2, 2), add(w, 1, 2);
    add(w, 3, 4), add(w, 1, 2), add(w, 100, 2), add(w, 2, 2), add(w, 1, 2);
    section(w, "KEYS", 4, 32);
    for (int32_t k = 0; k < 4; k++) {
        add(w, (uint32_t)(k * one / 4), 4), add(w, 0, 4), add(w, (uint32_t)(k * one / 8), 4);
        const int16_t q[4][4] = { { 0, 0, 0, 16384 }, { 0, 0, 8192, 14189 }, { 0, 0, 14189, 8192 }, { 0, 0, 0, 16384 } };
        for (int i = 0; i < 4; i++) add(w, (uint16_t)q[k][i], 2);
        for (int i = 0; i < 3; i++) add(w, (uint32_t)one, 4);
    }
    section(w, "ANIM", 1, 4);
    add(w, 200, 4);
    section(w, "note", 1, 4);
    add(w, 0x12345678, 4);
    while (w->size % 4) add(w, 0, 1);
    put(w, 8, w->size, 4);
    seal(w);
}

/* In memory of exactly its size, so that the sanitizer sees a read past the end. */
static int open_exact(ew_scene *scene, const writer *w, uint32_t size, void **memory)
{
    *memory = malloc(size ? size : 1);
    assert_non_null(*memory);
    memcpy(*memory, w->bytes, size);
    return ew_scene_open(scene, *memory, size);
}

static int open_and_forget(const writer *w, uint32_t size)
{
    ew_scene scene;
    void *memory;
    int result = open_exact(&scene, w, size, &memory);
    free(memory);
    return result;
}

static void reads_what_was_written(void **state)
{
    (void)state;
    writer w;
    ew_scene s;
    void *memory;
    write_scene(&w);
    assert_int_equal(open_exact(&s, &w, w.size, &memory), EW_OK);
    assert_int_equal(s.duration_ms, 200);
    assert_int_equal(s.largest_primitive, 3);
    ew_scene_camera camera;
    ew_scene_get_camera(&s, &camera);
    assert_int_equal(camera.focal, 65536);
    assert_int_equal(camera.near_z.m, 1 << 29);
    assert_int_equal(camera.near_z.e, -1);
    ew_scene_node node;
    ew_scene_get_node(&s, 1, &node);
    assert_int_equal(node.parent, 0);
    assert_int_equal(node.track, 0);
    assert_int_equal(node.first_primitive, 1);
    ew_scene_primitive p;
    ew_scene_get_primitive(&s, 1, &p);
    assert_int_equal(p.vertices[1].x, 3000);
    assert_int_equal(p.indices[2], 2);
    assert_int_equal(p.uv_fraction_bits, 4);
    assert_int_equal(p.dequantise.row[2].m[3], -3 * (1 << 28));
    assert_int_equal(p.dequantise.row[2].m[2], 1 << 29);
    ew_material m;
    ew_texture t;
    ew_scene_get_material(&s, 0, &m, &t);
    assert_ptr_equal(m.texture, &t);
    assert_int_equal(((const uint16_t *)t.texels)[7], 0x8888);
    assert_int_equal(m.tolerance, 4);
    ew_scene_get_material(&s, 1, &m, &t);
    assert_null(m.texture);
    assert_int_equal(m.flags, EW_DOUBLE_SIDED);
    ew_row sphere;
    ew_scene_get_bounds(&s, &sphere);
    assert_int_equal(sphere.m[3], 1 << 29);
    free(memory);
}

static void every_changed_byte_is_refused(void **state)
{
    (void)state;
    writer w;
    write_scene(&w);
    for (uint32_t at = 0; at < w.size; at++) {
        uint8_t kept = w.bytes[at];
        for (int change = 1; change < 256; change++) {
            w.bytes[at] = (uint8_t)(kept ^ change);
            test_context("byte %u: %02x instead of %02x", at, w.bytes[at], kept);
            assert_true(open_and_forget(&w, w.size) < 0);
        }
        w.bytes[at] = kept;
    }
}

static void every_length_is_refused(void **state)
{
    (void)state;
    writer w;
    write_scene(&w);
    for (uint32_t size = 0; size < w.size; size++) {
        test_context("%u of %u bytes", size, w.size);
        assert_int_equal(open_and_forget(&w, size), EW_ERR_TRUNCATED);
    }
    add(&w, 0, 4);
    assert_int_equal(open_and_forget(&w, w.size), EW_ERR_CORRUPT); /* longer than it says */
}

static void codes_say_what_is_wrong(void **state)
{
    (void)state;
    writer w;
    write_scene(&w);
    w.bytes[0] = 'X';
    assert_int_equal(open_and_forget(&w, w.size), EW_ERR_MAGIC);
    write_scene(&w);
    put(&w, 4, 2, 2), seal(&w);
    assert_int_equal(open_and_forget(&w, w.size), EW_ERR_VERSION);
    write_scene(&w);
    w.bytes[100] ^= 1;
    assert_int_equal(open_and_forget(&w, w.size), EW_ERR_CHECKSUM);
    ew_scene s;
    uint32_t words[64] = { 0 };
    assert_int_equal(ew_scene_open(&s, (uint8_t *)words + 2, 64), EW_ERR_ARGUMENT);
}

/* Each rule of the format page broken on its own, under a right checksum. */
static void every_rule_is_checked(void **state)
{
    (void)state;
    const struct {
        const char *tag;
        uint32_t at, value;
        int bytes;
        const char *rule;
    } broken[] = {
        { "CAMR", 60, 0, 4, "focal ratio above 0" },
        { "CAMR", 60, 1024 * 65536 + 1, 4, "focal ratio up to 1024" },
        { "CAMR", 64, (1 << 29) - 1, 4, "near mantissa normalised" },
        { "CAMR", 68, 1001, 2, "near exponent" },
        { "CAMR", 16, 1001, 2, "view exponent" },
        { "CAMR", 0, (1u << 30) + 1, 4, "view mantissa" },
        { "CAMR", 18, 1001, 2, "view exponent of the fourth" },
        { "CAMR", 68, (uint32_t)-1001, 2, "near exponent, least" },
        { "CAMR", 70, 1, 2, "zero behind the near exponent" },
        { "NODE", 8 + 40 + 16, 1001, 2, "exponent of the third row" },
        { "TEXR", 5, 12, 1, "texture height" },
        { "TRAK", 10, 1001, 2, "exponent of the scales" },
        { "BOUN", 16, (uint32_t)-1001, 2, "bounds exponent" },
        { "NODE", 0, 0, 2, "parent below its node" },
        { "NODE", 68, 1, 2, "parent below its node, second" },
        { "NODE", 68, (uint32_t)-2, 2, "parent at least -1" },
        { "NODE", 70, 2, 2, "track number" },
        { "NODE", 70, (uint32_t)-2, 2, "track at least -1" },
        { "NODE", 4, 2, 2, "primitives inside" },
        { "NODE", 6, 3, 2, "number of primitives" },
        { "PRIM", 0, 4, 4, "vertices inside" },
        { "PRIM", 4, 0, 2, "a vertex at least" },
        { "PRIM", 4, 7, 2, "number of vertices" },
        { "PRIM", 6, 2, 2, "material number" },
        { "PRIM", 40 + 8, 4, 4, "indices inside" },
        { "PRIM", 8, 7, 4, "indices inside, first" },
        { "PRIM", 40 + 8, 2, 4, "indices of one primitive only" },
        { "PRIM", 12, 2, 4, "indices in threes" },
        { "PRIM", 12, 9, 4, "number of indices" },
        { "PRIM", 12, 0xFFFFFFFFu, 4, "number of indices, huge" },
        { "PRIM", 16, 0x80000000u, 4, "box mantissa" },
        { "PRIM", 36, 13, 1, "fraction bits" },
        { "PRIM", 36, 0, 1, "fraction bits, least" },
        { "PRIM", 37, 1, 1, "zero byte" },
        { "INDX", 4, 3, 2, "index below the vertices" },
        { "MATL", 2, 1, 2, "texture number" },
        { "MATL", 4, 2, 2, "flags" },
        { "MATL", 6, 257, 2, "tolerance" },
        { "TEXR", 0, 1, 4, "texels inside" },
        { "TEXR", 4, 12, 1, "texture width" },
        { "TEXR", 5, 2, 1, "texels inside, by height" },
        { "TEXR", 6, 1, 1, "texture format" },
        { "TRAK", 4, 0, 2, "a key at least" },
        { "TRAK", 12 + 4, 2, 2, "keys inside" },
        { "TRAK", 12, 2, 4, "keys of one track only" },
        { "TRAK", 6, 0, 2, "interval" },
        { "TRAK", 8, 1001, 2, "track exponent" },
        { "KEYS", 0, (1u << 30) + 1, 4, "translation mantissa" },
        { "KEYS", 18, 16000, 2, "quaternion's length" },
        { "KEYS", 32 + 16, (uint32_t)-8192, 2, "quaternion's length stays, still the short way" },
        { "KEYS", 32 + 18, (uint32_t)-14189, 2, "the short way from key to key" },
        { "KEYS", 20, (uint32_t)-(1 << 30) - 1, 4, "scale mantissa" },
        { "ANIM", 0, 0, 4, "duration" },
    };
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        writer w;
        write_scene(&w);
        put(&w, offset_of(&w, broken[i].tag) + broken[i].at, broken[i].value, broken[i].bytes);
        seal(&w);
        test_context("%s: %s", broken[i].tag, broken[i].rule);
        int allowed = strstr(broken[i].rule, "stays") != NULL;
        assert_int_equal(open_and_forget(&w, w.size), allowed ? EW_OK : EW_ERR_CORRUPT);
    }
    /* the directory */
    const struct {
        uint32_t at, value;
        int bytes;
    } directory[] = { { 16, 0, 2 }, { 16, 33, 2 }, { 32, 'X', 1 }, { 48, 'C', 1 }, { 36, 2, 4 }, { 36, 16, 4 },
                      { 36, 0xFFFFFFFCu, 4 }, { 36, 32, 4 }, { 100, 0x7FFFFFFFu, 4 }, { 40, 2, 4 }, { 40, 0, 4 }, { 40, 0xFFFFFFFFu, 4 }, { 44, 71, 4 },
                      { 44, 0, 4 }, { 6, 36, 2 }, { 18, 1, 1 }, { 31, 128, 1 } };
    for (size_t i = 0; i < sizeof directory / sizeof *directory; i++) {
        writer w;
        write_scene(&w);
        put(&w, directory[i].at, directory[i].value, directory[i].bytes);
        seal(&w);
        test_context("directory, byte %u", directory[i].at);
        assert_int_equal(open_and_forget(&w, w.size), EW_ERR_CORRUPT);
    }
    writer w;
    write_scene(&w);
    memcpy(w.bytes + 48, "CAMR", 4), put(&w, 60, 72, 4), seal(&w);
    assert_int_equal(open_and_forget(&w, w.size), EW_ERR_CORRUPT); /* a tag twice */
}

/* The processor's seconds to refuse a scene in which n records of `tag` all name the same
 * 3 n indices or n keys: the checks must not go through them n times. */
static double seconds_to_refuse(const char *tag, uint32_t n)
{
    const int tracks = strcmp(tag, "TRAK") == 0;
    const uint32_t each = tracks ? 12 : 40, items = tracks ? n : 3 * n, item = tracks ? 32 : 2;
    writer small;
    write_scene(&small);
    const uint32_t first = small.size, second = first + each * n, size = (second + item * items + 3) / 4 * 4;
    uint8_t *bytes = calloc(size, 1);
    assert_non_null(bytes);
    const uint32_t record = offset_of(&small, tag), named = offset_of(&small, tracks ? "KEYS" : "INDX");
    put(&small, 8, size, 4);
    put(&small, record + (tracks ? 0 : 8), 0, 4), put(&small, record + (tracks ? 4 : 12), items, tracks ? 2 : 4);
    for (uint32_t at = 32; at < small.entry; at += 16) {
        if (memcmp(small.bytes + at, tag, 4) == 0) put(&small, at + 4, first, 4), put(&small, at + 8, n, 4);
        if (memcmp(small.bytes + at, tracks ? "KEYS" : "INDX", 4) == 0) {
            put(&small, at + 4, second, 4), put(&small, at + 8, items, 4);
        }
    }
    memcpy(bytes, small.bytes, small.size);
    for (uint32_t i = 0; i < n; i++) memcpy(bytes + first + each * i, small.bytes + record, each);
    for (uint32_t i = 0; i < items; i++) memcpy(bytes + second + item * i, small.bytes + named, item);
    uint32_t crc = crc32_of(bytes, size);
    for (int i = 0; i < 4; i++) bytes[12 + i] = (uint8_t)(crc >> 8 * i);
    double best = 1e9;
    for (int again = 0; again < 5; again++) {
        ew_scene scene;
        clock_t start = clock();
        assert_int_equal(ew_scene_open(&scene, bytes, size), EW_ERR_CORRUPT);
        best = fmin(best, (double)(clock() - start) / CLOCKS_PER_SEC);
    }
    free(bytes);
    return best;
}

static void shared_ranges_take_no_square_of_time(void **state)
{
    (void)state;
    const char *const tags[] = { "PRIM", "TRAK" };
    for (int i = 0; i < 2; i++) {
        double few = seconds_to_refuse(tags[i], 4000), many = seconds_to_refuse(tags[i], 16000);
        test_context("%s: %.6f s, four times the size %.6f s", tags[i], few, many);
        assert_true(many < 8 * few);
    }
}

static uint16_t colour[W * H], depth[W * H];

static int32_t draw(const ew_scene *s, uint32_t time_ms)
{
    static ew_mat34 world[16];
    static ew_screen_vertex scratch[65536];
    static ew_geometry geometry;
    ew_raster raster;
    ew_scene_camera camera;
    const ew_target target = { .colour = colour, .depth = depth, .width = W, .height = H, .stride = W };
    const ew_viewport viewport = { 0, 0, W, H };
    if (s->section[EW_SECTION_NODE].count > 16) return 0;
    assert_int_equal(ew_raster_init(&raster, &target), EW_OK);
    ew_raster_clear(&raster, 0);
    ew_geometry_init(&geometry, &raster);
    ew_scene_get_camera(s, &camera);
    int error = ew_scene_pose(s, time_ms, world);
    if (error) return error;
    return ew_scene_draw(s, &camera, world, &viewport, &geometry, scratch);
}

/* Random damage under a right checksum: refused, or drawn without a fault. */
static void damaged_scenes_do_no_harm(void **state)
{
    (void)state;
    int accepted = 0;
    for (int n = 0; n < 60000; n++) {
        writer w;
        ew_scene s;
        void *memory;
        write_scene(&w);
        int changes = 1 + (int)(test_random() % 3);
        test_context("damage %d", n);
        for (int k = 0; k < changes; k++) {
            uint32_t at = test_random() % w.size;
            if (at >= 8 && at < 16) continue;
            w.bytes[at] = (uint8_t)(test_random() & 1 ? test_random() : w.bytes[at] ^ 1u << (test_random() & 7));
        }
        seal(&w);
        if (open_exact(&s, &w, w.size, &memory) == EW_OK) {
            accepted++;
            (void)draw(&s, test_random() % 300);
        }
        free(memory);
    }
    assert_true(accepted > 10000);
}

static double element(const ew_mat34 *m, int i, int j) 
{
    return ldexp(m->row[i].m[j], (j < 3 ? m->row[i].e : m->row[i].e_last) - 30);
}

static void tracks_interpolate_and_clamp(void **state)
{
    (void)state;
    writer w;
    ew_scene s;
    void *memory;
    ew_mat34 world[2];
    write_scene(&w);
    assert_int_equal(open_exact(&s, &w, w.size, &memory), EW_OK);
    for (uint32_t ms = 0; ms < 400; ms++) {
        double t = ms < 200 ? ms / 100.0 : 2, k = fmin(floor(t), 1), f = t - k;
        const double q[3][2] = { { 0, 16384 }, { 8192, 14189 }, { 14189, 8192 } };
        int i = (int)k;
        /* about z, so the arc is a mean of the angles, and the rotation is twice as far */
        double angle = 2 * (atan2(q[i][0], q[i][1]) * (1 - f) + atan2(q[i + 1][0], q[i + 1][1]) * f);
        assert_int_equal(ew_scene_pose(&s, ms, world), EW_OK);
        test_context("%u ms", ms);
        assert_true(fabs(element(&world[1], 0, 0) - cos(angle)) < 3e-8);
        assert_true(fabs(element(&world[1], 1, 0) - sin(angle)) < 3e-8);
        assert_true(fabs(element(&world[1], 0, 3) - t * 0.5) < 1e-7);
        assert_true(fabs(element(&world[1], 2, 3) - t * 0.25) < 1e-7);
        assert_true(fabs(element(&world[0], 0, 0) - 1) < 1e-9);
    }
    assert_int_equal(ew_scene_pose(&s, UINT32_MAX, world), EW_OK);
    assert_true(fabs(element(&world[1], 0, 3) - 1) < 1e-7);
    free(memory);
}

static void draws_near_over_far(void **state)
{
    (void)state;
    writer w;
    ew_scene s;
    void *memory;
    write_scene(&w);
    assert_int_equal(open_exact(&s, &w, w.size, &memory), EW_OK);
    assert_int_equal(draw(&s, 0), 2);
    /* the small flat triangle stands before the middle of the textured one */
    assert_int_equal(colour[H / 2 * W + W / 2], 0xF81F);
    int textured = 0;
    for (int i = 0; i < W * H; i++) {
        if (colour[i] == 0) assert_int_equal(depth[i], 0);
        else if (colour[i] != 0xF81F) textured++, assert_true(colour[i] % 0x1111 == 0);
    }
    assert_true(textured > 100);
    assert_int_equal(depth[0], 0);
    free(memory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(reads_what_was_written),
        TEST(every_changed_byte_is_refused),
        TEST(every_length_is_refused),
        TEST(codes_say_what_is_wrong),
        TEST(every_rule_is_checked),
        TEST(shared_ranges_take_no_square_of_time),
        TEST(damaged_scenes_do_no_harm),
        TEST(tracks_interpolate_and_clamp),
        TEST(draws_near_over_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
