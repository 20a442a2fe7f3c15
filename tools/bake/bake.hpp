/* From a loaded scene to the records of docs/scene-format.md. */
#ifndef BAKE_BAKE_HPP
#define BAKE_BAKE_HPP

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model.hpp"

namespace bake
{

struct Options {
    int texture_width = 256, texture_height = 256; /* powers of two, 1 to 2048: at most */
    int tolerance = 4;                             /* 1/16 pixel, 0 to 256 */
    int key_interval = 32;                         /* milliseconds, 1 to 65535 */
};

/* A row of docs/scene-format.md: three numbers m[k] * 2^(e - 30), a fourth with e_last. */
struct Row {
    std::array<int32_t, 4> m = {};
    int16_t e = 0, e_last = 0;
    double value(size_t k) const;
};

/* The nearest row: its largest magnitude lies in [2^29, 2^30). Throws Error with `what`
 * where a number is too large; numbers below 2^-1000 become zero. */
Row make_row(const std::array<double, 4> &values, const std::string &what);

using Matrix = std::array<Row, 3>;

struct BakedCamera {
    Matrix view;
    int32_t focal = 0; /* q16.16 */
    Row near_z;        /* only m[0] and e */
};

struct BakedNode {
    int16_t parent = -1, track = -1;
    uint16_t first_primitive = 0, primitive_count = 0;
    Matrix local;
};

struct BakedPrimitive {
    uint32_t first_vertex = 0, first_index = 0, index_count = 0;
    uint16_t vertex_count = 0, material = 0;
    Row grid; /* ox, oy, oz, s */
    uint8_t uv_bits = 0;
};

struct BakedVertex {
    int16_t x = 0, y = 0, z = 0; /* q1.15 */
    int16_t u = 0, v = 0;        /* texels * 2^uv_bits */
    bool operator==(const BakedVertex &o) const
    {
        return x == o.x && y == o.y && z == o.z && u == o.u && v == o.v;
    }
};

struct BakedMaterial {
    uint16_t colour = 0, texture = 0xFFFF, flags = 0, tolerance = 0;
    bool operator==(const BakedMaterial &o) const
    {
        return colour == o.colour && texture == o.texture && flags == o.flags && tolerance == o.tolerance;
    }
};

struct BakedTexture {
    uint32_t first_texel = 0;
    uint8_t log2_width = 0, log2_height = 0;
};

struct BakedKey {
    int32_t translation[3] = {};
    int16_t rotation[4] = {}; /* q2.14 */
    int32_t scale[3] = {};
    bool operator==(const BakedKey &o) const;
};

struct BakedTrack {
    uint32_t first_key = 0;
    uint16_t key_count = 0;
    int16_t translation_e = 0, scale_e = 0;
};

/* What the baker tells about its work. */
struct Summary {
    std::string camera;           /* which, or how the default one stands */
    size_t empty_nodes = 0;       /* left out: nothing to draw in or below them */
    size_t flat_triangles = 0;    /* left out: two corners in one place */
    double position_rounding = 0; /* worst, mesh units */
    double uv_rounding = 0;       /* worst, texels */
    double translation_error = 0, rotation_error = 0,
           scale_error = 0; /* of movement: units, degrees, factor */
};

struct Baked {
    BakedCamera camera;
    Row bounds; /* centre, radius */
    std::vector<BakedNode> nodes;
    std::vector<BakedPrimitive> primitives;
    std::vector<BakedVertex> vertices;
    std::vector<uint16_t> indices;
    std::vector<BakedMaterial> materials;
    std::vector<BakedTexture> textures;
    std::vector<uint16_t> texels;
    std::vector<BakedTrack> tracks;
    std::vector<BakedKey> keys;
    int key_interval = 0;
    uint32_t duration = 0; /* milliseconds, 0 where nothing moves */
    Summary summary;
};

/* Bakes the scene. What version 1 cannot hold exactly is added to scene.warnings; what it
 * cannot hold at all throws Error. */
Baked bake_scene(Scene &scene, const Options &options);

/* Rounds to the nearest integer, ties away from zero, held inside [low, high]. */
int32_t round_within(double value, double low, double high);

/* ---- movement, animate.cpp ---- */

struct Pose {
    Vec3 translation;
    Quat rotation;
    Vec3 scale = {1, 1, 1};
};

/* The curves of one node, over its resting pose. */
class Motion
{
  public:
    Motion() = default;
    explicit Motion(const Node &node) : rest_{node.translation, node.rotation, node.scale} {}
    void add(const Channel &channel) { channels_.push_back(&channel); }
    bool moves() const { return !channels_.empty(); }
    double seconds() const;
    Pose at(double seconds) const;

  private:
    Pose rest_;
    std::vector<const Channel *> channels_;
};

/* Samples a motion every baked.key_interval ms up to `seconds` and adds the track, unless
 * nothing changes. Returns its number or -1. */
int bake_track(Baked &baked, const Motion &motion, double seconds, const std::string &what);

/* ---- the file, write.cpp ---- */

struct SectionSize {
    std::string tag;
    uint32_t count, bytes;
};

/* The bytes of the .ewb file; `sections` is told what is in it. */
std::vector<uint8_t> scene_file(const Baked &baked, std::vector<SectionSize> &sections);

/* The same as a C source: `const uint32_t NAME[]` and `const size_t NAME_size`, in bytes. */
std::vector<uint8_t> c_source(const std::vector<uint8_t> &file, const std::string &name);

} // namespace bake

#endif
