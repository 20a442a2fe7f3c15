#include "player.h"

enum { SKY = 0x6D7B }; /* RGB565 */

int player_open(player *p, const ew_target *target)
{
    int error = ew_scene_open(&p->scene, scene, scene_size);
    if (error) return error;
    if (p->scene.section[EW_SECTION_NODE].count > PLAYER_NODES) return EW_ERR_ROOM;
    if (p->scene.largest_primitive > PLAYER_VERTICES) return EW_ERR_ROOM;
    ew_scene_get_camera(&p->scene, &p->camera);
    ew_geometry_init(&p->geometry, &p->raster);
    return ew_raster_init(&p->raster, target);
}

int32_t player_draw(player *p, uint32_t time_ms)
{
    const ew_viewport whole = { 0, 0, p->raster.target.width, p->raster.target.height };
    if (p->scene.duration_ms) time_ms %= p->scene.duration_ms;
    int error = ew_scene_pose(&p->scene, time_ms, p->world);
    if (error) return error;
    ew_raster_clear(&p->raster, SKY);
    return ew_scene_draw(&p->scene, &p->camera, p->world, &whole, &p->geometry, p->scratch);
}
