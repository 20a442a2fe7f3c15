/* usbip_display - our display as a USB device that the kernel itself enumerates.
 *
 * Speaks the USB/IP protocol to vhci-hcd over a socketpair: no network, no usbip
 * tools. A full-speed HID device with an interrupt IN and an interrupt OUT endpoint
 * appears; usbhid, hidraw and libusb all see it. What arrives goes to the device's
 * end of the wire codec. Unlike uhid this holds the host back as USB does: a report
 * is taken when the reply goes out.
 *
 * USB/IP: the kernel's Documentation/usb/usbip_protocol.rst. Numbers are big-endian;
 * setup packets and descriptors are USB's own, little-endian.
 */
#include <argp.h>
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "edgewalk/error.h"

#include "../stream/clock.h"
#include "../stream/sim_panel.h"

#define VHCI_ATTACH "/sys/devices/platform/vhci_hcd.0/attach"

enum { CMD_SUBMIT = 1, CMD_UNLINK = 2, RET_SUBMIT = 3, RET_UNLINK = 4 };
enum { FULL_SPEED = 2, DEVICE_ID = 0x10001, MOST_WAITING = 8, MOST_DATA = 4096, TICK_MS = 50 };

/* Both directions; what the last five words mean depends on the command. */
typedef struct usbip_header {
    uint32_t command, sequence, device, direction, endpoint;
    uint32_t word[5];
    uint8_t setup[8];
} usbip_header;

typedef struct options {
    unsigned width, height, vendor, product, port;
    ew_hid_profile profile;
    unsigned long unplug_after, stall_after, hang_after; /* reports, 0: never  */
    unsigned away_ms, idle_ms, report_us;
    int no_replug, plain;
    const char *pictures;
} options;

typedef struct device {
    options options;
    ew_hid_display display;
    ew_sim_panel panel;
    FILE *pictures;
    int socket;
    uint32_t waiting[MOST_WAITING]; /* sequence numbers of interrupt IN requests   */
    unsigned waiting_count;
    int hung;
    uint32_t hung_sequence;
    unsigned long reports, by_control, written, plugs;
    unsigned long seen_commits;
} device;

static volatile sig_atomic_t stop;

static void on_signal(int number)
{
    (void)number;
    stop = 1;
}

/* ---- what the display does with reports ---- */

/* Every picture the display comes to show, once, as little-endian RGB565. */
static void keep_picture(device *d)
{
    size_t pixels = (size_t)d->panel.width * d->panel.height, i;
    if (d->panel.commits == d->seen_commits) {
        return;
    }
    d->seen_commits = d->panel.commits;
    for (i = 0; d->pictures && i < pixels; i++) {
        putc(d->panel.shown[i] & 0xFF, d->pictures);
        putc(d->panel.shown[i] >> 8, d->pictures);
    }
    if (d->pictures) {
        fflush(d->pictures);
    }
    d->written++;
}

/* `data` begins with the report id, on the endpoint as in a SET_REPORT request. */
static void take_output(device *d, const uint8_t *data, size_t length)
{
    d->reports++;
    if (length) {
        ew_hid_display_output(&d->display, data[0], data + 1, length - 1);
        keep_picture(d);
    }
}

/* ---- USB descriptors and control requests ---- */

static size_t string_descriptor(unsigned index, uint8_t *out)
{
    static const char *const strings[] = {"", "edgewalk", "edgewalk lab display", "LAB0001"};
    size_t n, i;

    if (index == 0) {
        memcpy(out, "\x04\x03\x09\x04", 4); /* language: English (US) */
        return 4;
    }
    if (index >= sizeof strings / sizeof *strings) {
        return 0;
    }
    n = strlen(strings[index]);
    out[0] = (uint8_t)(2 + 2 * n);
    out[1] = 3;
    for (i = 0; i < n; i++) {
        out[2 + 2 * i] = (uint8_t)strings[index][i];
        out[3 + 2 * i] = 0;
    }
    return out[0];
}

enum { CONFIGURATION_BYTES = 41, HID_DESCRIPTOR_AT = 18 };

/* clang-format off */
static const uint8_t configuration[CONFIGURATION_BYTES] = {
    9, 2, CONFIGURATION_BYTES, 0, 1, 1, 0, 0x80, 50,                   /* one interface, 100 mA */
    9, 4, 0, 0, 2, 3, 0, 0, 0,                                         /* HID, two endpoints    */
    9, 0x21, 0x11, 0x01, 0, 1, 0x22, EW_HID_DESCRIPTOR_BYTES & 0xFF, EW_HID_DESCRIPTOR_BYTES >> 8,
    7, 5, 0x81, 3, 64, 0, 1,                                           /* interrupt IN, 1 ms    */
    7, 5, 0x02, 3, 64, 0, 1};                                          /* interrupt OUT, 1 ms   */
/* clang-format on */

static size_t descriptor(const device *d, unsigned type, unsigned index, uint8_t *out)
{
    const options *o = &d->options;
    const uint8_t device_descriptor[18] = {18,
                                           1,
                                           0x00,
                                           0x02,
                                           0,
                                           0,
                                           0,
                                           64,
                                           (uint8_t)o->vendor,
                                           (uint8_t)(o->vendor >> 8),
                                           (uint8_t)o->product,
                                           (uint8_t)(o->product >> 8),
                                           0,
                                           1,
                                           1,
                                           2,
                                           3,
                                           1};
    switch (type) {
    case 1: memcpy(out, device_descriptor, sizeof device_descriptor); return sizeof device_descriptor;
    case 2: memcpy(out, configuration, sizeof configuration); return sizeof configuration;
    case 3: return string_descriptor(index, out);
    case 0x21: memcpy(out, configuration + HID_DESCRIPTOR_AT, 9); return 9;
    case 0x22: memcpy(out, ew_hid_descriptor, EW_HID_DESCRIPTOR_BYTES); return EW_HID_DESCRIPTOR_BYTES;
    default: return 0;
    }
}

static int get_report(const device *d, unsigned type, unsigned id, uint8_t *out)
{
    int n;
    if (type != 3 || (d->options.plain && id == EW_HID_CAPABILITIES)) {
        return -EPIPE;
    }
    out[0] = (uint8_t)id;
    n = ew_hid_display_get_feature(&d->display, (uint8_t)id, out + 1, 64);
    return n < 0 ? -EPIPE : n + 1;
}

static int set_report(device *d, unsigned type, const uint8_t *data, size_t length)
{
    if (type == 2) {
        d->by_control++;
        take_output(d, data, length);
        return 0;
    }
    if (type == 3 && length &&
        ew_hid_display_set_feature(&d->display, data[0], data + 1, length - 1) == EW_OK) {
        return 0;
    }
    return -EPIPE;
}

/* A control transfer. Returns the bytes put into `out`, or a negative errno. */
static int control(device *d, const uint8_t *setup, const uint8_t *data, size_t data_length, uint8_t *out)
{
    unsigned value = setup[2] | (unsigned)setup[3] << 8, length = setup[6] | (unsigned)setup[7] << 8;
    int n = 0;

    switch (setup[0] << 8 | setup[1]) {
    case 0x8006: /* get descriptor, of device and of interface */
    case 0x8106:
        n = (int)descriptor(d, value >> 8, value & 0xFF, out);
        if (!n) {
            return -EPIPE;
        }
        break;
    case 0x8000: /* get status, of device, interface and endpoint */
    case 0x8100:
    case 0x8200:
        out[0] = out[1] = 0;
        n = 2;
        break;
    case 0xA101: /* get report */ n = get_report(d, value >> 8, value & 0xFF, out); break;
    case 0x2109: /* set report */ return set_report(d, value >> 8, data, data_length);
    case 0x0009: /* set configuration, set interface, clear halt, set idle, set protocol */
    case 0x010B:
    case 0x0201:
    case 0x210A:
    case 0x210B: return 0;
    default: return -EPIPE;
    }
    return n > (int)length ? (int)length : n;
}

/* ---- USB/IP ---- */

static int read_all(int fd, void *to, size_t n)
{
    uint8_t *p = to;
    while (n) {
        ssize_t r = read(fd, p, n);
        if (r < 0 && errno == EINTR && !stop) {
            continue;
        }
        if (r <= 0) {
            return -1;
        }
        p += r;
        n -= (size_t)r;
    }
    return 0;
}

static void reply(const device *d, uint32_t command, uint32_t sequence, int status, const void *data,
                  uint32_t length, uint32_t actual)
{
    uint8_t whole[sizeof(usbip_header) + MOST_DATA];
    usbip_header header;

    memset(&header, 0, sizeof header);
    header.command = htonl(command);
    header.sequence = htonl(sequence);
    header.word[0] = htonl((uint32_t)status);
    header.word[1] = htonl(command == RET_SUBMIT ? actual : 0);
    memcpy(whole, &header, sizeof header);
    if (length) {
        memcpy(whole + sizeof header, data, length);
    }
    if (write(d->socket, whole, sizeof header + length) < 0) {
        fprintf(stderr, "usbip_display: reply: %s\n", strerror(errno));
    }
}

/* The status report, when there is one and the host asks for it. */
static void send_input(device *d)
{
    uint8_t report[1 + EW_HID_STATUS_BYTES];
    uint32_t sequence = d->waiting[0];

    if (!d->waiting_count || ew_hid_display_input(&d->display, report + 1) == 0) {
        return;
    }
    report[0] = EW_HID_STATUS;
    d->waiting_count--;
    memmove(d->waiting, d->waiting + 1, d->waiting_count * sizeof *d->waiting);
    reply(d, RET_SUBMIT, sequence, 0, report, sizeof report, sizeof report);
}

static int plug_in(device *d)
{
    int pair[2], attach, n;
    char line[64];

    if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair)) {
        perror("usbip_display: socketpair");
        return -1;
    }
    attach = open(VHCI_ATTACH, O_WRONLY);
    if (attach < 0) {
        perror("usbip_display: " VHCI_ATTACH);
        return -1;
    }
    n = snprintf(line, sizeof line, "%u %d %d %d", d->options.port, pair[1], DEVICE_ID, FULL_SPEED);
    if (write(attach, line, (size_t)n) != n) {
        perror("usbip_display: attach");
        n = -1;
    }
    close(attach);
    close(pair[1]);
    if (n < 0) {
        close(pair[0]);
        return -1;
    }
    d->socket = pair[0];
    d->waiting_count = 0;
    d->hung = 0;
    d->plugs++;
    return 0;
}

static void pull_out(device *d)
{
    shutdown(d->socket, SHUT_RDWR);
    close(d->socket);
    d->socket = -1;
}

/* A display that was plugged in again has forgotten everything. */
static void power_up(device *d)
{
    ew_hid_panel callbacks = ew_sim_panel_callbacks(&d->panel);
    memset(d->panel.shown, 0, (size_t)d->panel.width * d->panel.height * sizeof *d->panel.shown);
    callbacks.abandon(callbacks.user);
    ew_hid_display_init(&d->display, &callbacks, d->options.profile, (uint16_t)d->panel.width,
                        (uint16_t)d->panel.height);
}

static void unlink_request(device *d, uint32_t sequence, uint32_t victim)
{
    int status = 0;
    unsigned i;
    for (i = 0; i < d->waiting_count; i++) {
        if (d->waiting[i] == victim) {
            d->waiting_count--;
            memmove(d->waiting + i, d->waiting + i + 1, (d->waiting_count - i) * sizeof *d->waiting);
            status = -ECONNRESET;
            break;
        }
    }
    if (d->hung && d->hung_sequence == victim) {
        status = -ECONNRESET;
    }
    reply(d, RET_UNLINK, sequence, status, NULL, 0, 0);
}

static void interrupt_out(device *d, uint32_t sequence, const uint8_t *data, uint32_t length)
{
    const options *o = &d->options;
    if (o->hang_after && d->reports >= o->hang_after) {
        d->hung = 1; /* NAK for ever: no reply */
        d->hung_sequence = sequence;
        return;
    }
    if (o->stall_after && d->reports == o->stall_after) {
        d->reports++;
        reply(d, RET_SUBMIT, sequence, -EPIPE, NULL, 0, 0);
        return;
    }
    take_output(d, data, length);
    if (o->report_us) {
        usleep(o->report_us);
    }
    reply(d, RET_SUBMIT, sequence, 0, NULL, 0, length);
}

/* One request of the host. Returns 0, or -1 when the connection is over. */
static int serve(device *d)
{
    uint8_t data[MOST_DATA], out[MOST_DATA];
    usbip_header header;
    uint32_t sequence, length, direction;

    if (read_all(d->socket, &header, sizeof header)) {
        return -1;
    }
    sequence = ntohl(header.sequence);
    direction = ntohl(header.direction);
    length = ntohl(header.word[1]);
    if (ntohl(header.command) == CMD_UNLINK) {
        unlink_request(d, sequence, ntohl(header.word[0]));
        return 0;
    }
    if (direction == 0 && (length > sizeof data || read_all(d->socket, data, length))) {
        return -1;
    }
    if (ntohl(header.endpoint) == 0) {
        int n = control(d, header.setup, data, direction == 0 ? length : 0, out);
        uint32_t actual = direction ? (uint32_t)n : length;
        reply(d, RET_SUBMIT, sequence, n < 0 ? n : 0, out, direction && n > 0 ? (uint32_t)n : 0,
              n < 0 ? 0 : actual);
    } else if (direction == 0) {
        interrupt_out(d, sequence, data, length);
    } else if (d->waiting_count < MOST_WAITING) {
        d->waiting[d->waiting_count++] = sequence;
    } else {
        reply(d, RET_SUBMIT, sequence, -EPIPE, NULL, 0, 0);
    }
    send_input(d);
    return 0;
}

/* Returns 0 when the display may stay, -1 when it was pulled out for good. */
static int unplug_and_replug(device *d)
{
    int tries;
    fprintf(stderr, "usbip_display: unplugged after %lu reports\n", d->reports);
    d->options.unplug_after = 0;
    pull_out(d);
    if (d->options.no_replug) {
        return -1;
    }
    usleep(d->options.away_ms * 1000);
    power_up(d);
    for (tries = 0; plug_in(d); tries++) { /* the port is busy until the kernel has let go */
        if (tries == 50) {
            return -1;
        }
        usleep(100000);
    }
    fprintf(stderr, "usbip_display: plugged in again\n");
    return 0;
}

static int live(device *d)
{
    int64_t last_ms = ew_now_ms(), quiet_since_ms = last_ms;
    unsigned long seen = 0;

    while (!stop) {
        struct pollfd wait = {d->socket, POLLIN, 0};
        int r = poll(&wait, 1, TICK_MS);
        int64_t now = ew_now_ms();
        ew_hid_display_tick(&d->display, (uint32_t)(now - last_ms));
        last_ms = now;
        if (r > 0 && serve(d)) {
            return stop ? 0 : -1;
        }
        if (r == 0) {
            send_input(d);
        }
        if (d->reports != seen) {
            seen = d->reports;
            quiet_since_ms = now;
        }
        if (now - quiet_since_ms > (int64_t)d->options.idle_ms) {
            return 0;
        }
        if (d->options.unplug_after && d->reports >= d->options.unplug_after && unplug_and_replug(d)) {
            return 0;
        }
    }
    return 0;
}

/* ---- options ---- */

/* clang-format off */
static const struct argp_option option_list[] = {
    {"size", 's', "WxH", 0, "Size of the display [64x48]", 0},
    {"profile", 'p', "PROFILE", 0, "direct or buffered [buffered]", 0},
    {"id", 'i', "VID:PID", 0, "USB id in hex [16c0:05df]", 0},
    {"port", 'P', "N", 0, "Port of the virtual hub [0]", 0},
    {"pictures", 'o', "FILE", 0, "Write each picture shown, raw little-endian RGB565", 0},
    {"unplug-after", 'u', "N", 0, "Pull the plug after N reports", 0},
    {"away", 'a', "MS", 0, "Plug in again after so long [500]", 0},
    {"no-replug", 'x', NULL, 0, "Do not plug in again", 0},
    {"stall-after", 'S', "N", 0, "Refuse one report after N", 0},
    {"hang-after", 'H', "N", 0, "Take no report after N", 0},
    {"slow", 'w', "US", 0, "Time a report takes [0]", 0},
    {"plain", 'n', NULL, 0, "Without feature report 6", 0},
    {"idle", 'q', "MS", 0, "End when no report came for so long [5000]", 0},
    {0}};
/* clang-format on */

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case 's':
        if (sscanf(text, "%4ux%4u", &o->width, &o->height) != 2) {
            argp_error(state, "%s: not WxH", text);
        }
        break;
    case 'p': o->profile = strcmp(text, "direct") ? EW_HID_BUFFERED : EW_HID_DIRECT; break;
    case 'i':
        if (sscanf(text, "%4x:%4x", &o->vendor, &o->product) != 2) {
            argp_error(state, "%s: not VID:PID", text);
        }
        break;
    case 'P': o->port = (unsigned)strtoul(text, NULL, 10); break;
    case 'o': o->pictures = text; break;
    case 'u': o->unplug_after = strtoul(text, NULL, 10); break;
    case 'a': o->away_ms = (unsigned)strtoul(text, NULL, 10); break;
    case 'x': o->no_replug = 1; break;
    case 'S': o->stall_after = strtoul(text, NULL, 10); break;
    case 'H': o->hang_after = strtoul(text, NULL, 10); break;
    case 'w': o->report_us = (unsigned)strtoul(text, NULL, 10); break;
    case 'n': o->plain = 1; break;
    case 'q': o->idle_ms = (unsigned)strtoul(text, NULL, 10); break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

int main(int argc, char **argv)
{
    static const struct argp argp = {
        option_list, parse_option,
        NULL,        "A display on a virtual USB port of this machine (needs vhci-hcd and root).",
        NULL,        NULL,
        NULL};
    static device d = {.options = {.width = 64,
                                   .height = 48,
                                   .vendor = 0x16C0,
                                   .product = 0x05DF,
                                   .profile = EW_HID_BUFFERED,
                                   .away_ms = 500,
                                   .idle_ms = 5000},
                       .socket = -1};
    struct sigaction action = {.sa_handler = on_signal};
    int r;

    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &d.options);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGINT, &action, NULL);
    signal(SIGPIPE, SIG_IGN);
    if (ew_sim_panel_init(&d.panel, d.options.width, d.options.height, d.options.profile)) {
        fprintf(stderr, "usbip_display: panel: out of memory\n");
        return EXIT_FAILURE;
    }
    if (d.options.pictures && !(d.pictures = fopen(d.options.pictures, "wb"))) {
        perror(d.options.pictures);
        return EXIT_FAILURE;
    }
    power_up(&d);
    if (plug_in(&d)) {
        return EXIT_FAILURE;
    }
    r = live(&d);
    if (d.socket >= 0) {
        pull_out(&d);
    }
    if (d.pictures) {
        fclose(d.pictures);
    }
    printf("usbip_display: reports=%lu control=%lu pictures=%lu accepted=%u rejected=%u plugs=%lu\n",
           d.reports, d.by_control, d.written, d.display.accepted, d.display.rejected, d.plugs);
    ew_sim_panel_free(&d.panel);
    return r ? EXIT_FAILURE : EXIT_SUCCESS;
}
