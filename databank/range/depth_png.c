/* SPDX-License-Identifier: BSD-2-Clause */
/* See depth_png.h. libpng's errors come back by longjmp: what is set before it is volatile or in the struct. */
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/range.h>

#include "databank/range/depth_png.h"

#ifdef HAVE_PNG
#include <png.h>

typedef struct reading {
    const uint8_t *data;
    size_t size, at;
    float *depth;
    uint8_t *row;
    uint32_t columns, rows;
} reading;

static void fail(png_structp png, png_const_charp words)
{
    (void)words;
    png_longjmp(png, 1);
}

static void quiet(png_structp png, png_const_charp words)
{
    (void)png, (void)words;
}

static void take(png_structp png, png_bytep to, size_t count)
{
    reading *r = png_get_io_ptr(png);

    if (count > r->size - r->at)
        png_longjmp(png, 1);
    memcpy(to, r->data + r->at, count);
    r->at += count;
}

static fap_err begin(png_structp png, png_infop info, reading *r)
{
    png_read_info(png, info);
    r->columns = png_get_image_width(png, info);
    r->rows = png_get_image_height(png, info);
    if (png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY || png_get_bit_depth(png, info) < 8 ||
        png_get_interlace_type(png, info) != PNG_INTERLACE_NONE)
        return FAP_E_DATA;
    if (r->columns > FAP_RANGE_MAX_SIDE || r->rows > FAP_RANGE_MAX_SIDE)
        return FAP_E_LIMIT;
    r->depth = calloc((size_t)r->columns * r->rows, sizeof *r->depth);
    r->row = malloc(png_get_rowbytes(png, info));
    return r->depth && r->row ? FAP_OK : FAP_E_NOMEM;
}

static fap_err read_rows(png_structp png, png_infop info, reading *r)
{
    const fap_err err = begin(png, info, r);
    const int wide = err == FAP_OK && png_get_bit_depth(png, info) == 16;

    for (uint32_t y = 0; err == FAP_OK && y < r->rows; y++) {
        png_read_row(png, r->row, NULL);
        for (uint32_t x = 0; x < r->columns; x++)
            r->depth[(size_t)y * r->columns + x] =
                wide ? (float)(r->row[2 * x] << 8 | r->row[2 * x + 1]) : (float)r->row[x];
    }
    return err;
}

fap_err depth_png_read(float **depth, uint32_t *columns, uint32_t *rows, const uint8_t *data, size_t size)
{
    reading r = { .data = data, .size = size };
    volatile fap_err err = FAP_E_DATA;

    *depth = NULL;
    if (size < 8 || png_sig_cmp((png_bytep)(uintptr_t)data, 0, 8))
        return FAP_E_UNKNOWN_FORMAT;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, fail, quiet);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info) {
        png_destroy_read_struct(&png, NULL, NULL);
        return FAP_E_NOMEM;
    }
    if (!setjmp(png_jmpbuf(png))) {
        png_set_read_fn(png, &r, take);
        err = read_rows(png, info, &r);
    } else
        err = FAP_E_DATA;
    png_destroy_read_struct(&png, &info, NULL);
    free(r.row);
    if (err != FAP_OK) {
        free(r.depth);
        return err;
    }
    *depth = r.depth;
    *columns = r.columns;
    *rows = r.rows;
    return FAP_OK;
}

/* libpng's simplified interface has no longjmp to step over; its light is ours here, as it is the picture's. */
fap_err colour_png_read(uint8_t **rgb, uint32_t *columns, uint32_t *rows, const uint8_t *data, size_t size)
{
    png_image head = { .version = PNG_IMAGE_VERSION };

    *rgb = NULL;
    if (size < 8 || png_sig_cmp((png_bytep)(uintptr_t)data, 0, 8))
        return FAP_E_UNKNOWN_FORMAT;
    if (!png_image_begin_read_from_memory(&head, data, size))
        return FAP_E_DATA;
    head.format = PNG_FORMAT_RGB;
    fap_err err = head.width > FAP_RANGE_MAX_SIDE || head.height > FAP_RANGE_MAX_SIDE ? FAP_E_LIMIT : FAP_OK;
    if (err == FAP_OK && !(*rgb = malloc(PNG_IMAGE_SIZE(head))))
        err = FAP_E_NOMEM;
    if (err == FAP_OK && !png_image_finish_read(&head, NULL, *rgb, 0, NULL))
        err = FAP_E_DATA;
    *columns = head.width;
    *rows = head.height;
    png_image_free(&head);
    if (err != FAP_OK) {
        free(*rgb);
        *rgb = NULL;
    }
    return err;
}
#else
fap_err colour_png_read(uint8_t **rgb, uint32_t *columns, uint32_t *rows, const uint8_t *data, size_t size)
{
    (void)columns, (void)rows, (void)data, (void)size;
    *rgb = NULL;
    return FAP_E_UNSUPPORTED;
}

fap_err depth_png_read(float **depth, uint32_t *columns, uint32_t *rows, const uint8_t *data, size_t size)
{
    (void)columns, (void)rows, (void)data, (void)size;
    *depth = NULL;
    return FAP_E_UNSUPPORTED;
}
#endif
