/* SPDX-License-Identifier: BSD-2-Clause */
/* See pick_window.h. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/canvas/window.h"
#include "common/tool.h"
#include "databank/pick/pick_window.h"

enum { HEAD = 62, PANEL_WIDE = 420, PANEL_HIGH = 580, GUIDE_WIDE = 132, GUIDE_HIGH = 172 };

static const double upright[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
static const double zoom_step = 1.5, most_zoom = 12;
static const uint32_t ink_placed = 0x1060ff, ink_followed = 0xe08020, ink_asked = 0xff2020;

typedef struct picking {
    pick *p;
    const pick_scene *scan, *guide;
    canvas *sheet; /* while it is drawn */
    pick_view side[PICK_SIDES], guide_view;
    double mouse[2], zoom; /* zoom 1: all of the scan */
    float focus[3];
} picking;

static double panel_left(int side)
{
    return side * PANEL_WIDE;
}

/* --- drawing --- */

static void draw_head(const picking *w)
{
    const pick *p = w->p;
    char text[256];

    canvas_colour(w->sheet, 0x20242a, 1);
    canvas_box(w->sheet, 0, 0, PICK_SIDES * PANEL_WIDE, HEAD);
    canvas_colour(w->sheet, 0xffffff, 1);
    if (p->asked >= FAP_LABELS_MAJOR)
        snprintf(text, sizeof text, "That is all: %u places. Return writes them; Backspace goes back.",
                 (unsigned)pick_placed(p));
    else
        snprintf(text, sizeof text, "click on %s, %s   (%u of %d)", pick_name(p, p->asked),
                 pick_description(p, p->asked), (unsigned)p->asked + 1, FAP_LABELS_MAJOR);
    canvas_text(w->sheet, 12, 25, 17, CANVAS_LEFT, text);
    canvas_colour(w->sheet, 0xa8b0bc, 1);
    canvas_text(w->sheet, 12, 48, 12, CANVAS_LEFT,
                "Space: not to be seen   Backspace: back   arrows, R: turn the scan until the middle picture "
                "is its face   "
                "+ -: nearer to the mouse, and back   Return: done   Escape: give up");
}

static void draw_cross(const picking *w, const double at[2], double arm)
{
    canvas_line(w->sheet, at[0] - arm, at[1], at[0] + arm, at[1], 1.5);
    canvas_line(w->sheet, at[0], at[1] - arm, at[0], at[1] + arm, 1.5);
}

/* In a profile, only what is on this side of the head. */
static int is_seen(const picking *w, int side, const float at[3])
{
    const pick_view *v = &w->side[side];
    double depth = 0;

    for (int a = 0; a < 3; a++)
        depth += v->toward[a] * ((double)at[a] - v->middle[a]);
    return side == PICK_FRONT || depth > -0.1 * v->depth;
}

static void draw_labels(const picking *w, int side)
{
    const pick *p = w->p;

    for (uint32_t i = 0; i < p->labels.count; i++) {
        double at[2];
        if (p->place[i].state == FAP_LABEL_UNKNOWN || !is_seen(w, side, p->place[i].at))
            continue;
        pick_view_project(&w->side[side], p->place[i].at, at);
        at[0] += panel_left(side);
        at[1] += HEAD;
        if (p->place[i].state != FAP_LABEL_PLACED) {
            canvas_colour(w->sheet, ink_followed, p->place[i].state == FAP_LABEL_MET ? 0.9 : 0.35);
            canvas_disc(w->sheet, at[0], at[1], 2);
            continue;
        }
        canvas_colour(w->sheet, ink_placed, 1);
        draw_cross(w, at, 6);
        canvas_text(w->sheet, at[0] + 5, at[1] - 5, 10, CANVAS_LEFT, pick_name(p, i));
    }
}

/* The generic face with the place that is asked for, in the corner of the front view. */
static void draw_guide(const picking *w)
{
    const pick *p = w->p;
    const double left = panel_left(PICK_FRONT) + 6, top = HEAD + PANEL_HIGH - GUIDE_HIGH - 6;
    double at[2];

    canvas_picture(w->sheet, left, top, w->guide_view.rgba, GUIDE_WIDE, GUIDE_HIGH);
    if (p->asked >= FAP_LABELS_MAJOR)
        return;
    pick_view_project(&w->guide_view, w->guide->position[p->labels.vertex[p->asked]], at);
    at[0] += left;
    at[1] += top;
    canvas_colour(w->sheet, ink_asked, 1);
    canvas_disc(w->sheet, at[0], at[1], 3.5);
    draw_cross(w, at, 10);
}

static void draw(void *user, canvas *sheet, const double mouse[2])
{
    static const char *const names[PICK_SIDES] = { "from its right", "from the front", "from its left" };
    picking *w = user;

    memcpy(w->mouse, mouse, sizeof w->mouse);
    w->sheet = sheet;
    for (int side = 0; side < PICK_SIDES; side++) {
        canvas_picture(sheet, panel_left(side), HEAD, w->side[side].rgba, PANEL_WIDE, PANEL_HIGH);
        draw_labels(w, side);
        canvas_colour(sheet, 0xc8ced6, 1);
        canvas_text(sheet, panel_left(side) + PANEL_WIDE / 2.0, HEAD + 18, 12, CANVAS_MIDDLE, names[side]);
    }
    draw_guide(w);
    draw_head(w);
}

static void look(picking *w)
{
    for (int side = 0; side < PICK_SIDES; side++)
        pick_view_draw(&w->side[side], w->scan, (const double(*)[3])w->p->turn, (pick_side)side,
                       w->zoom > 1 ? w->focus : NULL, w->zoom);
}

/* --- hands --- */

static int find_place(const picking *w, const double at[2], float place[3])
{
    const int side = (int)floor(at[0] / PANEL_WIDE);

    return at[1] >= HEAD && side >= 0 && side < PICK_SIDES &&
           pick_view_cast(&w->side[side], w->scan, at[0] - panel_left(side) + 0.5, at[1] - HEAD + 0.5, place);
}

static void click(void *user, const double at[2])
{
    picking *w = user;
    float place[3];

    if (find_place(w, at, place))
        pick_place(w->p, place);
}

/* What is under the mouse comes to the middle. */
static void go_near(picking *w, double times)
{
    float place[3];

    if (times > 1 && find_place(w, w->mouse, place))
        memcpy(w->focus, place, sizeof place);
    else if (times > 1 && w->zoom <= 1)
        return;
    w->zoom = fmin(most_zoom, fmax(1, w->zoom * times));
    look(w);
}

static void turn(picking *w, int axis, int quarters)
{
    pick_turn(w->p, axis, quarters);
    look(w);
}

static int press(void *user, int key)
{
    picking *w = user;

    switch (key) {
    case CANVAS_KEY_SPACE: pick_skip(w->p); return 0;
    case CANVAS_KEY_BACK: pick_back(w->p); return 0;
    case CANVAS_KEY_LEFT: turn(w, 1, 1); return 0;
    case CANVAS_KEY_RIGHT: turn(w, 1, -1); return 0;
    case CANVAS_KEY_UP: turn(w, 0, 1); return 0;
    case CANVAS_KEY_DOWN: turn(w, 0, -1); return 0;
    case '=': go_near(w, zoom_step); return 0; /* the key that + is on */
    case '-': go_near(w, 1 / zoom_step); return 0;
    case 'R': turn(w, 2, 1); return 0;
    case CANVAS_KEY_ENTER: w->p->finished = 1; return 1;
    default: return 0;
    }
}

/* --- the whole --- */

static int open(picking *w)
{
    for (int side = 0; side < PICK_SIDES; side++)
        if (!pick_view_open(&w->side[side], PANEL_WIDE, PANEL_HIGH))
            return 0;
    if (!pick_view_open(&w->guide_view, GUIDE_WIDE, GUIDE_HIGH))
        return 0;
    pick_view_draw(&w->guide_view, w->guide, upright, PICK_FRONT, NULL, 1);
    look(w);
    return 1;
}

static void close(picking *w)
{
    for (int side = 0; side < PICK_SIDES; side++)
        pick_view_close(&w->side[side]);
    pick_view_close(&w->guide_view);
}

int pick_window_run(pick *p, const pick_scene *scan, const pick_scene *guide, fault *f)
{
    picking w = { .p = p, .scan = scan, .guide = guide, .zoom = 1 };
    const canvas_window window = {
        "where the face is - fapbank pick", PICK_SIDES * PANEL_WIDE, HEAD + PANEL_HIGH, draw, click, press, &w
    };

    const int ok = open(&w)
                       ? canvas_window_run(&window, "write the landmarks into a table for fit --landmarks", f)
                       : fault_set(f, EXIT_DATA, "out of memory");
    close(&w);
    return ok && (p->finished ||
                  fault_set(f, EXIT_DATA, "the window was closed before Return: nothing was written"));
}
