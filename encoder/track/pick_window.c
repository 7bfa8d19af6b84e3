/* SPDX-License-Identifier: BSD-2-Clause */
/* See pick_window.h: the picture, a lens, what is asked for. The window itself is common/canvas/window.h's. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/tables.h>

#include "common/canvas/window.h"
#include "common/tool.h"
#include "encoder/track/pick_window.h"

enum { HEAD = 58, LENS_PX = 25, LENS_ZOOM = 8, LENS = LENS_PX * LENS_ZOOM };

typedef struct picking {
    pick *p;
    const fap_picture *picture;
    canvas *sheet;  /* while it is drawn */
    uint8_t *shown; /* RGBA, the picture at the window's scale */
    double scale;
    int width, height; /* of the picture as shown */
    double mouse[2];   /* on the sheet */
} picking;

/* --- the picture --- */

static void copy_pixel(const fap_picture *p, double x, double y, uint8_t rgba[4])
{
    const int column = (int)fmin(fmax(lround(x), 0), p->width_px - 1),
              row = (int)fmin(fmax(lround(y), 0), p->height_px - 1);

    memcpy(rgba, p->rgb + (size_t)row * p->stride + 3 * (size_t)column, 3);
    rgba[3] = 255;
}

/* Pixels of the picture around a place, each as a square: what is clicked on can be seen. */
static void scale_picture(const fap_picture *p, double left, double top, double scale, int width, int height,
                          uint8_t *rgba)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            copy_pixel(p, left + (x + 0.5) / scale - 0.5, top + (y + 0.5) / scale - 0.5,
                       rgba + 4 * ((size_t)y * (size_t)width + (size_t)x));
}

static void to_picture(const picking *w, const double sheet[2], double at[2])
{
    at[0] = (sheet[0] + 0.5) / w->scale - 0.5;
    at[1] = (sheet[1] - HEAD + 0.5) / w->scale - 0.5;
}

static void to_sheet(const picking *w, const double at[2], double sheet[2])
{
    sheet[0] = (at[0] + 0.5) * w->scale - 0.5;
    sheet[1] = (at[1] + 0.5) * w->scale - 0.5 + HEAD;
}

/* --- drawing --- */

static void draw_head(const picking *w)
{
    const pick *p = w->p;
    const fap_track_dot *d = &p->dots.dot[p->label];
    const fap_point_info *info = fap_point_get(fap_point_by_name(d->name));
    char text[256];

    canvas_colour(w->sheet, 0x20242a, 1);
    canvas_box(w->sheet, 0, 0, w->width, HEAD);
    canvas_colour(w->sheet, 0xffffff, 1);
    if (p->finished)
        snprintf(text, sizeof text, "That is all. Return writes it; Backspace goes back.");
    else
        snprintf(text, sizeof text, "%s: click on %s%s%s   (%d of %d)", pick_view_name(p->view), d->name,
                 info ? ", " : "", info ? info->description : "", p->label + 1, p->dots.count);
    canvas_text(w->sheet, 12, 24, 16, CANVAS_LEFT, text);
    canvas_colour(w->sheet, 0xa8b0bc, 1);
    canvas_text(
        w->sheet, 12, 46, 12, CANVAS_LEFT,
        "Space: not seen here   Backspace: back   0, 1, 2: direct, mirrors   Return: done   Escape: give up");
}

static void draw_dot(const picking *w, const double at[2], uint32_t rgb, const char *name)
{
    double s[2];

    to_sheet(w, at, s);
    canvas_colour(w->sheet, rgb, 1);
    canvas_line(w->sheet, s[0] - 9, s[1], s[0] - 4, s[1], 1.5);
    canvas_line(w->sheet, s[0] + 4, s[1], s[0] + 9, s[1], 1.5);
    canvas_line(w->sheet, s[0], s[1] - 9, s[0], s[1] - 4, 1.5);
    canvas_line(w->sheet, s[0], s[1] + 4, s[0], s[1] + 9, 1.5);
    canvas_text(w->sheet, s[0] + 6, s[1] - 6, 11, CANVAS_LEFT, name);
}

static void draw_dots(const picking *w)
{
    static const uint32_t ink[FAP_TRACKS_VIEWS] = { 0x60ff60, 0xffd23c, 0x6cc8ff };

    for (int i = 0; i < w->p->dots.count; i++) {
        const fap_track_dot *d = &w->p->dots.dot[i];
        for (int view = 0; view < FAP_TRACKS_VIEWS; view++)
            if (d->has[view])
                draw_dot(w, d->at_px[view], ink[view], d->name);
    }
}

/* What is under the mouse, large, in the corner that the mouse is not in. */
static void draw_lens(const picking *w)
{
    static uint8_t rgba[4 * LENS * LENS];
    double at[2];

    to_picture(w, w->mouse, at);
    if (w->mouse[1] < HEAD || w->p->finished)
        return;
    scale_picture(w->picture, at[0] - (LENS_PX - 1) / 2.0, at[1] - (LENS_PX - 1) / 2.0, LENS_ZOOM, LENS, LENS,
                  rgba);
    const double x = w->mouse[0] < w->width / 2.0 ? w->width - LENS - 8 : 8, y = HEAD + 8;
    canvas_picture(w->sheet, x, y, rgba, LENS, LENS);
    canvas_colour(w->sheet, 0xffffff, 0.9);
    canvas_line(w->sheet, x + LENS / 2.0, y, x + LENS / 2.0, y + LENS, 1);
    canvas_line(w->sheet, x, y + LENS / 2.0, x + LENS, y + LENS / 2.0, 1);
}

static void draw(void *user, canvas *sheet, const double mouse[2])
{
    picking *w = user;

    w->sheet = sheet;
    memcpy(w->mouse, mouse, sizeof w->mouse);
    canvas_picture(sheet, 0, HEAD, w->shown, w->width, w->height);
    draw_dots(w);
    draw_lens(w);
    draw_head(w);
}

/* --- hands --- */

static void click(void *user, const double mouse[2])
{
    picking *w = user;
    double at[2];

    if (mouse[1] < HEAD)
        return;
    to_picture(w, mouse, at);
    pick_click(w->p, fmax(at[0], 0), fmax(at[1], 0));
}

static int press(void *user, int key)
{
    picking *w = user;

    switch (key) {
    case CANVAS_KEY_SPACE: pick_skip(w->p); return 0;
    case CANVAS_KEY_BACK: pick_back(w->p); return 0;
    case '0':
    case '1':
    case '2': pick_go_to_view(w->p, key - '0'); return 0;
    case CANVAS_KEY_ENTER: w->p->finished = 1; return 1;
    case CANVAS_KEY_ESCAPE: w->p->finished = 0; return 1;
    default: return 0;
    }
}

/* As large as a usual screen shows, small pictures twice as large. */
static void choose_size(picking *w)
{
    const double most_wide = 1280, most_high = 860;

    w->scale = fmin(2, fmin(most_wide / w->picture->width_px, most_high / w->picture->height_px));
    w->width = (int)fmax(1, floor(w->picture->width_px * w->scale));
    w->height = (int)fmax(1, floor(w->picture->height_px * w->scale));
}

int pick_window_run(pick *p, const fap_picture *picture, fault *f)
{
    picking w = { .p = p, .picture = picture };

    choose_size(&w);
    w.shown = malloc(4 * (size_t)w.width * (size_t)w.height);
    if (!w.shown)
        return fault_set(f, EXIT_DATA, "out of memory");
    scale_picture(picture, 0, 0, w.scale, w.width, w.height, w.shown);
    const canvas_window window = {
        "where the dots are - fapenc track", w.width, w.height + HEAD, draw, click, press, &w
    };
    const int opened = canvas_window_run(&window, "write where the dots are into a table for --init", f);
    free(w.shown);
    return opened && (p->finished ||
                      fault_set(f, EXIT_DATA, "the window was closed before Return: nothing was written"));
}
