/* The host's end of the protocol (docs/wire-protocol.md) over a display driver: reads
 * the display's size and capabilities, sends frames, watches the status reports and
 * decides when a key frame is due. One thread at a time.
 *
 * No call waits for ever as long as the driver's own calls return: a frame that is
 * not confirmed within status_ms counts as a time-out and makes the next one a key
 * frame, and after timeout_ms without any confirmed frame the link is given up.
 */
#ifndef EW_LINK_H
#define EW_LINK_H

#include <stdatomic.h>
#include <stdio.h>

#include "display_driver.h"
#include "edgewalk/display.h"

typedef enum ew_link_result {
    EW_LINK_OK = 0,
    EW_LINK_REFUSED = 1, /* the frame did not arrive whole; the next one is a key frame   */
    EW_LINK_LOST = -1    /* nothing more will arrive until the link is opened again       */
} ew_link_result;

typedef struct ew_link_config {
    ew_codec codec;
    unsigned keyframe_ms; /* a key frame at least so often; 0: every 5 s if the display
                             sends no status reports, else only when one is needed      */
    unsigned status_ms;   /* longest wait for a status report                           */
    unsigned timeout_ms;  /* longest time without a confirmed frame                     */
    FILE *record;         /* every report as a line of hex, or NULL                     */
} ew_link_config;

typedef struct ew_link_totals {
    unsigned long sent;     /* frames sent whole, keep-alives not counted               */
    unsigned long accepted; /* frames the display confirmed                             */
    unsigned long refused;  /* frames it did not confirm: errors and time-outs          */
    unsigned long keys, timeouts, keep_alives;
    unsigned long long reports; /* of 1 + EW_HID_OUT_BYTES bytes, keep-alives counted   */
} ew_link_totals;

/* Fields are the link's own, but for those said to be readable. */
typedef struct ew_link {
    ew_display_driver *driver;
    ew_link_config config;
    unsigned width, height, window; /* readable: of the display; frames in flight, 0 = no status */
    ew_link_totals totals;          /* readable                                         */
    char error[512];                /* readable: `what: why` after EW_LINK_LOST         */
    atomic_llong progress_ms;       /* readable from any thread: when something last moved */
    ew_stream_encoder encoder;
    ew_codec codec;     /* config.codec, as far as the display has it       */
    uint16_t *shown;    /* what the display shows if all frames arrived     */
    uint16_t begun;     /* frames begun: the number of the next one         */
    unsigned in_flight; /* frames sent or being sent and not yet confirmed  */
    int need_key;
    uint8_t code; /* of the last status that was not EW_STREAM_OK     */
    int64_t last_key_ms, failing_since_ms;
    unsigned failures;  /* frames in a row that were not confirmed          */
    unsigned confirmed; /* frames since the link was opened, keep-alives too */
    int counters_known;
    uint8_t first_accepted, first_rejected, last_accepted, last_rejected;
} ew_link;

void ew_link_init(ew_link *link, ew_display_driver *driver, const ew_link_config *config);
void ew_link_free(ew_link *link);

/* Opens the driver and reads features 6 and 1. Opening again demands the size of the
 * first time. Returns 0, EW_DRIVER_FAILED or EW_DRIVER_ABSENT with link->error set. */
int ew_link_open(ew_link *link);
void ew_link_close(ew_link *link);

/* Sends one frame of width * height pixels; waits for older frames as far as the
 * display's window demands, not for this one. */
ew_link_result ew_link_send(ew_link *link, const uint16_t *pixels);

/* Waits until every frame sent is confirmed. */
ew_link_result ew_link_settle(ew_link *link);

/* Sends one frame again and again until it is confirmed. EW_LINK_OK or EW_LINK_LOST. */
ew_link_result ew_link_deliver(ew_link *link, const uint16_t *pixels);

/* A frame without pixels, to be sent when there was none for a second. */
ew_link_result ew_link_keep_alive(ew_link *link);

/* Whether the display's own counters agree that it took every frame and refused none
 * since it first spoke (they count modulo 256). */
int ew_link_counters_agree(const ew_link *link);

#endif
