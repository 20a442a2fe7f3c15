/* A look at a glTF file before the parser sees it. */
#ifndef BAKE_CONTAINER_HPP
#define BAKE_CONTAINER_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bake
{

/* Where the JSON text lies in the file. */
struct Container {
    bool binary = false;
    const char *json = nullptr;
    size_t json_size = 0;
};

/* Finds the JSON text; for GLB, checks the header and the first chunk. Throws Error. */
Container open_container(const std::vector<uint8_t> &bytes);

constexpr int deepest_json = 64;

struct JsonScan {
    std::string version;               /* asset.version, empty when not found */
    std::vector<std::string> required; /* extensionsRequired */
};

/* Walks over the text once, without recursion: the parser recurses into objects it keeps,
 * and 20,000 of them inside each other end it. Malformed text is left to the parser.
 * Throws Error where the nesting is deeper than deepest_json. */
JsonScan scan_json(const char *text, size_t size);

/* Throw Error for a glTF other than 2.x, and for a required extension that is not drawn. */
void check_version(const std::string &version);
void check_extensions(const std::vector<std::string> &required);
bool is_drawn_extension(const std::string &name);

} // namespace bake

#endif
