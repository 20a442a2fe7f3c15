/* The seam between ew-stream and a display.
 *
 * A driver carries whole HID reports and knows nothing of frames. A concrete driver
 * begins with an ew_display_driver and casts. All calls for one driver come from one
 * thread at a time; a call may block for as long as its device holds the bus back,
 * which is why the sender runs it in a thread of its own (sender.h).
 */
#ifndef EW_DISPLAY_DRIVER_H
#define EW_DISPLAY_DRIVER_H

#include <stdint.h>
#include <stddef.h>

enum {
    EW_DRIVER_FAILED = -1, /* error() says why                                    */
    EW_DRIVER_ABSENT = -2  /* open only: no such display (now); error() says so   */
};

typedef struct ew_display_driver ew_display_driver;
struct ew_display_driver {
    /* Opens, or after close opens again. Returns 0, EW_DRIVER_FAILED or EW_DRIVER_ABSENT. */
    int (*open)(ew_display_driver *driver);
    /* Sends output report `id`, EW_HID_OUT_BYTES long without the id byte. 0 or EW_DRIVER_FAILED. */
    int (*write_report)(ew_display_driver *driver, uint8_t id, const uint8_t *report);
    /* Waits up to timeout_ms for an input report. Returns its length with the id byte,
     * which comes first; 0 when the time is over; or EW_DRIVER_FAILED. */
    int (*read_report)(ew_display_driver *driver, uint8_t *report, size_t size, unsigned timeout_ms);
    /* Reads feature report `id` without its id byte. Returns its length or EW_DRIVER_FAILED. */
    int (*get_feature)(ew_display_driver *driver, uint8_t id, uint8_t *report, size_t size);
    /* Harmless when not open. */
    void (*close)(ew_display_driver *driver);
    /* What went wrong last, `what: why`; valid until the next call. */
    const char *(*error)(ew_display_driver *driver);
};

#endif
