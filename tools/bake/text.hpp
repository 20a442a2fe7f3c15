/* Words for messages. */
#ifndef BAKE_TEXT_HPP
#define BAKE_TEXT_HPP

#include <cstddef>
#include <string>

namespace bake
{

/* Text from a file, fit for one line of a terminal: valid UTF-8 without control
 * characters, cut after `most` bytes. */
std::string printable(const std::string &text, size_t most = 60);

/* "node 3 'wheel'". */
std::string label(const char *kind, size_t number, const std::string &name);

/* The parser's messages: they end in line feeds, the JSON library's start with its name. */
std::string one_line(std::string text);

} // namespace bake

#endif
