/* The GPIO lines beside a display: reset (driven) and tearing effect (watched).
 *
 * Back ends: libgpiod 1.6 or 2.x, chosen when the program is built; none, which
 * refuses to open anything; and a scripted one for the unit tests. A line is
 * requested once and held until it is closed, because releasing it lets it float.
 */
#ifndef EW_GPIO_LINES_H
#define EW_GPIO_LINES_H

#include <stdint.h>
#include <stddef.h>

typedef struct ew_gpio_line ew_gpio_line; /* a back end's own */

typedef enum ew_gpio_use {
    EW_GPIO_OUTPUT_HIGH = 0, /* driven, high from the first moment */
    EW_GPIO_RISING_EDGES = 1 /* an input whose rising edges are kept */
} ew_gpio_use;

typedef struct ew_gpio_backend {
    /* Requests `line` (a number or the line's name) of `chip` (a number, a name such as
     * gpiochip0, or a path). Returns NULL after writing `what: why` to `error`. */
    ew_gpio_line *(*open)(const char *chip, const char *line, ew_gpio_use use, char *error, size_t size);
    /* Drives an output. 0 or -1. */
    int (*set)(ew_gpio_line *line, int value);
    /* Takes one rising edge, waiting up to timeout_ms; 0 takes only one that has already
     * happened. Returns 1, 0 when the time is over, or -1. */
    int (*wait_edge)(ew_gpio_line *line, unsigned timeout_ms);
    void (*close)(ew_gpio_line *line);
    /* What this back end is, e.g. "libgpiod 1.6.3". */
    const char *(*name)(void);
} ew_gpio_backend;

/* The one this program was built with. */
extern const ew_gpio_backend ew_gpio;

#endif
