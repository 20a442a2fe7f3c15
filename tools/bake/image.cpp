#include "image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace bake
{

namespace
{

struct Size {
    uint32_t width = 0, height = 0;
};

uint32_t big_endian(const uint8_t *at, int bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++) value = value << 8 | at[i];
    return value;
}

/* Walks from marker to marker up to the frame header. */
Size jpeg_size(const uint8_t *bytes, size_t size)
{
    size_t at = 2;
    while (at + 9 <= size && bytes[at] == 0xFF) {
        uint8_t marker = bytes[at + 1];
        if (marker == 0xFF) {
            at++; /* fill byte */
            continue;
        }
        bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        if (frame) return {big_endian(bytes + at + 7, 2), big_endian(bytes + at + 5, 2)};
        at += 2 + big_endian(bytes + at + 2, 2);
    }
    return {};
}

/* Sample value to linear light, for 8 bits a table. */
std::vector<double> linear_table(int bits)
{
    std::vector<double> table(size_t{1} << bits);
    for (size_t i = 0; i < table.size(); i++) {
        table[i] = linear_from_srgb(static_cast<double>(i) / static_cast<double>(table.size() - 1));
    }
    return table;
}

/* What a source position contributes to a target position: first source position, then
 * one weight each; they add up to 1. */
struct Span {
    int first = 0;
    std::vector<double> weights;
};

std::vector<Span> area_weights(int from, int to)
{
    std::vector<Span> spans(static_cast<size_t>(to));
    double step = static_cast<double>(from) / to;
    for (int i = 0; i < to; i++) {
        Span &span = spans[static_cast<size_t>(i)];
        double start = i * step, end = (i + 1) * step;
        span.first = std::min(static_cast<int>(start), from - 1);
        for (int s = span.first; s < from && s < end; s++) {
            double covered = std::min(end, s + 1.0) - std::max(start, static_cast<double>(s));
            span.weights.push_back(covered / step);
        }
    }
    return spans;
}

/* Rows of a picture in linear light, narrowed or widened to `columns`. */
class LinearRows
{
  public:
    LinearRows(const Image &image, int width)
        : image_(image), table_(linear_table(image.bits)), columns_(area_weights(image.width, width))
    {
    }

    void add(int row, double weight, std::vector<double> &sum) const
    {
        for (size_t x = 0; x < columns_.size(); x++) {
            const Span &span = columns_[x];
            for (size_t k = 0; k < span.weights.size(); k++) {
                size_t at = (static_cast<size_t>(row) * static_cast<size_t>(image_.width) +
                             static_cast<size_t>(span.first) + k) *
                            4;
                for (size_t c = 0; c < 3; c++)
                    sum[3 * x + c] += weight * span.weights[k] * table_[sample(at + c)];
            }
        }
    }

  private:
    size_t sample(size_t at) const
    {
        if (image_.bits == 8) return image_.pixels[at];
        uint16_t value;
        std::memcpy(&value, image_.pixels.data() + 2 * at, 2);
        return value;
    }

    const Image &image_;
    std::vector<double> table_;
    std::vector<Span> columns_;
};

/* Linear values between one level of `count` and the next: comparing with them rounds
 * the encoded value to the nearest level without encoding it. */
template <size_t count> std::array<double, count - 1> thresholds()
{
    std::array<double, count - 1> out;
    for (size_t i = 0; i + 1 < count; i++) {
        out[i] = linear_from_srgb((static_cast<double>(i) + 0.5) / static_cast<double>(count - 1));
    }
    return out;
}

template <size_t size> unsigned level(const std::array<double, size> &limits, double value)
{
    return static_cast<unsigned>(std::upper_bound(limits.begin(), limits.end(), value) - limits.begin());
}

} // namespace

void check_image_header(const uint8_t *bytes, size_t size, const std::string &what)
{
    Size found;
    if (size >= 24 && std::memcmp(bytes, "\x89PNG\r\n\x1A\n", 8) == 0) {
        found = {big_endian(bytes + 16, 4), big_endian(bytes + 20, 4)};
    } else if (size >= 4 && bytes[0] == 0xFF && bytes[1] == 0xD8) {
        found = jpeg_size(bytes, size);
    } else {
        throw Error(what, "neither PNG nor JPEG");
    }
    if (found.width == 0 || found.height == 0) throw Error(what, "cannot be decoded, it has no size");
    if (found.width > largest_image || found.height > largest_image ||
        static_cast<uint64_t>(found.width) * found.height > (uint64_t{1} << 26)) {
        throw Error(what, std::to_string(found.width) + "x" + std::to_string(found.height) +
                              " pixels are more than can be read (16384 either way, 2^26 in all)");
    }
}

double linear_from_srgb(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

uint16_t rgb565_from_linear(const double rgb[3])
{
    static const auto five = thresholds<32>();
    static const auto six = thresholds<64>();
    return static_cast<uint16_t>(level(five, rgb[0]) << 11 | level(six, rgb[1]) << 5 | level(five, rgb[2]));
}

int texture_size(int size, int most)
{
    int power = 1;
    while (power < most && 3 * power <= 2 * size) power *= 2; /* 2 power is as near as power, or nearer */
    return power;
}

std::vector<uint16_t> bake_texture(const Image &image, const double factor[3], int width, int height)
{
    LinearRows rows(image, width);
    std::vector<uint16_t> texels;
    std::vector<double> sum(3 * static_cast<size_t>(width));
    for (const Span &span : area_weights(image.height, height)) {
        std::fill(sum.begin(), sum.end(), 0);
        for (size_t k = 0; k < span.weights.size(); k++)
            rows.add(span.first + static_cast<int>(k), span.weights[k], sum);
        for (size_t x = 0; x < static_cast<size_t>(width); x++) {
            double rgb[3];
            for (size_t c = 0; c < 3; c++) rgb[c] = sum[3 * x + c] * factor[c];
            texels.push_back(rgb565_from_linear(rgb));
        }
    }
    return texels;
}

void mean_colour(const Image &image, const double factor[3], double rgb[3])
{
    LinearRows rows(image, 1);
    std::vector<double> sum(3, 0.0);
    for (int y = 0; y < image.height; y++) rows.add(y, 1.0 / image.height, sum);
    for (size_t c = 0; c < 3; c++) rgb[c] = sum[c] * factor[c];
}

} // namespace bake
