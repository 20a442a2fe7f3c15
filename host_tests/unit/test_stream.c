/* host_tests/unit/test_stream.c - ew-stream without a device: the host's rules over the
 * simulated display, with every kind of fault between them; the sender's thread; the
 * reset and tearing-effect lines with scripted edges.
 */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

#include "tools/stream/clock.h"
#include "tools/stream/link.h"
#include "tools/stream/panel_lines.h"
#include "tools/stream/sender.h"
#include "tools/stream/sim.h"

enum { WIDTH = 20, HEIGHT = 12, PIXELS = WIDTH * HEIGHT, TIMEOUT_MS = 300, SLACK_MS = 2000 };

/* ---- a simulated display behind a bad link ---- */

typedef enum fault {
    NO_FAULT,
    LOSE,
    REPEAT,
    SWAP,
    FLIP_BIT,
    LOSE_STATUS,
    POWER_CYCLE,
    GO_AWAY, /* this write and all after it fail until the next successful open */
    FAULTS
} fault;

typedef struct bad_link {
    ew_display_driver driver;
    ew_sim sim;
    fault fault;
    unsigned long at, writes, statuses; /* the fault is at this write or status, from 1 */
    uint8_t held[EW_HID_OUT_BYTES];
    int holding;
    int mute;             /* no status report ever arrives                              */
    int without_features; /* not our kind of display                                    */
    int open_loop;        /* says that it sends no status reports                       */
    int gone;
    unsigned absent, opens; /* opens that still fail; opens that succeeded              */
    unsigned write_ms;
    unsigned later_width;     /* of the display that comes back, 0: the same                */
    pthread_mutex_t *blocked; /* writes wait for it                                     */
    char error[64];
} bad_link;

static int bad_fail(bad_link *bad, int code, const char *text)
{
    snprintf(bad->error, sizeof bad->error, "%s", text);
    return code;
}

static int bad_open(ew_display_driver *driver)
{
    bad_link *bad = (bad_link *)driver;
    if (bad->absent > 0) {
        bad->absent--;
        return bad_fail(bad, EW_DRIVER_ABSENT, "open: no such display");
    }
    if (bad->opens++ > 0 && bad->later_width > 0) {
        bad->sim.width = bad->later_width;
    }
    bad->gone = 0;
    return bad->sim.driver.open(&bad->sim.driver);
}

static void pass(bad_link *bad, const uint8_t *report)
{
    bad->sim.driver.write_report(&bad->sim.driver, EW_HID_STREAM, report);
}

static void pass_with_fault(bad_link *bad, const uint8_t *report)
{
    uint8_t changed[EW_HID_OUT_BYTES];
    switch (bad->fault) {
    case LOSE: break;
    case REPEAT:
        pass(bad, report);
        pass(bad, report);
        break;
    case SWAP:
        memcpy(bad->held, report, EW_HID_OUT_BYTES);
        bad->holding = 1;
        break;
    case FLIP_BIT:
        memcpy(changed, report, EW_HID_OUT_BYTES);
        changed[bad->writes * 7 % EW_HID_OUT_BYTES] ^= (uint8_t)(1 << bad->writes % 8);
        pass(bad, changed);
        break;
    case POWER_CYCLE:
        pass(bad, report);
        bad->sim.driver.open(&bad->sim.driver);
        break;
    default: pass(bad, report); break;
    }
}

static int bad_write(ew_display_driver *driver, uint8_t id, const uint8_t *report)
{
    bad_link *bad = (bad_link *)driver;

    assert_int_equal(id, EW_HID_STREAM);
    bad->writes++;
    if (bad->blocked) {
        pthread_mutex_lock(bad->blocked);
        pthread_mutex_unlock(bad->blocked);
    }
    if (bad->write_ms) {
        ew_sleep_ms(bad->write_ms);
    }
    bad->gone |= bad->fault == GO_AWAY && bad->writes == bad->at;
    if (bad->gone) {
        return bad_fail(bad, EW_DRIVER_FAILED, "write: the display was unplugged");
    }
    if (bad->writes == bad->at) {
        pass_with_fault(bad, report);
        return 0;
    }
    pass(bad, report);
    if (bad->holding) {
        pass(bad, bad->held);
        bad->holding = 0;
    }
    return 0;
}

static int bad_read(ew_display_driver *driver, uint8_t *report, size_t size, unsigned timeout_ms)
{
    bad_link *bad = (bad_link *)driver;
    int n = bad->sim.driver.read_report(&bad->sim.driver, report, size, timeout_ms);
    if (bad->mute) {
        ew_sleep_ms(timeout_ms);
        return 0;
    }
    if (n > 0 && ++bad->statuses == bad->at && bad->fault == LOSE_STATUS) {
        return 0;
    }
    return n;
}

static int bad_get_feature(ew_display_driver *driver, uint8_t id, uint8_t *report, size_t size)
{
    bad_link *bad = (bad_link *)driver;
    int n = bad->sim.driver.get_feature(&bad->sim.driver, id, report, size);
    if (bad->without_features) {
        return bad_fail(bad, EW_DRIVER_FAILED, "feature report: stall");
    }
    if (id == EW_HID_CAPABILITIES && bad->open_loop) {
        report[10] = 0;
    }
    return n;
}

static void bad_close(ew_display_driver *driver) { (void)driver; }

static const char *bad_error(ew_display_driver *driver) { return ((bad_link *)driver)->error; }

static void bad_link_init(bad_link *bad, ew_hid_profile profile)
{
    static const ew_display_driver driver = {bad_open,        bad_write, bad_read,
                                             bad_get_feature, bad_close, bad_error};
    memset(bad, 0, sizeof *bad);
    bad->driver = driver;
    ew_sim_init(&bad->sim, WIDTH, HEIGHT, profile, 0);
}

/* ---- frames ---- */

/* Frame `n` of a sequence in which some of each picture moves and some stays. */
static void draw(uint16_t *pixels, unsigned n)
{
    unsigned i;
    for (i = 0; i < PIXELS; i++) {
        pixels[i] = (uint16_t)((i + 5 * n) % 9 < 3 ? 0x1234 + 77 * (i + n) : 0xF800);
    }
}

static void assert_shown(const bad_link *bad, const uint16_t *pixels)
{
    assert_memory_equal(bad->sim.panel.shown, pixels, PIXELS * sizeof *pixels);
}

static const ew_link_config quick = {EW_CODEC_AUTO, 0, 50, TIMEOUT_MS, NULL};

typedef struct setting {
    bad_link bad;
    ew_link link;
    ew_panel_lines lines;
    ew_sender sender;
} setting;

static void init_setting(setting *s, ew_hid_profile profile, const ew_link_config *config)
{
    bad_link_init(&s->bad, profile);
    memset(&s->lines, 0, sizeof s->lines);
    ew_link_init(&s->link, &s->bad.driver, config);
}

static void open_setting(setting *s, ew_hid_profile profile)
{
    init_setting(s, profile, &quick);
    assert_int_equal(ew_link_open(&s->link), 0);
}

static void open_faulty(setting *s, ew_hid_profile profile, fault kind, unsigned long at)
{
    open_setting(s, profile);
    s->bad.fault = kind;
    s->bad.at = at;
}

static void deliver(setting *s, unsigned n)
{
    uint16_t pixels[PIXELS];
    draw(pixels, n);
    assert_int_equal(ew_link_deliver(&s->link, pixels), EW_LINK_OK);
    assert_shown(&s->bad, pixels);
}

static void close_setting(setting *s)
{
    ew_link_close(&s->link);
    ew_link_free(&s->link);
    ew_sim_free(&s->bad.sim);
}

/* ---- the link ---- */

static void test_link_reads_size(void **state)
{
    setting s;
    (void)state;
    open_setting(&s, EW_HID_BUFFERED);
    assert_int_equal(s.link.width, WIDTH);
    assert_int_equal(s.link.height, HEIGHT);
    assert_int_equal(s.link.window, 1);
    close_setting(&s);
}

static void test_link_refuses_other_displays(void **state)
{
    setting s;
    (void)state;
    init_setting(&s, EW_HID_BUFFERED, &quick);
    s.bad.without_features = 1;
    assert_int_equal(ew_link_open(&s.link), EW_DRIVER_FAILED);
    assert_non_null(strstr(s.link.error, "not a display that takes streamed frames"));
    s.bad.absent = 1;
    assert_int_equal(ew_link_open(&s.link), EW_DRIVER_ABSENT);
    assert_string_equal(s.link.error, "open: no such display");
    close_setting(&s);
}

/* Every fault at every report of five frames: with `deliver` each picture is right. */
static void test_link_recovers_from_every_fault(void **state)
{
    unsigned long at, last;
    int profile, f;
    unsigned n;
    (void)state;

    for (profile = EW_HID_DIRECT; profile <= EW_HID_BUFFERED; profile++) {
        for (f = LOSE; f < GO_AWAY; f++) {
            for (at = 1, last = 1; at <= last; at++) {
                setting s;
                test_context("profile %d, fault %d at report %lu", profile, f, at);
                open_faulty(&s, (ew_hid_profile)profile, (fault)f, at);
                for (n = 0; n < 5; n++) {
                    deliver(&s, n);
                }
                assert_int_equal(s.link.totals.accepted, 5);
                last = f == LOSE_STATUS ? s.bad.statuses : s.bad.writes;
                close_setting(&s);
            }
            assert_true(last >= 5);
        }
    }
}

/* Without `deliver` a frame may be lost, but the one after it brings all right. */
static void test_link_next_frame_is_key(void **state)
{
    uint16_t pixels[PIXELS];
    setting s;
    unsigned n;
    (void)state;

    open_faulty(&s, EW_HID_BUFFERED, LOSE, 9);
    for (n = 0; n < 8; n++) {
        draw(pixels, n);
        assert_int_not_equal(ew_link_send(&s.link, pixels), EW_LINK_LOST);
    }
    assert_int_equal(ew_link_settle(&s.link), EW_LINK_OK);
    assert_shown(&s.bad, pixels);
    assert_int_equal(s.link.totals.refused, 1);
    assert_int_equal(s.link.totals.keys, 2);
    close_setting(&s);
}

static void test_link_lost_status_counts_as_timeout(void **state)
{
    setting s;
    (void)state;

    open_faulty(&s, EW_HID_BUFFERED, LOSE_STATUS, 1);
    deliver(&s, 0);
    assert_int_equal(s.link.totals.timeouts, 1);
    assert_int_equal(s.link.totals.sent, 2);
    assert_int_equal(s.link.totals.keys, 2);
    close_setting(&s);
}

static void test_link_unchanged_frame_is_one_report(void **state)
{
    ew_link_config raw = quick;
    setting s;
    unsigned long before;
    (void)state;

    raw.codec = EW_CODEC_RAW;
    init_setting(&s, EW_HID_BUFFERED, &raw);
    assert_int_equal(ew_link_open(&s.link), 0);
    deliver(&s, 0);
    before = s.bad.writes;
    deliver(&s, 0);
    assert_int_equal(s.bad.writes, before + 1);
    assert_int_equal(s.link.totals.accepted, 2);
    assert_int_equal(ew_link_keep_alive(&s.link), EW_LINK_OK);
    assert_int_equal(s.bad.writes, before + 2);
    assert_int_equal(s.link.totals.accepted, 2);
    assert_int_equal(s.link.totals.keep_alives, 1);
    assert_true(ew_link_counters_agree(&s.link));
    close_setting(&s);
}

static void test_link_counters_tell_of_refusals(void **state)
{
    setting s;
    unsigned n;
    (void)state;

    open_setting(&s, EW_HID_BUFFERED);
    assert_false(ew_link_counters_agree(&s.link)); /* it has not spoken yet */
    for (n = 0; n < 300; n++) {                    /* past the counters' wrap */
        deliver(&s, n);
    }
    assert_true(ew_link_counters_agree(&s.link));
    s.bad.fault = FLIP_BIT;
    s.bad.at = s.bad.writes + 2;
    deliver(&s, 1);
    assert_false(ew_link_counters_agree(&s.link));
    close_setting(&s);
}

static void test_link_open_loop_key_frames(void **state)
{
    ew_link_config config = quick;
    setting s;
    unsigned n;
    (void)state;

    config.keyframe_ms = 40;
    init_setting(&s, EW_HID_BUFFERED, &config);
    s.bad.open_loop = s.bad.mute = 1;
    assert_int_equal(ew_link_open(&s.link), 0);
    for (n = 0; n < 10; n++) {
        deliver(&s, n);
        ew_sleep_ms(25);
    }
    assert_int_equal(s.link.totals.timeouts, 0);
    assert_in_range(s.link.totals.keys, 3, 9);
    close_setting(&s);
}

/* A display that takes reports and never answers: given up after TIMEOUT_MS. */
static void test_link_never_answering_ends(void **state)
{
    uint16_t pixels[PIXELS];
    int64_t start = ew_now_ms();
    setting s;
    (void)state;

    open_setting(&s, EW_HID_BUFFERED);
    s.bad.mute = 1;
    draw(pixels, 0);
    assert_int_equal(ew_link_deliver(&s.link, pixels), EW_LINK_LOST);
    assert_in_range(ew_now_ms() - start, TIMEOUT_MS, TIMEOUT_MS + SLACK_MS);
    assert_non_null(strstr(s.link.error, "no frame confirmed for 300 ms"));
    assert_true(s.link.totals.timeouts >= 3);
    close_setting(&s);
}

static void test_link_records_whole_reports(void **state)
{
    ew_link_config config = quick;
    char line[512];
    setting s;
    unsigned long lines = 0;
    (void)state;

    config.record = tmpfile();
    assert_non_null(config.record);
    init_setting(&s, EW_HID_BUFFERED, &config);
    assert_int_equal(ew_link_open(&s.link), 0);
    deliver(&s, 0);
    rewind(config.record);
    while (fgets(line, sizeof line, config.record)) {
        assert_int_equal(strlen(line), 3 * (1 + EW_HID_OUT_BYTES));
        assert_memory_equal(line, "04 ", 3);
        lines++;
    }
    assert_int_equal(lines, s.bad.writes);
    fclose(config.record);
    close_setting(&s);
}

/* ---- the sender ---- */

/* Submits so many frames; `expected` is 0, with the last of them shown, or -1. */
static void run_sender(setting *s, const ew_sender_config *config, unsigned frames, unsigned pause_ms,
                       int expected)
{
    uint16_t pixels[PIXELS];
    unsigned n;
    int r = 0;

    assert_int_equal(ew_sender_start(&s->sender, &s->link, &s->lines, config), 0);
    for (n = 0; n < frames && !r; n++) {
        draw(pixels, n);
        r = ew_sender_submit(&s->sender, pixels);
        ew_sleep_ms(pause_ms);
    }
    r |= ew_sender_end(&s->sender);
    assert_int_equal(r ? -1 : 0, expected);
    if (!expected) {
        assert_shown(&s->bad, pixels);
    }
}

static void test_sender_lossless(void **state)
{
    ew_sender_config config = {.lossless = 1};
    setting s;
    (void)state;

    open_setting(&s, EW_HID_BUFFERED);
    run_sender(&s, &config, 50, 0, 0);
    assert_int_equal(s.sender.dropped, 0);
    assert_int_equal(s.link.totals.accepted, 50);
    close_setting(&s);
}

static void test_sender_newest_wins(void **state)
{
    ew_sender_config config = {0};
    setting s;
    (void)state;

    open_setting(&s, EW_HID_BUFFERED);
    s.bad.write_ms = 2;
    run_sender(&s, &config, 40, 1, 0);
    assert_true(s.sender.dropped > 0);
    assert_int_equal(s.link.totals.accepted + s.sender.dropped, 40);
    close_setting(&s);
}

/* The last frame arrives even when its last report is lost. */
static void test_sender_repeats_the_last_frame(void **state)
{
    ew_sender_config config = {.lossless = 1};
    unsigned long whole, lost;
    setting s;
    (void)state;

    open_setting(&s, EW_HID_DIRECT);
    run_sender(&s, &config, 6, 0, 0);
    whole = s.bad.writes;
    close_setting(&s);
    for (lost = 1; lost <= whole; lost++) {
        test_context("report %lu lost", lost);
        open_faulty(&s, EW_HID_DIRECT, LOSE, lost);
        run_sender(&s, &config, 6, 0, 0);
        close_setting(&s);
    }
}

static int count_confirmed(void *user, const uint16_t *pixels, char *error, size_t size)
{
    unsigned *count = user;
    uint16_t expected[PIXELS];
    (void)error, (void)size;
    draw(expected, (*count)++);
    return memcmp(expected, pixels, sizeof expected) ? -1 : 0;
}

static void test_sender_confirms_every_frame(void **state)
{
    unsigned count = 0;
    ew_sender_config config = {
        .lossless = 1, .confirm = 1, .confirmed = count_confirmed, .user = &count, .reconnect_ms = 3000};
    setting s;
    (void)state;

    open_faulty(&s, EW_HID_BUFFERED, GO_AWAY, 30); /* in the midst of a frame, which has to be sent again */
    s.bad.absent = 0;
    run_sender(&s, &config, 20, 0, 0);
    assert_int_equal(count, 20);
    assert_int_equal(s.sender.reconnects, 1);
    assert_int_equal(s.sender.dropped, 0);
    close_setting(&s);
}

static void test_sender_unplugged(void **state)
{
    ew_sender_config config = {.lossless = 1};
    setting s;
    (void)state;

    open_faulty(&s, EW_HID_BUFFERED, GO_AWAY, 30);
    run_sender(&s, &config, 20, 0, -1);
    assert_string_equal(s.sender.error, "write: the display was unplugged");
    assert_false(s.sender.abandoned);
    close_setting(&s);
}

static void test_sender_reconnects(void **state)
{
    unsigned long at;
    (void)state;

    for (at = 1; at <= 40; at += 3) {
        ew_sender_config config = {.lossless = 1, .reconnect_ms = 5000};
        setting s;
        test_context("unplugged at report %lu", at);
        open_faulty(&s, EW_HID_DIRECT, GO_AWAY, at);
        s.bad.absent = 1;
        run_sender(&s, &config, 12, 0, 0);
        assert_int_equal(s.sender.reconnects, 1);
        close_setting(&s);
    }
}

static void test_sender_does_not_wait_for_ever(void **state)
{
    ew_sender_config config = {.lossless = 1, .reconnect_ms = 300};
    int64_t start = ew_now_ms();
    setting s;
    (void)state;

    open_faulty(&s, EW_HID_BUFFERED, GO_AWAY, 10);
    s.bad.absent = 1000000;
    run_sender(&s, &config, 20, 0, -1);
    assert_in_range(ew_now_ms() - start, 300, 300 + SLACK_MS);
    assert_non_null(
        strstr(s.sender.error, "unplugged; looked for it again for 300 ms: open: no such display"));
    close_setting(&s);
}

static void test_sender_other_size_after_reconnect(void **state)
{
    ew_sender_config config = {.lossless = 1, .reconnect_ms = 300};
    setting s;
    (void)state;

    open_faulty(&s, EW_HID_BUFFERED, GO_AWAY, 10);
    s.bad.later_width = WIDTH + 1;
    run_sender(&s, &config, 20, 0, -1);
    assert_non_null(strstr(s.sender.error, "came back with another size"));
    close_setting(&s);
}

static void test_sender_keeps_alive(void **state)
{
    ew_sender_config config = {.lossless = 1};
    setting s;
    (void)state;

    open_setting(&s, EW_HID_BUFFERED);
    run_sender(&s, &config, 1, 2300, 0);
    assert_in_range(s.link.totals.keep_alives, 1, 3);
    assert_int_equal(s.link.totals.accepted, 1);
    close_setting(&s);
}

/* A write that does not return: the drawing side is told within watch_ms. */
static void test_sender_blocked_write_ends(void **state)
{
    pthread_mutex_t blocked = PTHREAD_MUTEX_INITIALIZER;
    ew_sender_config config = {.lossless = 1, .watch_ms = 200};
    int64_t start;
    uint16_t pixels[PIXELS];
    setting s;
    int r = 0, n;
    (void)state;

    open_setting(&s, EW_HID_BUFFERED);
    s.bad.blocked = &blocked;
    pthread_mutex_lock(&blocked);
    assert_int_equal(ew_sender_start(&s.sender, &s.link, &s.lines, &config), 0);
    start = ew_now_ms();
    draw(pixels, 0);
    for (n = 0; n < 10 && !r; n++) {
        r = ew_sender_submit(&s.sender, pixels);
    }
    assert_int_equal(r, -1);
    assert_int_equal(ew_sender_end(&s.sender), -1);
    assert_in_range(ew_now_ms() - start, 200, 200 + SLACK_MS);
    assert_true(s.sender.abandoned);
    assert_string_equal(s.sender.error, "write: the display has taken nothing for 200 ms");
    pthread_mutex_unlock(&blocked); /* lets the thread end, so that the test leaks nothing */
    pthread_join(s.sender.thread, NULL);
    free(s.sender.mailbox);
    free(s.sender.work);
    close_setting(&s);
}

static void test_sender_interrupted_while_looking(void **state)
{
    static atomic_int interrupted;
    ew_sender_config config = {.reconnect_ms = 60000, .interrupted = &interrupted};
    int64_t start = ew_now_ms();
    uint16_t pixels[PIXELS];
    setting s;
    (void)state;

    open_faulty(&s, EW_HID_BUFFERED, GO_AWAY, 1);
    s.bad.absent = 1000000;
    assert_int_equal(ew_sender_start(&s.sender, &s.link, &s.lines, &config), 0);
    draw(pixels, 0);
    assert_int_equal(ew_sender_submit(&s.sender, pixels), 0);
    ew_sleep_ms(200);
    interrupted = 1;
    assert_int_equal(ew_sender_end(&s.sender), -1);
    assert_true(ew_now_ms() - start < SLACK_MS);
    close_setting(&s);
}

/* ---- reset and tearing-effect lines ---- */

/* What wait_edge returns: first for edges that have gone by, then for real waits, one
 * letter each: e edge, . none, ! failure. The last letter is repeated. */
static struct script {
    const char *gone_by, *waits;
    unsigned asked, waited, longest_ms, held;
    int values[8];
    int64_t set_at_ms[8];
    unsigned sets;
    const char *missing; /* the line that cannot be opened */
} script;

static int read_letter(const char **letters)
{
    char letter = **letters;
    if (letter && (*letters)[1]) {
        (*letters)++;
    }
    return letter == 'e' ? 1 : letter == '!' ? -1 : 0;
}

static ew_gpio_line *scripted_open(const char *chip, const char *line, ew_gpio_use use, char *error,
                                   size_t size)
{
    (void)chip, (void)use;
    if (script.missing && !strcmp(line, script.missing)) {
        snprintf(error, size, "request line %s: no such line", line);
        return NULL;
    }
    script.held++;
    return (ew_gpio_line *)&script;
}

static int scripted_set(ew_gpio_line *line, int value)
{
    (void)line;
    script.values[script.sets] = value;
    script.set_at_ms[script.sets++] = ew_now_ms();
    return 0;
}

static int scripted_wait_edge(ew_gpio_line *line, unsigned timeout_ms)
{
    (void)line;
    if (timeout_ms == 0) {
        script.asked++;
        return read_letter(&script.gone_by);
    }
    script.waited++;
    script.longest_ms = timeout_ms;
    return read_letter(&script.waits);
}

static void scripted_close(ew_gpio_line *line)
{
    (void)line;
    script.held--;
}

static const char *scripted_name(void) { return "script"; }

static const ew_gpio_backend scripted = {scripted_open, scripted_set, scripted_wait_edge, scripted_close,
                                         scripted_name};

static void open_scripted(ew_panel_lines *lines, const char *gone_by, const char *waits)
{
    char error[128];
    memset(&script, 0, sizeof script);
    script.gone_by = gone_by;
    script.waits = waits;
    assert_int_equal(ew_panel_lines_open(lines, &scripted, "chip:0", "chip:1", error, sizeof error), 0);
    lines->te_timeout_ms = 66;
}

static void test_te_forgets_old_edges(void **state)
{
    ew_panel_lines lines;
    (void)state;
    open_scripted(&lines, "eee.", "e");
    assert_int_equal(ew_panel_wait_te(&lines), 0);
    assert_int_equal(script.asked, 4);
    assert_int_equal(script.waited, 1);
    assert_int_equal(script.longest_ms, 66);
    assert_int_equal(lines.te_edges, 1);
    assert_int_equal(lines.te_misses, 0);
    ew_panel_lines_close(&lines);
    assert_int_equal(script.held, 0);
}

static void test_te_misses_are_counted(void **state)
{
    ew_panel_lines lines;
    int i;
    (void)state;
    open_scripted(&lines, ".", "e..e.");
    for (i = 0; i < 6; i++) {
        assert_int_equal(ew_panel_wait_te(&lines), 0);
    }
    assert_int_equal(lines.te_edges, 2);
    assert_int_equal(lines.te_misses, 4);
    ew_panel_lines_close(&lines);
}

static void test_te_too_fast_a_line_does_not_block(void **state)
{
    ew_panel_lines lines;
    (void)state;
    open_scripted(&lines, "e", "e");
    assert_int_equal(ew_panel_wait_te(&lines), 0);
    assert_true(script.asked < 100);
    assert_int_equal(lines.te_edges, 1);
    ew_panel_lines_close(&lines);
}

static void test_te_failure(void **state)
{
    ew_panel_lines lines;
    (void)state;
    open_scripted(&lines, ".", "!");
    assert_int_equal(ew_panel_wait_te(&lines), -1);
    ew_panel_lines_close(&lines);
}

/* Each frame waits for its edge; a line that dies costs time, not the stream. */
static void test_te_paces_the_sender(void **state)
{
    ew_sender_config config = {.lossless = 1};
    setting s;
    (void)state;
    open_setting(&s, EW_HID_BUFFERED);
    open_scripted(&s.lines, ".", "eeeeeee.");
    run_sender(&s, &config, 10, 0, 0);
    assert_int_equal(script.waited, 10);
    assert_int_equal(s.lines.te_edges, 7);
    assert_int_equal(s.lines.te_misses, 3);
    assert_int_equal(s.link.totals.accepted, 10);
    ew_panel_lines_close(&s.lines);
    close_setting(&s);
}

static void test_te_failure_ends_the_sender(void **state)
{
    ew_sender_config config = {.lossless = 1, .reconnect_ms = 5000};
    setting s;
    (void)state;
    open_setting(&s, EW_HID_BUFFERED);
    open_scripted(&s.lines, ".", "ee!");
    run_sender(&s, &config, 10, 0, -1);
    assert_string_equal(s.sender.error, "TE line: cannot be read any more");
    ew_panel_lines_close(&s.lines);
    close_setting(&s);
}

static void test_reset_pulse(void **state)
{
    ew_panel_lines lines;
    int64_t end;
    (void)state;
    open_scripted(&lines, ".", ".");
    assert_int_equal(ew_panel_reset(&lines), 0);
    end = ew_now_ms();
    assert_int_equal(script.sets, 2);
    assert_int_equal(script.values[0], 0);
    assert_int_equal(script.values[1], 1);
    assert_true(script.set_at_ms[1] - script.set_at_ms[0] >= EW_RESET_LOW_MS - 1);
    assert_true(end - script.set_at_ms[1] >= EW_RESET_WAIT_MS - 1);
    ew_panel_lines_close(&lines);
}

static void test_no_lines(void **state)
{
    ew_panel_lines lines;
    char error[128];
    (void)state;
    assert_int_equal(ew_panel_lines_open(&lines, &scripted, NULL, NULL, error, sizeof error), 0);
    assert_int_equal(ew_panel_reset(&lines), 0);
    assert_int_equal(ew_panel_wait_te(&lines), 0);
    ew_panel_lines_close(&lines);
}

static void test_lines_that_cannot_be_opened(void **state)
{
    static const char *const wrong[] = {"", ":", "chip", "chip:", ":line"};
    ew_panel_lines lines;
    char error[128];
    size_t i;
    (void)state;
    memset(&script, 0, sizeof script);
    script.missing = "7";
    assert_int_equal(ew_panel_lines_open(&lines, &scripted, "chip:0", "/dev/chip:7", error, sizeof error),
                     -1);
    assert_string_equal(error, "/dev/chip:7: request line 7: no such line");
    assert_int_equal(script.held, 0);
    for (i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(ew_panel_lines_open(&lines, &scripted, wrong[i], NULL, error, sizeof error), -1);
        assert_non_null(strstr(error, "not of the form CHIP:LINE"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_link_reads_size),
        TEST(test_link_refuses_other_displays),
        TEST(test_link_recovers_from_every_fault),
        TEST(test_link_next_frame_is_key),
        TEST(test_link_lost_status_counts_as_timeout),
        TEST(test_link_unchanged_frame_is_one_report),
        TEST(test_link_counters_tell_of_refusals),
        TEST(test_link_open_loop_key_frames),
        TEST(test_link_never_answering_ends),
        TEST(test_link_records_whole_reports),
        TEST(test_sender_lossless),
        TEST(test_sender_newest_wins),
        TEST(test_sender_repeats_the_last_frame),
        TEST(test_sender_confirms_every_frame),
        TEST(test_sender_unplugged),
        TEST(test_sender_reconnects),
        TEST(test_sender_does_not_wait_for_ever),
        TEST(test_sender_other_size_after_reconnect),
        TEST(test_sender_keeps_alive),
        TEST(test_sender_blocked_write_ends),
        TEST(test_sender_interrupted_while_looking),
        TEST(test_te_forgets_old_edges),
        TEST(test_te_misses_are_counted),
        TEST(test_te_too_fast_a_line_does_not_block),
        TEST(test_te_failure),
        TEST(test_te_paces_the_sender),
        TEST(test_te_failure_ends_the_sender),
        TEST(test_reset_pulse),
        TEST(test_no_lines),
        TEST(test_lines_that_cannot_be_opened),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
