#define _GNU_SOURCE /* asprintf */

#include "whole_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct stat input; /* st_ino 0: none */

void ew_whole_file_spare(int descriptor)
{
    if (fstat(descriptor, &input) != 0) input.st_ino = 0;
}

static int is_input(const struct stat *status)
{
    return input.st_ino && status->st_ino == input.st_ino && status->st_dev == input.st_dev;
}

static int complain(const ew_whole_file *whole, const char *why)
{
    fprintf(stderr, "%s: %s: cannot be written: %s\n", whole->tool, whole->shown ? whole->shown : "", why);
    return -1;
}

static void forget(ew_whole_file *whole)
{
    free(whole->shown);
    free(whole->target);
    free(whole->temporary);
    memset(whole, 0, sizeof *whole);
}

int ew_whole_file_open(ew_whole_file *whole, const char *tool, const char *path)
{
    struct stat status;
    memset(whole, 0, sizeof *whole);
    if (!path) return 0;
    whole->tool = tool;
    whole->shown = strdup(path);
    const char *why = NULL;
    if (stat(path, &status) == 0) {
        if (!S_ISREG(status.st_mode)) why = strerror(S_ISDIR(status.st_mode) ? EISDIR : EINVAL);
        if (why && !S_ISDIR(status.st_mode)) why = "not a regular file";
        if (!why && is_input(&status)) why = "is the input file";
        whole->target = realpath(path, NULL);
    } else {
        whole->target = strdup(path);
    }
    if (!why && (!whole->shown || !whole->target || asprintf(&whole->temporary, "%s.part", whole->target) < 0)) {
        whole->temporary = NULL;
        why = strerror(errno);
    }
    if (!why) {
        whole->file = fopen(whole->temporary, "wb");
        if (!whole->file) why = strerror(errno);
    }
    if (!why) return 0;
    complain(whole, why);
    forget(whole);
    return -1;
}

int ew_whole_file_close(ew_whole_file *whole, int keep)
{
    if (!whole->file) return 0;
    struct stat status;
    if (keep && stat(whole->target, &status) == 0 && is_input(&status)) { /* read only after this was opened */
        complain(whole, "is the input file");
        ew_whole_file_close(whole, 0);
        return -1;
    }
    errno = 0;
    int bad = ferror(whole->file) != 0;
    bad |= fclose(whole->file) != 0;
    bad = keep && (bad || rename(whole->temporary, whole->target) != 0);
    if (bad) complain(whole, errno ? strerror(errno) : "write error");
    if (bad || !keep) unlink(whole->temporary);
    forget(whole);
    return bad ? -1 : 0;
}
