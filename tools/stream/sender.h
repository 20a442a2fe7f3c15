/* The thread that talks to the display.
 *
 * Between it and whoever draws lies a mailbox for one frame. For live output a newer
 * frame replaces one that still lies there, so the display is never behind by more
 * than the frame on the wire, and drawing never waits. A display whose bus blocks a
 * write holds up this thread alone; the drawing side notices that nothing moves and
 * gives up in bounded time.
 */
#ifndef EW_SENDER_H
#define EW_SENDER_H

#include <pthread.h>

#include "link.h"
#include "panel_lines.h"

typedef struct ew_sender_config {
    int lossless; /* submit waits until the mailbox is empty instead of replacing a frame */
    int confirm;  /* every frame is sent again until the display has confirmed it         */
    /* Called in the sender's thread after each confirmed frame (with `confirm`). 0, or
     * -1 to end the stream as failed, with `what: why` in `error`. May be NULL. */
    int (*confirmed)(void *user, const uint16_t *pixels, char *error, size_t size);
    void *user;
    unsigned reconnect_ms; /* how long to look for a display that has gone; 0: not at all   */
    /* Give up when nothing has moved for so long, and for reconnect_ms more: a blocked
     * write may yet come back with an error. 0: never. */
    unsigned watch_ms;
    const atomic_int *interrupted; /* set: stop waiting for anything; may be NULL */
} ew_sender_config;

/* Fields are the sender's own; `dropped`, `reconnects` and `error` may be read after
 * ew_sender_end. */
typedef struct ew_sender {
    ew_link *link;
    ew_panel_lines *lines;
    ew_sender_config config;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    uint16_t *mailbox, *work;
    size_t frame_bytes;
    int full, busy, stop, ended, failed, abandoned;
    int again; /* `work` is not known to be on the display; of the thread alone */
    int have;  /* `work` holds a frame; of the thread alone                     */
    unsigned long dropped, reconnects;
    char error[512];
} ew_sender;

/* The link is open; the sender has it to itself until ew_sender_end. Returns 0, or -1
 * with `error` set. */
int ew_sender_start(ew_sender *sender, ew_link *link, ew_panel_lines *lines, const ew_sender_config *config);

/* Hands over a frame (copied). Returns 0, or -1 when the stream has failed: `error`. */
int ew_sender_submit(ew_sender *sender, const uint16_t *pixels);

/* Sends what is left, waits for its confirmation and ends the thread. Returns 0 when
 * the last frame submitted is on the display, else -1: `error`. When the thread is
 * stuck inside the driver it is left there: `abandoned` is set, nothing of sender,
 * link, lines and driver may be freed, and the program should end. */
int ew_sender_end(ew_sender *sender);

#endif
