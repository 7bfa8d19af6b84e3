/* SPDX-License-Identifier: BSD-2-Clause */
/* See range_file.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/range.h>

#include "common/file.h"
#include "databank/range/depth_png.h"
#include "databank/range/range_file.h"

enum { PATH_SIZE = 4096 };

static const size_t most = (size_t)256 << 20;

static fap_err blame(const char *file, fap_err err, char *where)
{
    snprintf(where, FAP_ERROR_TEXT_SIZE, "%.100s: %.120s", file,
             err == FAP_E_IO && errno ? strerror(errno)
             : err == FAP_E_UNKNOWN_FORMAT
                 ? "no picture that is known: depth is a grey PNG or a PFM, colour a PNG"
             : err == FAP_E_UNSUPPORTED ? "this fapbank was built without libpng"
                                        : fap_strerror(err));
    return err == FAP_E_UNKNOWN_FORMAT ? FAP_E_DATA : err;
}

static fap_err read_depth(const range_folder *folder, const char *name, fap_range_image *im, char *where)
{
    uint8_t *data;
    size_t size;
    float *depth = NULL;

    errno = 0;
    fap_err err = folder->read(folder->user, name, &data, &size);
    if (err == FAP_OK) {
        err = depth_png_read(&depth, &im->columns, &im->rows, data, size);
        if (err == FAP_E_UNKNOWN_FORMAT || err == FAP_E_UNSUPPORTED) {
            const fap_err other = fap_range_read_pfm(&depth, &im->columns, &im->rows, data, size, NULL);
            err = other == FAP_E_UNKNOWN_FORMAT ? err : other;
        }
        free(data);
    }
    im->depth = depth;
    return err == FAP_OK ? err : blame(name, err, where);
}

static fap_err read_colour(const range_folder *folder, const char *name, fap_range_image *im, uint8_t **rgb,
                           char *where)
{
    uint8_t *data;
    size_t size;

    errno = 0;
    fap_err err = folder->read(folder->user, name, &data, &size);
    if (err == FAP_OK) {
        err = colour_png_read(rgb, &im->colour_columns, &im->colour_rows, data, size);
        free(data);
    }
    im->rgb = (const uint8_t(*)[3]) * rgb;
    return err == FAP_OK ? err : blame(name, err, where);
}

fap_err range_file_read(fap_surface **out, const range_folder *folder, const void *text, size_t size,
                        char *where)
{
    fap_range_camera camera;
    fap_range_image im = { 0 };
    uint8_t *rgb = NULL;

    *out = NULL;
    fap_err err = fap_range_camera_read(&camera, text, size, where);
    if (err == FAP_OK)
        err = read_depth(folder, camera.depth, &im, where);
    if (err == FAP_OK && *camera.colour)
        err = read_colour(folder, camera.colour, &im, &rgb, where);
    if (err == FAP_OK) {
        err = fap_range_surface(out, &im, &camera, NULL);
        if (err != FAP_OK)
            snprintf(where, FAP_ERROR_TEXT_SIZE, "%.100s: %.120s", camera.depth,
                     err == FAP_E_NOT_FOUND ? "nothing was seen" : fap_strerror(err));
    }
    free((void *)(uintptr_t)im.depth);
    free(rgb);
    return err;
}

/* --- files --- */

static fap_err read_beside(void *user, const char *name, uint8_t **data, size_t *size)
{
    const char *camera = user, *slash = strrchr(camera, '/');
    char path[PATH_SIZE];
    const int n = snprintf(path, sizeof path, "%.*s%s", slash ? (int)(slash - camera) + 1 : 0, camera, name);

    return n > 0 && n < PATH_SIZE ? file_read(path, most, data, size) : FAP_E_ARG;
}

int range_file_may_be(const uint8_t *data, size_t size)
{
    size_t i = 0;

    while (i < size && (data[i] == ' ' || data[i] == '\t' || data[i] == '\r' || data[i] == '\n'))
        i++;
    return i < size && data[i] == '{';
}

fap_err range_file_read_beside(fap_surface **out, const char *path, const void *text, size_t size,
                               char *where)
{
    const range_folder folder = { read_beside, (char *)(uintptr_t)path };
    return range_file_read(out, &folder, text, size, where);
}
