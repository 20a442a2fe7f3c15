/* The baked scene reader: docs/scene-format.md. Everything is checked once, in
 * ew_scene_open; the functions after it trust the bytes. */
#include "edgewalk/scene.h"

/* Vertices, indices and texels are used where they lie, as the machine's own numbers. */
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "baked scenes are little-endian and used in place"
#endif
typedef char ew_vertex16_is_ten_bytes[sizeof(ew_vertex16) == 10 ? 1 : -1];

enum { HEADER_BYTES = 32, ENTRY_BYTES = 16, MAX_SECTIONS = 32, ROW_BYTES = 20 };
#define MANTISSA_LIMIT (INT32_C(1) << 30)

typedef struct section_rule {
    char tag[5];
    uint16_t record_bytes;
    uint8_t required, at_most_one;
} section_rule;

static const section_rule rules[EW_SECTION_COUNT] = {
    { "CAMR", 72, 1, 1 }, { "BOUN", 20, 1, 1 }, { "NODE", 68, 1, 0 }, { "PRIM", 40, 1, 0 },
    { "VERT", 10, 1, 0 }, { "INDX", 2, 1, 0 },  { "MATL", 8, 1, 0 },  { "TEXR", 8, 0, 0 },
    { "TEXL", 2, 0, 0 },  { "TRAK", 12, 0, 0 }, { "KEYS", 32, 0, 0 }, { "ANIM", 4, 0, 1 }
};

/* ---- little-endian numbers ---- */

static uint16_t u16_at(const uint8_t *p) { return (uint16_t)(p[0] | (uint16_t)p[1] << 8); }
static uint32_t u32_at(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}
static int16_t i16_at(const uint8_t *p) { return (int16_t)u16_at(p); }
static int32_t i32_at(const uint8_t *p) { return (int32_t)u32_at(p); }

static int tag_is(const uint8_t *p, const char *tag)
{
    return p[0] == (uint8_t)tag[0] && p[1] == (uint8_t)tag[1] && p[2] == (uint8_t)tag[2] &&
           p[3] == (uint8_t)tag[3];
}

static EW_OWN_FRAME void row_at(const uint8_t *p, ew_row *row)
{
    for (int k = 0; k < 4; k++) row->m[k] = i32_at(p + 4 * k);
    row->e = i16_at(p + 16);
    row->e_last = i16_at(p + 18);
}
static void mat34_at(const uint8_t *p, ew_mat34 *m)
{
    for (int k = 0; k < 3; k++) row_at(p + ROW_BYTES * k, &m->row[k]);
}

/* CRC-32 of the whole file with bytes 12 to 15 as zero; four bits at a time, so that the
 * table takes 64 bytes. */
static uint32_t checksum(const uint8_t *p, uint32_t size)
{
    static const uint32_t table[16] = {
        0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u,
        0x4DB26158u, 0x5005713Cu, 0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu,
        0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu
    };
    uint32_t crc = 0xFFFFFFFFu;
    for (uint32_t i = 0; i < size; i++) {
        crc ^= i >= 12 && i < 16 ? 0u : p[i];
        crc = crc >> 4 ^ table[crc & 15u];
        crc = crc >> 4 ^ table[crc & 15u];
    }
    return ~crc;
}

/* ---- checks ---- */

static int row_ok(const uint8_t *p)
{
    for (int k = 0; k < 4; k++) {
        int32_t m = i32_at(p + 4 * k);
        if (m > MANTISSA_LIMIT || m < -MANTISSA_LIMIT) return 0;
    }
    int16_t e = i16_at(p + 16), e_last = i16_at(p + 18);
    return e >= -1000 && e <= 1000 && e_last >= -1000 && e_last <= 1000;
}
static int rows_ok(const uint8_t *p, int count)
{
    for (int k = 0; k < count; k++) {
        if (!row_ok(p + ROW_BYTES * k)) return 0;
    }
    return 1;
}

/* first .. first + count lies in 0 .. all */
static int range_ok(uint32_t first, uint32_t count, uint32_t all)
{
    return first <= all && count <= all - first;
}

static const uint8_t *record(const ew_scene *s, int section, uint32_t i)
{
    return s->section[section].records + (size_t)i * rules[section].record_bytes;
}

static int camera_ok(const uint8_t *p)
{
    int32_t focal = i32_at(p + 60), near_m = i32_at(p + 64);
    int16_t near_e = i16_at(p + 68);
    return rows_ok(p, 3) && focal > 0 && focal <= 1024 * 65536 && near_m >= MANTISSA_LIMIT / 2 &&
           near_m < MANTISSA_LIMIT && near_e >= -1000 && near_e <= 1000 && u16_at(p + 70) == 0;
}

static int node_ok(const ew_scene *s, uint32_t i)
{
    const uint8_t *p = record(s, EW_SECTION_NODE, i);
    int16_t parent = i16_at(p), track = i16_at(p + 2);
    return parent >= -1 && parent < (int32_t)i && track >= -1 &&
           track < (int32_t)s->section[EW_SECTION_TRAK].count &&
           range_ok(u16_at(p + 4), u16_at(p + 6), s->section[EW_SECTION_PRIM].count) && rows_ok(p + 8, 3);
}

/* Where the range of indices may begin that primitive i names, and that of keys of track i: behind
 * the range of the record before, which has been checked. So no index and no key is looked at
 * twice, and the checks take time in proportion to the file's size. */
static uint32_t least_index(const ew_scene *s, uint32_t i)
{
    if (i == 0) return 0;
    const uint8_t *before = record(s, EW_SECTION_PRIM, i - 1);
    return u32_at(before + 8) + u32_at(before + 12);
}
static uint32_t least_key(const ew_scene *s, uint32_t i)
{
    if (i == 0) return 0;
    const uint8_t *before = record(s, EW_SECTION_TRAK, i - 1);
    return u32_at(before) + u16_at(before + 4);
}

static int primitive_ok(const ew_scene *s, uint32_t i)
{
    const uint8_t *p = record(s, EW_SECTION_PRIM, i);
    uint32_t vertices = u16_at(p + 4), first_index = u32_at(p + 8), indices = u32_at(p + 12);
    if (vertices < 1 || !range_ok(u32_at(p), vertices, s->section[EW_SECTION_VERT].count) ||
        u16_at(p + 6) >= s->section[EW_SECTION_MATL].count || indices % 3 != 0 ||
        first_index < least_index(s, i) || !range_ok(first_index, indices, s->section[EW_SECTION_INDX].count) ||
        !row_ok(p + 16) || p[36] < 1 || p[36] > 12 || p[37] || p[38] || p[39]) {
        return 0;
    }
    for (uint32_t k = 0; k < indices; k++) {
        if (u16_at(record(s, EW_SECTION_INDX, first_index + k)) >= vertices) return 0;
    }
    return 1;
}

static int material_ok(const ew_scene *s, uint32_t i)
{
    const uint8_t *p = record(s, EW_SECTION_MATL, i);
    uint16_t texture = u16_at(p + 2);
    return (texture == 0xFFFF || texture < s->section[EW_SECTION_TEXR].count) && u16_at(p + 4) <= 1 &&
           u16_at(p + 6) <= EW_TOLERANCE_MAX;
}

enum { TEXTURE_LOG2_MAX = 11 }; /* EW_TEXTURE_MAX */

static int texture_ok(const ew_scene *s, uint32_t i)
{
    const uint8_t *p = record(s, EW_SECTION_TEXR, i);
    return p[4] <= TEXTURE_LOG2_MAX && p[5] <= TEXTURE_LOG2_MAX && p[6] == 0 && p[7] == 0 &&
           range_ok(u32_at(p), (uint32_t)1 << (p[4] + p[5]), s->section[EW_SECTION_TEXL].count);
}

static int track_ok(const ew_scene *s, uint32_t i)
{
    const uint8_t *p = record(s, EW_SECTION_TRAK, i);
    int16_t et = i16_at(p + 8), es = i16_at(p + 10);
    return u16_at(p + 4) >= 1 && u16_at(p + 6) >= 1 && et >= -1000 && et <= 1000 && es >= -1000 &&
           es <= 1000 && u32_at(p) >= least_key(s, i) &&
           range_ok(u32_at(p), u16_at(p + 4), s->section[EW_SECTION_KEYS].count);
}

/* The dot product of two keys' quaternions in units of 2^-26: |.| <= 2^30. */
static int32_t quaternion_dot(const uint8_t *a, const uint8_t *b)
{
    int32_t sum = 0;
    for (int k = 0; k < 4; k++) sum += (int32_t)i16_at(a + 12 + 2 * k) * i16_at(b + 12 + 2 * k) / 4;
    return sum;
}

static int key_ok(const ew_scene *s, uint32_t i)
{
    const uint8_t *p = record(s, EW_SECTION_KEYS, i);
    for (int k = 0; k < 3; k++) {
        int32_t t = i32_at(p + 4 * k), scale = i32_at(p + 20 + 4 * k);
        if (t > MANTISSA_LIMIT || t < -MANTISSA_LIMIT || scale > MANTISSA_LIMIT || scale < -MANTISSA_LIMIT) {
            return 0;
        }
    }
    /* |q|^2 within 1/128 of 1, so |q| within 1/256; units of 2^-26 (see quaternion_dot) */
    int32_t length = quaternion_dot(p, p), one = (int32_t)1 << 26;
    return length > one - one / 128 && length < one + one / 128;
}

typedef int record_check(const ew_scene *scene, uint32_t i);

static int all_ok(const ew_scene *s, int section, record_check *check)
{
    for (uint32_t i = 0; i < s->section[section].count; i++) {
        if (!check(s, i)) return 0;
    }
    return 1;
}

/* Between two keys the rotation goes the short way only if their dot product is not
 * negative; neighbours in different tracks do not matter. */
static int keys_turn_the_short_way(const ew_scene *s)
{
    for (uint32_t i = 0; i < s->section[EW_SECTION_TRAK].count; i++) {
        const uint8_t *p = record(s, EW_SECTION_TRAK, i);
        for (uint32_t k = 1; k < u16_at(p + 4); k++) {
            const uint8_t *key = record(s, EW_SECTION_KEYS, u32_at(p) + k);
            if (quaternion_dot(key - rules[EW_SECTION_KEYS].record_bytes, key) < 0) return 0;
        }
    }
    return 1;
}

static int read_directory(ew_scene *s, const uint8_t *bytes, uint32_t size)
{
    uint32_t sections = u16_at(bytes + 16), after = HEADER_BYTES + ENTRY_BYTES * sections;
    if (sections < 1 || sections > MAX_SECTIONS) return EW_ERR_CORRUPT;
    if (after > size) return EW_ERR_TRUNCATED;
    for (uint32_t i = 0; i < sections; i++) {
        const uint8_t *entry = bytes + HEADER_BYTES + ENTRY_BYTES * i;
        uint32_t offset = u32_at(entry + 4), count = u32_at(entry + 8), each = u32_at(entry + 12);
        int known = 0;
        while (known < EW_SECTION_COUNT && !tag_is(entry, rules[known].tag)) known++;
        if (known == EW_SECTION_COUNT) {
            if (entry[0] >= 'a' && entry[0] <= 'z') continue;
            return EW_ERR_CORRUPT;
        }
        const section_rule *rule = &rules[known];
        if (s->section[known].records || each != rule->record_bytes || offset % 4 != 0 || offset < after ||
            offset > size || count > (size - offset) / each || (rule->at_most_one && count > 1)) {
            return EW_ERR_CORRUPT;
        }
        s->section[known].records = bytes + offset;
        s->section[known].count = count;
    }
    for (int i = 0; i < EW_SECTION_COUNT; i++) {
        if (rules[i].required && !s->section[i].count) return EW_ERR_CORRUPT;
    }
    return EW_OK;
}

int ew_scene_open(ew_scene *scene, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    if ((uintptr_t)bytes % 4 != 0) return EW_ERR_ARGUMENT;
    if (size < 4) return EW_ERR_TRUNCATED;
    if (!tag_is(bytes, "EWB\x1A")) return EW_ERR_MAGIC;
    if (size < HEADER_BYTES) return EW_ERR_TRUNCATED;
    if (u16_at(bytes + 4) != 1) return EW_ERR_VERSION;
    uint32_t stated = u32_at(bytes + 8);
    if (stated > size) return EW_ERR_TRUNCATED;
    if (stated < size || stated % 4 != 0 || u16_at(bytes + 6) != HEADER_BYTES) return EW_ERR_CORRUPT;
    for (int i = 18; i < HEADER_BYTES; i++) {
        if (bytes[i] != 0) return EW_ERR_CORRUPT;
    }
    if (checksum(bytes, stated) != u32_at(bytes + 12)) return EW_ERR_CHECKSUM;

    static const ew_scene none;
    ew_scene s = none;
    int error = read_directory(&s, bytes, stated);
    if (error) return error;
    if (!camera_ok(record(&s, EW_SECTION_CAMR, 0)) || !row_ok(record(&s, EW_SECTION_BOUN, 0)) ||
        !all_ok(&s, EW_SECTION_NODE, node_ok) || !all_ok(&s, EW_SECTION_PRIM, primitive_ok) ||
        !all_ok(&s, EW_SECTION_MATL, material_ok) || !all_ok(&s, EW_SECTION_TEXR, texture_ok) ||
        !all_ok(&s, EW_SECTION_TRAK, track_ok) || !all_ok(&s, EW_SECTION_KEYS, key_ok) ||
        !keys_turn_the_short_way(&s)) {
        return EW_ERR_CORRUPT;
    }
    for (uint32_t i = 0; i < s.section[EW_SECTION_PRIM].count; i++) {
        uint16_t vertices = u16_at(record(&s, EW_SECTION_PRIM, i) + 4);
        if (vertices > s.largest_primitive) s.largest_primitive = vertices;
    }
    if (s.section[EW_SECTION_ANIM].count) {
        s.duration_ms = u32_at(record(&s, EW_SECTION_ANIM, 0));
        if (s.duration_ms < 1) return EW_ERR_CORRUPT;
    }
    *scene = s;
    return EW_OK;
}

/* ---- records ---- */

void ew_scene_get_camera(const ew_scene *scene, ew_scene_camera *camera)
{
    const uint8_t *p = record(scene, EW_SECTION_CAMR, 0);
    mat34_at(p, &camera->view);
    camera->focal = i32_at(p + 60);
    camera->near_z.m = i32_at(p + 64);
    camera->near_z.e = i16_at(p + 68);
}

void ew_scene_get_bounds(const ew_scene *scene, ew_row *centre_radius)
{
    row_at(record(scene, EW_SECTION_BOUN, 0), centre_radius);
}

void ew_scene_get_node(const ew_scene *scene, uint32_t i, ew_scene_node *node)
{
    const uint8_t *p = record(scene, EW_SECTION_NODE, i);
    node->parent = i16_at(p);
    node->track = i16_at(p + 2);
    node->first_primitive = u16_at(p + 4);
    node->primitive_count = u16_at(p + 6);
    mat34_at(p + 8, &node->local);
}

/* Takes the vertices of primitive p to its node: o + s v, a diagonal matrix and o. */
static void dequantise_at(const uint8_t *p, ew_mat34 *matrix)
{
    p += 16; /* o, s and both exponents, that of o first */
    for (int k = 0; k < 3; k++) {
        ew_row *row = &matrix->row[k];
        row->m[0] = row->m[1] = row->m[2] = 0;
        row->m[k] = i32_at(p + 12);
        row->m[3] = i32_at(p + 4 * k);
        row->e = i16_at(p + 18);
        row->e_last = i16_at(p + 16);
    }
}

/* Sections start on multiples of 4 and both records have even sizes. */
static const ew_vertex16 *vertices_at(const ew_scene *scene, const uint8_t *p)
{
    return (const void *)record(scene, EW_SECTION_VERT, u32_at(p));
}
static const uint16_t *indices_at(const ew_scene *scene, const uint8_t *p)
{
    return (const void *)record(scene, EW_SECTION_INDX, u32_at(p + 8));
}

void ew_scene_get_primitive(const ew_scene *scene, uint32_t i, ew_scene_primitive *primitive)
{
    const uint8_t *p = record(scene, EW_SECTION_PRIM, i);
    dequantise_at(p, &primitive->dequantise);
    primitive->vertices = vertices_at(scene, p);
    primitive->indices = indices_at(scene, p);
    primitive->index_count = u32_at(p + 12);
    primitive->vertex_count = u16_at(p + 4);
    primitive->material = u16_at(p + 6);
    primitive->uv_fraction_bits = p[36];
}

void ew_scene_get_material(const ew_scene *scene, uint32_t i, ew_material *material, ew_texture *texture)
{
    const uint8_t *p = record(scene, EW_SECTION_MATL, i);
    const ew_material plain = { .rung = EW_RUNG_AUTO };
    const ew_texture repeated = { .texels = NULL };
    uint16_t number = u16_at(p + 2);
    *material = plain;
    *texture = repeated;
    material->colour = u16_at(p);
    material->flags = u16_at(p + 4) & 1 ? EW_DOUBLE_SIDED : 0;
    material->tolerance = u16_at(p + 6);
    if (number == 0xFFFF) return;
    const uint8_t *t = record(scene, EW_SECTION_TEXR, number);
    texture->texels = (const void *)record(scene, EW_SECTION_TEXL, u32_at(t));
    texture->width = (uint16_t)(1u << t[4]);
    texture->height = (uint16_t)(1u << t[5]);
    material->texture = texture;
}

/* ---- movement ---- */

/* a + (b - a) f / 2^31, 0 <= f < 2^31, |a|, |b| <= 2^30: the product is below 2^62. */
static int32_t between(int32_t a, int32_t b, uint32_t f)
{
    return (int32_t)(a + EW_ASR(((int64_t)b - a) * (int64_t)f, 31));
}

static ew_quat quaternion_at(const uint8_t *p)
{
    ew_quat q = { ew_q2_30_from_q2_14(i16_at(p)), ew_q2_30_from_q2_14(i16_at(p + 2)),
                  ew_q2_30_from_q2_14(i16_at(p + 4)), ew_q2_30_from_q2_14(i16_at(p + 6)) };
    return q;
}

/* A place in a track: a part f 2^-31 of the way from key a to b. */
typedef struct key_pair {
    const uint8_t *a, *b;
    uint32_t f;
} key_pair;

static EW_OWN_FRAME void find_keys(key_pair *keys, const ew_scene *scene, const uint8_t *track,
                                   uint32_t time_ms)
{
    uint32_t first = u32_at(track), last = (uint32_t)u16_at(track + 4) - 1u, interval = u16_at(track + 6);
    uint32_t k = time_ms / interval, rest;
    uint32_t f = ew_udiv64_32((uint64_t)(time_ms % interval) << 31, interval, &rest);
    if (k >= last) k = last, f = 0;
    keys->a = record(scene, EW_SECTION_KEYS, first + k);
    keys->b = f ? keys->a + rules[EW_SECTION_KEYS].record_bytes : keys->a;
    keys->f = f;
}

static EW_OWN_FRAME int rotation_between(ew_quat *q, const key_pair *keys)
{
    ew_quat to = quaternion_at(keys->b + 12);
    *q = quaternion_at(keys->a + 12);
    return ew_quat_slerp(q, q, &to, keys->f);
}

/* Three numbers of the keys, from byte `at` on. */
static EW_OWN_FRAME void vector_between(int32_t v[3], const key_pair *keys, int at)
{
    for (int i = 0; i < 3; i++) {
        v[i] = between(i32_at(keys->a + at + 4 * i), i32_at(keys->b + at + 4 * i), keys->f);
    }
}

static EW_OWN_FRAME int track_matrix(const ew_scene *scene, uint32_t track, uint32_t time_ms, ew_mat34 *out)
{
    const uint8_t *p = record(scene, EW_SECTION_TRAK, track);
    key_pair keys;
    ew_quat q;
    int32_t t[3], s[3];
    find_keys(&keys, scene, p, time_ms);
    int error = rotation_between(&q, &keys);
    if (error) return error;
    vector_between(t, &keys, 0);
    vector_between(s, &keys, 20);
    return ew_mat34_from_trs(out, t, i16_at(p + 8), &q, s, i16_at(p + 10));
}

int ew_scene_pose(const ew_scene *scene, uint32_t time_ms, ew_mat34 *world)
{
    for (uint32_t i = 0; i < scene->section[EW_SECTION_NODE].count; i++) {
        const uint8_t *p = record(scene, EW_SECTION_NODE, i);
        const int16_t parent = i16_at(p), track = i16_at(p + 2);
        int error = EW_OK;
        if (track >= 0) error = track_matrix(scene, (uint32_t)track, time_ms, &world[i]);
        else mat34_at(p + 8, &world[i]);
        if (!error && parent >= 0) error = ew_mat34_mul(&world[i], &world[parent], &world[i]);
        if (error) return error;
    }
    return EW_OK;
}

/* ---- drawing ----
 *
 * Below ew_scene_draw lies the deepest chain of calls there is, so it holds what it can in
 * geometry->work.scene. */

static EW_OWN_FRAME int set_projection(ew_projection *projection, const ew_scene_camera *camera,
                                       const ew_viewport *viewport)
{
    /* focal_y = focal; focal_x = focal height/width, nearest */
    uint32_t rest;
    if (viewport->width < 1) return EW_ERR_ARGUMENT;
    uint64_t across = (uint64_t)(uint32_t)camera->focal * viewport->height + viewport->width / 2;
    if (across >> 32 >= viewport->width) return EW_ERR_ARGUMENT;
    uint32_t focal_x = ew_udiv64_32(across, viewport->width, &rest);
    if (focal_x > INT32_MAX) return EW_ERR_ARGUMENT;
    projection->focal_x = (ew_q16_16)focal_x;
    projection->focal_y = camera->focal;
    projection->near_z = camera->near_z;
    return EW_OK;
}

static EW_OWN_FRAME int use_material(const ew_scene *scene, uint32_t number, ew_raster *raster)
{
    ew_material material;
    ew_texture texture;
    ew_scene_get_material(scene, number, &material, &texture);
    return ew_raster_set_material(raster, &material);
}

/* A primitive's transform, by way of the node's and the view in work. */
static int primitive_transform(const uint8_t *p, ew_scene_work *work, ew_transform *transform)
{
    ew_mat34 *const model_view = &work->primitive_at_hand.model_view;
    dequantise_at(p, model_view);
    int error = ew_mat34_mul(model_view, &work->node_view, model_view);
    return error ? error : ew_transform_set(transform, &work->projection, model_view, &work->viewport);
}

static void primitive_mesh(const ew_scene *scene, const uint8_t *p, ew_mesh *mesh)
{
    mesh->vertices = vertices_at(scene, p);
    mesh->screen = NULL;
    mesh->colours = NULL;
    mesh->indices = indices_at(scene, p);
    mesh->index_count = u32_at(p + 12);
    mesh->uv_fraction_bits = p[36];
}

/* Makes material, transform and mesh ready for a primitive, with its vertices on the screen. */
static EW_OWN_FRAME int prepare_primitive(const ew_scene *scene, uint32_t number, ew_geometry *geometry)
{
    const uint8_t *p = record(scene, EW_SECTION_PRIM, number);
    ew_scene_work *const work = &geometry->work.scene;
    int error = primitive_transform(p, work, &geometry->transform);
    if (!error) error = use_material(scene, u16_at(p + 6), geometry->raster);
    if (error) return error;
    ew_mesh *const mesh = &work->primitive_at_hand.mesh;
    primitive_mesh(scene, p, mesh);
    mesh->screen = work->vertices;
    ew_transform_vertices(&geometry->transform, mesh->vertices, u16_at(p + 4), work->vertices);
    return EW_OK;
}

uint32_t ew_scene_object_count(const ew_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->section[EW_SECTION_NODE].count; i++) {
        count += u16_at(record(scene, EW_SECTION_NODE, i) + 6);
    }
    return count;
}

static EW_OWN_FRAME int make_object(const ew_scene *scene, uint32_t number, ew_scene_work *work, ew_object *object)
{
    const uint8_t *p = record(scene, EW_SECTION_PRIM, number);
    int error = primitive_transform(p, work, &object->transform);
    if (error) return error;
    primitive_mesh(scene, p, &object->mesh);
    object->vertex_count = u16_at(p + 4);
    ew_scene_get_material(scene, u16_at(p + 6), &object->material, &object->texture);
    return EW_OK;
}

int ew_scene_objects(const ew_scene *scene, const ew_scene_camera *camera, const ew_mat34 *world,
                     const ew_viewport *viewport, ew_geometry *geometry, ew_object *objects)
{
    ew_scene_work *work = &geometry->work.scene;
    int error = set_projection(&work->projection, camera, viewport);
    work->viewport = *viewport;
    for (uint32_t i = 0; i < scene->section[EW_SECTION_NODE].count && !error; i++) {
        const uint8_t *node = record(scene, EW_SECTION_NODE, i);
        work->primitive = u16_at(node + 4);
        work->left = u16_at(node + 6);
        if (work->left) error = ew_mat34_mul(&work->node_view, &camera->view, &world[i]);
        for (; work->left && !error; work->left--) error = make_object(scene, work->primitive++, work, objects++);
    }
    return error;
}

int32_t ew_scene_draw(const ew_scene *scene, const ew_scene_camera *camera, const ew_mat34 *world,
                      const ew_viewport *viewport, ew_geometry *geometry, ew_screen_vertex *scratch)
{
    /* what is needed after a primitive is drawn lies here, too: less on the stack below it */
    ew_scene_work *work = &geometry->work.scene;
    int error = set_projection(&work->projection, camera, viewport);
    if (error) return error;
    work->viewport = *viewport;
    work->vertices = scratch;
    work->view = &camera->view;
    work->drawn = 0;
    for (uint32_t i = 0; i < scene->section[EW_SECTION_NODE].count; i++) {
        const uint8_t *node = record(scene, EW_SECTION_NODE, i);
        work->primitive = u16_at(node + 4);
        work->left = u16_at(node + 6);
        if (!work->left) continue;
        error = ew_mat34_mul(&work->node_view, work->view, &world[i]);
        if (error) return error;
        for (; work->left; work->left--) {
            error = prepare_primitive(scene, work->primitive++, geometry);
            if (error) return error;
            int32_t result = ew_draw_triangles(geometry, &work->primitive_at_hand.mesh);
            if (result < 0) return result;
            work->drawn += result;
        }
    }
    return work->drawn;
}
