/* SPDX-License-Identifier: BSD-2-Clause */
/* The canvas of a build without cairo: it says so. */
#ifndef HAVE_CAIRO
#include <stdio.h>

#include "common/canvas/canvas.h"

int canvas_available(void)
{
    return 0;
}

fap_err canvas_open(canvas **c, canvas_format format, int width, int height, char *where)
{
    (void)format, (void)width, (void)height;
    *c = NULL;
    snprintf(where, FAP_ERROR_TEXT_SIZE, "built without cairo: install libcairo2-dev and build again");
    return FAP_E_UNSUPPORTED;
}

void canvas_close(canvas **c)
{
    (void)c;
}

fap_err canvas_save(canvas *c, const fap_writer *out)
{
    (void)c, (void)out;
    return FAP_E_UNSUPPORTED;
}

const uint8_t *canvas_pixels(canvas *c)
{
    (void)c;
    return NULL;
}

void canvas_colour(canvas *c, uint32_t rgb, double alpha)
{
    (void)c, (void)rgb, (void)alpha;
}

void canvas_box(canvas *c, double x, double y, double width, double height)
{
    (void)c, (void)x, (void)y, (void)width, (void)height;
}

void canvas_disc(canvas *c, double x, double y, double radius)
{
    (void)c, (void)x, (void)y, (void)radius;
}

void canvas_line(canvas *c, double x0, double y0, double x1, double y1, double thickness)
{
    (void)c, (void)x0, (void)y0, (void)x1, (void)y1, (void)thickness;
}

void canvas_curve(canvas *c, const double (*xy)[2], int count, double thickness, double dash)
{
    (void)c, (void)xy, (void)count, (void)thickness, (void)dash;
}

void canvas_text(canvas *c, double x, double y, double size, canvas_align align, const char *text)
{
    (void)c, (void)x, (void)y, (void)size, (void)align, (void)text;
}

double canvas_text_width(canvas *c, double size, const char *text)
{
    (void)c, (void)size, (void)text;
    return 0;
}

void canvas_picture(canvas *c, double x, double y, const uint8_t *rgba, int width, int height)
{
    (void)c, (void)x, (void)y, (void)rgba, (void)width, (void)height;
}
#endif
