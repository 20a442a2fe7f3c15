/* The raster context: target, scissor, material, clearing. */
#include "edgewalk/raster.h"

int ew_raster_init(ew_raster *raster, const ew_target *target)
{
    if (!target->colour || target->width < 1 || target->width > EW_TARGET_MAX || target->height < 1 ||
        target->height > EW_TARGET_MAX || target->stride < target->width) {
        return EW_ERR_ARGUMENT;
    }
    raster->target = *target;
    raster->scissor.x0 = raster->scissor.y0 = 0;
    raster->scissor.x1 = target->width;
    raster->scissor.y1 = target->height;
    ew_material black = { .rung = EW_RUNG_CONSTANT };
    return ew_raster_set_material(raster, &black);
}

int ew_raster_set_scissor(ew_raster *raster, const ew_rect *rect)
{
    if (rect->x0 > rect->x1 || rect->y0 > rect->y1 || rect->x1 > raster->target.width ||
        rect->y1 > raster->target.height) {
        return EW_ERR_ARGUMENT;
    }
    raster->scissor = *rect;
    return EW_OK;
}

static int is_texture_size(uint32_t size) { return size >= 1 && size <= EW_TEXTURE_MAX && !(size & (size - 1)); }

int ew_raster_set_material(ew_raster *raster, const ew_material *material)
{
    const ew_texture *texture = material->texture;
    if (material->rung >= EW_RUNG_COUNT || material->tolerance > EW_TOLERANCE_MAX ||
        (material->flags & ~(EW_DOUBLE_SIDED | EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE)) ||
        (texture && (!texture->texels || !is_texture_size(texture->width) || !is_texture_size(texture->height)))) {
        return EW_ERR_ARGUMENT;
    }
    raster->material = *material;
    if (material->rung == EW_RUNG_CONSTANT) texture = NULL; /* one colour, whatever else is there */
    if (texture) {
        raster->texture = *texture;
        raster->log2_width = (uint8_t)(31 - ew_clz32(texture->width));
        raster->log2_height = (uint8_t)(31 - ew_clz32(texture->height));
        raster->material.texture = &raster->texture;
    } else {
        raster->material.texture = NULL;
        raster->texture.texels = NULL;
        raster->texture.width = raster->texture.height = 1;
        raster->log2_width = raster->log2_height = 0;
    }
    return EW_OK;
}

void ew_raster_clear(ew_raster *raster, uint16_t rgb565)
{
    const ew_rect *r = &raster->scissor;
    for (uint16_t y = r->y0; y < r->y1; y++) {
        size_t row = (size_t)y * raster->target.stride;
        for (uint16_t x = r->x0; x < r->x1; x++) {
            raster->target.colour[row + x] = rgb565;
            if (raster->target.depth) raster->target.depth[row + x] = 0;
        }
    }
}
