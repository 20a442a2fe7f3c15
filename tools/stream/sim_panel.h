/* Panel memory behind an ew_hid_display: what the simulated display and the kernel
 * lab's virtual USB display show. */
#ifndef EW_SIM_PANEL_H
#define EW_SIM_PANEL_H

#include <stdint.h>

#include "edgewalk/display.h"

typedef struct ew_sim_panel {
    unsigned width, height;
    uint16_t *shown;     /* width * height pixels: the picture one would see        */
    uint16_t *collected; /* buffered: the frame being received, else the same array */
    unsigned long commits;
} ew_sim_panel;

/* Black. Returns 0, or -1 when memory is short. */
int ew_sim_panel_init(ew_sim_panel *panel, unsigned width, unsigned height, ew_hid_profile profile);
void ew_sim_panel_free(ew_sim_panel *panel);

/* The callbacks an ew_hid_display takes; `panel` must stay where it is. */
ew_hid_panel ew_sim_panel_callbacks(ew_sim_panel *panel);

#endif
