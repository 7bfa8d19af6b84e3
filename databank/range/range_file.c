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
#include "player/render/image.h"

enum { PATH_SIZE = 4096 };

static const size_t most = (size_t)256 << 20;

static fap_err blame(const char *file, fap_err err, char *where)
{
    snprintf(where, FAP_ERROR_TEXT_SIZE, "%.100s: %.120s", file,
             err == FAP_E_IO && errno      ? strerror(errno)
             : err == FAP_E_UNKNOWN_FORMAT ? "neither a grey PNG nor a PFM"
             : err == FAP_E_UNSUPPORTED    ? "this fapbank was built without libpng"
                                           : fap_strerror(err));
    return err == FAP_E_UNKNOWN_FORMAT ? FAP_E_DATA : err;
}

static int beside(const char *camera, const char *name, char path[PATH_SIZE])
{
    const char *slash = strrchr(camera, '/');
    const int n = snprintf(path, PATH_SIZE, "%.*s%s", slash ? (int)(slash - camera) + 1 : 0, camera, name);

    return n > 0 && n < PATH_SIZE;
}

static fap_err read_depth(const char *camera, const char *name, fap_range_image *im, char *where)
{
    char path[PATH_SIZE];
    uint8_t *data;
    size_t size;
    float *depth = NULL;

    if (!beside(camera, name, path))
        return FAP_E_ARG;
    errno = 0;
    fap_err err = file_read(path, most, &data, &size);
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

/* Three bytes a pixel out of four. */
static fap_err read_colour(const char *camera, const char *name, fap_range_image *im, uint8_t **rgb,
                           char *where)
{
    char path[PATH_SIZE];
    image picture;

    if (!beside(camera, name, path))
        return FAP_E_ARG;
    fap_err err = image_read_png(&picture, path);
    if (err != FAP_OK) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%.100s: %.120s", name,
                 err == FAP_E_NOT_FOUND ? "no such file" : "no PNG that can be read");
        return err == FAP_E_UNSUPPORTED ? err : FAP_E_DATA;
    }
    const size_t n = (size_t)picture.width * (size_t)picture.height;
    *rgb = malloc(3 * n);
    for (size_t i = 0; *rgb && i < n; i++)
        memcpy(*rgb + 3 * i, picture.rgba + 4 * i, 3);
    im->rgb = (const uint8_t(*)[3]) * rgb;
    im->colour_columns = (uint32_t)picture.width;
    im->colour_rows = (uint32_t)picture.height;
    image_free(&picture);
    return *rgb ? FAP_OK : FAP_E_NOMEM;
}

fap_err range_file_read(fap_surface **out, const char *path, const void *text, size_t size, char *where)
{
    fap_range_camera camera;
    fap_range_image im = { 0 };
    uint8_t *rgb = NULL;

    *out = NULL;
    fap_err err = fap_range_camera_read(&camera, text, size, where);
    if (err == FAP_OK)
        err = read_depth(path, camera.depth, &im, where);
    if (err == FAP_OK && *camera.colour)
        err = read_colour(path, camera.colour, &im, &rgb, where);
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
