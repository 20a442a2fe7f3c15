/* Packing: every colour, against channels rounded in doubles and bytes read as a panel's stream of
 * bits. Changed rows: against a referee that looks at each byte, and a panel that is sent
 * nothing but what was found. */
#include "unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edgewalk/panel.h"

static int any(int n) { return (int)(test_random() % (uint32_t)n); }

/* ---- packing ---- */

enum { MARK = 0xA5 };

/* Bits of the stream, the high one of the first byte first. */
static unsigned bits_at(const uint8_t *bytes, size_t bit, int n)
{
    unsigned value = 0;
    for (int i = 0; i < n; i++, bit++) value = 2 * value + ((unsigned)bytes[bit / 8] >> (7 - bit % 8) & 1u);
    return value;
}

static unsigned nearest(unsigned c, int from_bits, int to_bits)
{
    return (unsigned)lround(c * (ldexp(1, to_bits) - 1) / (ldexp(1, from_bits) - 1));
}

static void check_pixel(uint16_t p, const uint8_t *out, size_t bit, int bits, int spacing)
{
    static const int shift[3] = { 11, 5, 0 }, width[3] = { 5, 6, 5 };
    for (int k = 0; k < 3; k++, bit += (size_t)spacing) {
        const unsigned c = (unsigned)p >> shift[k] & ((1u << width[k]) - 1);
        const unsigned wanted = nearest(c, width[k], bits) << (spacing - bits);
        if (bits_at(out, bit, spacing) != wanted) fail_msg("%04x channel %d: %x, expected %x", p, k, bits_at(out, bit, spacing), wanted);
    }
}

/* Rows of 0 to 9 pixels and of all 65536, and nothing written behind them. */
static void check_packing(size_t (*pack)(const uint16_t *, size_t, uint8_t *), int bits, int spacing)
{
    static uint16_t pixels[65536];
    static uint8_t out[3 * 65536 + 1];
    for (size_t n = 0; n <= 65536; n = n < 9 ? n + 1 : n == 9 ? 65535 : n + 1) {
        const size_t bytes = (n * 3 * (size_t)spacing + 7) / 8;
        for (size_t i = 0; i < n; i++) pixels[i] = (uint16_t)(n > 9 ? i * 40503 : test_random()); /* neighbours differ */
        memset(out, MARK, sizeof out);
        assert_int_equal(pack(pixels, n, out), bytes);
        for (size_t i = 0; i < n; i++) check_pixel(pixels[i], out, i * 3 * (size_t)spacing, bits, spacing);
        assert_int_equal(bits_at(out, n * 3 * (size_t)spacing, (int)(8 * bytes - n * 3 * (size_t)spacing)), 0);
        for (size_t i = bytes; i < sizeof out; i++) assert_int_equal(out[i], MARK);
    }
}

static void rgb666(void **state)
{
    (void)state;
    check_packing(ew_pack_rgb666, 6, 8);
}

static void rgb444(void **state)
{
    (void)state;
    check_packing(ew_pack_rgb444, 4, 4);
}

/* Layouts as the data sheet draws them, in plain numbers. */
static void layouts(void **state)
{
    (void)state;
    static const uint16_t pixels[3] = { 0x8FE1, 0x0010, 0xFFFF }; /* 17 63 1, 0 0 16, white */
    static const uint8_t six[9] = { 35 << 2, 63 << 2, 2 << 2, 0, 0, 33 << 2, 63 << 2, 63 << 2, 63 << 2 };
    static const uint8_t four[5] = { 0x8F, 0x00, 0x08, 0xFF, 0xF0 };
    uint8_t out[9];
    assert_int_equal(ew_pack_rgb666(pixels, 3, out), 9);
    assert_memory_equal(out, six, 9);
    assert_int_equal(ew_pack_rgb444(pixels, 3, out), 5);
    assert_memory_equal(out, four, 5);
}

/* ---- what has changed ---- */

enum { ROWS = 24, BYTES = 40 };

static uint8_t shown[ROWS * BYTES], now[ROWS * BYTES];

static int differs(const ew_frame_rows *f, int row, int column)
{
    const size_t at = (size_t)row * f->stride + (size_t)(column * f->column_bytes);
    return memcmp(shown + at, now + at, f->column_bytes) != 0;
}

static int row_differs(const ew_frame_rows *f, int row)
{
    int any_column = 0;
    for (int column = 0; column < f->columns; column++) any_column |= differs(f, row, column);
    return any_column;
}

/* The rule, slowly: the first changed row, the last one with no larger gap before it, and the columns. */
static int expect(const ew_frame_rows *f, int from, ew_changed *r)
{
    int first = from;
    while (first < f->rows && !row_differs(f, first)) first++;
    if (first == f->rows) return 0;
    int last = first;
    for (int row = first + 1; row < f->rows && row - last <= f->gap + 1; row++) {
        if (row_differs(f, row)) last = row;
    }
    int x0 = f->columns, x1 = 0;
    for (int row = first; row <= last; row++) {
        for (int column = 0; column < f->columns; column++) {
            if (!differs(f, row, column)) continue;
            if (column < x0) x0 = column;
            if (column >= x1) x1 = column + 1;
        }
    }
    if (f->hashes) x0 = 0, x1 = f->columns;
    *r = (ew_changed){ (uint16_t)x0, (uint16_t)first, (uint16_t)x1, (uint16_t)(last + 1) };
    return 1;
}

/* A panel gets what was found, and then shows the frame. */
static void send(const ew_frame_rows *f, const ew_changed *r)
{
    for (int row = r->y0; row < r->y1; row++) {
        const size_t at = (size_t)row * f->stride + (size_t)(r->x0 * f->column_bytes);
        memcpy(shown + at, now + at, (size_t)((r->x1 - r->x0) * f->column_bytes));
    }
}

static void random_shape(ew_frame_rows *f)
{
    memset(f, 0, sizeof *f);
    f->column_bytes = (uint8_t)(1 + any(4));
    f->columns = (uint16_t)any(BYTES / f->column_bytes + 1);
    f->rows = (uint16_t)any(ROWS + 1);
    f->stride = (uint32_t)(f->columns * f->column_bytes + any(BYTES - f->columns * f->column_bytes + 1));
    f->gap = (uint16_t)(any(4) ? any(4) : 65535);
    f->pixels = now;
}

static void change_something(void)
{
    const int many = any(3) ? any(6) : any(2000);
    for (int i = 0; i < many; i++) now[any(sizeof now)] ^= (uint8_t)(1u << any(8));
}

static void check_frame(const ew_frame_rows *f)
{
    ew_changed found, wanted;
    int from = 0, calls = 0;
    for (;;) {
        const int more = expect(f, from, &wanted);
        test_context("%d columns of %d, %d rows, gap %d, stride %u, %s, from %d", f->columns, f->column_bytes, f->rows, f->gap,
                     (unsigned)f->stride, f->hashes ? "hashes" : "previous", from);
        assert_int_equal(ew_changed_next(f, (uint16_t)from, &found), more);
        if (!more) break;
        assert_memory_equal(&found, &wanted, sizeof found);
        send(f, &found);
        from = found.y1;
        assert_true(++calls <= ROWS);
    }
    for (int row = 0; row < f->rows; row++) assert_false(row_differs(f, row));
}

static void changed_rows(void **state)
{
    (void)state;
    uint32_t hashes[ROWS + 2];
    ew_frame_rows f;
    ew_changed found;
    for (int n = 0; n < 30000; n++) {
        random_shape(&f);
        for (size_t i = 0; i < sizeof now; i++) now[i] = shown[i] = (uint8_t)test_random();
        if (any(2)) {
            f.previous = shown;
        } else {
            f.hashes = hashes + 1;
            for (int i = 0; i < ROWS + 2; i++) hashes[i] = 77;
            for (uint16_t from = 0; ew_changed_next(&f, from, &found) > 0;) from = found.y1;
        }
        for (int frames = 0; frames < 3; frames++) {
            change_something();
            check_frame(&f);
        }
        if (f.hashes) assert_true(hashes[0] == 77 && hashes[1 + f.rows] == 77);
    }
}

/* A change inside one byte is never missed, wherever it is and whatever is around it. */
static void a_changed_byte_is_never_missed(void **state)
{
    (void)state;
    uint32_t hash;
    uint8_t row[64];
    ew_frame_rows f = { .pixels = row, .hashes = &hash, .stride = sizeof row, .columns = sizeof row, .rows = 1, .column_bytes = 1 };
    ew_changed found;
    for (int kind = 0; kind < 4; kind++) {
        for (size_t i = 0; i < sizeof row; i++) row[i] = (uint8_t)(kind == 0 ? 0 : kind == 1 ? 255 : test_random());
        ew_changed_next(&f, 0, &found);
        for (size_t i = 0; i < sizeof row; i++) {
            const uint8_t was = row[i];
            for (int value = 0; value < 256; value++) {
                row[i] = (uint8_t)value;
                assert_int_equal(ew_changed_next(&f, 0, &found), value != was);
                row[i] = was;
                assert_int_equal(ew_changed_next(&f, 0, &found), value != was);
            }
        }
    }
}

/* RFC 9923 lists this hash of the letter a. */
static void the_hash_is_fnv1a(void **state)
{
    (void)state;
    uint32_t hash = 0;
    const ew_frame_rows f = { .pixels = "a", .hashes = &hash, .stride = 1, .columns = 1, .rows = 1, .column_bytes = 1 };
    ew_changed found;
    assert_int_equal(ew_changed_next(&f, 0, &found), 1);
    assert_int_equal(hash, 0xE40C292C);
}

static void refused(void **state)
{
    (void)state;
    uint32_t hashes[ROWS];
    ew_changed found;
    const ew_frame_rows good = { .pixels = now, .previous = shown, .stride = 8, .columns = 4, .rows = 3, .column_bytes = 2 };
    memcpy(now, shown, sizeof now);
    assert_int_equal(ew_changed_next(&good, 3, &found), 0);
    assert_int_equal(ew_changed_next(&good, 4, &found), EW_ERR_ARGUMENT);
#define REFUSED(...) \
    do { \
        ew_frame_rows f = good; \
        __VA_ARGS__; \
        assert_int_equal(ew_changed_next(&f, 0, &found), EW_ERR_ARGUMENT); \
    } while (0)
    REFUSED(f.pixels = NULL);
    REFUSED(f.previous = NULL);
    REFUSED(f.hashes = hashes);
    REFUSED(f.stride = 7);
    REFUSED(f.column_bytes = 0);
    REFUSED(f.columns = 65535, f.column_bytes = 255, f.stride = 65535u * 255u - 1u);
#undef REFUSED
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(rgb666), TEST(rgb444), TEST(layouts), TEST(changed_rows), TEST(a_changed_byte_is_never_missed),
        TEST(the_hash_is_fnv1a), TEST(refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
