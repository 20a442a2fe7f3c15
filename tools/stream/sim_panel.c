#include "sim_panel.h"

#include <stdlib.h>
#include <string.h>

static size_t bytes_of(const ew_sim_panel *panel)
{
    return (size_t)panel->width * panel->height * sizeof *panel->shown;
}

static void fill(void *user, uint16_t x, uint16_t y, uint16_t n, uint16_t rgb565)
{
    ew_sim_panel *panel = user;
    uint16_t *pixel = panel->collected + (size_t)y * panel->width + x;
    while (n--) {
        *pixel++ = rgb565;
    }
}

static void commit(void *user)
{
    ew_sim_panel *panel = user;
    if (panel->collected != panel->shown) {
        memcpy(panel->shown, panel->collected, bytes_of(panel));
    }
    panel->commits++;
}

/* A skip means the pixel of the picture shown, so a frame given up is taken back whole. */
static void abandon(void *user)
{
    ew_sim_panel *panel = user;
    if (panel->collected != panel->shown) {
        memcpy(panel->collected, panel->shown, bytes_of(panel));
    }
}

int ew_sim_panel_init(ew_sim_panel *panel, unsigned width, unsigned height, ew_hid_profile profile)
{
    memset(panel, 0, sizeof *panel);
    panel->width = width;
    panel->height = height;
    panel->shown = calloc((size_t)width * height, sizeof *panel->shown);
    panel->collected = panel->shown;
    if (profile == EW_HID_BUFFERED) {
        panel->collected = calloc((size_t)width * height, sizeof *panel->collected);
    }
    if (!panel->shown || !panel->collected) {
        ew_sim_panel_free(panel);
        return -1;
    }
    return 0;
}

void ew_sim_panel_free(ew_sim_panel *panel)
{
    if (panel->collected != panel->shown) {
        free(panel->collected);
    }
    free(panel->shown);
    panel->shown = panel->collected = NULL;
}

ew_hid_panel ew_sim_panel_callbacks(ew_sim_panel *panel)
{
    ew_hid_panel callbacks = {panel, fill, commit, abandon, NULL};
    return callbacks;
}
