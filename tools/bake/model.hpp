/* What the baker knows of a scene after loading: plain numbers, checked, in glTF's own
 * units and directions (right-handed, y up, metres, linear colour factors, v downwards).
 *
 * Everything here is finite; every index points inside its vector. Only nodes of the
 * chosen scene are present, parents before children.
 */
#ifndef BAKE_MODEL_HPP
#define BAKE_MODEL_HPP

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "maths.hpp"

namespace bake
{

/* Why a file cannot be baked, as "what: why"; `file` is empty where it is the input. */
struct Error : std::runtime_error {
    std::string file;
    Error(const std::string &what, const std::string &why) : std::runtime_error(what + ": " + why) {}
    Error(const std::string &file_, const std::string &what, const std::string &why)
        : std::runtime_error(what + ": " + why), file(file_)
    {
    }
};

/* Decoded, four channels per pixel, sRGB encoded, top row first; 8 or 16 bits each. */
struct Image {
    std::string label;
    int width = 0, height = 0;
    int bits = 8;
    std::vector<uint8_t> pixels; /* 16-bit samples in the machine's byte order */
};

struct Material {
    std::string label;
    double factor[3] = {1, 1, 1}; /* linear, 0 to 1 */
    int image = -1;
    bool double_sided = false;
};

struct Primitive {
    std::string label;
    int material = -1; /* -1: white, one side */
    std::vector<Vec3> positions;
    std::vector<Vec2> uvs;           /* in textures, transform applied; as many as positions, or none */
    std::vector<uint32_t> triangles; /* three indices each */
};

struct Mesh {
    std::string label;
    std::vector<Primitive> primitives;
};

struct Node {
    std::string label;
    int parent = -1;
    int mesh = -1;
    bool has_matrix = false;
    Mat34 matrix; /* where has_matrix */
    Vec3 translation;
    Quat rotation;
    Vec3 scale = {1, 1, 1};
};

enum class Path { translation, rotation, scale };
enum class Interpolation { linear, step, cubic };

/* One curve. `values` holds 3 or 4 numbers per key; with cubic three such groups (in
 * tangent, value, out tangent). Rotations are normalised, tangents apart. */
struct Channel {
    int node = 0;
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times; /* seconds, >= 0, never decreasing, at least one */
    std::vector<double> values;
};

struct Camera {
    std::string label; /* empty: the scene has none */
    int node = -1;
    double yfov = 0, znear = 0;
};

struct Scene {
    std::vector<Node> nodes;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Image> images;
    std::vector<Channel> channels;
    Camera camera;
    std::vector<std::string> warnings; /* "what: why" */
};

/* Reads a .glb or .gltf file with what it refers to. `scene` is the scene's number, -1
 * for the file's default. Throws Error. */
Scene load_gltf(const std::string &path, int scene);

} // namespace bake

#endif
