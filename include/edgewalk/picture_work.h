/* edgewalk/picture_work.h - the geometry layer's own; nothing for users.
 *
 * What ew_picture_draw works with. It lies in the caller's ew_geometry, where ew_scene_draw has its
 * own at other times; nothing in it outlives a call.
 */
#ifndef EW_PICTURE_WORK_H
#define EW_PICTURE_WORK_H

#include "raster.h"

struct ew_geometry;
struct ew_object;
struct ew_picture;
struct ew_row_work;
struct ew_slot;

/* A place among the kept ones, or none: ew_active_list. */
typedef uint16_t ew_place;

typedef struct ew_picture_work {
    const struct ew_picture *picture;
    const struct ew_object *objects;
    uint32_t count;
    struct ew_geometry *geometry;
    uint32_t set_up, again, transformed, most_active, crossings, sections; /* ew_picture_counts */
    uint16_t rows, bands, stride; /* of a band, EW_DEPTH_SPANS: 1                            */
    uint16_t bands_at_once; /* that are handed over together                                */
    uint8_t is_listed;    /* whether triangles are sorted into bands                         */
    uint8_t is_narrow;    /* whether the scissor has not all of the columns                  */
    uint16_t band;        /* the one at hand                                                */
    uint16_t first, end;  /* rows that triangles are drawn in                               */
    uint16_t top, bottom; /* rows of the band at hand among them                            */
    ew_place kept, gaps;
    uint16_t slot_count, hand; /* hand: where a slot was taken last                         */
    /* Memory. */
    uint8_t *colour;
    uint16_t *depth;
    uint32_t colour_bytes; /* of one band                                                    */
    uint16_t *map;        /* one for each vertex: its row, then the slot that may have it   */
    uint32_t vertices;
    uint32_t *entries;
    struct ew_slot *slots; /* what lies behind all of this                                   */
    uint8_t *end_of_memory;
    struct ew_row_work *row; /* NULL but for EW_DEPTH_SPANS                                  */
    /* Lists. Late ones stand in the entries' place once these were taken: those of earlier bands
     * first, then, from late_begun on, those that the band at hand has added. */
    uint32_t entry_count, next;
    uint32_t late_count, late_next, late_left; /* of earlier bands: read up to, left so far      */
    uint32_t late_begun, late_new;
    ew_active_list list;  /* its link leads to the one that a band has come to              */
    uint32_t active;      /* how many are kept or late                                      */
    /* The object at hand, by number, and the one whose material the raster has. */
    uint32_t object, first_triangle, first_vertex, used;
    const struct ew_object *at;
    uint32_t behind;      /* the first triangle that is not the object's                    */
    uint32_t number;      /* the triangle at hand                                           */
} ew_picture_work;

#endif
