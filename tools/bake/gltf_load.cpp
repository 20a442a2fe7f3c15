/* glTF 2.0 to plain structs. The only file that knows tinygltf.
 *
 * tinygltf parses and decodes; it does not judge. It accepts accessors that end outside
 * their buffers, node cycles, NaN, paths that leave the folder, and it applies neither
 * sparse accessors nor texture transforms. So the file is capped and looked over before
 * it is parsed, external files are read by our own callbacks, images are decoded only
 * after their range was checked, and every index and number is checked on its way into
 * the structs of model.hpp.
 */
#include <algorithm>
#include <cstring>
#include <set>

#include <tiny_gltf.h>

#include "container.hpp"
#include "files.hpp"
#include "image.hpp"
#include "model.hpp"
#include "text.hpp"

namespace bake
{

namespace
{

constexpr uint64_t most_vertices = uint64_t{1} << 24; /* read in all, over all primitives */
constexpr uint64_t most_elements = uint64_t{1} << 26; /* of one accessor, times its components */

/* What the parser's callbacks share. */
struct Sources {
    std::string gltf;                         /* path of the glTF file */
    std::vector<std::vector<uint8_t>> images; /* bytes of those that are not in a buffer view */
    std::string failed_path, failure;         /* the last external file that could not be had */
    uint64_t bytes = 0;                       /* read so far */
};

bool source_exists(const std::string &, void *)
{
    return true; /* decided, with the reason, when it is read */
}

std::string source_path(const std::string &path, void *)
{
    return path; /* nothing is expanded: no ~, no variables */
}

bool source_read(std::vector<unsigned char> *out, std::string *, const std::string &uri, void *user)
{
    Sources &sources = *static_cast<Sources *>(user);
    std::string path;
    sources.failed_path = printable(uri);
    if (!resolve_beside(sources.gltf, uri, path, sources.failure)) return false;
    try {
        *out = read_file(path);
        sources.bytes += out->size();
        if (sources.bytes <= largest_input) return true;
        sources.failure = "external files take more than " + std::to_string(largest_input >> 20) + " MiB";
    } catch (const Error &error) {
        sources.failure = error.what();
    }
    return false;
}

/* Keeps the bytes of an external or data-URI image. Those of a buffer view are fetched
 * later: `bytes` may point anywhere. */
bool keep_image(tinygltf::Image *image, const int number, std::string *, std::string *, int, int,
                const unsigned char *bytes, int size, void *user)
{
    Sources &sources = *static_cast<Sources *>(user);
    if (image->bufferView != -1) return true;
    if (sources.images.size() <= static_cast<size_t>(number))
        sources.images.resize(static_cast<size_t>(number) + 1);
    sources.images[static_cast<size_t>(number)].assign(bytes, bytes + size);
    return true;
}

/* ---- the loader ---- */

class Loader
{
  public:
    explicit Loader(const std::string &path) { sources_.gltf = path; }
    Scene run(int scene);

  private:
    void parse();
    void check_storage();
    void check_view(int view, const std::string &what) const;
    void check_accessor(size_t number) const;
    void check_sparse(const tinygltf::Accessor &accessor, uint64_t element, const std::string &what) const;
    const uint8_t *element(int view, uint64_t offset) const;
    double component(const uint8_t *at, int type, bool normalised) const;
    std::vector<double> read(int accessor, int components, const std::string &what) const;
    std::vector<uint32_t> read_indices(int accessor, size_t vertices, const std::string &what) const;
    int element_size(const tinygltf::Accessor &accessor) const;

    std::vector<int> find_parents();
    std::vector<int> find_roots(int scene, const std::vector<int> &parent);
    void load_nodes(int scene);
    Node load_node(int number, int parent);
    int load_mesh(int number);
    void load_primitive(Mesh &mesh, const tinygltf::Primitive &source, const std::string &name);
    std::vector<uint32_t> triangulate(const tinygltf::Primitive &source, size_t vertices,
                                      const std::string &name);
    void load_uvs(Primitive &primitive, const tinygltf::Material *material,
                  const tinygltf::Primitive &source);
    int load_material(int number);
    void warn_material(const tinygltf::Material &material, const std::string &name);
    int load_image(int texture, const std::string &user);
    void load_camera();
    void load_animation();
    void load_channel(const tinygltf::Animation &animation, size_t number,
                      std::set<std::pair<int, int>> &seen);
    void warn_file();
    void warn(const std::string &what, const std::string &why);

    Sources sources_;
    tinygltf::Model model_;
    Scene scene_;
    std::vector<int> node_, mesh_, material_, image_; /* number in the file to number in scene_, -1 */
    std::set<std::string> warned_;
    uint64_t vertices_ = 0;
};

void Loader::warn(const std::string &what, const std::string &why)
{
    std::string line = what + ": " + why;
    if (warned_.insert(line).second) scene_.warnings.push_back(line);
}

void Loader::parse()
{
    std::vector<uint8_t> bytes = read_file(sources_.gltf);
    Container container = open_container(bytes);
    JsonScan scan = scan_json(container.json, container.json_size);
    if (!scan.version.empty()) check_version(scan.version);
    check_extensions(scan.required);

    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({source_exists, source_path, source_read, nullptr, &sources_});
    parser.SetImageLoader(keep_image, &sources_);
    std::string error, warning;
    bool done = false;
    try {
        auto size = static_cast<unsigned>(bytes.size());
        done = container.binary
                   ? parser.LoadBinaryFromMemory(&model_, &error, &warning, bytes.data(), size)
                   : parser.LoadASCIIFromString(&model_, &error, &warning, container.json, size, "");
    } catch (const std::bad_alloc &) {
        throw;
    } catch (const std::exception &exception) {
        error = exception.what();
    }
    if (!done && !sources_.failure.empty()) throw Error(sources_.failed_path, sources_.failure);
    /* A skin may lack inverseBindMatrices; tinygltf grumbles, and skins are not drawn anyway. */
    const std::string grumble = "'inverseBindMatrices' property is missing in Skin.\n";
    for (size_t at; done && (at = error.find(grumble)) != std::string::npos;) error.erase(at, grumble.size());
    if (!done && error.find("\"asset\" object") != std::string::npos)
        throw Error("asset.version", "missing, only glTF 2.0 is supported");
    if (!done || !error.empty())
        throw Error("not a valid glTF file", error.empty() ? "no reason known" : one_line(error));
    check_version(model_.asset.version);
    check_extensions(model_.extensionsRequired);
}

/* ---- accessors ---- */

int Loader::element_size(const tinygltf::Accessor &accessor) const
{
    return tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)) *
           tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
}

void Loader::check_view(int view, const std::string &what) const
{
    if (view < 0 || static_cast<size_t>(view) >= model_.bufferViews.size()) {
        throw Error(what, "buffer view " + std::to_string(view) + " does not exist");
    }
}

void Loader::check_storage()
{
    for (size_t i = 0; i < model_.bufferViews.size(); i++) {
        const tinygltf::BufferView &view = model_.bufferViews[i];
        if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= model_.buffers.size()) {
            throw Error(label("buffer view", i, view.name),
                        "buffer " + std::to_string(view.buffer) + " does not exist");
        }
        size_t size = model_.buffers[static_cast<size_t>(view.buffer)].data.size();
        if (view.byteOffset > size || view.byteLength > size - view.byteOffset) {
            throw Error(label("buffer view", i, view.name),
                        "ends outside its buffer of " + std::to_string(size) + " bytes");
        }
    }
    for (size_t i = 0; i < model_.accessors.size(); i++) check_accessor(i);
}

void Loader::check_accessor(size_t number) const
{
    const tinygltf::Accessor &accessor = model_.accessors[number];
    std::string what = label("accessor", number, accessor.name);
    int type = accessor.componentType;
    bool known = (type >= TINYGLTF_COMPONENT_TYPE_BYTE && type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) ||
                 type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT || type == TINYGLTF_COMPONENT_TYPE_FLOAT;
    if (!known) throw Error(what, "component type " + std::to_string(type) + " is not one of glTF 2.0");
    if (accessor.count > most_elements / 16)
        throw Error(what, "more than " + std::to_string(most_elements / 16) + " elements");
    auto size = static_cast<uint64_t>(element_size(accessor)); /* at most 64 */
    if (accessor.bufferView != -1) {
        check_view(accessor.bufferView, what);
        const tinygltf::BufferView &view = model_.bufferViews[static_cast<size_t>(accessor.bufferView)];
        int stride = accessor.ByteStride(view);
        if (stride < static_cast<int>(size))
            throw Error(what, "the stride of its buffer view does not fit its type");
        /* 2^22 elements of at most 252 bytes: below 2^30 */
        uint64_t span = accessor.count == 0 ? 0 : (accessor.count - 1) * static_cast<uint64_t>(stride) + size;
        if (accessor.byteOffset > view.byteLength || span > view.byteLength - accessor.byteOffset) {
            throw Error(what,
                        "ends outside its buffer view of " + std::to_string(view.byteLength) + " bytes");
        }
    }
    if (accessor.sparse.isSparse) check_sparse(accessor, size, what);
}

void Loader::check_sparse(const tinygltf::Accessor &accessor, uint64_t element, const std::string &what) const
{
    const auto &sparse = accessor.sparse;
    check_view(sparse.indices.bufferView, what);
    check_view(sparse.values.bufferView, what);
    int type = sparse.indices.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        throw Error(what, "sparse indices have component type " + std::to_string(type));
    }
    if (sparse.count < 0 || static_cast<uint64_t>(sparse.count) > accessor.count) {
        throw Error(what, "more sparse elements than elements");
    }
    auto fits = [&](int view, int offset, uint64_t size) {
        uint64_t length = model_.bufferViews[static_cast<size_t>(view)].byteLength;
        return offset >= 0 &&
               static_cast<uint64_t>(offset) + static_cast<uint64_t>(sparse.count) * size <= length;
    };
    auto index = static_cast<uint64_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type)));
    if (!fits(sparse.indices.bufferView, sparse.indices.byteOffset, index) ||
        !fits(sparse.values.bufferView, sparse.values.byteOffset, element)) {
        throw Error(what, "its sparse elements end outside their buffer view");
    }
}

const uint8_t *Loader::element(int view, uint64_t offset) const
{
    const tinygltf::BufferView &source = model_.bufferViews[static_cast<size_t>(view)];
    return model_.buffers[static_cast<size_t>(source.buffer)].data.data() + source.byteOffset + offset;
}

double Loader::component(const uint8_t *at, int type, bool normalised) const
{
    auto get = [at](auto value) {
        std::memcpy(&value, at, sizeof value); /* buffers are little-endian, and so is the host */
        return static_cast<double>(value);
    };
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return normalised ? std::max(get(int8_t{}) / 127, -1.0) : get(int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return get(uint8_t{}) / (normalised ? 255 : 1);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return normalised ? std::max(get(int16_t{}) / 32767, -1.0) : get(int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return get(uint16_t{}) / (normalised ? 65535 : 1);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return get(uint32_t{});
    default: return get(float{});
    }
}

/* All numbers of an accessor, sparse elements applied. */
std::vector<double> Loader::read(int number, int components, const std::string &what) const
{
    if (number < 0 || static_cast<size_t>(number) >= model_.accessors.size()) {
        throw Error(what, "accessor " + std::to_string(number) + " does not exist");
    }
    const tinygltf::Accessor &accessor = model_.accessors[static_cast<size_t>(number)];
    if (tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)) != components) {
        throw Error(what, "accessor " + std::to_string(number) + " does not have " +
                              std::to_string(components) + " components");
    }
    auto width = static_cast<size_t>(components);
    int type = accessor.componentType;
    auto bytes = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type)));
    std::vector<double> out(accessor.count * width);
    auto fetch = [&](size_t index, const uint8_t *at) {
        for (size_t c = 0; c < width; c++) {
            double value = component(at + c * bytes, type, accessor.normalized);
            if (!std::isfinite(value)) {
                throw Error(what, "element " + std::to_string(index) + " of accessor " +
                                      std::to_string(number) + " is not a finite number");
            }
            out[index * width + c] = value;
        }
    };
    if (accessor.bufferView != -1) {
        auto stride = static_cast<uint64_t>(
            accessor.ByteStride(model_.bufferViews[static_cast<size_t>(accessor.bufferView)]));
        for (size_t i = 0; i < accessor.count; i++) {
            fetch(i, element(accessor.bufferView, accessor.byteOffset + i * stride));
        }
    }
    if (!accessor.sparse.isSparse) return out;
    const auto &sparse = accessor.sparse;
    auto index_size = static_cast<size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(sparse.indices.componentType)));
    for (size_t i = 0; i < static_cast<size_t>(sparse.count); i++) {
        auto offset = static_cast<uint64_t>(sparse.indices.byteOffset) + i * index_size;
        double at =
            component(element(sparse.indices.bufferView, offset), sparse.indices.componentType, false);
        if (at >= static_cast<double>(accessor.count)) throw Error(what, "a sparse index is out of range");
        offset = static_cast<uint64_t>(sparse.values.byteOffset) + i * width * bytes;
        fetch(static_cast<size_t>(at), element(sparse.values.bufferView, offset));
    }
    return out;
}

std::vector<uint32_t> Loader::read_indices(int number, size_t vertices, const std::string &what) const
{
    std::vector<double> values = read(number, 1, what);
    const tinygltf::Accessor &accessor = model_.accessors[static_cast<size_t>(number)];
    int type = accessor.componentType;
    if (accessor.normalized ||
        (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
         type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
        throw Error(what, "its indices are not unsigned integers");
    }
    std::vector<uint32_t> indices(values.size());
    for (size_t i = 0; i < values.size(); i++) {
        indices[i] = static_cast<uint32_t>(values[i]);
        if (indices[i] >= vertices) {
            throw Error(what, "index " + std::to_string(indices[i]) + " is out of range, it has " +
                                  std::to_string(vertices) + " vertices");
        }
    }
    return indices;
}

/* ---- nodes ---- */

/* The parent of each node, -1 for none. Refuses two parents and cycles. */
std::vector<int> Loader::find_parents()
{
    size_t count = model_.nodes.size();
    std::vector<int> parent(count, -1);
    for (size_t i = 0; i < count; i++) {
        for (int child : model_.nodes[i].children) {
            if (child < 0 || static_cast<size_t>(child) >= count) {
                throw Error(label("node", i, model_.nodes[i].name),
                            "child " + std::to_string(child) + " does not exist");
            }
            int &known = parent[static_cast<size_t>(child)];
            std::string what =
                label("node", static_cast<size_t>(child), model_.nodes[static_cast<size_t>(child)].name);
            if (known == static_cast<int>(i)) warn(what, "listed twice by its parent, drawn once");
            else if (known != -1) {
                throw Error(what, "is a child of node " + std::to_string(known) + " and of node " +
                                      std::to_string(i));
            }
            known = static_cast<int>(i);
        }
    }
    /* With one parent each, whoever cannot be reached from a node without parent is in a cycle. */
    std::vector<int> stack;
    size_t reached = 0;
    std::vector<bool> seen(count, false);
    for (size_t i = 0; i < count; i++) {
        if (parent[i] == -1) stack.push_back(static_cast<int>(i));
    }
    while (!stack.empty()) {
        auto at = static_cast<size_t>(stack.back());
        stack.pop_back();
        if (seen[at]) continue;
        seen[at] = true, reached++;
        for (int child : model_.nodes[at].children) stack.push_back(child);
    }
    if (reached != count) {
        size_t at = static_cast<size_t>(std::find(seen.begin(), seen.end(), false) - seen.begin());
        throw Error(label("node", at, model_.nodes[at].name), "is its own ancestor");
    }
    return parent;
}

/* Nodes to start from: the scene's, but for those that another of them brings along. */
std::vector<int> Loader::find_roots(int scene, const std::vector<int> &parent)
{
    if (scene < 0) scene = model_.defaultScene;
    std::vector<int> roots;
    if (model_.scenes.empty() && scene <= 0) {
        warn("scene", "the file has none, all its nodes are drawn");
        for (size_t i = 0; i < parent.size(); i++) {
            if (parent[i] == -1) roots.push_back(static_cast<int>(i));
        }
        return roots;
    }
    if (scene < 0) scene = 0;
    if (static_cast<size_t>(scene) >= model_.scenes.size()) {
        throw Error("scene " + std::to_string(scene),
                    "does not exist, the file has " + std::to_string(model_.scenes.size()));
    }
    std::set<int> listed;
    for (int node : model_.scenes[static_cast<size_t>(scene)].nodes) {
        if (node < 0 || static_cast<size_t>(node) >= parent.size()) {
            throw Error("scene " + std::to_string(scene), "node " + std::to_string(node) + " does not exist");
        }
        if (listed.insert(node).second) roots.push_back(node);
    }
    auto brought = [&](int node) {
        std::string what =
            label("node", static_cast<size_t>(node), model_.nodes[static_cast<size_t>(node)].name);
        int above = parent[static_cast<size_t>(node)];
        if (above == -1) return false;
        for (; above != -1; above = parent[static_cast<size_t>(above)]) {
            if (!listed.count(above)) continue;
            warn(what, "listed by the scene and below node " + std::to_string(above) + ", drawn once");
            return true;
        }
        warn(what, "listed by the scene without its parent, whose transform is left out");
        return false;
    };
    roots.erase(std::remove_if(roots.begin(), roots.end(), brought), roots.end());
    return roots;
}

void Loader::load_nodes(int scene)
{
    std::vector<int> roots = find_roots(scene, find_parents());
    node_.assign(model_.nodes.size(), -1);
    std::vector<std::pair<int, int>> stack; /* number in the file, parent in scene_ */
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, -1});
    while (!stack.empty()) {
        auto [number, parent] = stack.back();
        stack.pop_back();
        if (node_[static_cast<size_t>(number)] != -1) continue;
        int here = static_cast<int>(scene_.nodes.size());
        node_[static_cast<size_t>(number)] = here;
        scene_.nodes.push_back(load_node(number, parent));
        const std::vector<int> &children = model_.nodes[static_cast<size_t>(number)].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            stack.push_back({*child, here});
    }
}

Node Loader::load_node(int number, int parent)
{
    const tinygltf::Node &source = model_.nodes[static_cast<size_t>(number)];
    Node node;
    node.label = label("node", static_cast<size_t>(number), source.name);
    node.parent = parent;
    auto check = [&](const std::vector<double> &values, size_t size, const char *name) {
        if (values.empty()) return false;
        if (values.size() != size)
            throw Error(node.label,
                        std::string(name) + " does not have " + std::to_string(size) + " numbers");
        for (double value : values) {
            if (!std::isfinite(value)) throw Error(node.label, std::string(name) + " is not finite");
        }
        return true;
    };
    if (check(source.matrix, 16, "matrix")) {
        node.has_matrix = true;
        for (size_t i = 0; i < 3; i++) {
            for (size_t j = 0; j < 4; j++) node.matrix.m[i][j] = source.matrix[j * 4 + i];
        }
        const double *m = source.matrix.data();
        if (std::fabs(m[3]) + std::fabs(m[7]) + std::fabs(m[11]) + std::fabs(m[15] - 1) > 1e-6) {
            throw Error(node.label, "the last row of its matrix is not 0 0 0 1");
        }
    }
    const std::vector<double> &t = source.translation, &r = source.rotation, &s = source.scale;
    if (check(t, 3, "translation")) node.translation = {t[0], t[1], t[2]};
    if (check(s, 3, "scale")) node.scale = {s[0], s[1], s[2]};
    if (check(r, 4, "rotation")) {
        Quat q = {r[0], r[1], r[2], r[3]};
        if (dot(q, q) < 1e-12) throw Error(node.label, "its rotation has no length");
        node.rotation = normalised(q);
    }
    if (source.skin >= 0 && source.mesh >= 0)
        warn(node.label, "has a skin, drawn in the shape it was bound in");
    if (source.mesh != -1) node.mesh = load_mesh(source.mesh);
    return node;
}

/* ---- meshes ---- */

int Loader::load_mesh(int number)
{
    if (number < 0 || static_cast<size_t>(number) >= model_.meshes.size()) {
        throw Error("mesh " + std::to_string(number), "does not exist");
    }
    int &known = mesh_[static_cast<size_t>(number)];
    if (known != -1) return known;
    const tinygltf::Mesh &source = model_.meshes[static_cast<size_t>(number)];
    Mesh mesh;
    mesh.label = label("mesh", static_cast<size_t>(number), source.name);
    for (size_t i = 0; i < source.primitives.size(); i++) {
        std::string name =
            source.primitives.size() == 1 ? mesh.label : mesh.label + " primitive " + std::to_string(i);
        load_primitive(mesh, source.primitives[i], name);
    }
    known = static_cast<int>(scene_.meshes.size());
    scene_.meshes.push_back(std::move(mesh));
    return known;
}

void Loader::load_primitive(Mesh &mesh, const tinygltf::Primitive &source, const std::string &name)
{
    if (source.mode < TINYGLTF_MODE_TRIANGLES || source.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        if (source.mode < 0 || source.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
            throw Error(name, "mode " + std::to_string(source.mode) + " is not one of glTF 2.0");
        }
        warn(name, source.mode == TINYGLTF_MODE_POINTS ? "points are left out" : "lines are left out");
        return;
    }
    auto position = source.attributes.find("POSITION");
    if (position == source.attributes.end()) {
        warn(name, "has no positions, left out");
        return;
    }
    if (!source.targets.empty()) warn(name, "morph targets are left out");
    if (source.attributes.count("COLOR_0")) warn(name, "vertex colours are left out");
    Primitive primitive;
    primitive.label = name;
    std::vector<double> p = read(position->second, 3, name);
    vertices_ += p.size() / 3;
    if (vertices_ > most_vertices)
        throw Error(name, "the scene has more than " + std::to_string(most_vertices) + " vertices");
    primitive.positions.resize(p.size() / 3);
    for (size_t i = 0; i < primitive.positions.size(); i++)
        primitive.positions[i] = {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
    primitive.triangles = triangulate(source, primitive.positions.size(), name);
    if (primitive.triangles.empty()) return;
    if (source.material != -1) {
        primitive.material = load_material(source.material);
        load_uvs(primitive, &model_.materials[static_cast<size_t>(source.material)], source);
    }
    mesh.primitives.push_back(std::move(primitive));
}

/* Strips and fans come in glTF's order: triangle i of a strip is (i, i + 1 + i % 2,
 * i + 2 - i % 2), of a fan (i + 1, i + 2, 0). */
std::vector<uint32_t> Loader::triangulate(const tinygltf::Primitive &source, size_t vertices,
                                          const std::string &name)
{
    std::vector<uint32_t> list;
    if (source.indices != -1) {
        list = read_indices(source.indices, vertices, name);
    } else {
        list.resize(vertices);
        for (size_t i = 0; i < vertices; i++) list[i] = static_cast<uint32_t>(i);
    }
    vertices_ += list.size() / 3;
    size_t left_over = source.mode == TINYGLTF_MODE_TRIANGLES ? list.size() % 3
                       : list.size() < 3                      ? list.size()
                                                              : 0;
    if (left_over != 0) {
        warn(name,
             "the last " + std::to_string(left_over) + " of its vertices make no triangle and are left out");
        list.resize(list.size() - left_over);
    }
    if (source.mode == TINYGLTF_MODE_TRIANGLES || list.empty()) return list;
    std::vector<uint32_t> out;
    out.reserve(3 * (list.size() - 2));
    for (size_t i = 0; i + 2 < list.size(); i++) {
        bool strip = source.mode == TINYGLTF_MODE_TRIANGLE_STRIP;
        size_t odd = i % 2;
        out.push_back(list[strip ? i : i + 1]);
        out.push_back(list[strip ? i + 1 + odd : i + 2]);
        out.push_back(list[strip ? i + 2 - odd : 0]);
    }
    return out;
}

/* KHR_texture_transform of one texture reference: uv' = offset + rotation * (scale * uv). */
struct TextureTransform {
    int set = 0;
    double a[2][3] = {{1, 0, 0}, {0, 1, 0}};
};

TextureTransform texture_transform(const tinygltf::TextureInfo &info, const std::string &name)
{
    TextureTransform out;
    out.set = info.texCoord;
    auto found = info.extensions.find("KHR_texture_transform");
    if (found == info.extensions.end()) return out;
    const tinygltf::Value &value = found->second;
    auto pair = [&](const char *key, double dflt, double result[2]) {
        result[0] = result[1] = dflt;
        if (!value.Has(key)) return;
        const tinygltf::Value &array = value.Get(key);
        if (array.ArrayLen() != 2 || !array.Get(0).IsNumber() || !array.Get(1).IsNumber()) {
            throw Error(name, std::string("KHR_texture_transform: ") + key + " is not two numbers");
        }
        for (int i = 0; i < 2; i++) result[i] = array.Get(i).GetNumberAsDouble();
    };
    double offset[2], scale[2];
    pair("offset", 0, offset);
    pair("scale", 1, scale);
    double angle = value.Has("rotation") ? value.Get("rotation").GetNumberAsDouble() : 0;
    if (value.Has("texCoord")) out.set = value.Get("texCoord").GetNumberAsInt();
    /* Counter-clockwise as one sees it, with v downwards: the extension's worked example
     * and its test model want this sign. */
    double c = std::cos(angle), s = std::sin(angle);
    double a[2][3] = {{c * scale[0], s * scale[1], offset[0]}, {-s * scale[0], c * scale[1], offset[1]}};
    std::memcpy(out.a, a, sizeof a);
    return out;
}

void Loader::load_uvs(Primitive &primitive, const tinygltf::Material *material,
                      const tinygltf::Primitive &source)
{
    const Material &baked = scene_.materials[static_cast<size_t>(primitive.material)];
    if (baked.image < 0) return;
    const tinygltf::TextureInfo &info = material->pbrMetallicRoughness.baseColorTexture;
    TextureTransform transform = texture_transform(info, baked.label);
    auto found = source.attributes.find("TEXCOORD_" + std::to_string(transform.set));
    primitive.uvs.resize(primitive.positions.size());
    if (found == source.attributes.end()) {
        warn(primitive.label,
             "has no texture coordinates " + std::to_string(transform.set) + ", drawn with those of (0, 0)");
        return;
    }
    std::vector<double> uv = read(found->second, 2, primitive.label);
    if (uv.size() / 2 < primitive.uvs.size())
        throw Error(primitive.label, "has fewer texture coordinates than positions");
    double lowest[2] = {0, 0}, most[2] = {1, 1};
    for (size_t i = 0; i < primitive.uvs.size(); i++) {
        double out[2];
        for (int k = 0; k < 2; k++) {
            out[k] = transform.a[k][0] * uv[2 * i] + transform.a[k][1] * uv[2 * i + 1] + transform.a[k][2];
            if (!std::isfinite(out[k])) throw Error(primitive.label, "texture coordinates are not finite");
            lowest[k] = std::min(lowest[k], out[k]), most[k] = std::max(most[k], out[k]);
        }
        primitive.uvs[i] = {out[0], out[1]};
    }
    int sampler = model_.textures[static_cast<size_t>(info.index)].sampler;
    if (sampler < 0) return;
    const tinygltf::Sampler &modes = model_.samplers[static_cast<size_t>(sampler)];
    int wrap[2] = {modes.wrapS, modes.wrapT};
    for (int k = 0; k < 2; k++) {
        /* Inside [0, 1] all modes draw the same. */
        if (wrap[k] == TINYGLTF_TEXTURE_WRAP_REPEAT || (lowest[k] >= 0 && most[k] <= 1)) continue;
        warn(baked.label, std::string("its texture is ") +
                              (wrap[k] == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE ? "clamped" : "mirrored") +
                              " in " + (k == 0 ? "u" : "v") + ", drawn repeating");
    }
}

/* ---- materials ---- */

int Loader::load_material(int number)
{
    if (number < 0 || static_cast<size_t>(number) >= model_.materials.size()) {
        throw Error("material " + std::to_string(number), "does not exist");
    }
    int &known = material_[static_cast<size_t>(number)];
    if (known != -1) return known;
    const tinygltf::Material &source = model_.materials[static_cast<size_t>(number)];
    Material material;
    material.label = label("material", static_cast<size_t>(number), source.name);
    warn_material(source, material.label);
    for (size_t i = 0; i < 3; i++) {
        double factor = source.pbrMetallicRoughness.baseColorFactor[i];
        if (!(factor >= 0 && factor <= 1))
            throw Error(material.label, "its base colour factor is outside 0 to 1");
        material.factor[i] = factor;
    }
    material.double_sided = source.doubleSided;
    int texture = source.pbrMetallicRoughness.baseColorTexture.index;
    if (texture != -1) material.image = load_image(texture, material.label);
    known = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back(material);
    return known;
}

void Loader::warn_material(const tinygltf::Material &material, const std::string &name)
{
    if (material.alphaMode == "MASK") warn(name, "has a transparency mask, drawn opaque");
    else if (material.alphaMode == "BLEND") warn(name, "is transparent, drawn opaque");
    else if (material.alphaMode != "OPAQUE" && !material.alphaMode.empty()) {
        throw Error(name, "alpha mode '" + printable(material.alphaMode) + "' is not one of glTF 2.0");
    }
    bool glows = material.emissiveTexture.index != -1;
    for (double factor : material.emissiveFactor) glows = glows || factor > 0;
    if (glows) warn(name, "its emissive colour is left out");
    if (material.normalTexture.index != -1) warn(name, "its normal texture is left out");
    if (material.occlusionTexture.index != -1) warn(name, "its occlusion texture is left out");
}

int Loader::load_image(int texture, const std::string &user)
{
    if (texture < 0 || static_cast<size_t>(texture) >= model_.textures.size()) {
        throw Error(user, "texture " + std::to_string(texture) + " does not exist");
    }
    const tinygltf::Texture &source = model_.textures[static_cast<size_t>(texture)];
    if (source.sampler < -1 || source.sampler >= static_cast<int>(model_.samplers.size())) {
        throw Error(label("texture", static_cast<size_t>(texture), source.name),
                    "its sampler does not exist");
    }
    if (source.source == -1) {
        warn(user, "its texture has no image of a known kind, drawn in one colour");
        return -1;
    }
    if (source.source < 0 || static_cast<size_t>(source.source) >= model_.images.size()) {
        throw Error(label("texture", static_cast<size_t>(texture), source.name), "its image does not exist");
    }
    auto number = static_cast<size_t>(source.source);
    if (image_[number] != -1) return image_[number];
    const tinygltf::Image &stored = model_.images[number];
    Image image;
    image.label = label("image", number, stored.name.empty() ? stored.uri : stored.name);
    const uint8_t *bytes = nullptr;
    size_t size = 0;
    if (stored.bufferView != -1) {
        check_view(stored.bufferView, image.label);
        bytes = element(stored.bufferView, 0);
        size = model_.bufferViews[static_cast<size_t>(stored.bufferView)].byteLength;
    } else if (number < sources_.images.size() && !sources_.images[number].empty()) {
        bytes = sources_.images[number].data();
        size = sources_.images[number].size();
    } else {
        throw Error(image.label, sources_.failure.empty() ? "has no data" : sources_.failure);
    }
    check_image_header(bytes, size, image.label);
    tinygltf::Image decoded;
    std::string error;
    if (!tinygltf::LoadImageData(&decoded, static_cast<int>(number), &error, nullptr, 0, 0, bytes,
                                 static_cast<int>(size), nullptr) ||
        decoded.component != 4 || decoded.width < 1 || decoded.height < 1) {
        throw Error(image.label, "cannot be decoded, the PNG or JPEG data is broken");
    }
    image.width = decoded.width, image.height = decoded.height, image.bits = decoded.bits;
    image.pixels = std::move(decoded.image);
    image_[number] = static_cast<int>(scene_.images.size());
    scene_.images.push_back(std::move(image));
    return image_[number];
}

/* ---- camera, animation, the rest ---- */

/* The first perspective camera in the order of the nodes. */
void Loader::load_camera()
{
    std::string orthographic;
    std::vector<std::pair<int, size_t>> users; /* node in scene_, node in the file */
    for (size_t i = 0; i < model_.nodes.size(); i++) {
        if (node_[i] != -1 && model_.nodes[i].camera != -1) users.push_back({node_[i], i});
    }
    std::sort(users.begin(), users.end());
    for (auto [node, number] : users) {
        int camera = model_.nodes[number].camera;
        if (camera < 0 || static_cast<size_t>(camera) >= model_.cameras.size()) {
            throw Error(scene_.nodes[static_cast<size_t>(node)].label,
                        "camera " + std::to_string(camera) + " does not exist");
        }
        const tinygltf::Camera &source = model_.cameras[static_cast<size_t>(camera)];
        std::string name = label("camera", static_cast<size_t>(camera), source.name);
        if (source.type == "orthographic") {
            if (orthographic.empty()) orthographic = name;
            continue;
        }
        if (!scene_.camera.label.empty()) {
            warn(name, "a further camera, left out");
            continue;
        }
        const tinygltf::PerspectiveCamera &lens = source.perspective;
        if (!(lens.yfov > 0 && lens.yfov < 3.14159)) throw Error(name, "yfov is outside 0 to pi");
        if (!(lens.znear > 0 && std::isfinite(lens.znear))) throw Error(name, "znear is not above 0");
        if (lens.zfar != 0) warn(name, "has a far plane, drawn to infinity");
        scene_.camera = {name, node, lens.yfov, lens.znear};
    }
    if (orthographic.empty()) return;
    if (scene_.camera.label.empty()) throw Error(orthographic, "orthographic cameras are not supported");
    warn(orthographic, "an orthographic camera, left out");
}

void Loader::load_animation()
{
    for (size_t i = 1; i < model_.animations.size(); i++) {
        warn(label("animation", i, model_.animations[i].name), "only the first animation is drawn, left out");
    }
    if (model_.animations.empty()) return;
    std::set<std::pair<int, int>> seen;
    const tinygltf::Animation &animation = model_.animations[0];
    for (size_t i = 0; i < animation.channels.size(); i++) load_channel(animation, i, seen);
}

void Loader::load_channel(const tinygltf::Animation &animation, size_t number,
                          std::set<std::pair<int, int>> &seen)
{
    const tinygltf::AnimationChannel &source = animation.channels[number];
    std::string what = label("animation", 0, animation.name) + " channel " + std::to_string(number);
    Channel channel;
    if (source.target_path == "translation") channel.path = Path::translation;
    else if (source.target_path == "rotation") channel.path = Path::rotation;
    else if (source.target_path == "scale") channel.path = Path::scale;
    else {
        warn(what, "moves '" + printable(source.target_path) + "', left out");
        return;
    }
    if (source.target_node == -1) return; /* glTF: to be ignored */
    if (source.target_node < 0 || static_cast<size_t>(source.target_node) >= model_.nodes.size()) {
        throw Error(what, "node " + std::to_string(source.target_node) + " does not exist");
    }
    channel.node = node_[static_cast<size_t>(source.target_node)];
    if (channel.node == -1) return; /* not in this scene */
    if (!seen.insert({channel.node, static_cast<int>(channel.path)}).second) {
        warn(what, "moves what a channel before it moves, left out");
        return;
    }
    if (source.sampler < 0 || static_cast<size_t>(source.sampler) >= animation.samplers.size()) {
        throw Error(what, "sampler " + std::to_string(source.sampler) + " does not exist");
    }
    const tinygltf::AnimationSampler &sampler = animation.samplers[static_cast<size_t>(source.sampler)];
    if (sampler.interpolation == "STEP") channel.interpolation = Interpolation::step;
    else if (sampler.interpolation == "CUBICSPLINE") channel.interpolation = Interpolation::cubic;
    else if (sampler.interpolation != "LINEAR") {
        throw Error(what, "interpolation '" + printable(sampler.interpolation) + "' is not one of glTF 2.0");
    }
    channel.times = read(sampler.input, 1, what);
    int width = channel.path == Path::rotation ? 4 : 3;
    size_t groups = channel.interpolation == Interpolation::cubic ? 3 : 1;
    channel.values = read(sampler.output, width, what);
    if (channel.times.empty() ||
        channel.values.size() != channel.times.size() * groups * static_cast<size_t>(width)) {
        throw Error(what, "does not have one value for each key time");
    }
    if (channel.times[0] < 0 || !std::is_sorted(channel.times.begin(), channel.times.end())) {
        throw Error(what, "its key times are below 0 or decrease");
    }
    for (size_t i = groups / 2; channel.path == Path::rotation && i < channel.times.size() * groups;
         i += groups) {
        double *v = &channel.values[4 * i];
        Quat q = {v[0], v[1], v[2], v[3]};
        if (dot(q, q) < 1e-12) throw Error(what, "a rotation has no length");
        q = normalised(q);
        v[0] = q.x, v[1] = q.y, v[2] = q.z, v[3] = q.w;
    }
    scene_.channels.push_back(std::move(channel));
}

void Loader::warn_file()
{
    for (const std::string &name : model_.extensionsUsed) {
        if (name == "KHR_lights_punctual") warn("lights", "left out, everything is drawn unlit");
        else if (!is_drawn_extension(name))
            warn("extension " + printable(name), "not supported, what it describes is left out");
    }
}

Scene Loader::run(int scene)
{
    parse();
    check_storage();
    warn_file();
    mesh_.assign(model_.meshes.size(), -1);
    material_.assign(model_.materials.size(), -1);
    image_.assign(model_.images.size(), -1);
    load_nodes(scene);
    load_camera();
    load_animation();
    return std::move(scene_);
}

} // namespace

Scene load_gltf(const std::string &path, int scene) { return Loader(path).run(scene); }

} // namespace bake
