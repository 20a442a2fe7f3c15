/* An axis of the stability atlas: a display link that loses reports. err_px is the part of the frames that were not
 * shown, ok up to one half. What a buffered display shows is always a whole frame that was sent, or the program ends. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edgewalk/display.h"
#include "walk.h"

enum { W = 32, H = 24, FRAMES = 600 };

typedef struct panel {
    uint16_t collected[W * H], shown[W * H];
} panel;

static void fill(void *user, uint16_t x, uint16_t y, uint16_t n, uint16_t colour)
{
    panel *p = user;
    for (uint16_t i = 0; i < n; i++) p->collected[W * y + x + i] = colour;
}

static void commit(void *user)
{
    panel *p = user;
    memcpy(p->shown, p->collected, sizeof p->shown);
}

static void abandon(void *user)
{
    panel *p = user;
    memcpy(p->collected, p->shown, sizeof p->collected);
}

static void control(void *user, int enable, int clear, uint8_t brightness) { (void)user, (void)enable, (void)clear, (void)brightness; }

/* Sends the frame over a link that loses a part of the reports; returns how many it has. */
static int send(ew_hid_display *display, ew_stream_encoder *encoder, const uint16_t *pixels, const uint16_t *previous, double lost)
{
    const ew_stream_frame frame = { pixels, previous, W, 0, 0, W, H };
    uint8_t report[EW_HID_OUT_BYTES];
    int count = 0;
    if (ew_stream_begin(encoder, &frame, previous ? EW_CODEC_SRL : EW_CODEC_RAW)) abort();
    for (; ew_stream_next(encoder, report); count++) {
        if (drand48() >= lost) ew_hid_display_output(display, EW_HID_STREAM, report, sizeof report);
    }
    return count;
}

static int status_of(ew_hid_display *display)
{
    uint8_t report[EW_HID_STATUS_BYTES];
    int status = -1;
    while (ew_hid_display_input(display, report) > 0) status = report[0];
    return status;
}

/* The part of the frames that were not shown. A key frame each time, or changes only while the display took the last
 * frame. *reports: of a key frame. */
static double not_shown(double lost, int listens, int *reports)
{
    static uint16_t frames[2][W * H];
    panel p = { { 0 }, { 0 } };
    const ew_hid_panel callbacks = { &p, fill, commit, abandon, control };
    ew_hid_display display;
    ew_stream_encoder encoder;
    int missing = 0, key = 1;
    uint16_t right[W * H] = { 0 };
    if (ew_hid_display_init(&display, &callbacks, EW_HID_BUFFERED, W, H)) abort();
    ew_stream_encoder_init(&encoder);
    srand48(6);
    memset(frames, 0, sizeof frames);
    for (int i = 0; i < FRAMES; i++) {
        uint16_t *now = frames[i & 1];
        const uint16_t *before = frames[(i + 1) & 1];
        for (int k = 0; k < W * H; k++) now[k] = k % W < W / 4 || i == 0 ? (uint16_t)(mrand48() & 0xFFFF) : before[k];
        const int sent = send(&display, &encoder, now, key ? NULL : before, lost);
        if (key) *reports = sent;
        const int shown = memcmp(p.shown, now, sizeof p.shown) == 0;
        if (!shown && memcmp(p.shown, right, sizeof right) != 0) {
            fprintf(stderr, "stability: a display shows what is no frame\n");
            abort();
        }
        if (shown) memcpy(right, now, sizeof right);
        missing += !shown;
        if (!shown) ew_hid_display_tick(&display, 1000); /* a sender without an answer waits for the time-out */
        key = status_of(&display) != EW_STREAM_OK || !listens;
    }
    return missing / (double)FRAMES;
}

/* The part of the reports that are lost. A frame of n reports arrives whole with a probability of (1 - x)^n, and one key
 * frame mends what was lost before: half of them are shown up to x = 1 - 2^(-1/n). */
void link_axes(void)
{
    for (int listens = 0; listens < 2; listens++) {
        int reports = 0;
        not_shown(0, 0, &reports);
        for (double x = 1e-4; x < 1; x *= 1.333521432163324) {
            int unused;
            const double missing = not_shown(x, listens, &unused);
            walk_row("link_reports_lost", listens ? "changes; a key frame after a loss" : "key frames", x, missing, 0, 0,
                     listens ? walk_no_limit : 1 - pow(0.5, 1.0 / reports), missing <= 0.5 ? "ok" : "degraded");
        }
    }
}
