/* Colours and textures: sRGB, RGB565, resizing. */
#ifndef BAKE_IMAGE_HPP
#define BAKE_IMAGE_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model.hpp"

namespace bake
{

constexpr int largest_image = 16384; /* pixels, either way */

/* Looks at the first bytes of PNG or JPEG data. Throws Error with `what` where they are
 * neither, or where the picture is larger than largest_image either way or has more than
 * 2^26 pixels. */
void check_image_header(const uint8_t *bytes, size_t size, const std::string &what);

/* The sRGB transfer function and its inverse (IEC 61966-2-1), both [0, 1] to [0, 1]. */
double linear_from_srgb(double encoded);

/* The nearest RGB565 of a linear colour: each part encoded as sRGB, then rounded to its
 * 5 or 6 bits. */
uint16_t rgb565_from_linear(const double rgb[3]);

/* The power of two nearest to `size`, the larger of two equally near, at most `most`,
 * which is a power of two. */
int texture_size(int size, int most);

/* The picture multiplied by `factor` and resized to width x height, both done in linear
 * light. Each texel is the mean over the area it covers. */
std::vector<uint16_t> bake_texture(const Image &image, const double factor[3], int width, int height);

/* The mean of the whole picture times `factor`, linear. */
void mean_colour(const Image &image, const double factor[3], double rgb[3]);

} // namespace bake

#endif
