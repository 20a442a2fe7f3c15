#define _GNU_SOURCE /* asprintf */

#include "stream_output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/common/image.h"
#include "stream_options.h"

static int complain(const char *path, const char *what)
{
    fprintf(stderr, "%s: %s: %s: %s\n", ew_stream_tool, path, what, strerror(errno));
    return -1;
}

int ew_pictures_open(ew_pictures *pictures, const char *dir, unsigned width, unsigned height)
{
    struct stat status;

    memset(pictures, 0, sizeof *pictures);
    if (!dir) {
        return 0;
    }
    if (mkdir(dir, 0777) && errno != EEXIST) {
        return complain(dir, "create");
    }
    if (stat(dir, &status) || !S_ISDIR(status.st_mode)) {
        errno = ENOTDIR;
        return complain(dir, "create");
    }
    pictures->spool = tmpfile();
    if (!pictures->spool) {
        return complain(dir, "temporary file");
    }
    pictures->dir = dir;
    pictures->width = width;
    pictures->height = height;
    return 0;
}

int ew_pictures_add(ew_pictures *pictures, const uint16_t *rgb565)
{
    size_t pixels = (size_t)pictures->width * pictures->height;
    char *path;
    int r;

    if (!pictures->dir) {
        return 0;
    }
    if (asprintf(&path, "%s/frame-%04u.png", pictures->dir, pictures->count) < 0) {
        return complain(pictures->dir, "write");
    }
    r = ew_image_write_png(ew_stream_tool, path, rgb565, pictures->width, pictures->height);
    free(path);
    if (!r && fwrite(rgb565, sizeof *rgb565, pixels, pictures->spool) != pixels) {
        return complain(pictures->dir, "temporary file");
    }
    pictures->count++;
    return r;
}

static int write_animation(ew_pictures *pictures, const char *path, unsigned fps)
{
    size_t pixels = (size_t)pictures->width * pictures->height;
    uint16_t *picture = malloc(pixels * sizeof *picture);
    ew_apng *apng;
    unsigned i;
    int r = 0;

    if (!picture) {
        return complain(path, "write");
    }
    apng = ew_apng_open(ew_stream_tool, path, pictures->width, pictures->height, pictures->count, fps);
    rewind(pictures->spool);
    for (i = 0; apng && !r && i < pictures->count; i++) {
        r = fread(picture, sizeof *picture, pixels, pictures->spool) == pixels
                ? ew_apng_add(apng, picture)
                : complain(path, "temporary file");
    }
    free(picture);
    if (!apng || ew_apng_close(apng, !r)) {
        r = -1;
    }
    return r;
}

int ew_pictures_close(ew_pictures *pictures, double fps)
{
    char *path;
    int r = 0;

    if (!pictures->dir) {
        return 0;
    }
    if (pictures->count) {
        if (asprintf(&path, "%s/animation.png", pictures->dir) < 0) {
            return complain(pictures->dir, "write");
        }
        r = write_animation(pictures, path, fps >= 1 ? (unsigned)(fps + 0.5) : 30);
        free(path);
    }
    fclose(pictures->spool);
    memset(pictures, 0, sizeof *pictures);
    return r;
}
