/* A display on USB, through hidapi: `VID:PID`, `VID:PID:SERIAL` or `/dev/hidrawN`. */
#ifndef EW_HID_H
#define EW_HID_H

#include <stdio.h>
#include <wchar.h>

#include "display_driver.h"

typedef struct ew_hid_name {
    const char *path; /* as given, or NULL for vendor, product and serial     */
    unsigned short vendor, product;
    wchar_t serial[128]; /* empty: any                                           */
} ew_hid_name;

typedef struct ew_hid {
    ew_display_driver driver; /* first: the driver is cast to this struct             */
    void *device;             /* hid_device, NULL when closed                         */
    ew_hid_name name;
    char error[384];
} ew_hid;

/* Takes `text`, which must outlive the name, apart. Returns 0, or -1 when it is of none
 * of the forms. */
int ew_hid_parse_name(ew_hid_name *name, const char *text);

/* Opens nothing. */
void ew_hid_init(ew_hid *hid, const ew_hid_name *name);

/* Prints every HID device that says it is a display, or (where the back end cannot
 * tell) every HID device. Returns their number, or -1 after writing `why`. */
int ew_hid_list(FILE *out, char *why, size_t size);

#endif
