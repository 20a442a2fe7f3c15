/* ew-stream - streams frames to a USB HID display.
 *
 * This thread makes the frames and keeps the time; the sender's thread talks to the
 * display (sender.h); what it may assume of the display is in link.h; how reports get
 * there is a driver's business (display_driver.h).
 */
#include <locale.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "clock.h"
#include "frame_source.h"
#include "hid.h"
#include "sender.h"
#include "sim.h"
#include "stream_options.h"
#include "stream_output.h"
#include "tools/common/whole_file.h"

enum {
    LEAST_STATUS_MS = 200, /* a status report may wait behind other traffic on the bus          */
    AFTER_RESET_MS = 3000  /* a display that was reset has to be enumerated again               */
};

typedef struct stream {
    ew_stream_options options;
    union {
        ew_sim sim;
        ew_hid hid;
    } device;
    ew_display_driver *driver;
    ew_panel_lines lines;
    ew_link link;
    ew_sender sender;
    ew_frame_source source;
    ew_whole_file record, dump;
    ew_pictures pictures;
    double seconds;
} stream;

static atomic_int interrupted;

static void on_signal(int number)
{
    (void)number;
    interrupted = 1;
}

static int complain(const char *thing, const char *what_and_why)
{
    fprintf(stderr, "%s: %s: %s\n", ew_stream_tool, thing, what_and_why);
    return -1;
}

static double frame_period_ms(const ew_stream_options *options)
{
    return 1000 / (options->fps > 0 ? options->fps : 30);
}

/* ---- opening ---- */

static int list(void)
{
    char why[128];
    int n = ew_hid_list(stdout, why, sizeof why);
    if (n < 0) {
        return complain("list", why);
    }
    if (n == 0) {
        puts("no HID display found");
    }
    return 0;
}

static void choose_driver(stream *s)
{
    const ew_stream_options *o = &s->options;
    if (o->is_sim) {
        ew_sim_init(&s->device.sim, o->sim_width, o->sim_height, o->profile, o->fault_drop);
        s->driver = &s->device.sim.driver;
    } else {
        ew_hid_init(&s->device.hid, &o->hid_name);
        s->driver = &s->device.hid.driver;
    }
}

static int open_lines(stream *s)
{
    const ew_stream_options *o = &s->options;
    char why[512];
    if (ew_panel_lines_open(&s->lines, &ew_gpio, o->gpio_reset, o->gpio_te, why, sizeof why)) {
        fprintf(stderr, "%s: %s\n", ew_stream_tool, why);
        return -1;
    }
    s->lines.te_timeout_ms = o->te_timeout_ms ? o->te_timeout_ms : (unsigned)(2 * frame_period_ms(o) + 0.5);
    if (ew_panel_reset(&s->lines)) {
        return complain(o->gpio_reset, "reset line: cannot be driven");
    }
    return 0;
}

static int open_display(stream *s)
{
    const ew_stream_options *o = &s->options;
    int64_t deadline = ew_now_ms() + (s->lines.reset && !o->is_sim ? AFTER_RESET_MS : 0);
    double status_ms = 2 * frame_period_ms(o);
    ew_link_config config = {o->codec, o->keyframe_ms,
                             (unsigned)(status_ms > LEAST_STATUS_MS ? status_ms : LEAST_STATUS_MS),
                             o->timeout_ms, s->record.file};
    int r;

    ew_link_init(&s->link, s->driver, &config);
    while ((r = ew_link_open(&s->link)) == EW_DRIVER_ABSENT && ew_now_ms() < deadline && !interrupted) {
        ew_sleep_ms(100);
    }
    return r ? complain(o->device, s->link.error) : 0;
}

/* In the sender's thread: the display has confirmed the frame. */
static int confirmed(void *user, const uint16_t *drawn, char *error, size_t size)
{
    stream *s = user;
    const ew_sim_panel *panel = &s->device.sim.panel;
    size_t pixels = (size_t)panel->width * panel->height, i;

    if (s->options.compare) {
        for (i = 0; i < pixels && panel->shown[i] == drawn[i]; i++) {
        }
        if (i < pixels) {
            snprintf(error, size, "compare: pixel %zu,%zu of frame %lu is %04x, drawn was %04x",
                     i % panel->width, i / panel->width, s->link.totals.accepted - 1, panel->shown[i],
                     drawn[i]);
            return -1;
        }
    }
    if (ew_pictures_add(&s->pictures, panel->shown)) {
        snprintf(error, size, "out: the picture could not be written");
        return -1;
    }
    return 0;
}

static int start_sender(stream *s)
{
    const ew_stream_options *o = &s->options;
    ew_sender_config config;

    memset(&config, 0, sizeof config);
    config.lossless = o->is_sim || o->compare || o->fps == 0;
    config.confirm = o->is_sim || o->compare;
    config.confirmed = o->is_sim ? confirmed : NULL;
    config.user = s;
    config.reconnect_ms = o->reconnect_ms;
    config.watch_ms = o->is_sim ? 0 : o->timeout_ms + (s->lines.te ? s->lines.te_timeout_ms : 0);
    config.interrupted = &interrupted;
    return ew_sender_start(&s->sender, &s->link, &s->lines, &config) ? complain(o->device, s->sender.error)
                                                                     : 0;
}

/* ---- streaming ---- */

static int dump(stream *s)
{
    size_t pixels = (size_t)s->link.width * s->link.height, i;
    for (i = 0; s->dump.file && i < pixels; i++) {
        putc(s->source.pixels[i] & 0xFF, s->dump.file);
        putc(s->source.pixels[i] >> 8, s->dump.file);
    }
    if (s->dump.file && ferror(s->dump.file)) {
        return complain(s->options.dump_drawn, "write: the file takes no more");
    }
    return 0;
}

/* Sleeps to the next frame's time. A frame that comes late does not hurry the others. */
static void keep_time(const stream *s, int64_t *due_ns)
{
    int64_t now = ew_now_ns();
    if (s->options.fps == 0) {
        return;
    }
    *due_ns += (int64_t)(frame_period_ms(&s->options) * 1e6);
    if (*due_ns < now) {
        *due_ns = now;
    } else {
        ew_sleep_until_ns(*due_ns);
    }
}

static void show_progress(const stream *s, int64_t *shown_ms)
{
    int64_t now = ew_now_ms();
    if (now - *shown_ms >= 500) {
        fprintf(stderr, "\r%s: %u frames", ew_stream_tool, s->source.drawn);
        *shown_ms = now;
    }
}

static int send_frames(stream *s)
{
    int64_t due_ns = ew_now_ns(), shown_ms = ew_now_ms();
    int terminal = isatty(STDERR_FILENO), r = 1, failed = 0;

    while (!failed && !interrupted && (r = ew_frame_source_next(&s->source, &interrupted)) == 1) {
        failed = dump(s) || ew_sender_submit(&s->sender, s->source.pixels);
        keep_time(s, &due_ns);
        if (terminal) {
            show_progress(s, &shown_ms);
        }
    }
    if (terminal) {
        fprintf(stderr, "\r\033[K");
    }
    return r < 0 || failed ? -1 : 0;
}

static int check_counters(const stream *s)
{
    if (!s->options.compare || s->options.is_sim) {
        return 0;
    }
    if (!s->link.window) {
        return complain(s->options.device, "compare: the display sends no status reports");
    }
    if (!ew_link_counters_agree(&s->link)) {
        return complain(s->options.device, "compare: the display's own counters do not agree");
    }
    return 0;
}

static void print_totals(const stream *s)
{
    const ew_link_totals *t = &s->link.totals;
    double frames = t->sent ? (double)t->sent : 1;

    printf("frames drawn      %u\n", s->source.drawn);
    printf("frames sent       %lu\n", t->sent);
    if (s->link.window) {
        printf("frames accepted   %lu\n", t->accepted);
    } else {
        printf("frames accepted   not reported by the display\n");
    }
    printf("frames refused    %lu\n", t->refused);
    printf("frames dropped    %lu\n", s->sender.dropped);
    printf("frames/s          %.1f\n", s->seconds > 0 ? (double)t->sent / s->seconds : 0);
    printf("bytes/frame raw   %lu\n", 2ul * s->link.width * s->link.height);
    printf("bytes/frame sent  %.0f\n", (double)(t->reports * (1 + EW_HID_OUT_BYTES)) / frames);
    printf("reports/frame     %.1f\n", (double)t->reports / frames);
    printf("key frames        %lu\n", t->keys);
    printf("TE edges          %lu\n", s->lines.te_edges);
    printf("TE misses         %lu\n", s->lines.te_misses);
    printf("time-outs         %lu\n", t->timeouts);
    printf("reconnects        %lu\n", s->sender.reconnects);
}

static int run(stream *s)
{
    int64_t start;
    int r, failed;

    if (ew_frame_source_open(&s->source, &s->options, s->link.width, s->link.height) ||
        ew_pictures_open(&s->pictures, s->options.out, s->link.width, s->link.height) ||
        ew_whole_file_open(&s->dump, ew_stream_tool, s->options.dump_drawn) || start_sender(s)) {
        return -1;
    }
    start = ew_now_ns();
    failed = send_frames(s);
    r = ew_sender_end(&s->sender);
    s->seconds = (double)(ew_now_ns() - start) / 1e9;
    if (r) {
        failed = complain(s->options.device, s->sender.error);
    }
    if (!failed) {
        failed = check_counters(s);
    }
    print_totals(s);
    return failed;
}

/* With the sender's thread stuck in a driver nothing it uses may be freed: the files
 * that are not whole are removed and the rest is left to the end of the process. */
static void leave(const stream *s)
{
    if (s->record.temporary) {
        unlink(s->record.temporary);
    }
    if (s->dump.temporary) {
        unlink(s->dump.temporary);
    }
    fflush(stdout);
    _exit(EXIT_FAILURE);
}

static int stream_all(stream *s)
{
    int failed;

    choose_driver(s);
    if (ew_whole_file_open(&s->record, ew_stream_tool, s->options.record)) {
        return -1;
    }
    failed = open_lines(s);
    if (!failed && !open_display(s)) {
        failed = run(s);
        if (s->sender.abandoned) {
            leave(s);
        }
        ew_link_close(&s->link);
    } else {
        failed = -1;
    }
    failed |= ew_pictures_close(&s->pictures, s->options.fps);
    failed |= ew_whole_file_close(&s->record, !failed);
    failed |= ew_whole_file_close(&s->dump, !failed);
    ew_frame_source_close(&s->source);
    ew_link_free(&s->link);
    ew_panel_lines_close(&s->lines);
    if (s->options.is_sim) {
        ew_sim_free(&s->device.sim);
    }
    return failed;
}

int main(int argc, char **argv)
{
    static stream s;
    struct sigaction action;

    setlocale(LC_CTYPE, ""); /* serial numbers */
    ew_stream_parse_options(&s.options, argc, argv);
    if (s.options.list) {
        return list() ? EXIT_FAILURE : EXIT_SUCCESS;
    }
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    return stream_all(&s) ? EXIT_FAILURE : EXIT_SUCCESS;
}
