/* SPDX-License-Identifier: BSD-2-Clause */
/* See mask.h. libjpeg reports errors by a callback that must not return, hence the longjmp. */
#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

#include "databank/mask.h"

#ifdef HAVE_JPEG
#include <jpeglib.h>

enum { MAX_SIDE = 8192 };

typedef struct failure {
    struct jpeg_error_mgr base;
    jmp_buf out;
} failure;

static void give_up(j_common_ptr info)
{
    longjmp(((failure *)info->err)->out, 1);
}

static void be_silent(j_common_ptr info)
{
    (void)info;
}

static fap_err read_rows(struct jpeg_decompress_struct *j, mask *m)
{
    jpeg_read_header(j, TRUE);
    if (j->image_width > MAX_SIDE || j->image_height > MAX_SIDE)
        return FAP_E_LIMIT;
    j->out_color_space = JCS_GRAYSCALE;
    jpeg_start_decompress(j);
    m->width = j->output_width;
    m->height = j->output_height;
    m->grey = malloc((size_t)m->width * m->height);
    if (!m->grey)
        return FAP_E_NOMEM;
    while (j->output_scanline < j->output_height) {
        JSAMPROW row = m->grey + (size_t)j->output_scanline * m->width;
        jpeg_read_scanlines(j, &row, 1);
    }
    return FAP_OK;
}

fap_err mask_decode(mask *m, const uint8_t *data, size_t size)
{
    struct jpeg_decompress_struct j;
    failure errors;

    *m = (mask){ 0 };
    j.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = give_up;
    errors.base.output_message = be_silent;
    volatile fap_err err = FAP_E_DATA; /* longjmp must not lose it */
    jpeg_create_decompress(&j);
    if (!setjmp(errors.out)) {
        jpeg_mem_src(&j, data, (unsigned long)size);
        err = read_rows(&j, m);
    }
    jpeg_destroy_decompress(&j);
    if (err)
        mask_free(m);
    return err;
}

#else

fap_err mask_decode(mask *m, const uint8_t *data, size_t size)
{
    (void)data, (void)size;
    *m = (mask){ 0 };
    return FAP_E_UNSUPPORTED;
}
#endif

void mask_free(mask *m)
{
    free(m->grey);
    *m = (mask){ 0 };
}

static float texel(const mask *m, long x, long y)
{
    const long w = (long)m->width, h = (long)m->height;
    x = x < 0 ? 0 : x >= w ? w - 1 : x;
    y = y < 0 ? 0 : y >= h ? h - 1 : y;
    return m->grey[y * w + x] / 255.0f;
}

float mask_sample(const mask *m, float u, float v)
{
    if (!m->grey || !(fabsf(u) <= 1) || !(fabsf(v) <= 1))
        return 0;
    const float x = u * (float)m->width - 0.5f, y = (1 - v) * (float)m->height - 0.5f;
    const long x0 = (long)floorf(x), y0 = (long)floorf(y);
    const float fx = x - (float)x0, fy = y - (float)y0;
    const float top = texel(m, x0, y0) * (1 - fx) + texel(m, x0 + 1, y0) * fx;
    const float low = texel(m, x0, y0 + 1) * (1 - fx) + texel(m, x0 + 1, y0 + 1) * fx;
    return top * (1 - fy) + low * fy;
}
