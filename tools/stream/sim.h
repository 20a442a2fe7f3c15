/* `sim:WxH`: a HID display inside the program. It takes the very report bytes that a
 * real one would get and decodes them with the device's end of the codec. Time is
 * simulated: waiting for a report that cannot come returns at once. */
#ifndef EW_SIM_H
#define EW_SIM_H

#include "display_driver.h"
#include "sim_panel.h"

typedef struct ew_sim {
    ew_display_driver driver; /* first: the driver is cast to this struct           */
    ew_hid_display display;
    ew_sim_panel panel;
    ew_hid_profile profile;
    unsigned width, height;
    unsigned fault_drop; /* every so many-th report is lost, 0: none           */
    unsigned long reports, lost;
    char error[96];
} ew_sim;

/* Memory is taken by open and given back by ew_sim_free, so the picture can still be
 * read after close. */
void ew_sim_init(ew_sim *sim, unsigned width, unsigned height, ew_hid_profile profile, unsigned fault_drop);
void ew_sim_free(ew_sim *sim);

#endif
