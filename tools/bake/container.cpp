#include "container.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <iterator>

#include "model.hpp"
#include "text.hpp"

namespace bake
{

namespace
{

const char *const drawn_extensions[] = {"KHR_mesh_quantization", "KHR_materials_unlit",
                                        "KHR_texture_transform"};

uint32_t u32_at(const std::vector<uint8_t> &bytes, size_t at)
{
    return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | static_cast<uint32_t>(bytes[at + 3]) << 24;
}

Container open_glb(const std::vector<uint8_t> &bytes)
{
    if (bytes.size() < 20) throw Error("GLB", "truncated: the file ends inside the header");
    uint32_t version = u32_at(bytes, 4), size = u32_at(bytes, 8), json_size = u32_at(bytes, 12);
    if (version == 1) throw Error("glTF 1.0", "not supported, only glTF 2.0 is");
    if (version != 2) throw Error("GLB", "version " + std::to_string(version) + " is not known");
    if (size > bytes.size()) {
        throw Error("GLB",
                    "truncated: " + std::to_string(bytes.size()) + " of " + std::to_string(size) + " bytes");
    }
    if (u32_at(bytes, 16) != 0x4E4F534A) throw Error("GLB", "the first chunk is not JSON");
    if (size < 20 || json_size > size - 20) throw Error("GLB", "the JSON chunk ends outside the file");
    return {true, reinterpret_cast<const char *>(bytes.data()) + 20, json_size};
}

class Scanner
{
  public:
    Scanner(const char *text, size_t size) : at_(text), end_(text + size) {}

    JsonScan run()
    {
        while (at_ < end_) {
            char c = *at_++;
            if (c == '"') string();
            else if (c == '{' || c == '[') open(c);
            else if (c == '}' || c == ']') close();
            else if (c == ':') value_ = true;
            else if (c == ',') value_ = false;
        }
        return found_;
    }

  private:
    void open(char c)
    {
        if (depth_ == deepest_json) {
            throw Error("JSON", "nested deeper than " + std::to_string(deepest_json) + " levels");
        }
        kind_[depth_++] = c;
        value_ = false;
    }

    void close()
    {
        if (depth_ > 0) depth_--;
        value_ = false;
    }

    /* Escapes are kept as they stand: an escaped key is not recognised here, and the
     * check after parsing finds it. */
    void string()
    {
        const char *start = at_;
        while (at_ < end_ && *at_ != '"') at_ += *at_ == '\\' && at_ + 1 < end_ ? 2 : 1;
        std::string text(start, at_);
        if (at_ < end_) at_++;
        bool in_object = depth_ > 0 && kind_[depth_ - 1] == '{';
        if (in_object && !value_) {
            if (depth_ <= 2) key_[depth_ - 1] = text;
        } else if (depth_ == 2 && kind_[0] == '{') {
            if (in_object && key_[0] == "asset" && key_[1] == "version") found_.version = text;
            if (!in_object && key_[0] == "extensionsRequired") found_.required.push_back(text);
        }
    }

    const char *at_, *end_;
    JsonScan found_;
    char kind_[deepest_json] = {};
    std::string key_[2];
    int depth_ = 0;
    bool value_ = false; /* a colon came, the next string is a value */
};

} // namespace

Container open_container(const std::vector<uint8_t> &bytes)
{
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) return open_glb(bytes);
    const char *text = reinterpret_cast<const char *>(bytes.data());
    size_t start = bytes.size() >= 3 && std::memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    while (start < bytes.size() && std::isspace(bytes[start])) start++;
    if (start == bytes.size() || text[start] != '{')
        throw Error("not a glTF file", "neither GLB nor JSON text");
    return {false, text, bytes.size()};
}

bool is_drawn_extension(const std::string &name)
{
    return std::find(std::begin(drawn_extensions), std::end(drawn_extensions), name) !=
           std::end(drawn_extensions);
}

void check_version(const std::string &version)
{
    if (version.compare(0, 2, "2.") == 0) return;
    if (version.compare(0, 2, "1.") == 0 || version.compare(0, 2, "0.") == 0) {
        throw Error("glTF " + printable(version), "not supported, only glTF 2.0 is");
    }
    throw Error("asset.version", "'" + printable(version) + "' is not a version of glTF 2");
}

void check_extensions(const std::vector<std::string> &required)
{
    for (const std::string &name : required) {
        if (!is_drawn_extension(name))
            throw Error("extension " + printable(name), "required by the file, not supported");
    }
}

JsonScan scan_json(const char *text, size_t size) { return Scanner(text, size).run(); }

} // namespace bake
