/* hidapi holds one handle for one thread; the sender's thread is the only one that
 * calls here. Every open begins with a fresh hidapi context: the libusb back end
 * does not see a device that was plugged in after hid_init() where no udev runs. */
#include "hid.h"

#include <errno.h>
#include <hidapi.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "edgewalk/display.h"

enum { USAGE_PAGE_DISPLAY = 0x14 };

static int failed(ew_hid *hid, int code, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(hid->error, sizeof hid->error, format, arguments);
    va_end(arguments);
    return code;
}

/* The first interface that answers to the name, as a path of hidapi's own; or NULL. */
static char *find_path(const ew_hid_name *name, unsigned short *vendor, unsigned short *product)
{
    struct hid_device_info *all = hid_enumerate(name->vendor, name->product), *i; /* 0: any */
    char *path = NULL;

    for (i = all; i && !path; i = i->next) {
        int same = name->path ? !strcmp(name->path, i->path)
                              : !name->serial[0] ||
                                    (i->serial_number && !wcscmp(name->serial, i->serial_number));
        if (same) {
            path = strdup(i->path);
            *vendor = i->vendor_id;
            *product = i->product_id;
        }
    }
    hid_free_enumeration(all);
    return path;
}

static int no_permission(ew_hid *hid, unsigned vendor, unsigned product, int denied)
{
    return failed(hid, EW_DRIVER_FAILED,
                  "open: %s; a udev rule lets users in: SUBSYSTEMS==\"usb\", ATTRS{idVendor}==\"%04x\", "
                  "ATTRS{idProduct}==\"%04x\", TAG+=\"uaccess\"",
                  denied ? "permission denied" : "found, but refused (permission denied?)", vendor, product);
}

static int hid_driver_open(ew_display_driver *driver)
{
    ew_hid *hid = (ew_hid *)driver;
    unsigned short vendor = 0, product = 0;
    char *path;
    int denied;

    hid_exit();
    if (hid_init()) {
        return failed(hid, EW_DRIVER_FAILED, "open: hidapi cannot be started");
    }
    path = find_path(&hid->name, &vendor, &product);
    if (!path) {
        if (hid->name.path && !access(hid->name.path, F_OK)) {
            return failed(hid, EW_DRIVER_FAILED, "open: not a HID device that hidapi can reach by path");
        }
        return failed(hid, EW_DRIVER_ABSENT, "open: no such display");
    }
    /* A path of the libusb back end is no file: access() then says nothing. */
    denied = path[0] == '/' && access(path, R_OK | W_OK) && errno == EACCES;
    hid->device = denied ? NULL : hid_open_path(path);
    free(path);
    return hid->device ? 0 : no_permission(hid, vendor, product, denied);
}

static const char *reason(int code)
{
    switch (code) {
    case 0: return "the display was unplugged or takes no reports";
    case ENODEV:
    case ENOENT:
    case ESHUTDOWN: return "the display was unplugged";
    case ETIMEDOUT: return "the display takes no reports";
    case EPIPE: return "the display refused the report (stall)";
    default: return strerror(code);
    }
}

static int hid_driver_write_report(ew_display_driver *driver, uint8_t id, const uint8_t *report)
{
    ew_hid *hid = (ew_hid *)driver;
    uint8_t whole[1 + EW_HID_OUT_BYTES];

    whole[0] = id;
    memcpy(whole + 1, report, EW_HID_OUT_BYTES);
    errno = 0;
    if (hid_write(hid->device, whole, sizeof whole) != (int)sizeof whole) {
        return failed(hid, EW_DRIVER_FAILED, "write: %s", reason(errno));
    }
    return 0;
}

static int hid_driver_read_report(ew_display_driver *driver, uint8_t *report, size_t size,
                                  unsigned timeout_ms)
{
    ew_hid *hid = (ew_hid *)driver;
    int n;

    errno = 0;
    n = hid_read_timeout(hid->device, report, size, (int)timeout_ms);
    return n < 0 ? failed(hid, EW_DRIVER_FAILED, "read: %s", reason(errno)) : n;
}

static int hid_driver_get_feature(ew_display_driver *driver, uint8_t id, uint8_t *report, size_t size)
{
    ew_hid *hid = (ew_hid *)driver;
    uint8_t whole[1 + 64] = {id};
    int n;

    errno = 0;
    n = hid_get_feature_report(hid->device, whole, size + 1 < sizeof whole ? size + 1 : sizeof whole);
    if (n < 1) {
        return failed(hid, EW_DRIVER_FAILED, "feature report %u: %s", id,
                      errno ? reason(errno) : "the display does not have it");
    }
    memcpy(report, whole + 1, (size_t)n - 1);
    return n - 1;
}

static void hid_driver_close(ew_display_driver *driver)
{
    ew_hid *hid = (ew_hid *)driver;
    if (hid->device) {
        hid_close(hid->device);
    }
    hid->device = NULL;
}

static const char *hid_driver_error(ew_display_driver *driver) { return ((ew_hid *)driver)->error; }

/* Exactly four hex digits at the start of `text`. */
static int parse_id(const char *text, unsigned short *id)
{
    char *after;
    unsigned long value;
    if (strspn(text, "0123456789abcdefABCDEF") != 4) {
        return -1;
    }
    value = strtoul(text, &after, 16);
    *id = (unsigned short)value;
    return 0;
}

int ew_hid_parse_name(ew_hid_name *name, const char *text)
{
    memset(name, 0, sizeof *name);
    if (text[0] == '/') {
        name->path = text;
        return 0;
    }
    if (parse_id(text, &name->vendor) || text[4] != ':' || parse_id(text + 5, &name->product)) {
        return -1;
    }
    if (text[9] == ':' && text[10]) {
        size_t n = mbstowcs(name->serial, text + 10, sizeof name->serial / sizeof *name->serial);
        return n < sizeof name->serial / sizeof *name->serial ? 0 : -1;
    }
    return text[9] ? -1 : 0;
}

void ew_hid_init(ew_hid *hid, const ew_hid_name *name)
{
    static const ew_display_driver driver = {hid_driver_open,        hid_driver_write_report,
                                             hid_driver_read_report, hid_driver_get_feature,
                                             hid_driver_close,       hid_driver_error};
    memset(hid, 0, sizeof *hid);
    hid->driver = driver;
    hid->name = *name;
}

int ew_hid_list(FILE *out, char *why, size_t size)
{
    struct hid_device_info *all, *i;
    const char *listed = "";
    int n = 0;

    if (hid_init()) {
        snprintf(why, size, "hidapi cannot be started");
        return -1;
    }
    all = hid_enumerate(0, 0);
    for (i = all; i; i = i->next) {
        /* The libusb back end reports page 0: it does not read report descriptors. The
         * hidraw back end has one entry, with the same path, for every usage. */
        if ((i->usage_page != 0 && i->usage_page != USAGE_PAGE_DISPLAY) || !strcmp(i->path, listed)) {
            continue;
        }
        listed = i->path;
        fprintf(out, "%04x:%04x%s%ls  %s  %ls%s\n", i->vendor_id, i->product_id,
                i->serial_number && i->serial_number[0] ? ":" : "", i->serial_number ? i->serial_number : L"",
                i->path, i->product_string ? i->product_string : L"",
                i->usage_page ? "" : "  (usage unknown)");
        n++;
    }
    hid_free_enumeration(all);
    hid_exit();
    return n;
}
