/* Quantising and choosing. */
#include "bake.hpp"

#include <algorithm>
#include <climits>
#include <map>
#include <tuple>
#include <unordered_map>

#include "image.hpp"

namespace bake
{

namespace
{

constexpr int most_uv_bits = 12;
constexpr int wanted_uv_bits = 5; /* steps of 1/32 texel */
constexpr uint32_t most_primitive_vertices = 65535;
constexpr size_t most_texels = size_t{1} << 28;

/* A box grows around points. */
struct Box {
    Vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    void add(Vec3 p)
    {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    Vec3 centre() const { return 0.5 * low + 0.5 * high; }
};

/* Position = origin + step * integer in [-32767, 32767], exactly as a reader computes it. */
struct Grid {
    Row row;
    Vec3 origin;
    double step = 0;

    Vec3 at(const BakedVertex &v) const { return origin + step * Vec3{1.0 * v.x, 1.0 * v.y, 1.0 * v.z}; }
};

struct VertexHash {
    size_t operator()(const BakedVertex &v) const
    {
        uint64_t hash = 0;
        for (int16_t part : {v.x, v.y, v.z, v.u, v.v})
            hash = (hash ^ static_cast<uint16_t>(part)) * 0x9E3779B97F4A7C15u;
        return static_cast<size_t>(hash >> 20);
    }
};

/* Largest i16 number of fraction bits that holds everything in [low, high] texels. */
int uv_bits_for(double low, double high)
{
    int bits = most_uv_bits;
    while (bits > 0 &&
           !(std::round(std::ldexp(low, bits)) >= -32768 && std::round(std::ldexp(high, bits)) <= 32767)) {
        bits--;
    }
    return bits;
}

/* Whole periods to take off, so that [low, high] lies around zero. */
double periods(double low, double high, double period)
{
    return std::floor((low / 2 + high / 2) / period + 0.5) * period;
}

/* How a primitive's texture coordinates are stored: all moved by one pair of whole
 * periods, or each triangle by its own. */
struct UvPlan {
    double size[2] = {0, 0}; /* of the texture, texels; 0 without one */
    double shift[2] = {0, 0};
    bool per_triangle = false;
    int bits = most_uv_bits;
};

struct MeshRange {
    uint16_t first = 0, count = 0;
};

class Baker
{
  public:
    Baker(Scene &scene, const Options &options) : scene_(scene), options_(options) {}
    Baked run();

  private:
    void choose_nodes();
    void find_motions();
    Mat34 local_at_start(int node) const;
    bool mirrors(int node);
    void bake_nodes();
    Grid make_grid(const Mesh &mesh) const;
    MeshRange bake_mesh(int mesh, bool mirror);
    UvPlan plan_uvs(const Primitive &primitive, const BakedMaterial &material);
    void uv_of(const Primitive &primitive, const uint32_t *corner, const UvPlan &plan, Vec2 uv[3]) const;
    BakedVertex quantise(Vec3 p, Vec2 uv, const Grid &grid, int uv_bits);
    void bake_primitive(const Primitive &primitive, const Grid &grid);
    void mirror_primitives(MeshRange from);
    uint16_t bake_material(int material);
    uint16_t bake_image(int image, const double factor[3], int width, int height);
    void bake_bounds();
    void bake_camera();
    void set_view(const Mat34 &world_from_view, double f, double near_z);
    void check_counts() const;
    void warn(const std::string &what, const std::string &why)
    {
        scene_.warnings.push_back(what + ": " + why);
    }

    Scene &scene_;
    const Options &options_;
    Baked out_;
    std::vector<Motion> motions_; /* of all nodes of scene_ */
    std::vector<Mat34> world_;    /* of all nodes of scene_, at time 0 */
    std::vector<bool> drawn_;     /* nodes that have something in or below them */
    std::vector<int> number_;     /* of the drawn ones in the file */
    double seconds_ = 0;
    std::map<std::pair<int, bool>, MeshRange> meshes_;
    std::map<int, uint16_t> materials_;
    std::map<std::tuple<int, double, double, double>, uint16_t> textures_;
    Vec3 centre_;
    double radius_ = 0;
};

void Baker::choose_nodes()
{
    drawn_.assign(scene_.nodes.size(), false);
    for (size_t i = scene_.nodes.size(); i-- > 0;) {
        const Node &node = scene_.nodes[i];
        if (node.mesh >= 0 && !scene_.meshes[static_cast<size_t>(node.mesh)].primitives.empty())
            drawn_[i] = true;
        if (drawn_[i] && node.parent >= 0) drawn_[static_cast<size_t>(node.parent)] = true;
    }
    int next = 0;
    for (bool drawn : drawn_) number_.push_back(drawn ? next++ : -1);
    out_.summary.empty_nodes = scene_.nodes.size() - static_cast<size_t>(next);
    if (next == 0) throw Error("scene", "there is nothing to draw in it, no node has triangles");
    if (next > 32767) throw Error("scene", std::to_string(next) + " nodes are more than the format's 32767");
}

/* Gathers the curves of every node; where all of them end is the animation's length. */
void Baker::find_motions()
{
    for (const Node &node : scene_.nodes) motions_.emplace_back(node);
    for (const Channel &channel : scene_.channels) {
        auto node = static_cast<size_t>(channel.node);
        if (scene_.nodes[node].has_matrix)
            throw Error(scene_.nodes[node].label, "is animated, but has a matrix");
        motions_[node].add(channel);
        seconds_ = std::max(seconds_, motions_[node].seconds());
    }
    for (size_t i = 0; i < scene_.nodes.size(); i++) {
        Mat34 local = local_at_start(static_cast<int>(i));
        int parent = scene_.nodes[i].parent;
        world_.push_back(parent < 0 ? local : world_[static_cast<size_t>(parent)] * local);
    }
}

Mat34 Baker::local_at_start(int node) const
{
    const Node &source = scene_.nodes[static_cast<size_t>(node)];
    if (source.has_matrix) return source.matrix;
    Pose pose = motions_[static_cast<size_t>(node)].at(0);
    return compose(pose.translation, pose.rotation, pose.scale);
}

/* Whether the node turns its triangles inside out, apart from its ancestors. A node that
 * grows from nothing has the sign it grows to. */
bool Baker::mirrors(int node)
{
    const Motion &motion = motions_[static_cast<size_t>(node)];
    double sign = determinant(local_at_start(node));
    bool changes = false;
    for (double ms = 0; motion.moves() && ms <= seconds_ * 1000; ms += options_.key_interval) {
        Vec3 s = motion.at(ms / 1000).scale;
        double now = s.x * s.y * s.z;
        if (sign == 0) sign = now;
        changes = changes || now * sign < 0;
    }
    if (changes) {
        warn(scene_.nodes[static_cast<size_t>(node)].label,
             "mirrors itself while it moves, its back sides are drawn then");
    }
    return sign < 0;
}

void Baker::bake_nodes()
{
    std::vector<bool> mirrored(scene_.nodes.size(), false);
    for (size_t i = 0; i < scene_.nodes.size(); i++) {
        if (!drawn_[i]) continue;
        const Node &source = scene_.nodes[i];
        BakedNode node;
        mirrored[i] = mirrors(static_cast<int>(i));
        if (source.parent >= 0) {
            auto parent = static_cast<size_t>(source.parent);
            node.parent = static_cast<int16_t>(number_[parent]);
            mirrored[i] = mirrored[i] != mirrored[parent];
        }
        if (motions_[i].moves()) {
            node.track = static_cast<int16_t>(bake_track(out_, motions_[i], seconds_, source.label));
        }
        Mat34 local = local_at_start(static_cast<int>(i));
        for (size_t k = 0; k < 3; k++) {
            node.local[k] =
                make_row({local.m[k][0], local.m[k][1], local.m[k][2], local.m[k][3]}, source.label);
        }
        if (source.mesh >= 0) {
            MeshRange range = bake_mesh(source.mesh, mirrored[i]);
            node.first_primitive = range.first, node.primitive_count = range.count;
        }
        out_.nodes.push_back(node);
    }
    if (!out_.tracks.empty())
        out_.duration = static_cast<uint32_t>(std::max(1.0, std::round(seconds_ * 1000)));
}

/* One grid for the whole mesh: corners that two of its primitives share stay together. */
Grid Baker::make_grid(const Mesh &mesh) const
{
    Box box;
    for (const Primitive &primitive : mesh.primitives) {
        for (uint32_t index : primitive.triangles) box.add(primitive.positions[index]);
    }
    Vec3 c = box.centre();
    double reach = std::max({box.high.x - c.x, box.high.y - c.y, box.high.z - c.z, 0.0});
    Grid grid;
    /* Grow the scale until the rounded row reaches all corners; once is the rule, a small
     * mesh far from its origin has few bits left for its scale. */
    for (double scale = reach * 32768 / 32767;;
         scale = scale * 1.0000001 + std::ldexp(1.0, std::max(grid.row.e, grid.row.e_last) - 30)) {
        grid.row = make_row({c.x, c.y, c.z, scale}, mesh.label);
        grid.origin = {grid.row.value(0), grid.row.value(1), grid.row.value(2)};
        grid.step = grid.row.value(3) / 32768;
        Vec3 a = box.high - grid.origin, b = grid.origin - box.low;
        if (std::max({a.x, a.y, a.z, b.x, b.y, b.z}) <= 32767.5 * grid.step) return grid;
    }
}

MeshRange Baker::bake_mesh(int mesh, bool mirror)
{
    auto found = meshes_.find({mesh, mirror});
    if (found != meshes_.end()) return found->second;
    auto other = meshes_.find({mesh, !mirror});
    size_t first = out_.primitives.size(), first_index = out_.indices.size();
    if (other != meshes_.end()) {
        mirror_primitives(other->second);
    } else {
        const Mesh &source = scene_.meshes[static_cast<size_t>(mesh)];
        if (source.primitives.empty()) return {};
        Grid grid = make_grid(source);
        for (const Primitive &primitive : source.primitives) bake_primitive(primitive, grid);
        for (size_t i = first_index; mirror && i < out_.indices.size(); i += 3) {
            std::swap(out_.indices[i + 1], out_.indices[i + 2]);
        }
    }
    if (out_.primitives.size() > 65535) throw Error("scene", "more primitives than the format's 65535");
    MeshRange range = {static_cast<uint16_t>(first), static_cast<uint16_t>(out_.primitives.size() - first)};
    meshes_[{mesh, mirror}] = range;
    return range;
}

/* The same vertices, turned the other way round. */
void Baker::mirror_primitives(MeshRange from)
{
    for (size_t i = from.first; i < static_cast<size_t>(from.first) + from.count; i++) {
        BakedPrimitive primitive = out_.primitives[i];
        size_t source = primitive.first_index;
        primitive.first_index = static_cast<uint32_t>(out_.indices.size());
        for (size_t k = 0; k < primitive.index_count; k += 3) {
            for (size_t corner : {0, 2, 1}) {
                uint16_t index = out_.indices[source + k + corner];
                out_.indices.push_back(index);
            }
        }
        out_.primitives.push_back(primitive);
    }
}

/* Texels of a triangle's corners, not yet moved. */
void texels_of(const Primitive &primitive, const uint32_t *corner, const UvPlan &plan, double out[2][3])
{
    for (int k = 0; k < 3; k++) {
        Vec2 uv = primitive.uvs[corner[k]];
        out[0][k] = uv.x * plan.size[0], out[1][k] = uv.y * plan.size[1];
    }
}

/* One move for the whole primitive where 5 fraction bits can be had that way, because it
 * keeps shared vertices shared; else each triangle its own, as near to zero as whole
 * periods bring it. */
UvPlan Baker::plan_uvs(const Primitive &primitive, const BakedMaterial &material)
{
    UvPlan plan;
    if (primitive.uvs.empty() || material.texture == 0xFFFF) return plan;
    const BakedTexture &texture = out_.textures[material.texture];
    plan.size[0] = 1 << texture.log2_width, plan.size[1] = 1 << texture.log2_height;
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    int own_bits = most_uv_bits;
    double widest = 0;
    for (size_t i = 0; i < primitive.triangles.size(); i += 3) {
        double t[2][3];
        texels_of(primitive, &primitive.triangles[i], plan, t);
        for (int k = 0; k < 2; k++) {
            double a = std::min({t[k][0], t[k][1], t[k][2]}), b = std::max({t[k][0], t[k][1], t[k][2]});
            double shift = periods(a, b, plan.size[k]);
            own_bits = std::min(own_bits, uv_bits_for(a - shift, b - shift));
            widest = std::max(widest, b - a);
            low[k] = std::min(low[k], a), high[k] = std::max(high[k], b);
        }
    }
    plan.bits = most_uv_bits;
    for (int k = 0; k < 2; k++) {
        plan.shift[k] = periods(low[k], high[k], plan.size[k]);
        plan.bits = std::min(plan.bits, uv_bits_for(low[k] - plan.shift[k], high[k] - plan.shift[k]));
    }
    if (plan.bits < wanted_uv_bits && own_bits > plan.bits) plan.bits = own_bits, plan.per_triangle = true;
    if (plan.bits < 1) {
        throw Error(primitive.label, "a triangle's texture coordinates span " +
                                         std::to_string(std::lround(std::min(widest, 1e9))) +
                                         " texels, the format holds 32767; try a smaller --texture-size");
    }
    if (plan.bits < wanted_uv_bits) {
        warn(primitive.label, "texture coordinates are rounded to 1/" + std::to_string(1 << plan.bits) +
                                  " texel, its triangles span up to " + std::to_string(std::lround(widest)) +
                                  " texels");
    }
    return plan;
}

/* Texels of the three corners as they are stored. */
void Baker::uv_of(const Primitive &primitive, const uint32_t *corner, const UvPlan &plan, Vec2 uv[3]) const
{
    if (plan.size[0] == 0) return;
    double t[2][3];
    texels_of(primitive, corner, plan, t);
    for (int k = 0; k < 2; k++) {
        double shift = plan.shift[k];
        if (plan.per_triangle) {
            shift = periods(std::min({t[k][0], t[k][1], t[k][2]}), std::max({t[k][0], t[k][1], t[k][2]}),
                            plan.size[k]);
        }
        for (int i = 0; i < 3; i++) (k == 0 ? uv[i].x : uv[i].y) = t[k][i] - shift;
    }
}

/* Rounds a corner to its grids and keeps the largest errors. */
BakedVertex Baker::quantise(Vec3 p, Vec2 uv, const Grid &grid, int uv_bits)
{
    auto steps = [&](double offset) {
        return static_cast<int16_t>(round_within(grid.step > 0 ? offset / grid.step : 0, -32767, 32767));
    };
    auto fixed = [&](double texels) {
        return static_cast<int16_t>(round_within(std::ldexp(texels, uv_bits), -32768, 32767));
    };
    Vec3 offset = p - grid.origin;
    BakedVertex v = {steps(offset.x), steps(offset.y), steps(offset.z), fixed(uv.x), fixed(uv.y)};
    Vec3 off = grid.at(v) - p;
    Summary &worst = out_.summary;
    worst.position_rounding =
        std::max({worst.position_rounding, std::fabs(off.x), std::fabs(off.y), std::fabs(off.z)});
    worst.uv_rounding = std::max({worst.uv_rounding, std::fabs(std::ldexp(v.u, -uv_bits) - uv.x),
                                  std::fabs(std::ldexp(v.v, -uv_bits) - uv.y)});
    return v;
}

bool together(const BakedVertex &a, const BakedVertex &b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* Vertices in the order of their first use; a new record starts before the 65536th. */
void Baker::bake_primitive(const Primitive &primitive, const Grid &grid)
{
    uint16_t material = bake_material(primitive.material);
    UvPlan plan = plan_uvs(primitive, out_.materials[material]);
    std::unordered_map<BakedVertex, uint16_t, VertexHash> known;
    BakedPrimitive record;
    auto begin = [&] {
        known.clear();
        record = {};
        record.first_vertex = static_cast<uint32_t>(out_.vertices.size());
        record.first_index = static_cast<uint32_t>(out_.indices.size());
        record.material = material;
        record.grid = grid.row;
        record.uv_bits = static_cast<uint8_t>(plan.bits);
    };
    auto end = [&] {
        record.vertex_count = static_cast<uint16_t>(known.size());
        record.index_count = static_cast<uint32_t>(out_.indices.size()) - record.first_index;
        if (record.index_count != 0) out_.primitives.push_back(record);
    };
    begin();
    for (size_t i = 0; i < primitive.triangles.size(); i += 3) {
        const uint32_t *corner = &primitive.triangles[i];
        Vec2 uv[3];
        uv_of(primitive, corner, plan, uv);
        BakedVertex v[3];
        for (int k = 0; k < 3; k++) v[k] = quantise(primitive.positions[corner[k]], uv[k], grid, plan.bits);
        if (together(v[0], v[1]) || together(v[1], v[2]) || together(v[2], v[0])) {
            out_.summary.flat_triangles++;
            continue;
        }
        if (known.size() + 3 > most_primitive_vertices) end(), begin();
        for (const BakedVertex &vertex : v) {
            auto [at, fresh] = known.insert({vertex, static_cast<uint16_t>(known.size())});
            if (fresh) out_.vertices.push_back(vertex);
            out_.indices.push_back(at->second);
        }
    }
    end();
}

uint16_t Baker::bake_material(int material)
{
    auto found = materials_.find(material);
    if (found != materials_.end()) return found->second;
    static const Material plain = {"default material", {1, 1, 1}, -1, false};
    const Material &source = material < 0 ? plain : scene_.materials[static_cast<size_t>(material)];
    BakedMaterial baked;
    baked.flags = source.double_sided ? 1 : 0;
    baked.tolerance = static_cast<uint16_t>(options_.tolerance);
    double colour[3] = {source.factor[0], source.factor[1], source.factor[2]};
    if (source.image >= 0) {
        const Image &image = scene_.images[static_cast<size_t>(source.image)];
        mean_colour(image, source.factor, colour);
        baked.texture =
            bake_image(source.image, source.factor, texture_size(image.width, options_.texture_width),
                       texture_size(image.height, options_.texture_height));
    }
    baked.colour = rgb565_from_linear(colour);
    auto same = std::find(out_.materials.begin(), out_.materials.end(), baked);
    auto number = static_cast<uint16_t>(same - out_.materials.begin());
    if (same == out_.materials.end()) out_.materials.push_back(baked);
    if (out_.materials.size() > 65535) throw Error("scene", "more materials than the format's 65535");
    return materials_[material] = number;
}

uint16_t Baker::bake_image(int image, const double factor[3], int width, int height)
{
    auto key = std::make_tuple(image, factor[0], factor[1], factor[2]);
    auto found = textures_.find(key);
    if (found != textures_.end()) return found->second;
    auto log2 = [](int n) {
        uint8_t bits = 0;
        while (n >> bits > 1) bits++;
        return bits;
    };
    if (out_.texels.size() > most_texels) throw Error("scene", "its textures take more than 512 MiB");
    BakedTexture texture = {static_cast<uint32_t>(out_.texels.size()), log2(width), log2(height)};
    std::vector<uint16_t> texels =
        bake_texture(scene_.images[static_cast<size_t>(image)], factor, width, height);
    out_.texels.insert(out_.texels.end(), texels.begin(), texels.end());
    out_.textures.push_back(texture);
    if (out_.textures.size() > 65535) throw Error("scene", "more textures than the format's 65535");
    return textures_[key] = static_cast<uint16_t>(out_.textures.size() - 1);
}

/* Around the middle of the box, over the vertices as they are stored, a little too large
 * rather than too small. */
void Baker::bake_bounds()
{
    std::vector<Vec3> points;
    for (size_t i = 0; i < scene_.nodes.size(); i++) {
        if (!drawn_[i]) continue;
        const BakedNode &node = out_.nodes[static_cast<size_t>(number_[i])];
        for (size_t p = node.first_primitive;
             p < static_cast<size_t>(node.first_primitive) + node.primitive_count; p++) {
            const BakedPrimitive &primitive = out_.primitives[p];
            Grid grid = {primitive.grid,
                         {primitive.grid.value(0), primitive.grid.value(1), primitive.grid.value(2)},
                         primitive.grid.value(3) / 32768};
            for (uint32_t v = 0; v < primitive.vertex_count; v++) {
                points.push_back(transform(world_[i], grid.at(out_.vertices[primitive.first_vertex + v])));
            }
        }
    }
    Box box;
    for (Vec3 p : points) box.add(p);
    centre_ = box.centre();
    for (Vec3 p : points) radius_ = std::max(radius_, length(p - centre_));
    if (!(radius_ > 0 && std::isfinite(radius_)))
        throw Error("scene", "its vertices span no finite space at time 0");
    /* Each part of the centre moves by half a unit of the row at most. */
    double largest = std::max({std::fabs(centre_.x), std::fabs(centre_.y), std::fabs(centre_.z), radius_});
    double radius = radius_ + std::ldexp(largest, -27);
    out_.bounds = make_row({centre_.x, centre_.y, centre_.z, radius}, "bounding sphere");
}

/* world_from_view: columns are the view's right, up and backwards directions, of length 1
 * and at right angles, and its place. */
void Baker::set_view(const Mat34 &world_from_view, double f, double near_z)
{
    for (size_t k = 0; k < 3; k++) {
        Vec3 axis = column(world_from_view, static_cast<int>(k));
        double offset = -dot(axis, column(world_from_view, 3));
        out_.camera.view[k] = make_row({axis.x, axis.y, axis.z, offset}, "camera");
    }
    if (!(f > 0.5 / 65536 && f <= 1024))
        throw Error("camera", "its field of view is outside what the format holds");
    out_.camera.focal = round_within(f * 65536, 1, 1024.0 * 65536);
    out_.camera.near_z = make_row({near_z, 0, 0, 0}, "camera");
}

/* Right, up and backwards from two directions, at `place`. */
Mat34 look(Vec3 backwards, Vec3 up, Vec3 place)
{
    Vec3 z = (1 / length(backwards)) * backwards;
    Vec3 x = cross(up, z);
    x = (1 / length(x)) * x;
    Vec3 y = cross(z, x);
    Mat34 out;
    const Vec3 columns[4] = {x, y, z, place};
    for (int j = 0; j < 4; j++)
        out.m[0][j] = columns[j].x, out.m[1][j] = columns[j].y, out.m[2][j] = columns[j].z;
    return out;
}

void Baker::bake_camera()
{
    const Camera &camera = scene_.camera;
    if (camera.label.empty()) {
        /* The sphere touches the edges of a square view: distance = radius / sin(45/2 degrees). */
        const Vec3 from = {0.5, 0.35, 1};
        double half = std::atan(1.0) / 2, distance = radius_ / std::sin(half);
        set_view(look(from, {0, 1, 0}, centre_ + (distance / length(from)) * from), 1 / std::tan(half),
                 distance / 20);
        out_.summary.camera =
            "none in the file: 45 degrees, from direction (0.5, 0.35, 1), the whole scene in a square view";
        return;
    }
    bool moves = false;
    for (int at = camera.node; at >= 0; at = scene_.nodes[static_cast<size_t>(at)].parent) {
        moves = moves || motions_[static_cast<size_t>(at)].moves();
    }
    if (moves) warn(camera.label, "is animated, drawn from where it is at time 0");
    const Mat34 &world = world_[static_cast<size_t>(camera.node)];
    Vec3 z = column(world, 2), y = column(world, 1);
    if (!(length(cross(y, z)) > 1e-12 * length(y) * length(z)) || !(length(y) * length(z) > 0)) {
        throw Error(camera.label, "its node is scaled to nothing");
    }
    set_view(look(z, (1 / length(y)) * y, column(world, 3)), 1 / std::tan(camera.yfov / 2), camera.znear);
    out_.summary.camera = camera.label;
}

void Baker::check_counts() const
{
    uint64_t bytes =
        out_.vertices.size() * 10 + out_.indices.size() * 2 + out_.texels.size() * 2 + out_.keys.size() * 32;
    if (bytes > (uint64_t{1} << 31)) throw Error("scene", "the baked file would be larger than 2 GiB");
}

Baked Baker::run()
{
    out_.key_interval = options_.key_interval;
    choose_nodes();
    find_motions();
    bake_nodes();
    if (out_.primitives.empty())
        throw Error("scene", "there is nothing to draw in it, all triangles are flat");
    bake_bounds();
    bake_camera();
    check_counts();
    return std::move(out_);
}

} // namespace

double Row::value(size_t k) const { return std::ldexp(static_cast<double>(m[k]), (k < 3 ? e : e_last) - 30); }

int32_t round_within(double value, double low, double high)
{
    return static_cast<int32_t>(std::round(std::min(std::max(value, low), high)));
}

Row make_row(const std::array<double, 4> &values, const std::string &what)
{
    Row row;
    for (double value : values) {
        if (!std::isfinite(value)) throw Error(what, "a number is not finite");
    }
    /* the first three share an exponent, the last has its own */
    const auto round_part = [&](size_t first, size_t end, int16_t &exponent) {
        double largest = 0;
        for (size_t k = first; k < end; k++) largest = std::max(largest, std::fabs(values[k]));
        int e = 0;
        if (largest == 0 || (std::frexp(largest, &e), e < -1000)) return;
        if (std::round(std::ldexp(largest, 30 - e)) == 1 << 30) e++;
        if (e > 1000) throw Error(what, "a number is too large");
        exponent = static_cast<int16_t>(e);
        for (size_t k = first; k < end; k++)
            row.m[k] = static_cast<int32_t>(std::round(std::ldexp(values[k], 30 - e)));
    };
    round_part(0, 3, row.e);
    round_part(3, 4, row.e_last);
    return row;
}

Baked bake_scene(Scene &scene, const Options &options) { return Baker(scene, options).run(); }

} // namespace bake
