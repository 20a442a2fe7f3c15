/* Triangles from indices: what cannot be seen is left out before anything is set up. */
#include "project.h"

/* The triangle at hand is that of three vertices on the screen. Without colours in the mesh, the
 * corners keep those that they have: white. */
static EW_OWN_FRAME void take_corners(ew_geometry *geometry, const ew_mesh *mesh, const uint16_t index[3])
{
    ew_raster_vertex *const v = geometry->at_hand.corner;
    const int32_t uv_unit = (int32_t)1 << (12 - mesh->uv_fraction_bits);
    for (int k = 0; k < 3; k++) {
        ew_corner_from(&v[k], &mesh->vertices[index[k]], &mesh->screen[index[k]], uv_unit);
        if (mesh->colours) v[k].colour = mesh->colours[index[k]];
    }
}

void ew_geometry_init(ew_geometry *geometry, ew_raster *raster) { geometry->raster = raster; }

int32_t ew_draw_triangles(ew_geometry *geometry, const ew_mesh *mesh)
{
    EW_ASSERT(mesh->index_count % 3 == 0 && mesh->uv_fraction_bits <= 12);
    const ew_screen_vertex *const screen = mesh->screen;
    const int one_sided = !(geometry->raster->material.flags & EW_DOUBLE_SIDED);
    ew_raster_vertex *const v = geometry->at_hand.corner;
    for (int k = 0; k < 3; k++) v[k].colour = ew_white;

    int32_t drawn = 0;
    const uint16_t *index = mesh->indices, *const end = index + mesh->index_count;
    for (; index < end; index += 3) {
        const ew_screen_vertex *a = &screen[index[0]], *b = &screen[index[1]], *c = &screen[index[2]];
        const int any = a->outcode | b->outcode | c->outcode;
        int result;
        if (ew_is_placeless(any)) {
            if (a->outcode & b->outcode & c->outcode & ~EW_OUT_GUARD) continue;
            take_corners(geometry, mesh, index);
            ew_clip_triangle(geometry, &geometry->transform, mesh, index, ew_placeless(a->outcode, b->outcode, c->outcode));
            result = 0;
            for (const ew_raster_vertex *at; result >= 0 && (at = ew_clip_next(geometry));) {
                const int reached = ew_raster_triangle_in_range(geometry->raster, &v[0], at - 1, at);
                result = reached < 0 ? reached : result | reached;
            }
        } else {
            if (any && (a->outcode & b->outcode & c->outcode)) continue;
            if (one_sided && !ew_faces_the_eye(a, b, c)) continue;
            take_corners(geometry, mesh, index);
            result = ew_raster_triangle_in_range(geometry->raster, &v[0], &v[1], &v[2]);
        }
        if (result < 0) return result;
        drawn += result;
    }
    return drawn;
}
