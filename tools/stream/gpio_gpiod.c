/* libgpiod 1.6 and 2.x. EW_GPIOD_MAJOR is 1 or 2, or 0 without the library; the
 * calls were taken from the two versions' gpiod.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpio_lines.h"

#ifndef EW_GPIOD_MAJOR
#define EW_GPIOD_MAJOR 0
#endif

#if EW_GPIOD_MAJOR == 0

static ew_gpio_line *none_open(const char *chip, const char *line, ew_gpio_use use, char *error, size_t size)
{
    (void)chip, (void)line, (void)use;
    snprintf(error, size, "open: this program was built without libgpiod");
    return NULL;
}

static int none_set(ew_gpio_line *line, int value)
{
    (void)line, (void)value;
    return -1;
}

static int none_wait_edge(ew_gpio_line *line, unsigned timeout_ms)
{
    (void)line, (void)timeout_ms;
    return -1;
}

static void none_close(ew_gpio_line *line) { (void)line; }

static const char *none_name(void) { return "none"; }

const ew_gpio_backend ew_gpio = {none_open, none_set, none_wait_edge, none_close, none_name};

#else

#include <gpiod.h>

static const char consumer[] = "ew-stream";

/* Both versions open a path; 1.x could guess from labels too, which 2.x gave up. */
static struct gpiod_chip *open_chip(const char *chip)
{
    char path[256];
    int digits = chip[strspn(chip, "0123456789")] == '\0';

    if (strchr(chip, '/')) {
        snprintf(path, sizeof path, "%s", chip);
    } else {
        snprintf(path, sizeof path, "/dev/%s%s", digits ? "gpiochip" : "", chip);
    }
    return gpiod_chip_open(path);
}

/* The number that `line` spells, or -1. */
static int line_number(const char *line)
{
    return line[strspn(line, "0123456789")] || strlen(line) > 6 ? -1 : atoi(line);
}

#if EW_GPIOD_MAJOR == 1

struct ew_gpio_line {
    struct gpiod_chip *chip;
    struct gpiod_line *line;
};

static void gpiod_lines_close(ew_gpio_line *line)
{
    if (line->line) {
        gpiod_line_release(line->line);
    }
    gpiod_chip_close(line->chip);
    free(line);
}

static int request(ew_gpio_line *line, const char *name, ew_gpio_use use)
{
    int number = line_number(name);
    struct gpiod_line *found = number < 0 ? gpiod_chip_find_line(line->chip, name)
                                          : gpiod_chip_get_line(line->chip, (unsigned)number);

    if (!found) {
        return -1;
    }
    if (use == EW_GPIO_OUTPUT_HIGH ? gpiod_line_request_output(found, consumer, 1)
                                   : gpiod_line_request_rising_edge_events(found, consumer)) {
        return -1;
    }
    line->line = found;
    return 0;
}

static int gpiod_lines_set(ew_gpio_line *line, int value) { return gpiod_line_set_value(line->line, value); }

static int gpiod_lines_wait_edge(ew_gpio_line *line, unsigned timeout_ms)
{
    struct timespec timeout = {(time_t)(timeout_ms / 1000), (long)(timeout_ms % 1000) * 1000000};
    struct gpiod_line_event event;
    int n = gpiod_line_event_wait(line->line, &timeout);
    return n == 1 && gpiod_line_event_read(line->line, &event) ? -1 : n;
}

static const char *gpiod_lines_name(void)
{
    static char name[32];
    snprintf(name, sizeof name, "libgpiod %s", gpiod_version_string());
    return name;
}

#else

struct ew_gpio_line {
    struct gpiod_chip *chip;
    struct gpiod_line_request *line;
    struct gpiod_edge_event_buffer *events;
    unsigned number;
};

static void gpiod_lines_close(ew_gpio_line *line)
{
    if (line->line) {
        gpiod_line_request_release(line->line);
    }
    if (line->events) {
        gpiod_edge_event_buffer_free(line->events);
    }
    gpiod_chip_close(line->chip);
    free(line);
}

static int apply(struct gpiod_line_settings *settings, ew_gpio_use use)
{
    if (use == EW_GPIO_OUTPUT_HIGH) {
        return gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_OUTPUT) ||
               gpiod_line_settings_set_output_value(settings, GPIOD_LINE_VALUE_ACTIVE);
    }
    return gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_INPUT) ||
           gpiod_line_settings_set_edge_detection(settings, GPIOD_LINE_EDGE_RISING);
}

static int request(ew_gpio_line *line, const char *name, ew_gpio_use use)
{
    struct gpiod_line_settings *settings = gpiod_line_settings_new();
    struct gpiod_line_config *lines = gpiod_line_config_new();
    struct gpiod_request_config *who = gpiod_request_config_new();
    int number = line_number(name), error;

    if (number < 0) {
        number = gpiod_chip_get_line_offset_from_name(line->chip, name);
    }
    line->number = (unsigned)number;
    line->events = gpiod_edge_event_buffer_new(1);
    if (number >= 0 && settings && lines && who && line->events && !apply(settings, use) &&
        !gpiod_line_config_add_line_settings(lines, &line->number, 1, settings)) {
        gpiod_request_config_set_consumer(who, consumer);
        line->line = gpiod_chip_request_lines(line->chip, who, lines);
    }
    error = errno;
    gpiod_request_config_free(who);
    gpiod_line_config_free(lines);
    gpiod_line_settings_free(settings);
    errno = error;
    return line->line ? 0 : -1;
}

static int gpiod_lines_set(ew_gpio_line *line, int value)
{
    return gpiod_line_request_set_value(line->line, line->number,
                                        value ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
}

static int gpiod_lines_wait_edge(ew_gpio_line *line, unsigned timeout_ms)
{
    int n = gpiod_line_request_wait_edge_events(line->line, (int64_t)timeout_ms * 1000000);
    return n == 1 && gpiod_line_request_read_edge_events(line->line, line->events, 1) < 1 ? -1 : n;
}

static const char *gpiod_lines_name(void)
{
    static char name[32];
    snprintf(name, sizeof name, "libgpiod %s", gpiod_api_version());
    return name;
}

#endif

static ew_gpio_line *gpiod_lines_open(const char *chip, const char *name, ew_gpio_use use, char *error,
                                      size_t size)
{
    ew_gpio_line *line = calloc(1, sizeof *line);

    if (!line) {
        snprintf(error, size, "open: out of memory");
        return NULL;
    }
    line->chip = open_chip(chip);
    if (!line->chip) {
        snprintf(error, size, "open chip %s: %s", chip, strerror(errno));
        free(line);
        return NULL;
    }
    errno = 0;
    if (request(line, name, use)) {
        snprintf(error, size, "request line %s: %s", name, errno ? strerror(errno) : "no such line");
        gpiod_lines_close(line);
        return NULL;
    }
    return line;
}

const ew_gpio_backend ew_gpio = {gpiod_lines_open, gpiod_lines_set, gpiod_lines_wait_edge, gpiod_lines_close,
                                 gpiod_lines_name};

#endif
