/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Lines, letters and pictures on a sheet that becomes a PNG or an SVG. Lengths are pixels of the PNG, y grows downwards. Drawing
 * never fails: what went wrong is told by canvas_save().
 */
#ifndef COMMON_CANVAS_CANVAS_H
#define COMMON_CANVAS_CANVAS_H

#include <stdint.h>

#include <fap/error.h>
#include <fap/io.h>

typedef struct canvas canvas;

typedef enum canvas_format { CANVAS_PNG, CANVAS_SVG } canvas_format;
typedef enum canvas_align { CANVAS_LEFT, CANVAS_MIDDLE, CANVAS_RIGHT } canvas_align;

enum { CANVAS_MAX_SIDE = 30000 };

/* 0: built without the library that draws. */
int canvas_available(void);
/* White. @where: FAP_ERROR_TEXT_SIZE bytes. FAP_E_UNSUPPORTED: built without the library that draws. */
fap_err canvas_open(canvas **c, canvas_format format, int width, int height, char *where);
/* Accepts NULL in @c. */
void canvas_close(canvas **c);
/* What was drawn, as a file; once. */
fap_err canvas_save(canvas *c, const fap_writer *out);

/* A PNG's rows from the top, 4 bytes a pixel: blue, green, red, and one that says nothing; no gaps between rows. Valid until more is drawn. */
const uint8_t *canvas_pixels(canvas *c);

/* 0xRRGGBB for everything that follows; @alpha 1 covers. */
void canvas_colour(canvas *c, uint32_t rgb, double alpha);
void canvas_box(canvas *c, double x, double y, double width, double height);
void canvas_disc(canvas *c, double x, double y, double radius);
void canvas_line(canvas *c, double x0, double y0, double x1, double y1, double thickness);
/* A line through @count points; @dash 0: solid, otherwise the length of its dashes. */
void canvas_curve(canvas *c, const double (*xy)[2], int count, double thickness, double dash);
/* UTF-8, its base line at @y; @size is the height of a line. */
void canvas_text(canvas *c, double x, double y, double size, canvas_align align, const char *text);
double canvas_text_width(canvas *c, double size, const char *text);
/* RGBA rows from the top, the alpha not looked at; a pixel of it as one of the sheet. */
void canvas_picture(canvas *c, double x, double y, const uint8_t *rgba, int width, int height);

#endif
