/* SPDX-License-Identifier: BSD-2-Clause */
/* The canvas by cairo. */
#ifdef HAVE_CAIRO
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cairo-svg.h>
#include <cairo.h>

#include "common/canvas/canvas.h"

struct canvas {
    cairo_surface_t *surface;
    cairo_t *pen;
    canvas_format format;
    uint8_t *svg; /* what cairo has written so far */
    size_t used, room;
};

static cairo_status_t keep(void *user, const unsigned char *data, unsigned size)
{
    canvas *c = user;

    if (c->used + size > c->room) {
        const size_t room = 2 * (c->used + size);
        uint8_t *grown = realloc(c->svg, room);
        if (!grown)
            return CAIRO_STATUS_NO_MEMORY;
        c->svg = grown;
        c->room = room;
    }
    memcpy(c->svg + c->used, data, size);
    c->used += size;
    return CAIRO_STATUS_SUCCESS;
}

static cairo_surface_t *make_surface(canvas *c, int width, int height)
{
    if (c->format == CANVAS_SVG)
        return cairo_svg_surface_create_for_stream(keep, c, width, height);
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
}

int canvas_available(void)
{
    return 1;
}

fap_err canvas_open(canvas **out, canvas_format format, int width, int height, char *where)
{
    *out = NULL;
    *where = '\0';
    if (width < 1 || height < 1 || width > CANVAS_MAX_SIDE || height > CANVAS_MAX_SIDE)
        return FAP_E_LIMIT;
    canvas *c = calloc(1, sizeof *c);
    if (!c)
        return FAP_E_NOMEM;
    c->format = format;
    c->surface = make_surface(c, width, height);
    c->pen = cairo_create(c->surface);
    if (cairo_status(c->pen) != CAIRO_STATUS_SUCCESS) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", cairo_status_to_string(cairo_status(c->pen)));
        canvas_close(&c);
        return FAP_E_NOMEM;
    }
    cairo_select_font_face(c->pen, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_line_join(c->pen, CAIRO_LINE_JOIN_ROUND);
    canvas_colour(c, 0xffffff, 1);
    cairo_paint(c->pen);
    *out = c;
    return FAP_OK;
}

void canvas_close(canvas **c)
{
    if (!*c)
        return;
    cairo_destroy((*c)->pen);
    cairo_surface_destroy((*c)->surface);
    free((*c)->svg);
    free(*c);
    *c = NULL;
}

static cairo_status_t pass_on(void *user, const unsigned char *data, unsigned size)
{
    const fap_writer *out = user;
    return out->write(out->user, data, size) ? CAIRO_STATUS_WRITE_ERROR : CAIRO_STATUS_SUCCESS;
}

static fap_err error_of(cairo_status_t status)
{
    switch (status) {
    case CAIRO_STATUS_SUCCESS: return FAP_OK;
    case CAIRO_STATUS_NO_MEMORY: return FAP_E_NOMEM;
    default: return FAP_E_IO;
    }
}

fap_err canvas_save(canvas *c, const fap_writer *out)
{
    fap_writer sink = *out;

    if (cairo_status(c->pen) != CAIRO_STATUS_SUCCESS)
        return error_of(cairo_status(c->pen));
    if (c->format == CANVAS_PNG)
        return error_of(cairo_surface_write_to_png_stream(c->surface, pass_on, &sink));
    cairo_surface_finish(c->surface);
    if (cairo_surface_status(c->surface) != CAIRO_STATUS_SUCCESS)
        return error_of(cairo_surface_status(c->surface));
    return sink.write(sink.user, c->svg, c->used) ? FAP_E_IO : FAP_OK;
}

/* Four bytes a pixel need no filling, so rows touch. */
const uint8_t *canvas_pixels(canvas *c)
{
    cairo_surface_flush(c->surface);
    return cairo_image_surface_get_data(c->surface);
}

/* --- drawing --- */

void canvas_colour(canvas *c, uint32_t rgb, double alpha)
{
    cairo_set_source_rgba(c->pen, (rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0,
                          alpha);
}

void canvas_box(canvas *c, double x, double y, double width, double height)
{
    cairo_rectangle(c->pen, x, y, width, height);
    cairo_fill(c->pen);
}

void canvas_disc(canvas *c, double x, double y, double radius)
{
    const double full_circle = 6.283185307179586;

    cairo_new_path(c->pen);
    cairo_arc(c->pen, x, y, radius, 0, full_circle);
    cairo_fill(c->pen);
}

void canvas_line(canvas *c, double x0, double y0, double x1, double y1, double thickness)
{
    const double xy[2][2] = { { x0, y0 }, { x1, y1 } };
    canvas_curve(c, xy, 2, thickness, 0);
}

void canvas_curve(canvas *c, const double (*xy)[2], int count, double thickness, double dash)
{
    if (count < 1)
        return;
    cairo_set_line_width(c->pen, thickness);
    cairo_set_dash(c->pen, &dash, dash > 0, 0);
    cairo_new_path(c->pen);
    for (int i = 0; i < count; i++)
        cairo_line_to(c->pen, xy[i][0], xy[i][1]);
    cairo_stroke(c->pen);
}

double canvas_text_width(canvas *c, double size, const char *text)
{
    cairo_text_extents_t e;

    cairo_set_font_size(c->pen, size);
    cairo_text_extents(c->pen, text, &e);
    return e.x_advance;
}

void canvas_text(canvas *c, double x, double y, double size, canvas_align align, const char *text)
{
    const double left = canvas_text_width(c, size, text) * align / 2;

    cairo_move_to(c->pen, x - left, y);
    cairo_show_text(c->pen, text);
}

/* cairo's pixels are words of four bytes. */
static void fill_pixels(cairo_surface_t *s, const uint8_t *rgba, int width, int height)
{
    uint8_t *const row = cairo_image_surface_get_data(s);
    const int stride = cairo_image_surface_get_stride(s);

    cairo_surface_flush(s);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, rgba += 4) {
            const uint32_t word = (uint32_t)rgba[0] << 16 | (uint32_t)rgba[1] << 8 | rgba[2];
            memcpy(row + (size_t)y * stride + 4 * (size_t)x, &word, sizeof word);
        }
    cairo_surface_mark_dirty(s);
}

void canvas_picture(canvas *c, double x, double y, const uint8_t *rgba, int width, int height)
{
    cairo_surface_t *s = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);

    if (cairo_surface_status(s) == CAIRO_STATUS_SUCCESS) {
        fill_pixels(s, rgba, width, height);
        cairo_set_source_surface(c->pen, s, x, y);
        cairo_paint(c->pen);
    }
    cairo_surface_destroy(s);
}
#endif
