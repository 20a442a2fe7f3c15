/* The bytes of docs/scene-format.md, version 1. */
#include <cstdio>

#include "bake.hpp"

namespace bake
{

namespace
{

class Bytes
{
  public:
    std::vector<uint8_t> data;

    void u8(unsigned value) { data.push_back(static_cast<uint8_t>(value)); }
    void u16(unsigned value) { u8(value & 0xFF), u8(value >> 8 & 0xFF); }
    void u32(uint32_t value) { u16(value & 0xFFFF), u16(value >> 16); }
    void i16(int value) { u16(static_cast<uint16_t>(value)); }
    void i32(int32_t value) { u32(static_cast<uint32_t>(value)); }
    void tag(const std::string &text)
    {
        for (char c : text) u8(static_cast<uint8_t>(c));
    }
    void row(const Row &row)
    {
        for (int32_t m : row.m) i32(m);
        i16(row.e), i16(row.e_last);
    }
    void matrix(const Matrix &matrix)
    {
        for (const Row &r : matrix) row(r);
    }
    void patch_u32(size_t at, uint32_t value)
    {
        for (size_t i = 0; i < 4; i++) data[at + i] = static_cast<uint8_t>(value >> 8 * i);
    }
    void align()
    {
        while (data.size() % 4 != 0) u8(0);
    }
};

void put(Bytes &out, const BakedCamera &camera)
{
    out.matrix(camera.view);
    out.i32(camera.focal);
    out.i32(camera.near_z.m[0]), out.i16(camera.near_z.e), out.u16(0);
}

void put(Bytes &out, const BakedNode &node)
{
    out.i16(node.parent), out.i16(node.track);
    out.u16(node.first_primitive), out.u16(node.primitive_count);
    out.matrix(node.local);
}

void put(Bytes &out, const BakedPrimitive &primitive)
{
    out.u32(primitive.first_vertex), out.u16(primitive.vertex_count), out.u16(primitive.material);
    out.u32(primitive.first_index), out.u32(primitive.index_count);
    out.row(primitive.grid);
    out.u32(primitive.uv_bits); /* one byte and three zeros */
}

void put(Bytes &out, const BakedVertex &vertex)
{
    for (int16_t part : {vertex.x, vertex.y, vertex.z, vertex.u, vertex.v}) out.i16(part);
}

void put(Bytes &out, const BakedMaterial &material)
{
    out.u16(material.colour), out.u16(material.texture), out.u16(material.flags), out.u16(material.tolerance);
}

void put(Bytes &out, const BakedTexture &texture)
{
    out.u32(texture.first_texel), out.u8(texture.log2_width), out.u8(texture.log2_height), out.u16(0);
}

void put(Bytes &out, const BakedKey &key)
{
    for (int32_t m : key.translation) out.i32(m);
    for (int16_t q : key.rotation) out.i16(q);
    for (int32_t m : key.scale) out.i32(m);
}

void put(Bytes &out, const Row &row) { out.row(row); }
void put(Bytes &out, uint16_t value) { out.u16(value); }

struct Section {
    SectionSize size;
    std::vector<uint8_t> data;
};

template <class Record>
Section section(const char *tag, uint32_t record_bytes, const std::vector<Record> &records)
{
    Bytes bytes;
    for (const Record &record : records) put(bytes, record);
    return {{tag, static_cast<uint32_t>(records.size()), record_bytes}, std::move(bytes.data)};
}

Section tracks(const Baked &baked)
{
    Bytes bytes;
    for (const BakedTrack &track : baked.tracks) {
        bytes.u32(track.first_key), bytes.u16(track.key_count),
            bytes.u16(static_cast<unsigned>(baked.key_interval));
        bytes.i16(track.translation_e), bytes.i16(track.scale_e);
    }
    return {{"TRAK", static_cast<uint32_t>(baked.tracks.size()), 12}, std::move(bytes.data)};
}

Section duration(const Baked &baked)
{
    Bytes bytes;
    bytes.u32(baked.duration);
    return {{"ANIM", 1, 4}, std::move(bytes.data)};
}

uint32_t crc32(const std::vector<uint8_t> &data)
{
    uint32_t crc = 0xFFFFFFFF;
    for (uint8_t byte : data) {
        crc ^= byte;
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320 : 0);
    }
    return ~crc;
}

} // namespace

std::vector<uint8_t> scene_file(const Baked &baked, std::vector<SectionSize> &sections)
{
    std::vector<Section> parts;
    parts.push_back(section("CAMR", 72, std::vector<BakedCamera>{baked.camera}));
    parts.push_back(section("BOUN", 20, std::vector<Row>{baked.bounds}));
    parts.push_back(section("NODE", 68, baked.nodes));
    parts.push_back(section("PRIM", 40, baked.primitives));
    parts.push_back(section("VERT", 10, baked.vertices));
    parts.push_back(section("INDX", 2, baked.indices));
    parts.push_back(section("MATL", 8, baked.materials));
    if (!baked.textures.empty()) {
        parts.push_back(section("TEXR", 8, baked.textures));
        parts.push_back(section("TEXL", 2, baked.texels));
    }
    if (!baked.tracks.empty()) {
        parts.push_back(tracks(baked));
        parts.push_back(section("KEYS", 32, baked.keys));
        parts.push_back(duration(baked));
    }
    Bytes file;
    file.tag("EWB\x1A");
    file.u16(1), file.u16(32);
    file.u32(0), file.u32(0); /* size and CRC, see below */
    file.u16(static_cast<unsigned>(parts.size()));
    for (int i = 0; i < 14; i++) file.u8(0);
    uint32_t offset = 32 + 16 * static_cast<uint32_t>(parts.size());
    for (const Section &part : parts) {
        file.tag(part.size.tag);
        file.u32(offset), file.u32(part.size.count), file.u32(part.size.bytes);
        offset += (static_cast<uint32_t>(part.data.size()) + 3) / 4 * 4;
        sections.push_back(part.size);
    }
    for (const Section &part : parts) {
        file.data.insert(file.data.end(), part.data.begin(), part.data.end());
        file.align();
    }
    file.patch_u32(8, offset);
    file.patch_u32(12, crc32(file.data));
    return std::move(file.data);
}

std::vector<uint8_t> c_source(const std::vector<uint8_t> &file, const std::string &name)
{
    std::string text = "/* A baked scene, written by ew-bake: change the model, not this file. Words of a\n"
                       " * little-endian machine, so that the scene starts on a multiple of 4. */\n"
                       "#include <stddef.h>\n#include <stdint.h>\n\n"
                       "extern const uint32_t " +
                       name + "[];\nextern const size_t " + name +
                       "_size; /* bytes */\n\n"
                       "const size_t " +
                       name + "_size = " + std::to_string(file.size()) +
                       ";\n"
                       "const uint32_t " +
                       name + "[] = {";
    for (size_t i = 0; i < file.size(); i += 4) {
        char word[24];
        uint32_t value =
            file[i] | file[i + 1] << 8 | file[i + 2] << 16 | static_cast<uint32_t>(file[i + 3]) << 24;
        std::snprintf(word, sizeof word, "%s0x%08X,", i % 32 == 0 ? "\n    " : " ",
                      static_cast<unsigned>(value));
        text += word;
    }
    text += "\n};\n";
    return {text.begin(), text.end()};
}

} // namespace bake
