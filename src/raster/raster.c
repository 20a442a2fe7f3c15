/* The raster context: target, scissor, material, fog, clearing. */
#include "edgewalk/raster.h"

#include "fill.h"
#include "loops.h"
#include "pixel.h"
#include "target.h"
#include "texture.h"
#include "triangle.h"

/* All rows of the target. */
static void scissor_rows(ew_raster *raster)
{
    raster->scissor.y0 = raster->target.first_row;
    raster->scissor.y1 = (uint16_t)(raster->target.first_row + raster->target.height);
}

int ew_raster_init(ew_raster *raster, const ew_target *target)
{
    int error = ew_target_check(target);
    if (error) return error;
    raster->target = *target;
    raster->scissor.x0 = 0;
    raster->scissor.x1 = target->width;
    scissor_rows(raster);
    /* a share of 0 whatever 1/z is */
    raster->fog_near = raster->fog_far = raster->fog_scale = 0;
    raster->fog_colour = 0;
    raster->fog_shift = 0;
    ew_raster_set_cost(raster, &ew_cost_generic);
    ew_material black = { .rung = EW_RUNG_CONSTANT };
    return ew_raster_set_material(raster, &black);
}

int ew_raster_set_scissor(ew_raster *raster, const ew_rect *rect)
{
    const ew_target *target = &raster->target;
    if (rect->x1 > target->width || rect->x0 > rect->x1 || rect->y1 > target->first_row + target->height ||
        rect->y0 > rect->y1 || rect->y0 < target->first_row) {
        return EW_ERR_ARGUMENT;
    }
    raster->scissor = *rect;
    return EW_OK;
}

int ew_raster_set_rows(ew_raster *raster, void *colour, uint16_t *depth, uint16_t first_row, uint16_t height)
{
    ew_target target = raster->target;
    target.colour = colour;
    target.depth = depth;
    target.first_row = first_row;
    target.height = height;
    const int error = ew_target_check(&target);
    if (error) return error;
    if (!depth != !raster->target.depth) return EW_ERR_ARGUMENT;
    raster->target = target;
    scissor_rows(raster);
    return EW_OK;
}

/* ---- material ---- */

enum { KNOWN_FLAGS = EW_DOUBLE_SIDED | EW_NO_DEPTH_TEST | EW_NO_DEPTH_WRITE | EW_SHADED | EW_COLOUR_KEY | EW_ALPHA_MASK | EW_FOG };

static int check_material(const ew_material *m)
{
    if (m->rung >= EW_RUNG_COUNT || m->tolerance > EW_TOLERANCE_MAX || (m->flags & ~KNOWN_FLAGS) ||
        m->blend > EW_BLEND_ADD || m->filter > EW_FILTER_TRILINEAR) {
        return EW_ERR_ARGUMENT;
    }
    int error = m->texture ? ew_texture_check(m->texture, m->filter, m->flags) : EW_OK;
    if (error) return error;
    if ((!EW_WITH_SHADING && (m->flags & EW_SHADED)) || (!EW_WITH_FOG && (m->flags & EW_FOG)) ||
        (!EW_WITH_BLENDS && m->blend)) {
        return EW_ERR_UNSUPPORTED;
    }
    return EW_OK;
}

/* Rounded up. */
static uint8_t log2_of(uint32_t size) { return (uint8_t)(32 - ew_clz32(size - 1u)); }

int ew_raster_set_material(ew_raster *raster, const ew_material *material)
{
    int error = check_material(material);
    if (error) return error;
    const ew_texture *texture = material->rung == EW_RUNG_CONSTANT ? NULL : material->texture;
    const ew_texture none = { .width = 1, .height = 1 };
    raster->texture = texture ? *texture : none;
    raster->material = *material;
    raster->material.texture = texture ? &raster->texture : NULL;
    raster->inverse_width = ew_texture_inverse(raster->texture.width);
    raster->inverse_height = ew_texture_inverse(raster->texture.height);
    raster->log2_width = log2_of(raster->texture.width);
    raster->log2_height = log2_of(raster->texture.height);
    raster->loop = ew_loop_of(raster);
    if (raster->loop == LOOP_TEXTURED) ew_packing_init(&raster->work.packing, raster);
    return EW_OK;
}

/* ---- fog ---- */

int ew_raster_set_fog(ew_raster *raster, uint16_t rgb565, ew_uq1_31 w_near, ew_uq1_31 w_far)
{
    const int64_t range = (int64_t)w_near - w_far;
    if (range <= 0 || w_near > 0x80000000u) return EW_ERR_ARGUMENT;
    if (!EW_WITH_FOG) return EW_ERR_UNSUPPORTED;
    uint32_t steps = (uint32_t)range; /* 1 to 2^31 */
    raster->fog_shift = 0;
    for (; steps > 0xFFFFu; steps >>= 1) raster->fog_shift++;
    raster->fog_colour = rgb565;
    raster->fog_near = w_near;
    raster->fog_far = w_far;
    raster->fog_scale = (0x7FFFFFFFu + steps) / steps; /* steps: 1 to 2^16 - 1 */
    return EW_OK;
}

/* ---- clear ---- */

/* n items become `value`, as far as may be two at a time: 3 instructions for each would be a fifth of a frame
 * of scene B. */
static EW_HOT void fill_words(uint16_t *at, uint32_t n, uint16_t value)
{
    uint32_t i = 0;
    if (n > 0 && (uintptr_t)at % 4u) at[i++] = value;
    for (; i + 16u <= n; i += 16) {
        uint16_t *to = at + i;
        EW_STORE_TWICE(to, value), EW_STORE_TWICE(to + 2, value), EW_STORE_TWICE(to + 4, value);
        EW_STORE_TWICE(to + 6, value), EW_STORE_TWICE(to + 8, value), EW_STORE_TWICE(to + 10, value);
        EW_STORE_TWICE(to + 12, value), EW_STORE_TWICE(to + 14, value);
    }
    for (; i < n; i++) at[i] = value;
}

EW_HOT void ew_raster_fill(ew_raster *raster, const ew_rect *r, uint16_t rgb565, uint16_t *depth)
{
    const ew_target *target = &raster->target;
    const int as_it_is = ew_target_takes_words(target);
    const uint32_t n = (uint32_t)r->x1 - r->x0;
    ew_piece *piece = &raster->work.now.span.fill.any.piece;
    if (!as_it_is) {
        piece->live = 0xFF;
        piece->n = EW_PIECE;
        ew_piece_paint(piece, target, rgb565);
    }
    for (uint16_t y = r->y0; y < r->y1; y++) {
        if (as_it_is) {
            fill_words(ew_target_words(target, y) + r->x0, n, rgb565);
        } else {
            piece->x = r->x0;
            piece->y = y;
            ew_target_fill(target, piece, r->x1);
        }
        if (depth) fill_words(depth + ew_row_start(target, y) + r->x0, n, 0);
    }
}

void ew_raster_clear(ew_raster *raster, uint16_t rgb565)
{
    ew_raster_fill(raster, &raster->scissor, rgb565, raster->target.depth);
}
