/* host_tests/unit/test_display.c - the display link without faults: checks, descriptor,
 * encoder, device model, features, blits, and every status code.
 */
#include "display_panel.h"

/* ---- checks and descriptor ---- */

static void test_crc_known_answers(void **state)
{
    (void)state;
    uint16_t crc16 = 0xFFFF;
    uint8_t crc8 = 0;
    for (const char *c = "123456789"; *c != '\0'; c++) {
        crc16 = ew_crc16(crc16, (uint8_t)*c);
        crc8 = ew_crc8(crc8, (uint8_t)*c);
    }
    assert_int_equal(crc16, 0x29B1);
    assert_int_equal(crc8, 0xF4);
}

static uint32_t crc_by_bits(uint32_t crc, unsigned byte, unsigned bits, uint32_t polynomial)
{
    crc ^= (uint32_t)byte << (bits - 8);
    for (int i = 0; i < 8; i++) {
        uint32_t top = crc >> (bits - 1) & 1;
        crc = (crc << 1 ^ (top ? polynomial : 0)) & ((1u << bits) - 1);
    }
    return crc;
}

static void test_crc_every_step(void **state)
{
    (void)state;
    for (unsigned crc = 0; crc < 0x100; crc++)
        for (unsigned byte = 0; byte < 0x100; byte++)
            assert_int_equal(ew_crc8((uint8_t)crc, (uint8_t)byte), crc_by_bits(crc, byte, 8, 0x07));
    for (unsigned crc = 0; crc < 0x10000; crc++)
        for (unsigned byte = 0; byte < 0x100; byte++)
            if (ew_crc16((uint16_t)crc, (uint8_t)byte) != crc_by_bits(crc, byte, 16, 0x1021))
                fail_msg("crc %04x byte %02x", crc, byte);
}

/* What the items of a descriptor add up to. */
typedef struct parsed_descriptor {
    unsigned bits[3][8]; /* input, output, feature; by report id              */
    unsigned usages[3][8];
    int depth, deepest, collections;
    uint32_t first_page, first_usage;
    int closed_early;
} parsed_descriptor;

static uint32_t item_data(const uint8_t *item, unsigned size)
{
    uint32_t data = 0;
    for (unsigned i = 0; i < size; i++) data |= (uint32_t)item[1 + i] << 8 * i;
    return data;
}

static void parse_descriptor(const uint8_t *bytes, size_t length, parsed_descriptor *out)
{
    uint32_t size = 0, count = 0, id = 0, usages = 0;
    memset(out, 0, sizeof *out);
    for (size_t at = 0; at < length;) {
        unsigned data_size = (bytes[at] & 3) == 3 ? 4 : bytes[at] & 3;
        assert_true(at + 1 + data_size <= length);
        uint32_t data = item_data(bytes + at, data_size);
        int kind = -1;
        switch (bytes[at] & 0xFC) {
        case 0x04: /* usage page */
            if (out->first_page == 0) out->first_page = data;
            break;
        case 0x08: /* usage */
            if (out->first_usage == 0) out->first_usage = data;
            usages++;
            break;
        case 0x14: /* logical minimum */ assert_int_equal(data, 0); break;
        case 0x24: /* logical maximum: signed in its own size */
            assert_true(data_size == 4 || data >> (8 * data_size - 1) == 0);
            break;
        case 0x74: size = data; break;
        case 0x94: count = data; break;
        case 0x84:
            id = data;
            assert_in_range(id, 1, 7);
            break;
        case 0x80:
        case 0x90:
        case 0xB0: kind = (bytes[at] & 0xFC) == 0xB0 ? 2 : (bytes[at] & 0xFC) == 0x90; break;
        case 0xA0: /* collection */
            out->collections++;
            out->depth++;
            if (out->depth > out->deepest) out->deepest = out->depth;
            usages = 0;
            break;
        case 0xC0:
            out->depth--;
            usages = 0;
            break;
        default: fail_msg("item %02x at %zu is none of ours", bytes[at], at);
        }
        if (kind >= 0) {
            out->bits[kind][id] += size * count;
            out->usages[kind][id] += usages;
            usages = 0;
        }
        at += 1 + data_size;
        if (out->depth <= 0 && out->collections > 0 && at < length) out->closed_early = 1;
    }
}

static void test_descriptor(void **state)
{
    (void)state;
    parsed_descriptor parsed;
    assert_int_equal(sizeof ew_hid_descriptor, EW_HID_DESCRIPTOR_BYTES);
    parse_descriptor(ew_hid_descriptor, sizeof ew_hid_descriptor, &parsed);
    assert_int_equal(parsed.first_page, 0x14);
    assert_int_equal(parsed.first_usage, 0x02);
    assert_int_equal(parsed.depth, 0);
    assert_int_equal(parsed.deepest, 2);
    assert_int_equal(parsed.collections, 4);
    assert_false(parsed.closed_early);
    static const struct {
        int kind, id, bytes, usages;
    } reports[] = {
        {2, EW_HID_ATTRIBUTES, EW_HID_ATTRIBUTES_BYTES, 5},
        {2, EW_HID_CONTROL, EW_HID_CONTROL_BYTES, 3},
        {1, EW_HID_BLIT, EW_HID_OUT_BYTES, 5},
        {1, EW_HID_STREAM, EW_HID_OUT_BYTES, 1},
        {0, EW_HID_STATUS, EW_HID_STATUS_BYTES, 1},
        {2, EW_HID_CAPABILITIES, EW_HID_CAPABILITIES_BYTES, 1},
    };
    unsigned expected = 0, found = 0;
    for (size_t i = 0; i < sizeof reports / sizeof *reports; i++) {
        assert_int_equal(parsed.bits[reports[i].kind][reports[i].id], 8 * reports[i].bytes);
        assert_int_equal(parsed.usages[reports[i].kind][reports[i].id], reports[i].usages);
        expected += 8 * (unsigned)reports[i].bytes;
    }
    for (int kind = 0; kind < 3; kind++)
        for (int id = 0; id < 8; id++) found += parsed.bits[kind][id];
    assert_int_equal(found, expected);
}

/* ---- the page's example ---- */

static const char *const example[3] = {
    "17 00 18 5F 00 00 00 00 00 00 04 00 02 00 01 F8 44 F8 00 02 07 E0 00 1F FF FF 2D 79",
    "13 01 13 C4 01 00 00 00 00 00 04 00 02 00 01 F7 85 00 FF E0 80 6C EE",
    "03 02 0E D1 02 00 00 00 00 00 00 00 00 00 01 FC B1 9F",
};

static void bytes_from_hex(const char *hex, uint8_t *bytes, size_t size)
{
    memset(bytes, 0, size);
    for (size_t i = 0; *hex != '\0' && i < size; i++) {
        bytes[i] = (uint8_t)strtoul(hex, NULL, 16);
        hex += hex[2] == '\0' ? 2 : 3;
    }
}

static void test_example_frames(void **state)
{
    (void)state;
    static const uint16_t first[8] = {0xF800, 0xF800, 0xF800, 0xF800, 0xF800, 0x07E0, 0x001F, 0xFFFF};
    static const uint16_t second[8] = {0xF800, 0xF800, 0xF800, 0xF800, 0xF800, 0x07E0, 0xFFE0, 0xFFFF};
    const ew_stream_frame frames[3] = {
        {first, NULL, 4, 0, 0, 4, 2}, {second, first, 4, 0, 0, 4, 2}, {NULL, NULL, 0, 0, 0, 0, 0}};
    ew_stream_encoder encoder;
    test_panel panel;
    ew_stream_encoder_init(&encoder);
    panel_open(&panel, EW_HID_BUFFERED, 4, 2);
    for (int i = 0; i < 3; i++) {
        uint8_t report[EW_HID_OUT_BYTES], expected[EW_HID_OUT_BYTES];
        bytes_from_hex(example[i], expected, sizeof expected);
        assert_int_equal(ew_stream_begin(&encoder, &frames[i], EW_CODEC_AUTO), EW_OK);
        assert_int_equal(ew_stream_next(&encoder, report), 1);
        assert_memory_equal(report, expected, sizeof report);
        assert_int_equal(ew_stream_next(&encoder, report), 0);
        assert_int_equal(encoder.payload_bytes, expected[2]);
        assert_int_equal(encoder.reports, 1);
        panel_take(&panel, expected);
        assert_int_equal(panel_status(&panel), EW_STREAM_OK);
        assert_memory_equal(panel.shown, i == 0 ? first : second, sizeof first);
    }
    panel_close(&panel);
}

/* The page shows the bytes that the test above has checked. */
static void test_example_on_page(void **state)
{
    (void)state;
    FILE *file = fopen("docs/wire-protocol.md", "rb");
    static char page[65536];
    if (file == NULL) {
        print_message("skipped: docs/wire-protocol.md is not here; run from the project's root\n");
        skip();
    }
    page[fread(page, 1, sizeof page - 1, file)] = '\0';
    fclose(file);
    for (int i = 0; i < 3; i++) assert_non_null(strstr(page, example[i]));
    char descriptor[3 * EW_HID_DESCRIPTOR_BYTES + 1];
    for (size_t i = 0; i < EW_HID_DESCRIPTOR_BYTES; i++)
        sprintf(descriptor + 3 * i, "%02X%c", ew_hid_descriptor[i], i % 16 == 15 ? '\n' : ' ');
    descriptor[3 * EW_HID_DESCRIPTOR_BYTES - 1] = '\0';
    assert_non_null(strstr(page, descriptor));
}

/* ---- encoder and decoder against each other ---- */

/* Sends the frame; the reports must be well formed. Returns the status. */
static int send_frame(ew_stream_encoder *encoder, const ew_stream_frame *frame, ew_codec codec,
                      test_panel *panel)
{
    uint8_t report[EW_HID_OUT_BYTES];
    uint32_t reports = 0, bytes = 0;
    uint8_t sequence = encoder->sequence;
    assert_int_equal(ew_stream_begin(encoder, frame, codec), EW_OK);
    while (ew_stream_next(encoder, report)) {
        assert_int_equal(report[1], sequence++);
        assert_int_equal(report[0] & 1, reports == 0);
        assert_int_equal((report[0] & 4) != 0, frame->previous == NULL && frame->width > 0);
        assert_int_equal(report[0] >> 4, encoder->codec);
        if ((report[0] & 2) == 0) assert_int_equal(report[2], EW_STREAM_PAYLOAD_BYTES);
        bytes += report[2];
        reports++;
        panel_take(panel, report);
    }
    assert_true((report[0] & 2) != 0);
    assert_int_equal(encoder->reports, reports);
    assert_int_equal(encoder->payload_bytes, bytes);
    return panel_status(panel);
}

/* Bytes of the frame's pixel data, without sending it anywhere. */
static uint32_t encoded_bytes(const ew_stream_frame *frame, ew_codec codec)
{
    ew_stream_encoder encoder;
    uint8_t report[EW_HID_OUT_BYTES];
    ew_stream_encoder_init(&encoder);
    assert_int_equal(ew_stream_begin(&encoder, frame, codec), EW_OK);
    while (ew_stream_next(&encoder, report)) continue;
    return encoder.payload_bytes - 14;
}

/* Changes some of a picture in one of several manners: noise, bars, dots, nothing. */
static void change_picture(uint16_t *pixels, uint32_t n, uint64_t *random)
{
    uint32_t manner = random_below(random, 6);
    if (manner == 0) return;
    for (uint32_t i = 0; i < n;) {
        uint32_t length = manner == 1 ? 1 : 1 + random_below(random, manner * manner * 4);
        uint16_t colour = (uint16_t)random_u32(random);
        int draws = manner <= 2 || random_below(random, 3) == 0;
        for (; length > 0 && i < n; length--, i++)
            if (draws) pixels[i] = manner == 4 ? (uint16_t)random_below(random, 2) : colour;
    }
}

/* Random frames of random rectangles on random panels, key and delta, all codecs. */
static void round_trip(uint64_t seed)
{
    uint64_t random = seed;
    uint16_t width = (uint16_t)(1 + random_below(&random, seed % 4 == 0 ? 4 : 90));
    uint16_t height = (uint16_t)(1 + random_below(&random, 60));
    uint32_t n = (uint32_t)width * height;
    uint16_t *picture = calloc(n, 2), *previous = calloc(n, 2);
    ew_stream_encoder encoder;
    test_panel panel;
    ew_stream_encoder_init(&encoder);
    panel_open(&panel, seed & 1 ? EW_HID_BUFFERED : EW_HID_DIRECT, width, height);
    change_picture(picture, n, &random);
    for (int i = 0; i < 12; i++) {
        ew_stream_frame frame = {picture, NULL, width, 0, 0, width, height};
        if (i > 0) {
            frame.width = (uint16_t)(1 + random_below(&random, width));
            frame.height = (uint16_t)(1 + random_below(&random, height));
            frame.x = (uint16_t)random_below(&random, (uint32_t)(width - frame.width + 1));
            frame.y = (uint16_t)random_below(&random, (uint32_t)(height - frame.height + 1));
            for (uint16_t row = 0; row < frame.height; row++)
                change_picture(picture + (size_t)(frame.y + row) * width + frame.x, frame.width, &random);
            frame.pixels = picture + (size_t)frame.y * width + frame.x;
            if (random_below(&random, 4) > 0) frame.previous = previous + (frame.pixels - picture);
        }
        uint32_t raw = encoded_bytes(&frame, EW_CODEC_RAW), srl = encoded_bytes(&frame, EW_CODEC_SRL);
        uint32_t pixels = (uint32_t)frame.width * frame.height;
        assert_int_equal(raw, 2 * pixels);
        assert_true(srl <= raw + (pixels + 63) / 64);
        assert_int_equal(encoded_bytes(&frame, EW_CODEC_AUTO), raw < srl ? raw : srl);
        ew_codec codec = (ew_codec)random_below(&random, 3);
        if (send_frame(&encoder, &frame, codec, &panel) != EW_STREAM_OK ||
            panel.commits != (unsigned long)i + 1 || memcmp(panel.shown, picture, panel_bytes(&panel)) != 0)
            fail_msg("seed %llu frame %d", (unsigned long long)seed, i);
        memcpy(previous, picture, panel_bytes(&panel));
    }
    assert_int_equal(panel.abandons, 0);
    panel_close(&panel);
    free(picture);
    free(previous);
}

static void test_round_trip(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 1500; seed++) round_trip(seed);
}

/* One row of pixels, `previous` may be NULL: the exact pixel data of the SRL codec. */
static void assert_ops(const uint16_t *pixels, const uint16_t *previous, uint16_t n, const uint8_t *ops,
                       uint32_t op_bytes)
{
    ew_stream_frame frame = {pixels, previous, n, 0, 0, n, 1};
    /* The decoder's panel as a column, too: each pixel is a row of its own. */
    ew_stream_frame column = {pixels, previous, 1, 0, 0, 1, n};
    ew_stream_encoder encoder;
    uint8_t report[EW_HID_OUT_BYTES];
    uint32_t at = 0;
    test_panel panel;
    panel_open(&panel, EW_HID_DIRECT, 1, n);
    for (uint32_t i = 0; i < n; i++) panel.shown[i] = previous == NULL ? BLANK : previous[i];
    panel.display.need_key = 0;
    panel.display.sequence = 0xFF;
    panel.display.frame_number = 0xFFFF;
    ew_stream_encoder_init(&encoder);
    assert_int_equal(send_frame(&encoder, &column, EW_CODEC_SRL, &panel), EW_STREAM_OK);
    assert_memory_equal(panel.shown, pixels, panel_bytes(&panel));
    panel_close(&panel);

    ew_stream_encoder_init(&encoder);
    assert_int_equal(ew_stream_begin(&encoder, &frame, EW_CODEC_SRL), EW_OK);
    while (ew_stream_next(&encoder, report))
        for (uint8_t i = 0; i < report[2]; i++, at++)
            if (at >= 12 && at < 12 + op_bytes && report[4 + i] != ops[at - 12])
                fail_msg("op byte %u is %02x, not %02x", at - 12, report[4 + i], ops[at - 12]);
    assert_int_equal(at, 12 + op_bytes + 2);
}

/* Bounds of the counts; the expected bytes worked out by hand from the page. */
static void test_op_bounds(void **state)
{
    (void)state;
    static const struct {
        uint16_t n;
        uint8_t bytes, run[8], skip[4], skip_bytes;
    } cases[] = {
        {1, 3, {0x00, 0xAB, 0xCD}, {0x80}, 1}, /* a run of one is a literal of one */
        {2, 3, {0x41, 0xAB, 0xCD}, {0x81}, 1},
        {64, 3, {0x7F, 0xAB, 0xCD}, {0xBF}, 1},
        {65, 4, {0xE0, 0x00, 0xAB, 0xCD}, {0xC0, 0x00}, 2},
        {320, 4, {0xE0, 0xFF, 0xAB, 0xCD}, {0xC0, 0xFF}, 2},
        {321, 4, {0xE1, 0x00, 0xAB, 0xCD}, {0xC1, 0x00}, 2},
        {8256, 4, {0xFF, 0xFF, 0xAB, 0xCD}, {0xDF, 0xFF}, 2},
        {8257, 7, {0xFF, 0xFF, 0xAB, 0xCD, 0x00, 0xAB, 0xCD}, {0xDF, 0xFF, 0x80}, 3},
        {8321, 8, {0xFF, 0xFF, 0xAB, 0xCD, 0xE0, 0x00, 0xAB, 0xCD}, {0xDF, 0xFF, 0xC0, 0x00}, 4},
    };
    static uint16_t pixels[8400];
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++) pixels[i] = 0xABCD;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (cases[i].n > 4096) /* such a row is no frame: tested in squares below */
            continue;
        assert_ops(pixels, NULL, cases[i].n, cases[i].run, cases[i].bytes);
        assert_ops(pixels, pixels, cases[i].n, cases[i].skip, cases[i].skip_bytes);
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint16_t n = cases[i].n;
        uint16_t rows = n == 8256 ? 3 : n == 8257 ? 23 : 53; /* 8257 = 23 * 359, 8321 = 53 * 157 */
        ew_stream_frame frame = {pixels, NULL, (uint16_t)(n / rows), 0, 0, (uint16_t)(n / rows), rows};
        if (n <= 4096) continue;
        assert_int_equal(frame.width * rows, n);
        assert_int_equal(encoded_bytes(&frame, EW_CODEC_SRL), cases[i].bytes);
        frame.previous = pixels;
        assert_int_equal(encoded_bytes(&frame, EW_CODEC_SRL), cases[i].skip_bytes);
    }
}

static void test_large_counts_decode(void **state)
{
    (void)state;
    static uint16_t pixels[359 * 23], before[359 * 23];
    ew_stream_encoder encoder;
    test_panel panel;
    ew_stream_frame frame = {pixels, NULL, 359, 0, 0, 359, 23};
    ew_stream_encoder_init(&encoder);
    panel_open(&panel, EW_HID_DIRECT, 359, 23);
    assert_int_equal(send_frame(&encoder, &frame, EW_CODEC_SRL, &panel), EW_STREAM_OK);
    assert_memory_equal(panel.shown, pixels, sizeof pixels);
    pixels[8256] = 7; /* the only pixel behind the longest skip */
    frame.previous = before;
    panel.fills = 0;
    assert_int_equal(send_frame(&encoder, &frame, EW_CODEC_SRL, &panel), EW_STREAM_OK);
    assert_int_equal(encoder.payload_bytes, 14 + 2 + 3);
    assert_int_equal(panel.fills, 1);
    assert_memory_equal(panel.shown, pixels, sizeof pixels);
    panel_close(&panel);
}

static void test_literal_bounds(void **state)
{
    (void)state;
    uint16_t pixels[130], previous[130];
    uint8_t ops[300];
    for (uint16_t i = 0; i < 130; i++) {
        pixels[i] = (uint16_t)(0x1234 + 0x101 * i);
        previous[i] = (uint16_t)~pixels[i];
    }
    for (uint16_t n = 1; n <= 130; n++) {
        uint32_t at = 0;
        for (uint16_t i = 0; i < n; i++) {
            if (i % 64 == 0) ops[at++] = (uint8_t)((n - i < 64 ? n - i : 64) - 1);
            ops[at++] = (uint8_t)(pixels[i] >> 8);
            ops[at++] = (uint8_t)pixels[i];
        }
        assert_ops(pixels, NULL, n, ops, at);
        assert_ops(pixels, previous, n, ops, at);
    }
}

/* Where a literal ends: at a skip of two, not of one; at a run of three, not of two. */
static void test_literal_ends(void **state)
{
    (void)state;
    static const uint16_t pixels[7] = {1, 2, 3, 4, 4, 4, 5};
    static const uint8_t run[] = {0x02, 0, 1, 0, 2, 0, 3, 0x42, 0, 4, 0x00, 0, 5};
    assert_ops(pixels, NULL, 7, run, sizeof run);
    static const uint16_t pair[5] = {1, 2, 4, 4, 5};
    static const uint8_t pair_ops[] = {0x04, 0, 1, 0, 2, 0, 4, 0, 4, 0, 5};
    assert_ops(pair, NULL, 5, pair_ops, sizeof pair_ops);
    static const uint16_t last_pair[4] = {1, 2, 4, 4};
    static const uint8_t last_pair_ops[] = {0x01, 0, 1, 0, 2, 0x41, 0, 4};
    assert_ops(last_pair, NULL, 4, last_pair_ops, sizeof last_pair_ops);
    static const uint16_t one[5] = {9, 9, 4, 9, 9}, two[5] = {9, 2, 4, 9, 8}, now[5] = {1, 2, 4, 5, 6};
    static const uint8_t one_ops[] = {0x04, 0, 1, 0, 2, 0, 4, 0, 5, 0, 6};
    static const uint8_t two_ops[] = {0x00, 0, 1, 0x81, 0x01, 0, 5, 0, 6};
    assert_ops(now, one, 5, one_ops, sizeof one_ops);
    assert_ops(now, two, 5, two_ops, sizeof two_ops);
}

/* The device takes the payload however it is cut, empty reports included. */
static void test_every_cut(void **state)
{
    (void)state;
    uint64_t random = 5;
    for (int round = 0; round < 2000; round++) {
        uint16_t picture[9 * 7], before[9 * 7];
        uint8_t payload[512], report[EW_HID_OUT_BYTES], flags = 0;
        uint32_t length = 0, at = 0;
        ew_stream_encoder encoder;
        test_panel panel;
        memset(before, 0, sizeof before);
        memcpy(picture, before, sizeof picture);
        change_picture(picture, 9 * 7, &random);
        ew_stream_frame frame = {picture, NULL, 9, 0, 0, 9, 7};
        ew_stream_encoder_init(&encoder);
        assert_int_equal(ew_stream_begin(&encoder, &frame, (ew_codec)(round % 2)), EW_OK);
        while (ew_stream_next(&encoder, report)) {
            flags = report[0] & 0xFC;
            memcpy(payload + length, report + 4, report[2]);
            length += report[2];
        }
        panel_open(&panel, EW_HID_DIRECT, 9, 7);
        uint32_t most = 1 + random_below(&random, 59);
        uint8_t sequence = (uint8_t)random_u32(&random);
        int first = 1;
        do {
            memset(report, 0, sizeof report);
            report[2] = (uint8_t)random_below(&random, most + 1);
            if (report[2] > length - at) report[2] = (uint8_t)(length - at);
            memcpy(report + 4, payload + at, report[2]);
            at += report[2];
            report[0] = (uint8_t)(flags | first);
            if (at == length && random_below(&random, 2) == 1) report[0] |= 2;
            report[1] = sequence++;
            first = 0;
            seal_report(report);
            panel_take(&panel, report);
        } while ((report[0] & 2) == 0);
        assert_int_equal(panel_status(&panel), EW_STREAM_OK);
        assert_memory_equal(panel.shown, picture, sizeof picture);
        panel_close(&panel);
    }
}

/* A run of 65 saves 126 bytes and each full literal costs one: 126 of them are a tie. */
static void test_auto_at_a_tie(void **state)
{
    (void)state;
    static uint16_t pixels[65 + 126 * 64];
    ew_stream_frame frame = {pixels, NULL, 739, 0, 0, 739, 11};
    ew_stream_encoder encoder;
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++) pixels[i] = (uint16_t)(i < 65 ? 0 : i);
    ew_stream_encoder_init(&encoder);
    assert_int_equal(sizeof pixels, 2 * 739 * 11);
    assert_int_equal(encoded_bytes(&frame, EW_CODEC_SRL), encoded_bytes(&frame, EW_CODEC_RAW));
    assert_int_equal(ew_stream_begin(&encoder, &frame, EW_CODEC_AUTO), EW_OK);
    assert_int_equal(encoder.codec, EW_CODEC_RAW);
    pixels[65] = 0; /* the run takes one from the literals */
    assert_int_equal(encoded_bytes(&frame, EW_CODEC_SRL), encoded_bytes(&frame, EW_CODEC_RAW) - 2);
    assert_int_equal(ew_stream_begin(&encoder, &frame, EW_CODEC_AUTO), EW_OK);
    assert_int_equal(encoder.codec, EW_CODEC_SRL);
}

static void test_stride_and_padding(void **state)
{
    (void)state;
    uint16_t source[5 * 11];
    ew_stream_encoder encoder;
    test_panel panel;
    for (uint16_t i = 0; i < 55; i++) source[i] = i;
    ew_stream_frame frame = {source + 3, NULL, 11, 0, 0, 4, 5};
    ew_stream_encoder_init(&encoder);
    panel_open(&panel, EW_HID_DIRECT, 4, 5);
    assert_int_equal(send_frame(&encoder, &frame, EW_CODEC_RAW, &panel), EW_STREAM_OK);
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 4; x++) assert_int_equal(panel.shown[y * 4 + x], y * 11 + 3 + x);
    panel_close(&panel);
}

static void test_begin_refuses(void **state)
{
    (void)state;
    static const uint16_t pixel[1] = {0};
    static const struct {
        ew_stream_frame frame;
        int codec, expected;
    } cases[] = {
        {{pixel, NULL, 1, 0, 0, 1, 1}, EW_CODEC_AUTO, EW_OK},
        {{pixel, NULL, 1, 4095, 4095, 1, 1}, EW_CODEC_RAW, EW_OK},
        {{NULL, NULL, 0, 0, 0, 0, 0}, EW_CODEC_AUTO, EW_OK},
        {{NULL, NULL, 1, 0, 0, 1, 1}, EW_CODEC_AUTO, EW_ERR_ARGUMENT},
        {{pixel, NULL, 0, 0, 0, 1, 1}, EW_CODEC_AUTO, EW_ERR_ARGUMENT},
        {{pixel, NULL, 1, 0, 0, 1, 0}, EW_CODEC_AUTO, EW_ERR_ARGUMENT},
        {{pixel, NULL, 1, 0, 0, 0, 1}, EW_CODEC_AUTO, EW_ERR_ARGUMENT},
        {{pixel, NULL, 1, 4096, 0, 1, 1}, EW_CODEC_RAW, EW_ERR_ARGUMENT},
        {{pixel, NULL, 1, 0, 4096, 1, 1}, EW_CODEC_RAW, EW_ERR_ARGUMENT},
        {{pixel, NULL, 1, 0, 0, 1, 1}, 3, EW_ERR_ARGUMENT},
    };
    ew_stream_encoder encoder, before;
    uint8_t report[EW_HID_OUT_BYTES];
    ew_stream_encoder_init(&encoder);
    assert_int_equal(ew_stream_next(&encoder, report), 0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        before = encoder;
        assert_int_equal(ew_stream_begin(&encoder, &cases[i].frame, (ew_codec)cases[i].codec),
                         cases[i].expected);
        if (cases[i].expected != EW_OK) assert_memory_equal(&encoder, &before, sizeof encoder);
    }
}

/* ---- the device's rules ---- */

typedef struct link {
    ew_stream_encoder encoder;
    test_panel panel;
    uint16_t picture[64], previous[64];
} link_fixture;

/* An 8 x 8 panel that shows a first key frame; nothing unread. */
static void link_open(link_fixture *link, ew_hid_profile profile)
{
    ew_stream_frame frame = {link->picture, NULL, 8, 0, 0, 8, 8};
    for (uint16_t i = 0; i < 64; i++) link->picture[i] = link->previous[i] = (uint16_t)(0x100 + i);
    ew_stream_encoder_init(&link->encoder);
    panel_open(&link->panel, profile, 8, 8);
    assert_int_equal(send_frame(&link->encoder, &frame, EW_CODEC_RAW, &link->panel), EW_STREAM_OK);
}

static int send_picture(link_fixture *link, int key, ew_codec codec)
{
    ew_stream_frame frame = {link->picture, key ? NULL : link->previous, 8, 0, 0, 8, 8};
    int status = send_frame(&link->encoder, &frame, codec, &link->panel);
    memcpy(link->previous, link->picture, sizeof link->picture);
    return status;
}

/* Changes the last pixel, too, so that a raw frame has three reports. */
static uint8_t begin_change(link_fixture *link, int key, uint8_t first[EW_HID_OUT_BYTES])
{
    ew_stream_frame frame = {link->picture, key ? NULL : link->previous, 8, 0, 0, 8, 8};
    for (uint16_t i = 0; i < 64; i++) link->picture[i] = (uint16_t)(link->picture[i] + 0x100);
    assert_int_equal(ew_stream_begin(&link->encoder, &frame, EW_CODEC_RAW), EW_OK);
    assert_int_equal(ew_stream_next(&link->encoder, first), 1);
    return first[1];
}

static void assert_recovers(link_fixture *link, ew_hid_profile profile)
{
    uint16_t shown[64];
    memcpy(shown, link->panel.shown, sizeof shown);
    unsigned long fills = link->panel.fills;
    link->picture[9] ^= 0x8000;
    assert_int_equal(send_picture(link, 0, EW_CODEC_SRL), EW_STREAM_NEED_KEY);
    assert_int_equal(send_picture(link, 0, EW_CODEC_RAW), EW_STREAM_NEED_KEY);
    assert_int_equal(fills, link->panel.fills);
    assert_memory_equal(link->panel.shown, shown, sizeof shown);
    ew_codec codec = profile == EW_HID_DIRECT ? EW_CODEC_RAW : EW_CODEC_SRL;
    assert_int_equal(send_picture(link, 1, codec), EW_STREAM_OK);
    assert_memory_equal(link->panel.shown, link->picture, sizeof shown);
    link->picture[3] ^= 0x8000;
    assert_int_equal(send_picture(link, 0, EW_CODEC_SRL), EW_STREAM_OK);
    assert_memory_equal(link->panel.shown, link->picture, sizeof shown);
}

/* One hand-made frame of one report, next in sequence. */
static void make_frame(const link_fixture *link, uint8_t report[EW_HID_OUT_BYTES], uint8_t flags,
                       const uint8_t *data, uint8_t data_length)
{
    uint16_t crc = 0xFFFF, number = (uint16_t)(link->panel.display.frame_number + 1);
    uint8_t sum = 0, *payload = report + 4;
    memset(report, 0, EW_HID_OUT_BYTES);
    report[0] = (uint8_t)(flags | 3);
    report[1] = (uint8_t)(link->panel.display.sequence + 1);
    report[2] = (uint8_t)(14 + data_length);
    payload[0] = (uint8_t)number;
    payload[1] = (uint8_t)(number >> 8);
    payload[6] = payload[8] = 8;
    payload[10] = 1;
    for (int i = 0; i < 11; i++) sum = (uint8_t)(sum + payload[i]);
    payload[11] = (uint8_t)~sum;
    memcpy(payload + 12, data, data_length);
    for (int i = 0; i < 12 + data_length; i++) crc = ew_crc16(crc, payload[i]);
    payload[12 + data_length] = (uint8_t)crc;
    payload[13 + data_length] = (uint8_t)(crc >> 8);
    seal_report(report);
}

/* make_frame with one byte of the header changed and header check, CRC and check made
 * right again; byte 11 is the header check itself. */
static void make_frame_with(const link_fixture *link, uint8_t report[EW_HID_OUT_BYTES], int byte,
                            uint8_t value)
{
    static const uint8_t skip_all[1] = {0xBF};
    uint16_t crc = 0xFFFF;
    uint8_t sum = 0, *payload = report + 4;
    make_frame(link, report, 0x10, skip_all, 1);
    payload[byte] = value;
    for (int i = 0; i < 11; i++) sum = (uint8_t)(sum + payload[i]);
    if (byte != 11) payload[11] = (uint8_t)~sum;
    for (int i = 0; i < 13; i++) crc = ew_crc16(crc, payload[i]);
    payload[13] = (uint8_t)crc;
    payload[14] = (uint8_t)(crc >> 8);
    seal_report(report);
}

typedef struct ops_case {
    const char *name;
    uint8_t flags, length, data[12];
    int status;
} ops_case;

static const ops_case ops_cases[] = {
    {"skip all", 0x10, 1, {0xBF}, EW_STREAM_OK},
    {"run all", 0x10, 3, {0x7F, 1, 2}, EW_STREAM_OK},
    {"run all, key", 0x14, 3, {0x7F, 1, 2}, EW_STREAM_OK},
    {"skip in a key frame", 0x14, 1, {0xBF}, EW_STREAM_BAD_OP},
    {"long skip too long", 0x10, 2, {0xC0, 0x00}, EW_STREAM_BAD_OP},
    {"long run too long", 0x10, 4, {0xFF, 0xFF, 1, 2}, EW_STREAM_BAD_OP},
    {"run over the end", 0x10, 4, {0x80, 0x7F, 1, 2}, EW_STREAM_BAD_OP},
    {"skip over the end", 0x10, 2, {0x80, 0xBF}, EW_STREAM_BAD_OP},
    {"literal over the end", 0x10, 4, {0xBE, 0x01, 1, 2}, EW_STREAM_BAD_OP},
    {"ends after the skip", 0x10, 1, {0xBE}, EW_STREAM_BAD_OP},
    {"ends inside a colour", 0x10, 3, {0xBE, 0x40, 1}, EW_STREAM_BAD_OP},
    {"no data", 0x10, 0, {0}, EW_STREAM_BAD_OP},
    {"an op too much", 0x10, 2, {0xBF, 0x80}, EW_STREAM_BAD_CHECK}, /* the op is taken for the CRC */
    {"raw, too little", 0x00, 4, {1, 2, 3, 4}, EW_STREAM_BAD_OP},
    {"codec 2", 0x20, 1, {0xBF}, EW_STREAM_UNSUPPORTED},
    {"codec 7", 0x70, 1, {0xBF}, EW_STREAM_UNSUPPORTED},
    {"flag 08", 0x18, 1, {0xBF}, EW_STREAM_UNSUPPORTED},
    {"flag 80", 0x90, 1, {0xBF}, EW_STREAM_UNSUPPORTED},
};

static void test_bad_data(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ops_cases / sizeof *ops_cases; i++) {
        link_fixture link;
        uint8_t report[EW_HID_OUT_BYTES];
        link_open(&link, EW_HID_BUFFERED);
        make_frame(&link, report, ops_cases[i].flags, ops_cases[i].data, ops_cases[i].length);
        panel_take(&link.panel, report);
        int status = panel_status(&link.panel);
        if (status != ops_cases[i].status) fail_msg("%s: status %d", ops_cases[i].name, status);
        if (status != EW_STREAM_OK) {
            assert_memory_equal(link.panel.shown, link.picture, sizeof link.picture);
            assert_recovers(&link, EW_HID_BUFFERED);
        }
        panel_close(&link.panel);
    }
}

static void test_bad_headers(void **state)
{
    (void)state;
    static const struct {
        int byte;
        uint8_t value;
        int status;
    } cases[] = {
        {0, 2, EW_STREAM_SEQUENCE_GAP}, /* frame 1 is next                       */
        {0, 0, EW_STREAM_SEQUENCE_GAP},
        {1, 1, EW_STREAM_SEQUENCE_GAP},
        {2, 1, EW_STREAM_BAD_RECT}, /* x                                     */
        {3, 0xFF, EW_STREAM_BAD_RECT},
        {4, 1, EW_STREAM_BAD_RECT}, /* y                                     */
        {5, 0xFF, EW_STREAM_BAD_RECT},
        {6, 9, EW_STREAM_BAD_RECT}, /* width                                 */
        {6, 0, EW_STREAM_BAD_RECT},
        {7, 0xFF, EW_STREAM_BAD_RECT},
        {8, 9, EW_STREAM_BAD_RECT}, /* height                                */
        {8, 0, EW_STREAM_BAD_RECT},
        {9, 0xFF, EW_STREAM_BAD_RECT},
        {10, 2, EW_STREAM_UNSUPPORTED}, /* version                               */
        {10, 0, EW_STREAM_UNSUPPORTED},
        {11, 0, EW_STREAM_BAD_CHECK},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        link_fixture link;
        uint8_t report[EW_HID_OUT_BYTES];
        link_open(&link, EW_HID_DIRECT);
        make_frame_with(&link, report, cases[i].byte, cases[i].value);
        panel_take(&link.panel, report);
        int status = panel_status(&link.panel);
        if (status != cases[i].status)
            fail_msg("header byte %d = %d: status %d", cases[i].byte, cases[i].value, status);
        assert_recovers(&link, EW_HID_DIRECT);
        panel_close(&link.panel);
    }
}

static void test_bad_crc(void **state)
{
    (void)state;
    static const uint8_t run_all[3] = {0x7F, 1, 2};
    for (int which = 0; which < 2; which++) {
        link_fixture link;
        uint8_t report[EW_HID_OUT_BYTES];
        link_open(&link, EW_HID_BUFFERED);
        make_frame(&link, report, 0x10, run_all, 3);
        report[4 + 12 + 3 + which] ^= 0x20;
        seal_report(report);
        panel_take(&link.panel, report);
        assert_int_equal(panel_status(&link.panel), EW_STREAM_BAD_CHECK);
        assert_int_equal(link.panel.abandons, 1);
        assert_memory_equal(link.panel.shown, link.picture, sizeof link.picture);
        assert_recovers(&link, EW_HID_BUFFERED);
        panel_close(&link.panel);
    }
}

/* More data after the CRC, in the same report and in a further one. */
static void test_data_after_crc(void **state)
{
    (void)state;
    static const uint8_t run_all[3] = {0x7F, 1, 2};
    for (int further = 0; further < 2; further++) {
        link_fixture link;
        uint8_t report[EW_HID_OUT_BYTES];
        link_open(&link, EW_HID_BUFFERED);
        make_frame(&link, report, 0x10, run_all, 3);
        if (further) {
            report[0] = 0x11;
            seal_report(report);
            panel_take(&link.panel, report);
            memset(report, 0, sizeof report);
            report[0] = 0x12;
            report[1] = (uint8_t)(link.panel.display.sequence + 1);
            report[2] = 1;
        } else {
            report[2]++;
        }
        seal_report(report);
        assert_int_equal(panel_status(&link.panel), -1);
        panel_take(&link.panel, report);
        assert_int_equal(panel_status(&link.panel), EW_STREAM_BAD_OP);
        assert_recovers(&link, EW_HID_BUFFERED);
        panel_close(&link.panel);
    }
}

/* A change of any one bit is found, wherever it is, and so is any other length. */
static void test_every_bit(void **state)
{
    (void)state;
    static const uint8_t literal[] = {0xBD, 0x01, 0, 1, 0, 0};
    link_fixture link, copy;
    link_open(&link, EW_HID_DIRECT);
    uint8_t report[EW_HID_OUT_BYTES];
    make_frame(&link, report, 0x10, literal, sizeof literal);
    for (unsigned bit = 0; bit < 8 * EW_HID_OUT_BYTES; bit++) {
        uint8_t changed[EW_HID_OUT_BYTES];
        copy = link;
        copy.panel.display.panel = panel_callbacks(&copy.panel);
        memcpy(changed, report, sizeof changed);
        changed[bit / 8] = (uint8_t)(changed[bit / 8] ^ 1u << bit % 8);
        panel_take(&copy.panel, changed);
        assert_int_equal(panel_status(&copy.panel), EW_STREAM_BAD_CHECK);
    }
    for (size_t length = 0; length < 80; length++) {
        uint8_t longer[80] = {0};
        copy = link;
        copy.panel.display.panel = panel_callbacks(&copy.panel);
        memcpy(longer, report, sizeof report);
        ew_hid_display_output(&copy.panel.display, EW_HID_STREAM, longer, length);
        assert_int_equal(panel_status(&copy.panel),
                         length == EW_HID_OUT_BYTES ? EW_STREAM_OK : EW_STREAM_BAD_CHECK);
    }
    panel_close(&link.panel);
}

static void test_wrong_id(void **state)
{
    (void)state;
    link_fixture link;
    uint8_t report[EW_HID_OUT_BYTES] = {0};
    static const uint8_t ids[] = {0, 1, 2, 5, 6, 7, 255};
    for (size_t i = 0; i < sizeof ids; i++) {
        link_open(&link, EW_HID_DIRECT);
        ew_hid_display_output(&link.panel.display, ids[i], report, sizeof report);
        assert_int_equal(panel_status(&link.panel), EW_STREAM_BAD_CHECK);
        assert_recovers(&link, EW_HID_DIRECT);
        panel_close(&link.panel);
    }
}

/* Lost: the first, the second, the last, or every report of a frame. */
static void test_lost_reports(void **state)
{
    (void)state;
    for (int lost = 1; lost < 8; lost++) {
        link_fixture link;
        uint8_t report[EW_HID_OUT_BYTES];
        uint16_t before[64];
        link_open(&link, EW_HID_BUFFERED);
        memcpy(before, link.picture, sizeof before);
        begin_change(&link, 0, report);
        int i = 0;
        do {
            if ((lost >> i++ & 1) == 0) panel_take(&link.panel, report);
        } while (ew_stream_next(&link.encoder, report));
        assert_int_equal(i, 3);
        memcpy(link.previous, link.picture, sizeof link.picture);
        if (lost == 4 || lost == 6 || lost == 7) { /* nothing came after the loss: the next frame tells */
            assert_int_equal(panel_status(&link.panel), -1);
            link.picture[0]++;
            assert_int_equal(send_picture(&link, 0, EW_CODEC_SRL), EW_STREAM_SEQUENCE_GAP);
        } else {
            assert_int_equal(panel_status(&link.panel), EW_STREAM_SEQUENCE_GAP);
        }
        assert_memory_equal(link.panel.shown, before, sizeof before);
        assert_recovers(&link, EW_HID_BUFFERED);
        panel_close(&link.panel);
    }
}

/* 256 reports lost look like none by their sequence: the frame number tells. */
static void test_lost_frame_of_256_reports(void **state)
{
    (void)state;
    link_fixture link;
    uint16_t big[7544];
    uint8_t report[EW_HID_OUT_BYTES];
    ew_stream_frame frame = {big, NULL, 7544 / 4, 0, 0, 7544 / 4, 4};
    memset(big, 0, sizeof big);
    link_open(&link, EW_HID_BUFFERED);
    assert_int_equal(ew_stream_begin(&link.encoder, &frame, EW_CODEC_RAW), EW_OK);
    while (ew_stream_next(&link.encoder, report)) continue;
    assert_int_equal(link.encoder.reports, 256);
    link.picture[0]++;
    assert_int_equal(send_picture(&link, 0, EW_CODEC_SRL), EW_STREAM_SEQUENCE_GAP);
    assert_recovers(&link, EW_HID_BUFFERED);
    panel_close(&link.panel);
}

/* The other way round: the frame number is next, the sequence is not. */
static void test_lost_by_sequence_alone(void **state)
{
    (void)state;
    link_fixture link;
    link_open(&link, EW_HID_BUFFERED);
    link.encoder.sequence++;
    link.picture[0]++;
    assert_int_equal(send_picture(&link, 0, EW_CODEC_SRL), EW_STREAM_SEQUENCE_GAP);
    assert_recovers(&link, EW_HID_BUFFERED);
    panel_close(&link.panel);
}

/* A sender that gives up a frame inside a literal and begins the next. */
static void test_given_up_by_sender(void **state)
{
    (void)state;
    link_fixture link;
    uint8_t report[EW_HID_OUT_BYTES];
    link_open(&link, EW_HID_BUFFERED);
    for (int key = 0; key < 2; key++) {
        ew_stream_frame frame = {link.picture, NULL, 8, 0, 0, 8, 8};
        link.picture[1]++;
        assert_int_equal(ew_stream_begin(&link.encoder, &frame, EW_CODEC_SRL), EW_OK);
        assert_int_equal(ew_stream_next(&link.encoder, report), 1);
        assert_true(link.encoder.literals_left > 0);
        panel_take(&link.panel, report);
        assert_int_equal(send_picture(&link, key, EW_CODEC_SRL), key ? EW_STREAM_OK : EW_STREAM_SEQUENCE_GAP);
    }
    /* Given up twice and refused once. */
    assert_int_equal(link.panel.abandons, 2);
    assert_int_equal(link.panel.display.rejected, 3);
    assert_memory_equal(link.panel.shown, link.picture, sizeof link.picture);
    panel_close(&link.panel);
}

/* A frame that breaks off between two ops, and a blit that is committed after it. */
static void test_broken_between_ops(void **state)
{
    (void)state;
    static const uint8_t two_runs[] = {0x5F, 1, 2, 0x5F, 3, 4};
    link_fixture link;
    uint8_t report[EW_HID_OUT_BYTES];
    link_open(&link, EW_HID_BUFFERED);
    make_frame(&link, report, 0x10, two_runs, sizeof two_runs);
    report[0] = 0x11;
    report[2] = 12 + 3;
    memset(report + 4 + 15, 0, 59 - 15);
    seal_report(report);
    panel_take(&link.panel, report);
    ew_hid_display_tick(&link.panel.display, 500);
    assert_int_equal(panel_status(&link.panel), EW_STREAM_SEQUENCE_GAP);
    assert_int_equal(link.panel.abandons, 1);
    memset(report, 0, sizeof report); /* a black pixel at 0, 0 */
    ew_hid_display_output(&link.panel.display, EW_HID_BLIT, report, sizeof report);
    link.picture[0] = 0;
    assert_memory_equal(link.panel.shown, link.picture, sizeof link.picture);
    assert_recovers(&link, EW_HID_BUFFERED);
    panel_close(&link.panel);
}

/* What is left of a frame when the display is cleared is dropped without a word. */
static void test_clear_in_a_frame(void **state)
{
    (void)state;
    static const uint8_t clear[2] = {3, 255};
    link_fixture link;
    uint8_t report[EW_HID_OUT_BYTES];
    link_open(&link, EW_HID_DIRECT);
    for (int inside = 1; inside >= 0; inside--) {
        begin_change(&link, 0, report);
        if (inside) panel_take(&link.panel, report);
        assert_int_equal(ew_hid_display_set_feature(&link.panel.display, EW_HID_CONTROL, clear, 2), EW_OK);
        unsigned long fills = link.panel.fills;
        while (ew_stream_next(&link.encoder, report)) panel_take(&link.panel, report);
        assert_int_equal(link.panel.fills, fills);
        assert_int_equal(panel_status(&link.panel), inside ? -1 : EW_STREAM_SEQUENCE_GAP);
        memcpy(link.previous, link.picture, sizeof link.picture);
        assert_recovers(&link, EW_HID_DIRECT);
    }
    panel_close(&link.panel);
}

/* Repeated and swapped reports of a delta frame. */
static void test_repeated_and_swapped(void **state)
{
    (void)state;
    static const struct {
        int order[4], n;
    } cases[] = {
        {{0, 0, 1, 2}, 4},  {{0, 1, 1, 2}, 4},  {{0, 1, 2, 2}, 4},
        {{1, 0, 2, -1}, 3}, {{0, 2, 1, -1}, 3}, {{2, 1, 0, -1}, 3},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        link_fixture link;
        uint8_t reports[3][EW_HID_OUT_BYTES];
        link_open(&link, EW_HID_BUFFERED);
        begin_change(&link, 0, reports[0]);
        assert_int_equal(ew_stream_next(&link.encoder, reports[1]), 1);
        assert_int_equal(ew_stream_next(&link.encoder, reports[2]), 1);
        for (int k = 0; k < cases[i].n; k++) panel_take(&link.panel, reports[cases[i].order[k]]);
        memcpy(link.previous, link.picture, sizeof link.picture);
        assert_int_equal(panel_status(&link.panel), EW_STREAM_SEQUENCE_GAP);
        assert_recovers(&link, EW_HID_BUFFERED);
        panel_close(&link.panel);
    }
}

/* A key frame does not care what came before: its first report may come twice. */
static void test_key_restarts(void **state)
{
    (void)state;
    link_fixture link;
    uint8_t report[EW_HID_OUT_BYTES];
    link_open(&link, EW_HID_DIRECT);
    begin_change(&link, 1, report);
    panel_take(&link.panel, report);
    do panel_take(&link.panel, report);
    while (ew_stream_next(&link.encoder, report));
    assert_int_equal(panel_status(&link.panel), EW_STREAM_OK);
    assert_memory_equal(link.panel.shown, link.picture, sizeof link.picture);
    panel_close(&link.panel);
}

/* A second sender begins at sequence 0, frame 0, in the middle of the first one's frame. */
static void test_second_sender(void **state)
{
    (void)state;
    for (int clears = 0; clears < 2; clears++) {
        static const uint8_t clear[2] = {3, 80};
        link_fixture link;
        uint8_t report[EW_HID_OUT_BYTES];
        link_open(&link, EW_HID_BUFFERED);
        begin_change(&link, 0, report);
        panel_take(&link.panel, report);
        ew_stream_encoder_init(&link.encoder);
        if (clears)
            assert_int_equal(ew_hid_display_set_feature(&link.panel.display, EW_HID_CONTROL, clear, 2),
                             EW_OK);
        assert_int_equal(send_picture(&link, 0, EW_CODEC_SRL),
                         clears ? EW_STREAM_NEED_KEY : EW_STREAM_SEQUENCE_GAP);
        assert_recovers(&link, EW_HID_BUFFERED);
        panel_close(&link.panel);
    }
}

/* Only a key frame of the whole panel ends the need; any other is one more frame. */
static void test_partial_key(void **state)
{
    (void)state;
    link_fixture link;
    link_open(&link, EW_HID_DIRECT);
    ew_stream_frame part = {link.picture, NULL, 8, 0, 0, 8, 7};
    assert_int_equal(send_frame(&link.encoder, &part, EW_CODEC_AUTO, &link.panel), EW_STREAM_OK);
    ew_hid_display_output(&link.panel.display, EW_HID_STREAM, NULL, 0);
    assert_int_equal(panel_status(&link.panel), EW_STREAM_BAD_CHECK);
    assert_int_equal(send_frame(&link.encoder, &part, EW_CODEC_AUTO, &link.panel), EW_STREAM_NEED_KEY);
    assert_recovers(&link, EW_HID_DIRECT);
    panel_close(&link.panel);
}

static void test_keep_alive(void **state)
{
    (void)state;
    link_fixture link;
    const ew_stream_frame nothing = {NULL, NULL, 0, 0, 0, 0, 0};
    link_open(&link, EW_HID_BUFFERED);
    for (int codec = 0; codec < 3; codec++) {
        assert_int_equal(send_frame(&link.encoder, &nothing, (ew_codec)codec, &link.panel), EW_STREAM_OK);
        link.picture[codec] ^= 0x4000;
        assert_int_equal(send_picture(&link, 0, EW_CODEC_SRL), EW_STREAM_OK);
        assert_memory_equal(link.panel.shown, link.picture, sizeof link.picture);
    }
    assert_int_equal(link.panel.commits, 4);
    ew_hid_display_output(&link.panel.display, EW_HID_STREAM, NULL, 0);
    assert_int_equal(panel_status(&link.panel), EW_STREAM_BAD_CHECK);
    assert_int_equal(send_frame(&link.encoder, &nothing, EW_CODEC_RAW, &link.panel), EW_STREAM_NEED_KEY);
    assert_recovers(&link, EW_HID_BUFFERED);
    assert_int_equal(link.panel.abandons, 0);
    panel_close(&link.panel);
}

static void test_time_out(void **state)
{
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        link_fixture link;
        uint8_t report[EW_HID_OUT_BYTES];
        link_open(&link, (ew_hid_profile)profile);
        ew_hid_display_tick(&link.panel.display, 0xFFFFFFFFu); /* between frames time does not matter */
        assert_int_equal(panel_status(&link.panel), -1);
        begin_change(&link, 0, report);
        panel_take(&link.panel, report);
        ew_hid_display_tick(&link.panel.display, 499);
        ew_stream_next(&link.encoder, report);
        panel_take(&link.panel, report);
        ew_hid_display_tick(&link.panel.display, 250);
        ew_hid_display_tick(&link.panel.display, 249);
        assert_int_equal(panel_status(&link.panel), -1);
        assert_int_equal(link.panel.abandons, 0);
        ew_hid_display_tick(&link.panel.display, 1);
        assert_int_equal(panel_status(&link.panel), EW_STREAM_SEQUENCE_GAP);
        assert_int_equal(link.panel.abandons, 1);
        ew_stream_next(&link.encoder, report); /* too late, and known already */
        panel_take(&link.panel, report);
        assert_int_equal(panel_status(&link.panel), -1);
        assert_recovers(&link, (ew_hid_profile)profile);
        panel_close(&link.panel);
    }
}

static void test_time_out_of_a_dropped_frame(void **state)
{
    (void)state;
    link_fixture link;
    uint8_t report[EW_HID_OUT_BYTES];
    link_open(&link, EW_HID_DIRECT);
    begin_change(&link, 0, report);
    ew_stream_next(&link.encoder, report);
    panel_take(&link.panel, report);
    assert_int_equal(panel_status(&link.panel), EW_STREAM_SEQUENCE_GAP);
    ew_hid_display_tick(&link.panel.display, 0xFFFFFFFFu);
    assert_int_equal(panel_status(&link.panel), -1);
    ew_stream_next(&link.encoder, report); /* told anew: nothing is known of an earlier part */
    panel_take(&link.panel, report);
    assert_int_equal(panel_status(&link.panel), EW_STREAM_SEQUENCE_GAP);
    memcpy(link.previous, link.picture, sizeof link.picture);
    assert_recovers(&link, EW_HID_DIRECT);
    panel_close(&link.panel);
}

static void test_status_report(void **state)
{
    (void)state;
    link_fixture link;
    uint8_t report[EW_HID_OUT_BYTES], status[EW_HID_STATUS_BYTES];
    link_open(&link, EW_HID_DIRECT); /* frame 0: reports 0 to 2 */
    assert_int_equal(ew_hid_display_input(&link.panel.display, status), 0);
    begin_change(&link, 0, report); /* frame 1: reports 3 to 5, 4 is lost */
    panel_take(&link.panel, report);
    ew_stream_next(&link.encoder, report);
    ew_stream_next(&link.encoder, report);
    panel_take(&link.panel, report);
    memcpy(link.previous, link.picture, sizeof link.picture);
    /* frame 2 is refused: the gap has not been read yet and is not hidden by that */
    ew_stream_frame frame = {link.picture, link.previous, 8, 0, 0, 8, 8};
    ew_stream_begin(&link.encoder, &frame, EW_CODEC_SRL);
    ew_stream_next(&link.encoder, report);
    panel_take(&link.panel, report);
    static const uint8_t gap[] = {EW_STREAM_SEQUENCE_GAP, 6, 2, 0, 1, 2, 0, 0};
    assert_int_equal(ew_hid_display_input(&link.panel.display, status), EW_HID_STATUS_BYTES);
    assert_memory_equal(status, gap, sizeof gap);
    assert_int_equal(ew_hid_display_input(&link.panel.display, status), 0);
    frame.previous = NULL;
    ew_stream_begin(&link.encoder, &frame, EW_CODEC_RAW);
    while (ew_stream_next(&link.encoder, report)) panel_take(&link.panel, report);
    static const uint8_t done[] = {EW_STREAM_OK, 9, 3, 0, 2, 2, 0, 0};
    assert_int_equal(ew_hid_display_input(&link.panel.display, status), EW_HID_STATUS_BYTES);
    assert_memory_equal(status, done, sizeof done);
    panel_close(&link.panel);
}

/* ---- features and blits ---- */

static void test_features(void **state)
{
    (void)state;
    test_panel panel;
    uint8_t report[17];
    static const uint8_t attributes[] = {0xF0, 0x00, 0x87, 0x00, 55, 0, 0x10, 0};
    static const uint8_t capabilities[] = {'F', 'B', '1', 1, 63, 0, 0x03, 0x01, 0xF0, 0, 1, 0, 0, 0, 0, 0};
    panel_open(&panel, EW_HID_DIRECT, 240, 135);
    ew_hid_display *display = &panel.display;
    assert_int_equal(ew_hid_display_get_feature(display, EW_HID_ATTRIBUTES, report, 8), 8);
    assert_memory_equal(report, attributes, 8);
    assert_int_equal(ew_hid_display_get_feature(display, EW_HID_CAPABILITIES, report, 17), 16);
    assert_memory_equal(report, capabilities, 16);
    assert_int_equal(ew_hid_display_get_feature(display, EW_HID_ATTRIBUTES, report, 7), EW_ERR_ROOM);
    assert_int_equal(ew_hid_display_get_feature(display, EW_HID_CAPABILITIES, report, 15), EW_ERR_ROOM);
    for (int id = 0; id < 256; id++)
        if (id != EW_HID_ATTRIBUTES && id != EW_HID_CAPABILITIES)
            assert_int_equal(ew_hid_display_get_feature(display, (uint8_t)id, report, 17), EW_ERR_ARGUMENT);
    panel_close(&panel);
}

static void test_control(void **state)
{
    (void)state;
    link_fixture link;
    static const uint8_t on[2] = {0xFD, 200}, clear[2] = {2, 7}; /* padding bits mean nothing */
    link_open(&link, EW_HID_DIRECT);
    ew_hid_display *display = &link.panel.display;
    assert_int_equal(ew_hid_display_set_feature(display, EW_HID_CONTROL, on, 1), EW_ERR_ARGUMENT);
    assert_int_equal(ew_hid_display_set_feature(display, EW_HID_CONTROL, on, 3), EW_ERR_ARGUMENT);
    assert_int_equal(ew_hid_display_set_feature(display, EW_HID_ATTRIBUTES, on, 2), EW_ERR_ARGUMENT);
    assert_int_equal(link.panel.controls, 0);
    assert_int_equal(ew_hid_display_set_feature(display, EW_HID_CONTROL, on, 2), EW_OK);
    assert_int_equal(link.panel.enable, 1);
    assert_int_equal(link.panel.clear, 0);
    assert_int_equal(link.panel.brightness, 200);
    link.picture[5]++;
    assert_int_equal(send_picture(&link, 0, EW_CODEC_SRL), EW_STREAM_OK); /* not disturbed */
    assert_int_equal(ew_hid_display_set_feature(display, EW_HID_CONTROL, clear, 2), EW_OK);
    assert_int_equal(link.panel.enable, 0);
    assert_int_equal(link.panel.clear, 1);
    assert_int_equal(panel_status(&link.panel), -1);
    assert_recovers(&link, EW_HID_DIRECT);
    display->panel.control = NULL;
    assert_int_equal(ew_hid_display_set_feature(display, EW_HID_CONTROL, clear, 2), EW_OK);
    assert_recovers(&link, EW_HID_DIRECT);
    panel_close(&link.panel);
}

static void make_blit(uint8_t report[EW_HID_OUT_BYTES], unsigned x1, unsigned y1, unsigned x2, unsigned y2)
{
    const unsigned corner[4] = {x1, y1, x2, y2};
    for (unsigned i = 0; i < 4; i++) {
        report[2 * i] = (uint8_t)corner[i];
        report[2 * i + 1] = (uint8_t)(corner[i] >> 8);
    }
    for (unsigned i = 8; i < EW_HID_OUT_BYTES; i++) report[i] = (uint8_t)i;
}

static void test_blit(void **state)
{
    (void)state;
    uint8_t report[EW_HID_OUT_BYTES];
    for (int profile = 0; profile < 2; profile++) {
        test_panel panel;
        panel_open(&panel, (ew_hid_profile)profile, 12, 5);
        make_blit(report, 2, 1, 10, 3); /* 9 x 3 = 27 pixels, the most there are */
        ew_hid_display_output(&panel.display, EW_HID_BLIT, report, sizeof report);
        assert_int_equal(panel_status(&panel), -1);
        assert_int_equal(panel.commits, 1);
        for (int y = 0; y < 5; y++)
            for (int x = 0; x < 12; x++) {
                int at = 8 + 2 * ((y - 1) * 9 + x - 2);
                int inside = x >= 2 && x <= 10 && y >= 1 && y <= 3;
                assert_int_equal(panel.shown[y * 12 + x], inside ? at << 8 | (at + 1) : BLANK);
            }
        panel_close(&panel);
    }
}

static void test_blit_refused(void **state)
{
    (void)state;
    static const uint16_t corners[][4] = {
        {2, 0, 1, 0},      {0, 2, 0, 1},           {0, 0, 12, 0},
        {12, 0, 12, 0},    {0, 0, 0, 5},           {0, 0, 6, 3},
        {0, 0, 11, 4},     {0, 0, 0xFFFF, 0xFFFF}, {0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF},
        {0, 0, 0xFFFF, 0},
    };
    uint8_t report[EW_HID_OUT_BYTES];
    test_panel panel;
    panel_open(&panel, EW_HID_DIRECT, 12, 5);
    for (size_t i = 0; i < sizeof corners / sizeof *corners; i++) {
        make_blit(report, corners[i][0], corners[i][1], corners[i][2], corners[i][3]);
        ew_hid_display_output(&panel.display, EW_HID_BLIT, report, sizeof report);
        assert_int_equal(panel_status(&panel), EW_STREAM_BAD_RECT);
    }
    make_blit(report, 0, 0, 0, 0);
    ew_hid_display_output(&panel.display, EW_HID_BLIT, report, sizeof report - 1);
    assert_int_equal(panel_status(&panel), EW_STREAM_BAD_CHECK);
    assert_int_equal(panel.fills, 0);
    panel_close(&panel);
}

static void test_blit_and_stream(void **state)
{
    (void)state;
    uint8_t report[EW_HID_OUT_BYTES], blit[EW_HID_OUT_BYTES];
    link_fixture link;
    link_open(&link, EW_HID_DIRECT);
    make_blit(blit, 1, 0, 1, 0);
    begin_change(&link, 0, report);
    panel_take(&link.panel, report);
    unsigned long fills = link.panel.fills;
    ew_hid_display_output(&link.panel.display, EW_HID_BLIT, blit, sizeof blit);
    assert_int_equal(panel_status(&link.panel), EW_STREAM_UNSUPPORTED);
    assert_int_equal(link.panel.fills, fills);
    while (ew_stream_next(&link.encoder, report)) /* the frame itself goes on */
        panel_take(&link.panel, report);
    assert_int_equal(panel_status(&link.panel), EW_STREAM_OK);
    assert_memory_equal(link.panel.shown, link.picture, sizeof link.picture);
    memcpy(link.previous, link.picture, sizeof link.picture);
    ew_hid_display_output(&link.panel.display, EW_HID_BLIT, blit, sizeof blit);
    assert_int_equal(link.panel.shown[1], 0x0809);
    link.picture[1] = link.previous[1] = 0x0809; /* a sender that keeps account may skip it */
    link.picture[2]++;
    assert_int_equal(send_picture(&link, 0, EW_CODEC_SRL), EW_STREAM_OK);
    assert_memory_equal(link.panel.shown, link.picture, sizeof link.picture);
    panel_close(&link.panel);
}

static void test_init_refuses(void **state)
{
    (void)state;
    test_panel panel;
    ew_hid_display display;
    ew_hid_panel all = panel_callbacks(&panel), none = {0}, fill_only = {0};
    fill_only.fill = panel_fill;
    static const uint16_t bad[][2] = {{0, 1}, {1, 0}, {4097, 1}, {1, 4097}, {65535, 65535}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(ew_hid_display_init(&display, &all, EW_HID_DIRECT, bad[i][0], bad[i][1]),
                         EW_ERR_ARGUMENT);
    assert_int_equal(ew_hid_display_init(&display, &all, (ew_hid_profile)2, 1, 1), EW_ERR_ARGUMENT);
    assert_int_equal(ew_hid_display_init(&display, &none, EW_HID_DIRECT, 1, 1), EW_ERR_ARGUMENT);
    assert_int_equal(ew_hid_display_init(&display, &fill_only, EW_HID_BUFFERED, 1, 1), EW_ERR_ARGUMENT);
    assert_int_equal(ew_hid_display_init(&display, &fill_only, EW_HID_DIRECT, 4096, 4096), EW_OK);
    assert_int_equal(ew_hid_display_init(&display, &all, EW_HID_BUFFERED, 1, 1), EW_OK);
}

/* A direct display needs no callback but fill, whatever happens. */
static void test_fill_only(void **state)
{
    (void)state;
    link_fixture link;
    static const uint8_t clear[2] = {2, 0};
    uint8_t report[EW_HID_OUT_BYTES];
    link_open(&link, EW_HID_DIRECT);
    link.panel.display.panel.commit = NULL;
    link.panel.display.panel.abandon = NULL;
    link.panel.display.panel.control = NULL;
    begin_change(&link, 0, report);
    panel_take(&link.panel, report);
    panel_take(&link.panel, report);
    assert_int_equal(panel_status(&link.panel), EW_STREAM_SEQUENCE_GAP);
    memcpy(link.previous, link.picture, sizeof link.picture);
    assert_recovers(&link, EW_HID_DIRECT);
    assert_int_equal(ew_hid_display_set_feature(&link.panel.display, EW_HID_CONTROL, clear, 2), EW_OK);
    assert_recovers(&link, EW_HID_DIRECT);
    panel_close(&link.panel);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crc_known_answers),
        cmocka_unit_test(test_crc_every_step),
        cmocka_unit_test(test_descriptor),
        cmocka_unit_test(test_example_frames),
        cmocka_unit_test(test_example_on_page),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_op_bounds),
        cmocka_unit_test(test_large_counts_decode),
        cmocka_unit_test(test_literal_bounds),
        cmocka_unit_test(test_literal_ends),
        cmocka_unit_test(test_every_cut),
        cmocka_unit_test(test_auto_at_a_tie),
        cmocka_unit_test(test_stride_and_padding),
        cmocka_unit_test(test_begin_refuses),
        cmocka_unit_test(test_bad_data),
        cmocka_unit_test(test_bad_headers),
        cmocka_unit_test(test_bad_crc),
        cmocka_unit_test(test_data_after_crc),
        cmocka_unit_test(test_every_bit),
        cmocka_unit_test(test_wrong_id),
        cmocka_unit_test(test_lost_reports),
        cmocka_unit_test(test_lost_frame_of_256_reports),
        cmocka_unit_test(test_lost_by_sequence_alone),
        cmocka_unit_test(test_given_up_by_sender),
        cmocka_unit_test(test_broken_between_ops),
        cmocka_unit_test(test_clear_in_a_frame),
        cmocka_unit_test(test_repeated_and_swapped),
        cmocka_unit_test(test_key_restarts),
        cmocka_unit_test(test_second_sender),
        cmocka_unit_test(test_partial_key),
        cmocka_unit_test(test_keep_alive),
        cmocka_unit_test(test_time_out),
        cmocka_unit_test(test_time_out_of_a_dropped_frame),
        cmocka_unit_test(test_status_report),
        cmocka_unit_test(test_features),
        cmocka_unit_test(test_control),
        cmocka_unit_test(test_blit),
        cmocka_unit_test(test_blit_refused),
        cmocka_unit_test(test_blit_and_stream),
        cmocka_unit_test(test_init_refuses),
        cmocka_unit_test(test_fill_only),
    };
    return cmocka_run_group_tests_name("display", tests, NULL, NULL);
}
