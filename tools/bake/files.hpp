/* Files: read whole within a limit, named inside a folder, written whole or not at all. */
#ifndef BAKE_FILES_HPP
#define BAKE_FILES_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bake
{

constexpr size_t largest_input = size_t{512} << 20;

/* The bytes of a regular file of at most largest_input bytes. Throws Error with `path`
 * as its file. */
std::vector<uint8_t> read_file(const std::string &path);

/* The path of `relative`, a URI's decoded path, inside the folder of the file `beside`.
 * Refuses absolute paths, schemes and whatever leaves the folder, also through a symbolic
 * link. On failure returns false and says why. */
bool resolve_beside(const std::string &beside, const std::string &relative, std::string &path,
                    std::string &why);

/* Writes `bytes` under a temporary name in the same folder and renames it to `path`;
 * whatever fails, `path` is left as it was. `input` must not be the same file. Throws
 * Error with `path` as its file. */
void write_file(const std::string &path, const std::vector<uint8_t> &bytes, const std::string &input);

} // namespace bake

#endif
