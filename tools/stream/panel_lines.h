/* What ew-stream does with a display's reset and tearing-effect (TE) lines. */
#ifndef EW_PANEL_LINES_H
#define EW_PANEL_LINES_H

#include "gpio_lines.h"

/* Reset: low for so long, then so long until the display is spoken to. The second is
 * what common panel controllers ask for after a hardware reset. */
#ifndef EW_RESET_LOW_MS
#define EW_RESET_LOW_MS 10
#endif
#ifndef EW_RESET_WAIT_MS
#define EW_RESET_WAIT_MS 120
#endif

typedef struct ew_panel_lines {
    const ew_gpio_backend *gpio;
    ew_gpio_line *reset, *te; /* NULL: not used                                */
    unsigned te_timeout_ms;   /* longest wait for an edge                      */
    unsigned long te_edges, te_misses;
} ew_panel_lines;

/* CHIP:LINE, split at its last colon. */
typedef struct ew_line_name {
    char chip[128], line[128];
} ew_line_name;

/* Returns 0, or -1 when `text` is not of that form. */
int ew_line_name_parse(ew_line_name *name, const char *text);

/* Requests the lines given as CHIP:LINE; NULL for none. The reset line is driven high.
 * Returns 0, or -1 with `what: why` in `error` and nothing held. */
int ew_panel_lines_open(ew_panel_lines *lines, const ew_gpio_backend *gpio, const char *reset, const char *te,
                        char *error, size_t size);
void ew_panel_lines_close(ew_panel_lines *lines);

/* One reset pulse and the wait after it. 0, also without a reset line, or -1. */
int ew_panel_reset(ew_panel_lines *lines);

/* Forgets edges that have gone by and waits for the next one. Returns 0, also without
 * a TE line and when the time is over, which counts as a miss; -1 when the line fails. */
int ew_panel_wait_te(ew_panel_lines *lines);

#endif
