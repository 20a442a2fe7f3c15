/* host_tests/unit/display_panel.h - a panel in memory behind the device model, and what
 * else both tests of the display link need. Functions are static: each test is one
 * executable.
 */
#ifndef EW_TEST_DISPLAY_PANEL_H
#define EW_TEST_DISPLAY_PANEL_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "edgewalk/display.h"
#include "edgewalk/error.h"

enum { BLANK = 0x0841 }; /* a new or cleared panel: a colour that no test frame has */

typedef struct test_panel {
    ew_hid_display display;
    uint16_t width, height;
    uint16_t *shown;     /* what a viewer sees                             */
    uint16_t *collected; /* where fill draws: `shown` itself when direct   */
    unsigned long fills, commits, abandons, controls;
    int enable, clear;
    uint8_t brightness;
    void (*on_pixel)(void *context, uint32_t index, uint16_t colour); /* may be NULL */
    void (*on_commit)(void *context);                                 /* may be NULL */
    void *context;
} test_panel;

static inline size_t panel_bytes(const test_panel *panel)
{
    return (size_t)panel->width * panel->height * sizeof(uint16_t);
}

static inline void panel_blank(test_panel *panel)
{
    for (uint32_t i = 0; i < (uint32_t)panel->width * panel->height; i++)
        panel->shown[i] = panel->collected[i] = BLANK;
}

static inline void panel_fill(void *user, uint16_t x, uint16_t y, uint16_t n, uint16_t rgb565)
{
    test_panel *panel = user;
    assert_in_range(n, 1, panel->width);
    assert_in_range(x, 0, panel->width - n);
    assert_in_range(y, 0, panel->height - 1);
    panel->fills++;
    for (uint16_t i = 0; i < n; i++) {
        uint32_t index = (uint32_t)y * panel->width + x + i;
        if (panel->on_pixel != NULL) panel->on_pixel(panel->context, index, rgb565);
        panel->collected[index] = rgb565;
    }
}

static inline void panel_commit(void *user)
{
    test_panel *panel = user;
    panel->commits++;
    if (panel->shown != panel->collected) memcpy(panel->shown, panel->collected, panel_bytes(panel));
    if (panel->on_commit != NULL) panel->on_commit(panel->context);
}

static inline void panel_abandon(void *user)
{
    test_panel *panel = user;
    panel->abandons++;
    if (panel->shown != panel->collected) memcpy(panel->collected, panel->shown, panel_bytes(panel));
}

static inline void panel_control(void *user, int enable, int clear, uint8_t brightness)
{
    test_panel *panel = user;
    panel->controls++;
    panel->enable = enable;
    panel->clear = clear;
    panel->brightness = brightness;
    if (clear) panel_blank(panel);
}

static inline ew_hid_panel panel_callbacks(test_panel *panel)
{
    ew_hid_panel callbacks = {panel, panel_fill, panel_commit, panel_abandon, panel_control};
    return callbacks;
}

static inline void panel_open(test_panel *panel, ew_hid_profile profile, uint16_t width, uint16_t height)
{
    memset(panel, 0, sizeof *panel);
    panel->width = width;
    panel->height = height;
    panel->shown = malloc(panel_bytes(panel));
    panel->collected = profile == EW_HID_DIRECT ? panel->shown : malloc(panel_bytes(panel));
    assert_non_null(panel->shown);
    assert_non_null(panel->collected);
    panel_blank(panel);
    ew_hid_panel callbacks = panel_callbacks(panel);
    assert_int_equal(ew_hid_display_init(&panel->display, &callbacks, profile, width, height), EW_OK);
}

static inline void panel_close(test_panel *panel)
{
    if (panel->collected != panel->shown) free(panel->collected);
    free(panel->shown);
}

static inline void panel_take(test_panel *panel, const uint8_t report[EW_HID_OUT_BYTES])
{
    ew_hid_display_output(&panel->display, EW_HID_STREAM, report, EW_HID_OUT_BYTES);
}

/* The status code waiting to be read, or -1. */
static inline int panel_status(test_panel *panel)
{
    uint8_t report[EW_HID_STATUS_BYTES];
    return ew_hid_display_input(&panel->display, report) > 0 ? report[0] : -1;
}

/* SplitMix64, the upper half. */
static inline uint32_t random_u32(uint64_t *state)
{
    uint64_t z = (*state += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return (uint32_t)((z ^ (z >> 31)) >> 32);
}

/* 0 to n - 1. */
static inline uint32_t random_below(uint64_t *state, uint32_t n)
{
    return (uint32_t)(((uint64_t)random_u32(state) * n) >> 32);
}

static inline void seal_report(uint8_t report[EW_HID_OUT_BYTES])
{
    uint8_t crc = 0;
    for (int i = 0; i < 3; i++) crc = ew_crc8(crc, report[i]);
    for (int i = 0; i < report[2] && i < EW_STREAM_PAYLOAD_BYTES; i++) crc = ew_crc8(crc, report[4 + i]);
    report[3] = crc;
}

#endif
