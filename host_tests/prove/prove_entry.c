/* src/raster/: what is checked on entry, for every bit pattern. */
#include "seams.h"

/* Every pattern of a structure's bytes, but for its pointers: those are NULL or lead somewhere. */
static uint16_t somewhere[1];

static ew_target any_target(void)
{
    ew_target t;
    t.colour = perhaps(somewhere);
    t.depth = perhaps(somewhere);
    t.width = any16(), t.height = any16(), t.stride = any16(), t.first_row = any16();
    t.format = any8(), t.dither = any8();
    return t;
}

static ew_texture any_texture(void)
{
    ew_texture t;
    t.texels = perhaps((const uint8_t *)somewhere + any_of(2));
    t.palette = perhaps(somewhere);
    t.mask = perhaps((const uint8_t *)somewhere + any_of(2));
    t.width = any16(), t.height = any16(), t.key = any16();
    t.format = any8(), t.wrap_u = any8(), t.wrap_v = any8(), t.levels = any8();
    return t;
}

static ew_raster raster;

void prove_entry(void)
{
    ew_raster fresh; /* nothing is read before it is written */
    const ew_target target = any_target();
    (void)ew_raster_init(&fresh, &target);

    /* a context that was made, for a whole picture of any size: rows of bands are compared with each
     * other in ew_target_check, which Eva does not follow */
    const ew_target good = { .colour = somewhere, .depth = perhaps(somewhere), .width = (uint16_t)between(1, 4096),
                             .height = (uint16_t)between(1, 4096), .stride = any16(), .format = (uint8_t)any_of(6),
                             .dither = (uint8_t)any_of(2), .first_row = 0 };
    raster.target = good;
    raster.scissor = (ew_rect){ 0, 0, good.width, good.height };
    while (any_of(2)) {
        const ew_rect rect = { any16(), any16(), any16(), any16() };
        const ew_texture texture = any_texture();
        const ew_material material = { perhaps(&texture), any16(), any16(), any8(), any8(), any8(), any8() };
        const ew_cost cost = { any16(), any16(), any16() };
        switch (any_of(4)) {
        case 0: (void)ew_raster_set_scissor(&raster, &rect); break;
        case 1: (void)ew_raster_set_material(&raster, &material); break;
        case 2: (void)ew_raster_set_fog(&raster, any16(), any32(), any32()); break;
        default: (void)ew_raster_set_cost(&raster, &cost); break;
        }
    }
    check_context(&raster);
    (void)ew_raster_set_rows(&raster, perhaps(somewhere), perhaps(somewhere), any16(), any16());
}
