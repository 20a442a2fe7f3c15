#include "text.hpp"

#include <algorithm>
#include <cctype>

namespace bake
{

namespace
{

/* Length of the UTF-8 sequence that starts at `at`, 0 where there is none. */
size_t utf8_length(const std::string &text, size_t at)
{
    auto byte = [&](size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
    size_t length = byte(at) < 0x80   ? 1
                    : byte(at) < 0xC2 ? 0
                    : byte(at) < 0xE0 ? 2
                    : byte(at) < 0xF0 ? 3
                    : byte(at) < 0xF5 ? 4
                                      : 0;
    for (size_t i = 1; i < length; i++) {
        if ((byte(at + i) & 0xC0) != 0x80) return 0;
    }
    return length;
}

} // namespace

std::string printable(const std::string &text, size_t most)
{
    std::string line;
    for (size_t at = 0; at < text.size();) {
        if (line.size() >= most) return line + "...";
        size_t length = utf8_length(text, at);
        bool control = length == 1 && (static_cast<unsigned char>(text[at]) < 32 || text[at] == 127);
        line += length == 0 ? "?" : control ? " " : text.substr(at, length);
        at += length == 0 ? 1 : length;
    }
    return line;
}

std::string label(const char *kind, size_t number, const std::string &name)
{
    std::string text = std::string(kind) + " " + std::to_string(number);
    return name.empty() ? text : text + " '" + printable(name) + "'";
}

std::string one_line(std::string text)
{
    if (text.compare(0, 16, "[json.exception.") == 0)
        text.erase(0, std::min(text.find("] "), text.size() - 2) + 2);
    while (!text.empty() && (std::isspace(static_cast<unsigned char>(text.back())) || text.back() == '.')) {
        text.pop_back();
    }
    return printable(text, 200);
}

} // namespace bake
