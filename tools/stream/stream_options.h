/* What the command line of ew-stream says. */
#ifndef EW_STREAM_OPTIONS_H
#define EW_STREAM_OPTIONS_H

#include "edgewalk/display.h"

#include "hid.h"

extern const char ew_stream_tool[]; /* "ew-stream", the first word of every error line */

typedef struct ew_stream_options {
    const char *scene; /* NULL with raw frames on stdin                          */
    const char *device;
    int is_sim;
    unsigned sim_width, sim_height; /* of a simulated display                           */
    ew_hid_name hid_name;           /* of any other                                     */
    ew_hid_profile profile;
    unsigned fault_drop;
    int raw;
    unsigned raw_width, raw_height;
    unsigned frames; /* 0: until the input or the user ends it                 */
    double fps;      /* 0: as fast as possible                                 */
    ew_codec codec;
    unsigned keyframe_ms, timeout_ms, reconnect_ms;
    const char *out, *record, *dump_drawn;
    int compare, list;
    const char *gpio_reset, *gpio_te;
    unsigned te_timeout_ms; /* 0: two frame periods                               */
} ew_stream_options;

/* Fills `options` or ends the program: status 2 after wrong usage, 0 after --help and
 * --version. */
void ew_stream_parse_options(ew_stream_options *options, int argc, char **argv);

#endif
