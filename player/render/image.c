/* SPDX-License-Identifier: BSD-2-Clause */
/* See image.h. PNG files are in image_png.c, letters in image_text.c. */
#include <stdlib.h>
#include <string.h>

#include "player/render/image.h"

enum { MAX_SIDE = 16384 };
static const double least_structure = 0.9;

fap_err image_create(image *im, int width, int height)
{
    *im = (image){ 0 };
    if (width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE)
        return FAP_E_LIMIT;
    im->rgba = calloc((size_t)width * (size_t)height, 4);
    if (!im->rgba)
        return FAP_E_NOMEM;
    im->width = width;
    im->height = height;
    return FAP_OK;
}

void image_free(image *im)
{
    free(im->rgba);
    *im = (image){ 0 };
}

static int pixel_distance(const uint8_t *a, const uint8_t *b)
{
    int worst = 0;
    for (int c = 0; c < 3; c++) {
        const int d = abs(a[c] - b[c]);
        worst = d > worst ? d : worst;
    }
    return worst;
}

fap_err image_compare(const image *a, const image *b, int tolerance, image_difference *d, image *diff)
{
    if (a->width != b->width || a->height != b->height)
        return FAP_E_DATA;
    if (diff) {
        const fap_err err = image_create(diff, a->width, a->height);
        if (err != FAP_OK)
            return err;
    }
    *d = (image_difference){ .pixel_count = (size_t)a->width * (size_t)a->height };
    for (size_t i = 0; i < d->pixel_count; i++) {
        const int distance = pixel_distance(a->rgba + 4 * i, b->rgba + 4 * i);
        d->worst = distance > d->worst ? distance : d->worst;
        d->far_count += distance > tolerance;
        if (diff) { /* small differences are made visible, far ones red */
            const int shown = distance * 16 > 255 ? 255 : distance * 16;
            const uint8_t pixel[4] = { (uint8_t)shown, (uint8_t)(distance > tolerance ? 0 : shown), 0, 255 };
            memcpy(diff->rgba + 4 * i, pixel, 4);
        }
    }
    d->structure = d->worst ? image_structure(a, b) : 1;
    return FAP_OK;
}

int image_same(const image_difference *d)
{
    return d->far_count * 2000 <= d->pixel_count && d->structure >= least_structure;
}

void image_blit(image *dst, const image *src, int x, int y)
{
    const int left = x < 0 ? -x : 0, right = x + src->width > dst->width ? dst->width - x : src->width;

    for (int row = 0; row < src->height && left < right; row++) {
        if (y + row < 0 || y + row >= dst->height)
            continue;
        memcpy(dst->rgba + 4 * ((size_t)(y + row) * (size_t)dst->width + (size_t)(x + left)),
               src->rgba + 4 * ((size_t)row * (size_t)src->width + (size_t)left), 4 * (size_t)(right - left));
    }
}

void image_sheet_grid(int count, int *columns, int *rows)
{
    int c = 1;
    while (c * c < count)
        c++;
    if (count > 3 && c * (c - 2) >= count) /* a wide sheet reads better than a square with an empty row */
        c--;
    *columns = c;
    *rows = (count + c - 1) / c;
}
