/* SPDX-License-Identifier: BSD-2-Clause */
/* PNG files through libpng, whose errors come back by longjmp. */
#include <setjmp.h>
#include <stdlib.h>

#include "player/render/image.h"

#ifdef HAVE_PNG
#include <png.h>

/* libpng would print its words; ours come from who called. */
static void fail(png_structp png, png_const_charp text)
{
    (void)text;
    png_longjmp(png, 1);
}

static void quiet(png_structp png, png_const_charp text)
{
    (void)png, (void)text;
}

static void write_rows(png_structp png, png_infop info, const image *im)
{
    png_set_IHDR(png, info, (png_uint_32)im->width, (png_uint_32)im->height, 8,
                 im->transparent ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    if (!im->transparent)
        png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (int y = 0; y < im->height; y++)
        png_write_row(png, im->rgba + (size_t)y * (size_t)im->width * 4);
    png_write_end(png, info);
}

fap_err image_write_png(const image *im, FILE *out, int level)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, fail, quiet);
    png_infop info = png ? png_create_info_struct(png) : NULL;

    if (!info) {
        png_destroy_write_struct(&png, NULL);
        return FAP_E_NOMEM;
    }
    if (setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return FAP_E_IO;
    }
    png_init_io(png, out);
    png_set_compression_level(png, level);
    write_rows(png, info, im);
    png_destroy_write_struct(&png, &info);
    return FAP_OK;
}

/* Any PNG becomes 8-bit RGBA through libpng's simplified interface, which has no longjmp to step over. */
fap_err image_read_png(image *im, const char *path)
{
    png_image head = { .version = PNG_IMAGE_VERSION };

    *im = (image){ 0 };
    if (!png_image_begin_read_from_file(&head, path)) {
        FILE *f = fopen(path, "rb");
        if (!f)
            return FAP_E_NOT_FOUND;
        fclose(f);
        return FAP_E_DATA;
    }
    head.format = PNG_FORMAT_RGBA;
    if (head.width > INT32_MAX || head.height > INT32_MAX) {
        png_image_free(&head);
        return FAP_E_LIMIT;
    }
    const fap_err err = image_create(im, (int)head.width, (int)head.height);
    if (err != FAP_OK) {
        png_image_free(&head);
        return err;
    }
    if (png_image_finish_read(&head, NULL, im->rgba, 0, NULL))
        return FAP_OK;
    png_image_free(&head);
    image_free(im);
    return FAP_E_DATA;
}
#else
fap_err image_write_png(const image *im, FILE *out, int level)
{
    (void)im, (void)out, (void)level;
    return FAP_E_UNSUPPORTED;
}

fap_err image_read_png(image *im, const char *path)
{
    (void)path;
    *im = (image){ 0 };
    return FAP_E_UNSUPPORTED;
}
#endif
