/* ew-bake: options, messages, exit codes. */
#include <argp.h>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>

#include "bake.hpp"
#include "edgewalk/edgewalk.h"
#include "files.hpp"

extern "C" {
#include "../common/options.h"
}

const char *argp_program_version = "ew-bake " EW_VERSION;

namespace
{

struct Command {
    std::string input, output, name = "scene";
    bool name_given = false, c_array = false, json = false;
    int scene = -1;
    bake::Options options;
};

enum Key { key_name = 256, key_c_array, key_json, key_scene, key_interval };

/* A decimal number from low to high. */
int number(argp_state *state, const char *option, const char *text, unsigned low, unsigned high)
{
    unsigned value = low;
    if (ew_parse_unsigned(text, low, high, &value)) {
        argp_error(state, "%s %s: not a number from %u to %u", option, text, low, high);
    }
    return static_cast<int>(value);
}

void texture_size(argp_state *state, const char *text, bake::Options &options)
{
    unsigned width = 0, height = 0;
    if (ew_parse_unsigned(text, 1, 2048, &width) == 0) height = width;
    else ew_parse_size(text, &width, &height);
    auto good = [](unsigned n) { return n >= 1 && n <= 2048 && (n & (n - 1)) == 0; };
    if (!good(width) || !good(height)) {
        argp_error(state, "--texture-size %s: not WxH or N, powers of two from 1 to 2048", text);
    }
    options.texture_width = static_cast<int>(width), options.texture_height = static_cast<int>(height);
}

int tolerance(argp_state *state, const char *text)
{
    double pixels = -1;
    if (ew_parse_double(text, 0, 16, &pixels) || pixels * 16 != std::floor(pixels * 16)) {
        argp_error(state, "--tolerance %s: not a multiple of 1/16 from 0 to 16", text);
    }
    return static_cast<int>(pixels * 16);
}

bool is_identifier(const char *text)
{
    if (*text == '\0' || std::strchr("0123456789", *text)) return false;
    const char *letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    return std::strspn(text, letters) == std::strlen(text);
}

error_t parse_option(int key, char *text, argp_state *state)
{
    Command &command = *static_cast<Command *>(state->input);
    switch (key) {
    case 'o': command.output = text; break;
    case 't': texture_size(state, text, command.options); break;
    case 'e': command.options.tolerance = tolerance(state, text); break;
    case key_scene: command.scene = number(state, "--scene", text, 0, 1000000); break;
    case key_interval: command.options.key_interval = number(state, "--key-interval", text, 1, 65535); break;
    case key_c_array: command.c_array = true; break;
    case key_json: command.json = true; break;
    case key_name:
        if (!is_identifier(text)) argp_error(state, "--name %s: not a C identifier", text);
        command.name = text, command.name_given = true;
        break;
    case ARGP_KEY_ARG:
        if (!command.input.empty()) argp_error(state, "%s: one model only", text);
        command.input = text;
        break;
    case ARGP_KEY_END:
        if (command.input.empty()) argp_error(state, "no model given");
        if (command.output.empty()) argp_error(state, "no output given (-o FILE)");
        if (command.name_given && !command.c_array) argp_error(state, "--name goes with --c-array");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

const argp_option options[] = {
    {"output", 'o', "FILE", 0, "Write the baked scene there", 0},
    {"texture-size", 't', "WxH", 0,
     "The largest a texture may become, powers of two from 1 to 2048; N means NxN (256)", 0},
    {"tolerance", 'e', "PX", 0, "Error that drawing may make, a multiple of 1/16 pixel from 0 to 16 (0.25)",
     0},
    {"scene", key_scene, "N", 0, "Bake this scene of the file instead of its default one", 0},
    {"key-interval", key_interval, "MS", 0, "Milliseconds from one key of a movement to the next (32)", 0},
    {"c-array", key_c_array, nullptr, 0, "Write C source instead of the binary file", 0},
    {"name", key_name, "NAME", 0, "With --c-array: name of the array (scene)", 0},
    {"json", key_json, nullptr, 0, "Print the summary as JSON", 0},
    {},
};

struct Report {
    const Command &command;
    const bake::Baked &baked;
    const std::vector<bake::SectionSize> &sections;
    size_t bytes, warnings;
};

std::string json_string(const std::string &text)
{
    std::string out = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
    return out + "\"";
}

void print_json(const Report &r)
{
    const bake::Baked &b = r.baked;
    const bake::Summary &s = b.summary;
    std::printf(
        "{\n  \"nodes\": %zu,\n  \"empty_nodes\": %zu,\n  \"primitives\": %zu,\n  \"vertices\": %zu,\n"
        "  \"triangles\": %zu,\n  \"flat_triangles\": %zu,\n  \"materials\": %zu,\n  \"textures\": %zu,\n"
        "  \"tracks\": %zu,\n  \"duration_ms\": %u,\n",
        b.nodes.size(), s.empty_nodes, b.primitives.size(), b.vertices.size(), b.indices.size() / 3,
        s.flat_triangles, b.materials.size(), b.textures.size(), b.tracks.size(),
        static_cast<unsigned>(b.duration));
    std::printf(
        "  \"position_rounding\": %.9g,\n  \"uv_rounding_texels\": %.9g,\n"
        "  \"translation_error\": %.9g,\n  \"rotation_error_degrees\": %.9g,\n  \"scale_error\": %.9g,\n",
        s.position_rounding, s.uv_rounding, s.translation_error, s.rotation_error, s.scale_error);
    std::printf("  \"camera\": %s,\n  \"warnings\": %zu,\n  \"bytes\": %zu,\n  \"sections\": {",
                json_string(s.camera).c_str(), r.warnings, r.bytes);
    for (const bake::SectionSize &section : r.sections) {
        std::printf("%s\"%s\": %u", &section == &r.sections[0] ? " " : ", ", section.tag.c_str(),
                    static_cast<unsigned>(section.count * section.bytes));
    }
    std::printf(" }\n}\n");
}

void print_text(const Report &r)
{
    const bake::Baked &b = r.baked;
    const bake::Summary &s = b.summary;
    std::printf("%s: %zu bytes from %s\n", r.command.output.c_str(), r.bytes, r.command.input.c_str());
    std::printf("  %zu nodes, %zu primitives, %zu vertices, %zu triangles, %zu materials, %zu textures\n",
                b.nodes.size(), b.primitives.size(), b.vertices.size(), b.indices.size() / 3,
                b.materials.size(), b.textures.size());
    if (s.empty_nodes != 0)
        std::printf("  left out: %zu of the model's nodes, with no mesh in or below them (a camera's view is kept)\n",
                    s.empty_nodes);
    if (s.flat_triangles != 0)
        std::printf("  left out: %zu triangles that cover nothing\n", s.flat_triangles);
    std::printf("  sections:");
    for (const bake::SectionSize &section : r.sections) {
        std::printf(" %s %u", section.tag.c_str(), static_cast<unsigned>(section.count * section.bytes));
    }
    std::printf("\n  rounding: positions %.3g units, texture coordinates %.3g texels\n", s.position_rounding,
                s.uv_rounding);
    if (b.duration != 0) {
        std::printf(
            "  movement: %zu tracks, %u ms, a key each %d ms; off by at most %.3g units, %.3g degrees, "
            "scale %.3g\n",
            b.tracks.size(), static_cast<unsigned>(b.duration), b.key_interval, s.translation_error,
            s.rotation_error, s.scale_error);
    }
    std::printf("  camera: %s\n", s.camera.c_str());
}

void run(const Command &command)
{
    bake::Scene scene = bake::load_gltf(command.input, command.scene);
    bake::Baked baked = bake::bake_scene(scene, command.options);
    for (const std::string &warning : scene.warnings) {
        std::fprintf(stderr, "ew-bake: %s: warning: %s\n", command.input.c_str(), warning.c_str());
    }
    std::vector<bake::SectionSize> sections;
    std::vector<uint8_t> file = bake::scene_file(baked, sections);
    bake::write_file(command.output, command.c_array ? bake::c_source(file, command.name) : file,
                     command.input);
    Report report = {command, baked, sections, file.size(), scene.warnings.size()};
    if (command.json) print_json(report);
    else print_text(report);
}

} // namespace

int main(int argc, char **argv)
{
    static const argp parser = {
        options,
        parse_option,
        "MODEL",
        "Bakes a glTF 2.0 model (.glb or .gltf) into a scene file for edgewalk.\v"
        "What cannot be drawn is named on stderr, one line each. Exit code: 0 done, 1 failed, "
        "2 wrong usage.",
        nullptr,
        nullptr,
        nullptr};
    argp_err_exit_status = 2;
    Command command;
    argp_parse(&parser, argc, argv, 0, nullptr, &command);
    try {
        run(command);
    } catch (const bake::Error &error) {
        std::fprintf(stderr, "ew-bake: %s: %s\n", (error.file.empty() ? command.input : error.file).c_str(),
                     error.what());
        return 1;
    } catch (const std::bad_alloc &) {
        std::fprintf(stderr, "ew-bake: %s: cannot be baked: not enough memory\n", command.input.c_str());
        return 1;
    }
    if (std::fflush(stdout) != 0) {
        std::fprintf(stderr, "ew-bake: standard output: cannot be written: %s\n", std::strerror(errno));
        return 1;
    }
    return 0;
}
