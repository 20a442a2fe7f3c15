#include "panel_lines.h"

#include <stdio.h>
#include <string.h>

#include "clock.h"

int ew_line_name_parse(ew_line_name *name, const char *text)
{
    const char *colon = strrchr(text, ':');
    size_t n = colon ? (size_t)(colon - text) : 0;

    if (!n || n >= sizeof name->chip || !colon[1] || strlen(colon + 1) >= sizeof name->line) {
        return -1;
    }
    memcpy(name->chip, text, n);
    name->chip[n] = '\0';
    memcpy(name->line, colon + 1, strlen(colon + 1) + 1);
    return 0;
}

static int open_line(const ew_gpio_backend *gpio, const char *text, ew_gpio_use use, ew_gpio_line **line,
                     char *error, size_t size)
{
    ew_line_name name;
    char why[256];

    if (!text) {
        return 0;
    }
    if (ew_line_name_parse(&name, text)) {
        snprintf(error, size, "%s: not of the form CHIP:LINE", text);
        return -1;
    }
    *line = gpio->open(name.chip, name.line, use, why, sizeof why);
    if (!*line) {
        snprintf(error, size, "%s: %s", text, why);
        return -1;
    }
    return 0;
}

int ew_panel_lines_open(ew_panel_lines *lines, const ew_gpio_backend *gpio, const char *reset, const char *te,
                        char *error, size_t size)
{
    memset(lines, 0, sizeof *lines);
    lines->gpio = gpio;
    if (open_line(gpio, reset, EW_GPIO_OUTPUT_HIGH, &lines->reset, error, size) ||
        open_line(gpio, te, EW_GPIO_RISING_EDGES, &lines->te, error, size)) {
        ew_panel_lines_close(lines);
        return -1;
    }
    return 0;
}

void ew_panel_lines_close(ew_panel_lines *lines)
{
    if (lines->reset) {
        lines->gpio->close(lines->reset);
    }
    if (lines->te) {
        lines->gpio->close(lines->te);
    }
    lines->reset = lines->te = NULL;
}

int ew_panel_reset(ew_panel_lines *lines)
{
    if (!lines->reset) {
        return 0;
    }
    if (lines->gpio->set(lines->reset, 0)) {
        return -1;
    }
    ew_sleep_ms(EW_RESET_LOW_MS);
    if (lines->gpio->set(lines->reset, 1)) {
        return -1;
    }
    ew_sleep_ms(EW_RESET_WAIT_MS);
    return 0;
}

int ew_panel_wait_te(ew_panel_lines *lines)
{
    /* The kernel keeps 16 edges of a line; a source that fires faster than it can be
     * drained must not hold the stream up. */
    unsigned stale_left = 64;
    int n;

    if (!lines->te) {
        return 0;
    }
    do {
        n = lines->gpio->wait_edge(lines->te, 0);
    } while (n == 1 && stale_left--);
    if (n == 0) {
        n = lines->gpio->wait_edge(lines->te, lines->te_timeout_ms);
    }
    if (n < 0) {
        return -1;
    }
    lines->te_edges += n == 1;
    lines->te_misses += n == 0;
    return 0;
}
