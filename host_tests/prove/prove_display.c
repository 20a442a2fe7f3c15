/* src/display/: the device's end for any reports in any order, and the sender's. */
#include "edgewalk/display.h"

#include "unknown.h"

static int panel;

static void fill(void *user, uint16_t x, uint16_t y, uint16_t n, uint16_t rgb565)
{
    (void)x, (void)y, (void)n, (void)rgb565;
    //@ assert user_passed: user == &panel;
}
static void told(void *user)
{
    //@ assert user_passed: user == &panel;
}
static void control(void *user, int enable, int clear, uint8_t brightness)
{
    (void)brightness;
    //@ assert user_passed: user == &panel && (enable == 0 || enable == 1) && (clear == 0 || clear == 1);
}

/* What a display of any size refuses, and what it makes of every call after one that it took. */
void prove_display(void)
{
    ew_hid_display display;
    ew_hid_panel owner = { &panel, any_of(2) ? fill : NULL, any_of(2) ? told : NULL, any_of(2) ? told : NULL,
                           any_of(2) ? control : NULL };
    (void)ew_hid_display_init(&display, &owner, (ew_hid_profile)any_s16(), any16(), any16());
    owner.fill = fill;
    const uint16_t width = (uint16_t)between(1, 4096), height = (uint16_t)between(1, 4096);
    const int ready = ew_hid_display_init(&display, &owner, EW_HID_DIRECT, width, height);
    //@ assert taken: ready == 0;
    while (any_of(2)) {
        uint8_t report[EW_HID_OUT_BYTES];
        any_bytes(report, sizeof report);
        switch (any_of(5)) {
        case 0: ew_hid_display_output(&display, any8(), report, any_of(2) ? sizeof report : any16()); break;
        case 1: (void)ew_hid_display_get_feature(&display, any8(), report, (size_t)any_of(sizeof report + 1)); break;
        case 2: (void)ew_hid_display_set_feature(&display, any8(), report, (size_t)any_of(sizeof report + 1)); break;
        case 3: (void)ew_hid_display_input(&display, report); break;
        default: ew_hid_display_tick(&display, any32()); break;
        }
    }
}
