/* host_tests/unit/test_display_faults.c - the display link with faults.
 *
 * Animations go through a channel that loses, repeats, swaps, cuts short and changes
 * reports. After every pixel drawn: it is that pixel of a frame that was sent. After
 * every commit: the panel is, whole, the frame whose number the device states. After
 * one key frame without faults: the picture is right, on either kind of device.
 *
 * For a direct device a changed report has an odd number of wrong bits: those the check
 * always finds. An even number passes it once in some 256 times; the CRC at the frame's
 * end is then what is left, and a direct device has drawn by that time.
 */
#include "display_panel.h"

enum { MOST_SIDE = 24, MOST_PIXELS = MOST_SIDE * MOST_SIDE, FRAMES = 24 };

typedef enum fault {
    FAULT_NONE,
    FAULT_LOSE,
    FAULT_REPEAT,
    FAULT_SWAP, /* comes after the report that follows */
    FAULT_TRUNCATE,
    FAULT_LENGTHEN,
    FAULT_FLIP,
    FAULT_WAIT,       /* the time-out passes before it        */
    FAULT_LOSE_FIRST, /* from here on, by place in the frame  */
    FAULT_LOSE_LAST,
    FAULT_LOSE_FRAME,
    FAULT_KINDS
} fault;

typedef struct animation {
    uint64_t seed, random;
    test_panel panel;
    ew_stream_encoder encoder;
    uint16_t frames[FRAMES][MOST_PIXELS]; /* whole pictures, by number of frame */
    unsigned first_of_session, sent;      /* sent: how many of them             */
    uint8_t held[EW_HID_OUT_BYTES];       /* a report that comes late           */
    int holds;
    int status; /* newest read, -1 when none was                                */
    unsigned long faults, recoveries;
} animation;

/* A colour that tells frame and pixel, but for areas of one colour so that runs occur:
 * those tell frame and area. */
static uint16_t animated_pixel(unsigned frame, uint32_t pixel, int flat)
{
    uint32_t colour =
        flat ? 0x8000u | (frame * 131u + pixel / 9 % 3 * 41u) : (pixel * 29u + frame * 1201u) & 0x7FFFu;
    return (uint16_t)(colour == BLANK ? 1 : colour);
}

/* The next picture: the one before with some stretches of its own. */
static void draw_next(animation *a, int key)
{
    uint32_t n = (uint32_t)a->panel.width * a->panel.height;
    uint16_t *picture = a->frames[a->sent];
    if (a->sent > 0) memcpy(picture, a->frames[a->sent - 1], n * sizeof *picture);
    for (uint32_t i = 0; i < n;) {
        uint32_t length = 1 + random_below(&a->random, n / 3 + 1);
        int changes = key || random_below(&a->random, 2), flat = (int)random_below(&a->random, 2);
        for (; length > 0 && i < n; length--, i++)
            if (changes) picture[i] = animated_pixel(a->sent, i, flat);
    }
    a->sent++;
}

static void check_pixel(void *context, uint32_t index, uint16_t colour)
{
    animation *a = context;
    for (unsigned i = 0; i < a->sent; i++)
        if (a->frames[i][index] == colour) return;
    fail_msg("seed %llu: pixel %u drawn as %04x, of no frame sent", (unsigned long long)a->seed, index,
             colour);
}

static void check_commit(void *context)
{
    animation *a = context;
    unsigned frame = a->first_of_session + a->panel.display.frame_number;
    assert_in_range(frame, a->first_of_session, a->sent - 1);
    if (memcmp(a->panel.shown, a->frames[frame], panel_bytes(&a->panel)) != 0)
        fail_msg("seed %llu: not frame %u, as it says", (unsigned long long)a->seed, frame);
}

/* A buffered panel shows one whole frame, or is blank, whenever one looks. */
static void check_not_torn(animation *a)
{
    size_t bytes = panel_bytes(&a->panel);
    uint16_t blank[MOST_PIXELS];
    if (a->panel.shown == a->panel.collected) return;
    for (unsigned i = a->sent; i-- > 0;)
        if (memcmp(a->panel.shown, a->frames[i], bytes) == 0) return;
    for (int i = 0; i < MOST_PIXELS; i++) blank[i] = BLANK;
    if (memcmp(a->panel.shown, blank, bytes) != 0)
        fail_msg("seed %llu: the panel shows no frame", (unsigned long long)a->seed);
}

static void deliver(animation *a, const uint8_t *report, size_t length)
{
    ew_hid_display_output(&a->panel.display, EW_HID_STREAM, report, length);
    check_not_torn(a);
    int status = panel_status(&a->panel);
    if (status >= 0) a->status = status;
}

static void deliver_changed(animation *a, const uint8_t *report)
{
    uint8_t changed[EW_HID_OUT_BYTES];
    int buffered = a->panel.shown != a->panel.collected;
    unsigned bits = buffered ? 1 + random_below(&a->random, 20) : 1 + 2 * random_below(&a->random, 3);
    memcpy(changed, report, sizeof changed);
    for (unsigned flipped = 0; flipped < bits;) {
        unsigned bit = random_below(&a->random, 8 * EW_HID_OUT_BYTES);
        if (((changed[bit / 8] ^ report[bit / 8]) >> bit % 8 & 1) == 0) {
            changed[bit / 8] = (uint8_t)(changed[bit / 8] ^ 1u << bit % 8);
            flipped++;
        }
    }
    deliver(a, changed, sizeof changed);
}

static void send_through(animation *a, const uint8_t *report, fault f)
{
    uint8_t longer[80] = {0};
    a->faults += f != FAULT_NONE;
    memcpy(longer, report, EW_HID_OUT_BYTES);
    switch (f) {
    case FAULT_LOSE: break;
    case FAULT_TRUNCATE: deliver(a, report, random_below(&a->random, EW_HID_OUT_BYTES)); break;
    case FAULT_LENGTHEN: deliver(a, longer, EW_HID_OUT_BYTES + 1 + random_below(&a->random, 16)); break;
    case FAULT_FLIP: deliver_changed(a, report); break;
    case FAULT_SWAP:
        if (!a->holds) {
            memcpy(a->held, report, sizeof a->held);
            a->holds = 1;
            return;
        }
        deliver(a, report, EW_HID_OUT_BYTES);
        break;
    case FAULT_REPEAT:
        deliver(a, report, EW_HID_OUT_BYTES);
        deliver(a, report, EW_HID_OUT_BYTES);
        break;
    case FAULT_WAIT:
        ew_hid_display_tick(&a->panel.display, 300 + random_below(&a->random, 400));
        deliver(a, report, EW_HID_OUT_BYTES);
        break;
    default: deliver(a, report, EW_HID_OUT_BYTES); break;
    }
    if (a->holds) {
        a->holds = 0;
        deliver(a, a->held, EW_HID_OUT_BYTES);
    }
}

/* Draws and sends the next frame. `in_1000`: how many of 1000 reports meet a fault. */
static void send_next(animation *a, int key, uint32_t in_1000)
{
    uint8_t report[EW_HID_OUT_BYTES];
    int first = 1;
    fault whole = random_below(&a->random, 1000) < in_1000
                      ? (fault)(FAULT_LOSE_FIRST + random_below(&a->random, FAULT_KINDS - FAULT_LOSE_FIRST))
                      : FAULT_NONE;
    draw_next(a, key);
    ew_stream_frame frame = {
        a->frames[a->sent - 1], key ? NULL : a->frames[a->sent - 2], a->panel.width, 0, 0, a->panel.width,
        a->panel.height};
    assert_int_equal(ew_stream_begin(&a->encoder, &frame, (ew_codec)random_below(&a->random, 3)), EW_OK);
    while (ew_stream_next(&a->encoder, report)) {
        int last = (report[0] & 2) != 0;
        fault f = FAULT_NONE;
        if (random_below(&a->random, 1000) < in_1000)
            f = (fault)(FAULT_LOSE + random_below(&a->random, FAULT_LOSE_FIRST - FAULT_LOSE));
        if (whole == FAULT_LOSE_FRAME || (whole == FAULT_LOSE_FIRST && first) ||
            (whole == FAULT_LOSE_LAST && last))
            f = FAULT_LOSE;
        send_through(a, report, f);
        first = 0;
    }
}

/* What is late still comes, then one key frame and one delta frame without faults. */
static void assert_one_key_mends(animation *a)
{
    if (a->holds) deliver(a, a->held, EW_HID_OUT_BYTES);
    a->holds = 0;
    for (int key = 1; key >= 0; key--) {
        send_next(a, key, 0);
        if (a->status != EW_STREAM_OK ||
            memcmp(a->panel.shown, a->frames[a->sent - 1], panel_bytes(&a->panel)) != 0)
            fail_msg("seed %llu: not right after a %s frame", (unsigned long long)a->seed,
                     key ? "key" : "delta");
    }
}

static void open_animation(animation *a, uint64_t seed)
{
    uint16_t width, height;
    memset(a, 0, sizeof *a);
    a->seed = a->random = seed;
    a->status = -1;
    width = (uint16_t)(1 + random_below(&a->random, MOST_SIDE));
    height = (uint16_t)(1 + random_below(&a->random, MOST_SIDE));
    panel_open(&a->panel, seed & 1 ? EW_HID_BUFFERED : EW_HID_DIRECT, width, height);
    a->panel.context = a;
    a->panel.on_pixel = seed & 1 ? NULL : check_pixel; /* what is only collected may be wrong */
    a->panel.on_commit = check_commit;
    ew_stream_encoder_init(&a->encoder);
}

/* A sender that does not listen at all: delta after delta, a key frame now and then. */
static void test_deaf_sender(void **state)
{
    (void)state;
    static animation a;
    unsigned long faults = 0;
    for (uint64_t seed = 1; seed <= 8000; seed++) {
        open_animation(&a, seed);
        uint32_t in_1000 = 5u << random_below(&a.random, 7);
        for (unsigned i = 0; i < FRAMES - 2; i++)
            send_next(&a, i == 0 || random_below(&a.random, 5) == 0, in_1000);
        assert_one_key_mends(&a);
        faults += a.faults;
        panel_close(&a.panel);
    }
    print_message("%lu faults in 8000 sequences\n", faults);
}

/* A sender that reads the status and answers anything but OK with a key frame. Without
 * an answer at all it waits for the time-out and sends one as well. */
static void listening_session(animation *a, unsigned frames, uint32_t in_1000)
{
    int key = 1;
    for (unsigned i = 0; i < frames; i++) {
        a->status = -1;
        unsigned long faults = a->faults;
        int held = a->holds;
        send_next(a, key, in_1000);
        int clean = a->faults == faults && !held && !a->holds;
        if (a->status < 0) {
            ew_hid_display_tick(&a->panel.display, 500);
            a->status = panel_status(&a->panel);
        }
        if (clean) {
            /* A frame that met no fault is accepted if it is a key frame, and is then
             * what the panel shows; a delta is accepted or a key frame asked for. */
            if (key) assert_int_equal(a->status, EW_STREAM_OK);
            assert_true(a->status >= 0);
        }
        if (clean && a->status == EW_STREAM_OK)
            assert_memory_equal(a->panel.shown, a->frames[a->sent - 1], panel_bytes(&a->panel));
        a->recoveries += key && i > 0 && a->status == EW_STREAM_OK;
        key = a->status != EW_STREAM_OK;
    }
}

static void test_listening_sender(void **state)
{
    (void)state;
    static animation a;
    unsigned long faults = 0, recoveries = 0;
    for (uint64_t seed = 1; seed <= 4000; seed++) {
        open_animation(&a, seed ^ 0xA5A50000u);
        listening_session(&a, FRAMES - 4, 4u << random_below(&a.random, 5));
        if (a.holds) deliver(&a, a.held, EW_HID_OUT_BYTES);
        a.holds = 0;
        /* In quiet again the sender needs at most one refused frame to be right. */
        listening_session(&a, 1, 0);
        assert_one_key_mends(&a);
        faults += a.faults;
        recoveries += a.recoveries;
        panel_close(&a.panel);
    }
    print_message("%lu faults, %lu recoveries in 4000 sessions\n", faults, recoveries);
}

/* A sender that dies anywhere in a frame and is started again, at frame 0 and sequence 0,
 * over a link with faults; it clears the display when it opens it. */
static void test_restarted_sender(void **state)
{
    (void)state;
    static animation a;
    static const uint8_t clear[EW_HID_CONTROL_BYTES] = {3, 255};
    for (uint64_t seed = 1; seed <= 4000; seed++) {
        uint8_t report[EW_HID_OUT_BYTES];
        open_animation(&a, seed ^ 0x5A0000u);
        for (int session = 0; session < 4; session++) {
            assert_int_equal(ew_hid_display_set_feature(&a.panel.display, EW_HID_CONTROL, clear, 2), EW_OK);
            a.holds = 0;
            a.first_of_session = a.sent;
            ew_stream_encoder_init(&a.encoder);
            unsigned frames = random_below(&a.random, 4);
            for (unsigned i = 0; i < frames; i++) send_next(&a, i == 0, 60);
            if (frames > 0) { /* and dies in the next one */
                draw_next(&a, 0);
                ew_stream_frame frame = {a.frames[a.sent - 1], a.frames[a.sent - 2], a.panel.width, 0, 0,
                                         a.panel.width,        a.panel.height};
                ew_stream_begin(&a.encoder, &frame, EW_CODEC_RAW);
                for (uint32_t i = random_below(&a.random, 5); i > 0 && ew_stream_next(&a.encoder, report);
                     i--)
                    if ((report[0] & 2) == 0) deliver(&a, report, sizeof report);
            }
        }
        if (a.holds) deliver(&a, a.held, EW_HID_OUT_BYTES);
        a.holds = 0;
        a.first_of_session = a.sent;
        ew_stream_encoder_init(&a.encoder);
        assert_one_key_mends(&a); /* this one does not clear */
        panel_close(&a.panel);
    }
}

/* ---- garbage ---- */

typedef struct bounds {
    uint16_t width, height;
    unsigned long fills, commits, abandons;
} bounds;

static void bounds_fill(void *user, uint16_t x, uint16_t y, uint16_t n, uint16_t rgb565)
{
    bounds *b = user;
    (void)rgb565;
    b->fills++;
    if (n == 0 || (uint32_t)x + n > b->width || y >= b->height)
        fail_msg("fill %u,%u +%u on %ux%u", x, y, n, b->width, b->height);
}

static void bounds_commit(void *user) { ((bounds *)user)->commits++; }

static void bounds_abandon(void *user) { ((bounds *)user)->abandons++; }

/* A report that passes for one of a frame: mostly in sequence, intact, sometimes with a
 * header, of which sometimes a field is wrong. */
static void make_plausible(uint64_t *random, const ew_hid_display *display, uint8_t report[EW_HID_OUT_BYTES])
{
    uint8_t *header = report + 4;
    report[0] = (uint8_t)((random_below(random, 4) == 0) | (random_below(random, 6) == 0) << 1 |
                          (random_below(random, 3) > 0) << 2 | (random_below(random, 3) > 0) << 4);
    report[1] = (uint8_t)(display->sequence + 1 - (random_below(random, 20) == 0));
    report[2] = (uint8_t)(random_below(random, 4) == 0 ? random_below(random, 60) : 59);
    memset(report + 4 + report[2], 0, (size_t)(EW_STREAM_PAYLOAD_BYTES - report[2]));
    if (report[0] & 1) {
        uint16_t number = (uint16_t)(display->frame_number + 1);
        uint16_t fields[5] = {number, 0, 0, display->panel_width, display->panel_height};
        uint8_t sum = 0;
        if (random_below(random, 3) == 0) {
            fields[3] = (uint16_t)random_below(random, display->panel_width + 1u);
            fields[4] = (uint16_t)random_below(random, display->panel_height + 1u);
            fields[1] = (uint16_t)random_below(random, display->panel_width + 1u - fields[3]);
            fields[2] = (uint16_t)random_below(random, display->panel_height + 1u - fields[4]);
        }
        if (random_below(random, 8) == 0) fields[random_below(random, 5)] = (uint16_t)random_u32(random);
        for (int i = 0; i < 5; i++) {
            header[2 * i] = (uint8_t)fields[i];
            header[2 * i + 1] = (uint8_t)(fields[i] >> 8);
        }
        header[10] = 1;
        for (int i = 0; i < 11; i++) sum = (uint8_t)(sum + header[i]);
        header[11] = (uint8_t)~sum;
        if (report[2] < 12) report[2] = 12;
    }
    seal_report(report);
}

/* On a small panel: a whole SRL frame with the right CRC, so that frames get accepted. */
static void send_real_frame(uint64_t *random, ew_hid_display *display, ew_stream_encoder *encoder)
{
    static uint16_t pixels[64];
    uint8_t report[EW_HID_OUT_BYTES];
    if ((uint32_t)display->panel_width * display->panel_height > 64) return;
    pixels[random_below(random, 64)] = (uint16_t)random_u32(random);
    ew_stream_frame frame = {
        pixels, NULL, display->panel_width, 0, 0, display->panel_width, display->panel_height};
    ew_stream_begin(encoder, &frame, EW_CODEC_SRL);
    while (ew_stream_next(encoder, report))
        ew_hid_display_output(display, EW_HID_STREAM, report, sizeof report);
}

static void test_garbage(void **state)
{
    (void)state;
    static const uint16_t sizes[][2] = {{1, 1}, {4096, 4096}, {240, 135}, {3, 4096}, {7, 5}, {4096, 1}};
    unsigned long accepted = 0, fills = 0, abandons = 0;
    for (unsigned run = 0; run < 12; run++) {
        uint64_t random = 1000 + run;
        bounds b = {sizes[run / 2][0], sizes[run / 2][1], 0, 0, 0};
        ew_hid_panel panel = {&b, bounds_fill, bounds_commit, bounds_abandon, NULL};
        ew_hid_display display;
        ew_stream_encoder encoder;
        ew_stream_encoder_init(&encoder);
        assert_int_equal(ew_hid_display_init(&display, &panel, (ew_hid_profile)(run % 2), b.width, b.height),
                         EW_OK);
        for (unsigned i = 0; i < 100000; i++) {
            uint8_t report[EW_HID_OUT_BYTES], answer[EW_HID_STATUS_BYTES];
            for (int k = 0; k < EW_HID_OUT_BYTES; k++) report[k] = (uint8_t)random_u32(&random);
            uint32_t kind = random_below(&random, 16);
            if (kind >= 4) make_plausible(&random, &display, report);
            if (kind == 3) report[1] = report[3] = report[5] = report[7] = 0; /* a blit within 256 x 256 */
            if (kind == 0 && random_below(&random, 8) == 0)
                ew_hid_display_output(&display, (uint8_t)random_u32(&random), report,
                                      random_below(&random, 64));
            else
                ew_hid_display_output(&display, kind == 3 ? EW_HID_BLIT : EW_HID_STREAM, report,
                                      sizeof report);
            if (random_below(&random, 50) == 0) send_real_frame(&random, &display, &encoder);
            if (random_below(&random, 100) == 0) ew_hid_display_tick(&display, random_below(&random, 600));
            if (random_below(&random, 3) == 0 && ew_hid_display_input(&display, answer))
                accepted += answer[0] == EW_STREAM_OK;
            assert_true(display.pixels_left <= (uint32_t)b.width * b.height);
        }
        fills += b.fills;
        abandons += b.abandons;
        assert_true(b.fills > 0);
    }
    print_message("%lu fills, %lu frames given up, %lu OK read\n", fills, abandons, accepted);
}

/* Any bytes at all from a fixed start, each as the only change: every op byte, then every
 * second byte, at every distance to the end of the rectangle. */
static void test_every_op(void **state)
{
    (void)state;
    bounds b = {16, 16, 0, 0, 0};
    ew_hid_panel panel = {&b, bounds_fill, bounds_commit, bounds_abandon, NULL};
    ew_hid_display fresh, display;
    assert_int_equal(ew_hid_display_init(&fresh, &panel, EW_HID_DIRECT, 16, 16), EW_OK);
    fresh.need_key = 0;
    fresh.state = 3; /* IN_OP of the device's own states */
    fresh.flags = 0x10;
    fresh.width = 16;
    for (uint32_t left = 1; left <= 256; left++)
        for (unsigned op = 0; op < 256; op++)
            for (unsigned second = 0; second < 256; second += op < 0xC0 ? 85 : 1) {
                uint8_t report[EW_HID_OUT_BYTES] = {0x10, 1, 4, 0, (uint8_t)op, (uint8_t)second, 1, 2};
                display = fresh;
                display.pixels_left = left;
                display.row = (uint16_t)((256 - left) / 16);
                display.column = (uint16_t)((256 - left) % 16);
                seal_report(report);
                ew_hid_display_output(&display, EW_HID_STREAM, report, sizeof report);
                assert_true(display.pixels_left <= left);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_deaf_sender),      cmocka_unit_test(test_listening_sender),
        cmocka_unit_test(test_restarted_sender), cmocka_unit_test(test_garbage),
        cmocka_unit_test(test_every_op),
    };
    return cmocka_run_group_tests_name("display_faults", tests, NULL, NULL);
}
