/* PNG through libpng. An animation is a PNG file whose further frames lie in chunks that
 * libpng 1.6 does not know (acTL, fcTL, fdAT of the APNG specification), so those are
 * written through its chunk functions, their pixels deflated by zlib as IDAT's are. */
#include "image.h"

#include "whole_file.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

struct ew_apng {
    const char *tool;
    ew_whole_file out;
    png_structp png;
    png_infop info;
    uint8_t *rows;    /* one frame, each row behind its filter byte */
    uint8_t *deflated;
    uLong deflated_room;
    unsigned width, height, frames, fps, added, sequence;
    int failed;
};

static void complain(const char *tool, const char *path, const char *why)
{
    fprintf(stderr, "%s: %s: cannot write the picture: %s\n", tool, path, why);
}

static void on_png_error(png_structp png, png_const_charp message)
{
    ew_apng *a = png_get_error_ptr(png);
    complain(a->tool, a->out.shown, errno ? strerror(errno) : message);
    a->failed = 1;
    longjmp(png_jmpbuf(png), 1);
}
static void on_png_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

/* 5 and 6 bits to 8: nearest, so that full scale stays full scale. */
static void expand(uint8_t *rgb, uint16_t p)
{
    rgb[0] = (uint8_t)(((p >> 11) * 255 + 15) / 31);
    rgb[1] = (uint8_t)(((p >> 5 & 63) * 255 + 31) / 63);
    rgb[2] = (uint8_t)(((p & 31) * 255 + 15) / 31);
}

static size_t row_bytes(const ew_apng *a) { return 1 + 3 * (size_t)a->width; }

/* Filter 1 (difference to the pixel on the left) suits rendered pictures well enough. */
static void fill_rows(ew_apng *a, const uint16_t *rgb565)
{
    for (unsigned y = 0; y < a->height; y++) {
        uint8_t *row = a->rows + y * row_bytes(a), before[3] = { 0, 0, 0 };
        row[0] = 1;
        for (unsigned x = 0; x < a->width; x++) {
            uint8_t rgb[3];
            expand(rgb, rgb565[(size_t)y * a->width + x]);
            for (int k = 0; k < 3; k++) {
                row[1 + 3 * x + (unsigned)k] = (uint8_t)(rgb[k] - before[k]);
                before[k] = rgb[k];
            }
        }
    }
}

/* Frees it; the file is kept if nothing failed. */
static int release(ew_apng *a)
{
    if (a->png) png_destroy_write_struct(&a->png, &a->info);
    if (ew_whole_file_close(&a->out, !a->failed)) a->failed = 1;
    int result = a->failed ? -1 : 0;
    free(a->rows);
    free(a->deflated);
    free(a);
    return result;
}

static int write_header(ew_apng *a)
{
    if (setjmp(png_jmpbuf(a->png))) return -1;
    png_init_io(a->png, a->out.file);
    png_set_IHDR(a->png, a->info, a->width, a->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(a->png, a->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(a->png, a->info);
    if (a->frames > 1) {
        png_byte control[8];
        png_save_uint_32(control, a->frames);
        png_save_uint_32(control + 4, 0);
        png_write_chunk(a->png, (png_const_bytep)"acTL", control, sizeof control);
    }
    return 0;
}

ew_apng *ew_apng_open(const char *tool, const char *path, unsigned width, unsigned height, unsigned frames,
                      unsigned fps)
{
    ew_apng *a = calloc(1, sizeof *a);
    if (!a) {
        complain(tool, path, strerror(ENOMEM));
        return NULL;
    }
    a->tool = tool;
    a->width = width, a->height = height, a->frames = frames, a->fps = fps ? fps : 1;
    a->rows = malloc(row_bytes(a) * height);
    a->deflated_room = compressBound((uLong)(row_bytes(a) * height));
    a->deflated = malloc(4 + a->deflated_room);
    a->failed = 1;
    if (!a->rows || !a->deflated) {
        complain(tool, path, strerror(ENOMEM));
        release(a);
        return NULL;
    }
    if (ew_whole_file_open(&a->out, tool, path)) {
        release(a);
        return NULL;
    }
    a->failed = 0;
    errno = 0;
    a->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, a, on_png_error, on_png_warning);
    if (a->png) a->info = png_create_info_struct(a->png);
    if (!a->png || !a->info || write_header(a)) {
        a->failed = 1;
        release(a);
        return NULL;
    }
    return a;
}

static void write_frame_control(ew_apng *a)
{
    png_byte control[26] = { 0 };
    png_save_uint_32(control, a->sequence++);
    png_save_uint_32(control + 4, a->width);
    png_save_uint_32(control + 8, a->height);
    png_save_uint_16(control + 20, 1);
    png_save_uint_16(control + 22, a->fps);
    png_write_chunk(a->png, (png_const_bytep)"fcTL", control, sizeof control);
}

int ew_apng_add(ew_apng *a, const uint16_t *rgb565)
{
    if (a->failed) return -1;
    if (a->added == a->frames) {
        complain(a->tool, a->out.shown, "more frames than were announced");
        a->failed = 1;
        return -1;
    }
    fill_rows(a, rgb565);
    uLongf size = a->deflated_room;
    if (compress2(a->deflated + 4, &size, a->rows, (uLong)(row_bytes(a) * a->height), 6) != Z_OK) {
        complain(a->tool, a->out.shown, "zlib failed");
        a->failed = 1;
        return -1;
    }
    errno = 0;
    if (setjmp(png_jmpbuf(a->png))) return -1;
    if (a->frames > 1) write_frame_control(a);
    if (a->added == 0) {
        png_write_chunk(a->png, (png_const_bytep)"IDAT", a->deflated + 4, size);
    } else {
        png_save_uint_32(a->deflated, a->sequence++);
        png_write_chunk(a->png, (png_const_bytep)"fdAT", a->deflated, size + 4);
    }
    a->added++;
    return 0;
}

int ew_apng_close(ew_apng *a, int keep)
{
    if (!keep) a->failed = 1;
    if (!a->failed && a->added != a->frames) {
        complain(a->tool, a->out.shown, "fewer frames than were announced");
        a->failed = 1;
    }
    if (!a->failed) {
        errno = 0;
        if (setjmp(png_jmpbuf(a->png)) == 0) png_write_chunk(a->png, (png_const_bytep)"IEND", NULL, 0);
    }
    return release(a);
}

int ew_image_write_png(const char *tool, const char *path, const uint16_t *rgb565, unsigned width,
                       unsigned height)
{
    ew_apng *a = ew_apng_open(tool, path, width, height, 1, 1);
    if (!a) return -1;
    return ew_apng_close(a, ew_apng_add(a, rgb565) == 0);
}
