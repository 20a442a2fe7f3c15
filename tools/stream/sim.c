#include "sim.h"

#include <stdio.h>
#include <string.h>

static int sim_open(ew_display_driver *driver)
{
    ew_sim *sim = (ew_sim *)driver;
    ew_hid_panel callbacks;

    if (!sim->width || !sim->height || sim->width > 4096 || sim->height > 4096) {
        snprintf(sim->error, sizeof sim->error, "size: each side must be 1 to 4096 pixels");
        return EW_DRIVER_FAILED;
    }
    ew_sim_panel_free(&sim->panel);
    if (ew_sim_panel_init(&sim->panel, sim->width, sim->height, sim->profile)) {
        snprintf(sim->error, sizeof sim->error, "panel: out of memory");
        return EW_DRIVER_FAILED;
    }
    callbacks = ew_sim_panel_callbacks(&sim->panel);
    ew_hid_display_init(&sim->display, &callbacks, sim->profile, (uint16_t)sim->width, (uint16_t)sim->height);
    return 0;
}

static int sim_write_report(ew_display_driver *driver, uint8_t id, const uint8_t *report)
{
    ew_sim *sim = (ew_sim *)driver;
    sim->reports++;
    if (sim->fault_drop && sim->reports % sim->fault_drop == 0) {
        sim->lost++;
        return 0;
    }
    ew_hid_display_output(&sim->display, id, report, EW_HID_OUT_BYTES);
    return 0;
}

static int sim_read_report(ew_display_driver *driver, uint8_t *report, size_t size, unsigned timeout_ms)
{
    ew_sim *sim = (ew_sim *)driver;
    int n;

    if (size < 1 + EW_HID_STATUS_BYTES) {
        snprintf(sim->error, sizeof sim->error, "read: buffer too small");
        return EW_DRIVER_FAILED;
    }
    n = ew_hid_display_input(&sim->display, report + 1);
    if (!n && timeout_ms) {
        ew_hid_display_tick(&sim->display, timeout_ms);
        n = ew_hid_display_input(&sim->display, report + 1);
    }
    report[0] = EW_HID_STATUS;
    return n ? n + 1 : 0;
}

static int sim_get_feature(ew_display_driver *driver, uint8_t id, uint8_t *report, size_t size)
{
    ew_sim *sim = (ew_sim *)driver;
    int n = ew_hid_display_get_feature(&sim->display, id, report, size);
    if (n < 0) {
        snprintf(sim->error, sizeof sim->error, "feature report %u: %s", id, ew_error_text(n));
        return EW_DRIVER_FAILED;
    }
    return n;
}

static void sim_close(ew_display_driver *driver) { (void)driver; }

static const char *sim_error(ew_display_driver *driver) { return ((ew_sim *)driver)->error; }

void ew_sim_init(ew_sim *sim, unsigned width, unsigned height, ew_hid_profile profile, unsigned fault_drop)
{
    static const ew_display_driver driver = {sim_open,        sim_write_report, sim_read_report,
                                             sim_get_feature, sim_close,        sim_error};
    memset(sim, 0, sizeof *sim);
    sim->driver = driver;
    sim->width = width;
    sim->height = height;
    sim->profile = profile;
    sim->fault_drop = fault_drop;
}

void ew_sim_free(ew_sim *sim) { ew_sim_panel_free(&sim->panel); }
