#include "pictures.h"

#include <string.h>

#include "cases.h"

void random_target(ew_target *target)
{
    memset(target, 0, sizeof *target);
    target->format = (uint8_t)(pick(2) ? EW_TARGET_RGB565 : pick(6));
    target->width = (uint16_t)(1 + pick(PICTURE_WIDTH));
    target->height = (uint16_t)(1 + pick(PICTURE_HEIGHT));
    target->stride = (uint16_t)((target->width + 7) / 8 * 8);
    target->dither = (uint8_t)pick(2);
    static uint16_t depth;
    target->depth = pick(5) ? &depth : NULL;
}

void target_rows(ew_target *target, picture *p, uint16_t first_row, uint16_t rows)
{
    static const uint8_t bits[] = { 16, 16, 8, 8, 4, 1 };
    const size_t before = (size_t)first_row * target->stride;
    target->colour = (uint8_t *)p->colour + before * bits[target->format] / 8;
    target->depth = target->depth ? p->depth + before : NULL;
    target->first_row = first_row;
    target->height = rows;
}

enum { TEXELS = 128 * 128 * 3 / 2 };

static uint16_t texels[TEXELS];

static uint16_t random_size(void) { return (uint16_t)(pick(2) ? 1u << pick(8) : 1 + pick(128)); }

static void random_texture(ew_texture *t)
{
    for (int i = 0; i < TEXELS && !texels[TEXELS - 1]; i++) texels[i] = (uint16_t)(test_random() | 1u);
    memset(t, 0, sizeof *t);
    t->texels = texels, t->palette = texels, t->mask = (const uint8_t *)texels;
    t->width = random_size(), t->height = random_size();
    t->key = texels[pick(64)];
    if (pick(2)) return;
    t->format = (uint8_t)pick(6);
    t->wrap_u = (uint8_t)pick(3), t->wrap_v = (uint8_t)pick(3);
    for (int larger = t->width > t->height ? t->width : t->height; larger > 1 && pick(4); larger /= 2) t->levels++;
    if (t->format) t->key &= t->format == EW_TEXTURE_PALETTE1 ? 1 : t->format == EW_TEXTURE_PALETTE4 ? 15 : 255;
}

void random_material(ew_material *m, ew_texture *texture)
{
    random_texture(texture);
    memset(m, 0, sizeof *m);
    m->texture = pick(8) ? texture : NULL;
    m->colour = (uint16_t)test_random();
    m->tolerance = (uint16_t)(pick(3) ? pick(17) : pick(EW_TOLERANCE_MAX + 1));
    m->rung = (uint8_t)(pick(2) ? EW_RUNG_AUTO : pick(EW_RUNG_COUNT));
    m->flags = EW_DOUBLE_SIDED;
    if (pick(2)) return;
    m->flags |= (uint8_t)pick(128);
    m->blend = (uint8_t)pick(3);
    m->filter = (uint8_t)pick(3);
}

void random_attributes(ew_raster_vertex v[3])
{
    const uint32_t texels_apart = UINT32_C(1) << (12 + pick(13)), near = pick(4), far = pick(16);
    for (int k = 0; k < 3; k++) {
        v[k].w = UINT32_C(0x80000000) >> near >> pick(far + 1);
        v[k].w -= test_random() % (v[k].w / 2u);
        v[k].u = (int32_t)pick(texels_apart), v[k].v = (int32_t)pick(texels_apart);
        v[k].colour = (ew_colour888){ (uint8_t)pick(256), (uint8_t)pick(256), (uint8_t)pick(256) };
    }
}

void random_scissor(ew_rect *rect, const ew_target *target)
{
    *rect = (ew_rect){ 0, target->first_row, target->width, (uint16_t)(target->first_row + target->height) };
    if (pick(2)) return;
    rect->x0 = (uint16_t)pick(target->width), rect->x1 = (uint16_t)(rect->x0 + pick(target->width - rect->x0 + 1u));
    rect->y0 = (uint16_t)(target->first_row + pick(target->height));
    rect->y1 = (uint16_t)(rect->y0 + pick((uint32_t)(target->first_row + target->height - rect->y0) + 1u));
}

void picture_fill(picture *p, uint32_t seed)
{
    uint32_t a = seed | 1u;
    for (size_t i = 0; i < sizeof p->colour / sizeof *p->colour; i++) {
        a ^= a << 13, a ^= a >> 17, a ^= a << 5;
        p->colour[i] = (uint16_t)a;
        p->depth[i] = (uint16_t)(a >> 16 & 0x3FFFu);
    }
}
