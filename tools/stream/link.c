#include "link.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"

enum {
    STATUS_REPORT = 1 + EW_HID_STATUS_BYTES,
    REPORTS_PER_POLL = 8,         /* while a frame is sent: how soon an error ends it         */
    OPEN_LOOP_KEYFRAME_MS = 5000, /* for a display without status reports                     */
    FAILURES_TO_GIVE_UP = 3       /* ... and timeout_ms: a slow display may need both frames  */
};

static void set_error(ew_link *link, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(link->error, sizeof link->error, format, arguments);
    va_end(arguments);
}

static void progress(ew_link *link) { atomic_store(&link->progress_ms, ew_now_ms()); }

static const char *status_text(uint8_t code)
{
    static const char *const texts[] = {"none",          "need key frame", "sequence gap", "bad check",
                                        "bad operation", "bad rectangle",  "unsupported"};
    return code < sizeof texts / sizeof *texts ? texts[code] : "unknown";
}

static unsigned le16(const uint8_t *p) { return p[0] | (unsigned)p[1] << 8; }

void ew_link_init(ew_link *link, ew_display_driver *driver, const ew_link_config *config)
{
    memset(link, 0, sizeof *link);
    link->driver = driver;
    link->config = *config;
    ew_stream_encoder_init(&link->encoder);
    progress(link);
}

void ew_link_free(ew_link *link)
{
    free(link->shown);
    link->shown = NULL;
}

/* ---- opening ---- */

static int bad_feature(ew_link *link, const char *why)
{
    set_error(link, "open: %s", why);
    return EW_DRIVER_FAILED;
}

static int read_capabilities(ew_link *link)
{
    uint8_t c[EW_HID_CAPABILITIES_BYTES];
    int n = link->driver->get_feature(link->driver, EW_HID_CAPABILITIES, c, sizeof c);

    if (n < 0) {
        set_error(link, "open: not a display that takes streamed frames: %s",
                  link->driver->error(link->driver));
        return EW_DRIVER_FAILED;
    }
    if (n < (int)sizeof c || memcmp(c, "FB1", 3)) {
        return bad_feature(link, "not a display that takes streamed frames: feature report 6 is not ours");
    }
    if (!(c[6] & 1 << EW_CODEC_RAW) || !(c[7] & 1)) {
        return bad_feature(link, "the display takes no raw RGB565 frames");
    }
    link->codec = link->config.codec;
    if (!(c[6] & 1 << EW_CODEC_SRL)) {
        if (link->config.codec == EW_CODEC_SRL) {
            return bad_feature(link, "the display does not have codec srl");
        }
        link->codec = EW_CODEC_RAW;
    }
    link->window = c[10];
    return 0;
}

static int read_attributes(ew_link *link)
{
    uint8_t a[EW_HID_ATTRIBUTES_BYTES];
    unsigned width, height;
    int n = link->driver->get_feature(link->driver, EW_HID_ATTRIBUTES, a, sizeof a);

    if (n < (int)sizeof a) {
        set_error(link, "open: %s",
                  n < 0 ? link->driver->error(link->driver) : "feature report 1 is too short");
        return EW_DRIVER_FAILED;
    }
    width = le16(a);
    height = le16(a + 2);
    if (!width || !height || width > 4096 || height > 4096) {
        return bad_feature(link, "the display's size is not 1 to 4096 pixels on each side");
    }
    if (link->shown) { /* opened before */
        return width == link->width && height == link->height
                   ? 0
                   : bad_feature(link, "the display came back with another size");
    }
    link->width = width;
    link->height = height;
    return 0;
}

static int start(ew_link *link)
{
    uint8_t stale[64];
    int i;

    if (read_capabilities(link) || read_attributes(link)) {
        return EW_DRIVER_FAILED;
    }
    if (!link->shown) {
        link->shown = calloc((size_t)link->width * link->height, sizeof *link->shown);
    }
    if (!link->shown) {
        return bad_feature(link, "out of memory");
    }
    for (i = 0; i < 64 && link->driver->read_report(link->driver, stale, sizeof stale, 0) > 0; i++) {
    }
    return 0;
}

int ew_link_open(ew_link *link)
{
    int r = link->driver->open(link->driver);
    if (r) {
        set_error(link, "%s", link->driver->error(link->driver));
        return r;
    }
    progress(link);
    link->need_key = 1;
    link->in_flight = link->failures = link->confirmed = 0;
    link->counters_known = 0;
    link->code = EW_STREAM_OK;
    r = start(link);
    if (r) {
        link->driver->close(link->driver);
    }
    return r;
}

void ew_link_close(ew_link *link) { link->driver->close(link->driver); }

/* ---- status reports ---- */

/* What was sent and not confirmed is taken for lost. */
static void refuse(ew_link *link)
{
    link->need_key = 1;
    if (!link->in_flight) {
        return; /* an echo of frames already given up */
    }
    link->totals.refused += link->in_flight;
    link->in_flight = 0;
    if (!link->failures++) {
        link->failing_since_ms = ew_now_ms();
    }
}

/* A confirmation stands for all frames up to its number: a display that is busy may
 * have had no time to confirm each. A number that is not in flight is an old one. */
static void confirm(ew_link *link, unsigned number)
{
    unsigned behind = (uint16_t)(link->begun - 1 - number);
    if (behind < link->in_flight) {
        link->totals.accepted += link->in_flight - behind;
        link->confirmed += link->in_flight - behind;
        link->in_flight = behind;
        link->failures = 0;
    }
}

static void take_status(ew_link *link, const uint8_t *status)
{
    link->last_accepted = status[4];
    link->last_rejected = status[5];
    if (status[0] == EW_STREAM_OK) {
        confirm(link, le16(status + 2));
    } else {
        link->code = status[0];
        refuse(link);
    }
    if (!link->counters_known) {
        link->first_accepted = (uint8_t)(status[4] - link->confirmed);
        link->first_rejected = status[5];
        link->counters_known = 1;
    }
}

/* Waits up to timeout_ms for one report. 1: took one, 0: the time is over, -1: lost. */
static int poll_status(ew_link *link, unsigned timeout_ms)
{
    uint8_t report[64];
    int n = link->driver->read_report(link->driver, report, sizeof report, timeout_ms);

    if (n < 0) {
        set_error(link, "%s", link->driver->error(link->driver));
        return -1;
    }
    if (n > 0) {
        progress(link);
    }
    if (n >= STATUS_REPORT && report[0] == EW_HID_STATUS) {
        take_status(link, report + 1);
    }
    return n > 0;
}

static ew_link_result after_failure(ew_link *link)
{
    if (link->failures >= FAILURES_TO_GIVE_UP &&
        ew_now_ms() - link->failing_since_ms >= (int64_t)link->config.timeout_ms) {
        set_error(link, "status: no frame confirmed for %u ms, last error reported: %s",
                  link->config.timeout_ms, status_text(link->code));
        return EW_LINK_LOST;
    }
    return EW_LINK_REFUSED;
}

/* Until at most `limit` frames are in flight. A driver that returns early without a
 * report says that the time is over. */
static ew_link_result wait_in_flight(ew_link *link, unsigned limit)
{
    int64_t deadline = ew_now_ms() + link->config.status_ms;
    unsigned long refused = link->totals.refused;

    while (link->in_flight > limit) {
        int64_t left = deadline - ew_now_ms();
        int n = left > 0 ? poll_status(link, (unsigned)left) : 0;
        if (n < 0) {
            return EW_LINK_LOST;
        }
        if (n == 0) {
            link->totals.timeouts++;
            refuse(link);
        }
    }
    return link->totals.refused == refused ? EW_LINK_OK : after_failure(link);
}

/* ---- frames ---- */

static void record(FILE *file, const uint8_t *report)
{
    int i;
    fprintf(file, "%02x", EW_HID_STREAM);
    for (i = 0; i < EW_HID_OUT_BYTES; i++) {
        fprintf(file, " %02x", report[i]);
    }
    fputc('\n', file);
}

static ew_link_result transmit(ew_link *link, const ew_stream_frame *frame)
{
    uint8_t report[EW_HID_OUT_BYTES];
    unsigned long refused = link->totals.refused;
    unsigned n = 0;

    if (ew_stream_begin(&link->encoder, frame, link->codec) != EW_OK) {
        set_error(link, "encode: the frame is not one");
        return EW_LINK_LOST;
    }
    link->begun++;
    link->in_flight += link->window != 0;
    while (ew_stream_next(&link->encoder, report)) {
        if (link->config.record) {
            record(link->config.record, report);
        }
        if (link->driver->write_report(link->driver, EW_HID_STREAM, report)) {
            set_error(link, "%s", link->driver->error(link->driver));
            return EW_LINK_LOST;
        }
        link->totals.reports++;
        progress(link);
        if (link->window && ++n % REPORTS_PER_POLL == 0 && poll_status(link, 0) < 0) {
            return EW_LINK_LOST;
        }
        if (link->totals.refused != refused) {
            return after_failure(link);
        }
    }
    link->totals.sent++;
    return EW_LINK_OK;
}

static int key_due(const ew_link *link)
{
    unsigned every = link->config.keyframe_ms;
    if (!every && !link->window) {
        every = OPEN_LOOP_KEYFRAME_MS;
    }
    return link->need_key || (every && ew_now_ms() - link->last_key_ms >= (int64_t)every);
}

ew_link_result ew_link_send(ew_link *link, const uint16_t *pixels)
{
    size_t bytes = (size_t)link->width * link->height * sizeof *pixels;
    ew_stream_frame frame = {pixels, link->shown,           (uint16_t)link->width, 0,
                             0,      (uint16_t)link->width, (uint16_t)link->height};
    ew_link_result r;
    int key;

    if (link->window && wait_in_flight(link, link->window - 1) == EW_LINK_LOST) {
        return EW_LINK_LOST;
    }
    key = key_due(link);
    if (key) {
        frame.previous = NULL;
        link->need_key = 0;
    } else if (!memcmp(pixels, link->shown, bytes)) {
        frame.width = frame.height = 0; /* nothing changed */
    }
    r = transmit(link, &frame);
    if (r == EW_LINK_OK) {
        memcpy(link->shown, pixels, bytes);
        if (key) {
            link->totals.keys++;
            link->last_key_ms = ew_now_ms();
        }
    }
    return r;
}

ew_link_result ew_link_settle(ew_link *link)
{
    ew_link_result r = wait_in_flight(link, 0);
    return r == EW_LINK_OK && link->need_key ? EW_LINK_REFUSED : r;
}

ew_link_result ew_link_deliver(ew_link *link, const uint16_t *pixels)
{
    ew_link_result r;
    do {
        r = ew_link_send(link, pixels);
        if (r == EW_LINK_OK) {
            r = ew_link_settle(link);
        }
    } while (r == EW_LINK_REFUSED);
    return r;
}

ew_link_result ew_link_keep_alive(ew_link *link)
{
    ew_stream_frame frame = {link->shown, link->shown, (uint16_t)link->width, 0, 0, 0, 0};
    ew_link_result r = ew_link_settle(link);
    unsigned long sent = link->totals.sent, accepted = link->totals.accepted;

    if (r != EW_LINK_OK) {
        return r;
    }
    r = transmit(link, &frame);
    if (r == EW_LINK_OK) {
        r = ew_link_settle(link);
    }
    link->totals.sent = sent;
    link->totals.accepted = accepted;
    link->totals.keep_alives++;
    return r;
}

int ew_link_counters_agree(const ew_link *link)
{
    return link->counters_known && link->last_rejected == link->first_rejected &&
           (uint8_t)(link->last_accepted - link->first_accepted) == (uint8_t)link->confirmed;
}
