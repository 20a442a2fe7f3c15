/* Pixels in the widths of panel controllers: panel.h has the layouts. */
#include "edgewalk/panel.h"

size_t ew_pack_rgb666(const uint16_t *rgb565, size_t n, uint8_t *out)
{
    for (size_t i = 0; i < n; i++) {
        const uint16_t p = rgb565[i];
        const unsigned r = p >> 11, g = p >> 5 & 63u, b = p & 31u;
        *out++ = (uint8_t)(r << 3 | (r >> 4) << 2); /* 4 (2 r + floor(r / 16)) */
        *out++ = (uint8_t)(g << 2);
        *out++ = (uint8_t)(b << 3 | (b >> 4) << 2);
    }
    return 3 * n;
}

/* Twelve bits. */
static unsigned rgb444_of(uint16_t p)
{
    const unsigned g = p >> 5 & 63u;
    return (unsigned)(p >> 12) << 8 | (61u * g + 121u) >> 8 << 4 | (p >> 1 & 15u); /* 61 * 63 + 121 < 2^12 */
}

size_t ew_pack_rgb444(const uint16_t *rgb565, size_t n, uint8_t *out)
{
    uint8_t *const start = out;
    for (size_t i = 0; i < n; i += 2) {
        const unsigned first = rgb444_of(rgb565[i]), second = i + 1 < n ? rgb444_of(rgb565[i + 1]) : 0;
        *out++ = (uint8_t)(first >> 4);
        *out++ = (uint8_t)((first & 15u) << 4 | second >> 8);
        if (i + 1 < n) *out++ = (uint8_t)(second & 255u);
    }
    return (size_t)(out - start);
}
