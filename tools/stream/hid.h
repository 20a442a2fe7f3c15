/* A display on USB, through hidapi: `VID:PID`, `VID:PID:SERIAL` or `/dev/hidrawN`. */
#ifndef EW_HID_H
#define EW_HID_H

#include <stdio.h>
#include <wchar.h>

#include "display_driver.h"

typedef struct ew_hid {
    ew_display_driver driver; /* first: the driver is cast to this struct             */
    void *device;             /* hid_device, NULL when closed                         */
    const char *path;         /* as given, or NULL for vendor, product and serial     */
    unsigned short vendor, product;
    wchar_t serial[128]; /* empty: any                                           */
    char error[384];
} ew_hid;

/* Parses `name`, which must outlive the driver. Returns 0, or -1 when it is neither
 * form. Opens nothing. */
int ew_hid_init(ew_hid *hid, const char *name);

/* Prints every HID device that says it is a display, or (where the back end cannot
 * tell) every HID device. Returns their number, or -1 after writing `why`. */
int ew_hid_list(FILE *out, char *why, size_t size);

#endif
