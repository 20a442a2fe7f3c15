#include "sender.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"

enum { KEEP_ALIVE_MS = 1000, LOOK_AGAIN_MS = 100, WATCH_EVERY_MS = 50 };

typedef enum taken { TAKEN_END, TAKEN_FRAME, TAKEN_AGAIN, TAKEN_NOTHING } taken;

static int interrupted(const ew_sender *sender)
{
    return sender->config.interrupted && *sender->config.interrupted;
}

/* With the lock held. */
static int fail(ew_sender *sender, const char *format, ...)
{
    va_list arguments;
    if (!sender->failed) {
        va_start(arguments, format);
        vsnprintf(sender->error, sizeof sender->error, format, arguments);
        va_end(arguments);
    }
    sender->failed = 1;
    return -1;
}

static void wait_ms(ew_sender *sender, unsigned ms)
{
    struct timespec until = ew_timespec_ns(ew_now_ns() + (int64_t)ms * 1000000);
    pthread_cond_timedwait(&sender->changed, &sender->lock, &until);
}

/* ---- the sender's thread ---- */

static taken take(ew_sender *sender)
{
    int64_t keep_alive = ew_now_ms() + KEEP_ALIVE_MS;
    taken what = TAKEN_NOTHING;

    pthread_mutex_lock(&sender->lock);
    sender->busy = 0;
    for (;;) {
        if (sender->again && (sender->config.confirm || !sender->full)) {
            what = TAKEN_AGAIN;
            break;
        }
        if (sender->full) {
            uint16_t *frame = sender->mailbox;
            sender->mailbox = sender->work;
            sender->work = frame;
            sender->full = 0;
            sender->have = 1;
            sender->dropped += (unsigned)sender->again; /* replaced before it could be repeated */
            what = TAKEN_FRAME;
            break;
        }
        if (sender->stop) {
            what = TAKEN_END;
            break;
        }
        int64_t left = keep_alive - ew_now_ms();
        if (left <= 0) {
            break;
        }
        wait_ms(sender, (unsigned)left);
    }
    sender->busy = 1;
    atomic_store(&sender->link->progress_ms, ew_now_ms());
    pthread_cond_broadcast(&sender->changed);
    pthread_mutex_unlock(&sender->lock);
    return what;
}

static ew_link_result broken(ew_sender *sender, const char *what, const char *why)
{
    pthread_mutex_lock(&sender->lock);
    fail(sender, "%s%s", what, why);
    pthread_mutex_unlock(&sender->lock);
    return EW_LINK_LOST;
}

static ew_link_result send_work(ew_sender *sender)
{
    char why[256] = "";
    ew_link_result r;

    if (ew_panel_wait_te(sender->lines)) {
        return broken(sender, "TE line: ", "cannot be read any more");
    }
    atomic_store(&sender->link->progress_ms, ew_now_ms());
    r = sender->config.confirm ? ew_link_deliver(sender->link, sender->work)
                               : ew_link_send(sender->link, sender->work);
    if (r == EW_LINK_OK && sender->config.confirm && sender->config.confirmed &&
        sender->config.confirmed(sender->config.user, sender->work, why, sizeof why)) {
        return broken(sender, "", why);
    }
    return r;
}

static int reopen(ew_sender *sender)
{
    int64_t deadline = ew_now_ms() + sender->config.reconnect_ms;
    int r = EW_DRIVER_ABSENT;

    ew_link_close(sender->link);
    if (ew_panel_reset(sender->lines)) {
        broken(sender, "reset line: ", "cannot be driven any more");
        return -1;
    }
    /* A display that is just coming back may be there and refuse for a moment, so any
     * failure is tried again until the time is over. */
    while (!interrupted(sender) && ew_now_ms() < deadline) {
        atomic_store(&sender->link->progress_ms, ew_now_ms());
        r = ew_link_open(sender->link);
        if (!r) {
            return 0;
        }
        ew_sleep_ms(LOOK_AGAIN_MS);
    }
    return -1;
}

/* Returns 0 when the stream can go on. */
static int recover(ew_sender *sender)
{
    char lost[sizeof sender->link->error];
    int failed;

    pthread_mutex_lock(&sender->lock);
    failed = sender->failed;
    pthread_mutex_unlock(&sender->lock);
    if (failed) {
        return -1;
    }
    memcpy(lost, sender->link->error, sizeof lost);
    if (!sender->config.reconnect_ms) {
        broken(sender, "", lost);
        return -1;
    }
    if (reopen(sender)) {
        pthread_mutex_lock(&sender->lock);
        fail(sender, "%.200s; looked for it again for %u ms: %.200s", lost, sender->config.reconnect_ms,
             sender->link->error);
        pthread_mutex_unlock(&sender->lock);
        return -1;
    }
    sender->reconnects++;
    return 0;
}

static void *run(void *argument)
{
    ew_sender *sender = argument;

    for (;;) {
        taken what = take(sender);
        ew_link_result r;
        if (what == TAKEN_END) {
            r = sender->have ? ew_link_settle(sender->link) : EW_LINK_OK;
        } else if (what == TAKEN_NOTHING) {
            r = sender->have ? ew_link_keep_alive(sender->link) : EW_LINK_OK;
        } else {
            r = send_work(sender);
        }
        if (r == EW_LINK_LOST && recover(sender)) {
            break;
        }
        if (what == TAKEN_END && r == EW_LINK_OK) {
            break; /* only with the last frame on the display; else it is sent again */
        }
        sender->again = r != EW_LINK_OK && sender->have;
    }
    pthread_mutex_lock(&sender->lock);
    sender->ended = 1;
    sender->busy = 0;
    pthread_cond_broadcast(&sender->changed);
    pthread_mutex_unlock(&sender->lock);
    return NULL;
}

/* ---- the drawing side ---- */

/* With the lock held. */
static int stuck(ew_sender *sender)
{
    int64_t still = ew_now_ms() - atomic_load(&sender->link->progress_ms);
    int64_t limit =
        (int64_t)sender->config.watch_ms + (interrupted(sender) ? 0 : sender->config.reconnect_ms);
    if (!sender->config.watch_ms || !sender->busy || still <= limit) {
        return 0;
    }
    fail(sender, "write: the display has taken nothing for %lld ms", (long long)limit);
    return 1;
}

int ew_sender_start(ew_sender *sender, ew_link *link, ew_panel_lines *lines, const ew_sender_config *config)
{
    size_t pixels = (size_t)link->width * link->height;
    pthread_condattr_t monotonic;

    memset(sender, 0, sizeof *sender);
    sender->link = link;
    sender->lines = lines;
    sender->config = *config;
    sender->frame_bytes = pixels * sizeof *sender->work;
    sender->mailbox = calloc(pixels, sizeof *sender->mailbox);
    sender->work = calloc(pixels, sizeof *sender->work);
    pthread_mutex_init(&sender->lock, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&sender->changed, &monotonic);
    pthread_condattr_destroy(&monotonic);
    if (!sender->mailbox || !sender->work || pthread_create(&sender->thread, NULL, run, sender)) {
        free(sender->mailbox);
        free(sender->work);
        return fail(sender, "start: out of memory or threads");
    }
    return 0;
}

int ew_sender_submit(ew_sender *sender, const uint16_t *pixels)
{
    int failed;

    pthread_mutex_lock(&sender->lock);
    while (sender->config.lossless && sender->full && !sender->failed && !stuck(sender) &&
           !interrupted(sender)) {
        wait_ms(sender, WATCH_EVERY_MS);
    }
    failed = sender->failed || stuck(sender);
    if (!failed) {
        sender->dropped += (unsigned)sender->full;
        memcpy(sender->mailbox, pixels, sender->frame_bytes);
        sender->full = 1;
        pthread_cond_broadcast(&sender->changed);
    }
    pthread_mutex_unlock(&sender->lock);
    return failed ? -1 : 0;
}

int ew_sender_end(ew_sender *sender)
{
    pthread_mutex_lock(&sender->lock);
    sender->stop = 1;
    pthread_cond_broadcast(&sender->changed);
    while (!sender->ended && !stuck(sender)) {
        wait_ms(sender, WATCH_EVERY_MS);
    }
    sender->abandoned = !sender->ended;
    pthread_mutex_unlock(&sender->lock);
    if (!sender->abandoned) {
        pthread_join(sender->thread, NULL);
        free(sender->mailbox);
        free(sender->work);
        pthread_mutex_destroy(&sender->lock);
        pthread_cond_destroy(&sender->changed);
    }
    return sender->failed ? -1 : 0;
}
