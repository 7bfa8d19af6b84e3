/* SPDX-License-Identifier: BSD-2-Clause */
/* See curves.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <fap/tables.h>

#include "encoder/plot/curves.h"

enum {
    PANEL_PX = 132, /* with the room to the next one */
    CURVE_PX = 104,
    LEFT_PX = 74,
    LEGEND_PX = 250,
    AXIS_PX = 40,
    KEY_PX = 30,
    PANEL_MAX_FAPS = 10,
};

static const uint32_t ink = 0x222222, faint = 0xdddddd, gap_grey = 0xe8e8ec, fill_orange = 0xf2a63a;
/* Left and right of a pair lie next to each other: a dark tone and its light one. */
static const uint32_t palette[PANEL_MAX_FAPS] = { 0x1f4e9c, 0x6fa3ef, 0xa02020, 0xf07f70, 0x1b6b3a,
                                                  0x63bd7f, 0x6a2c91, 0xbf87dc, 0x7a5a10, 0xd1ab45 };

typedef struct panel {
    const char *name;
    int turns; /* its FAPs are angles */
    int fap[PANEL_MAX_FAPS + 1];
} panel;

static const panel panels[] = {
    { "jaw", 0, { 3, 14, 15, 18 } },
    { "outer lips", 0, { 51, 52, 53, 54, 55, 56, 57, 58, 59, 60 } },
    { "inner lips", 0, { 4, 5, 6, 7, 8, 9, 10, 11, 12, 13 } },
    { "lips forward", 0, { 16, 17 } },
    { "eyelids", 0, { 19, 20, 21, 22 } },
    { "eyeballs", 1, { 23, 24, 25, 26 } },
    { "eyes in depth, pupils", 0, { 27, 28, 29, 30 } },
    { "brows", 0, { 31, 32, 33, 34, 35, 36, 37, 38 } },
    { "cheeks", 0, { 39, 40, 41, 42 } },
    { "tongue", 0, { 43, 44, 45, 46, 47 } },
    { "head", 1, { 48, 49, 50 } },
    { "nose", 0, { 61, 62, 63, 64 } },
    { "ears", 0, { 65, 66, 67, 68 } },
};

enum { PANEL_COUNT = sizeof panels / sizeof *panels };

/* Where a panel's curves are, and how much they span. */
typedef struct frame_box {
    double x, y, width, height;
    double low, high, length_s;
} frame_box;

static double scale_of(const panel *p)
{
    const double degrees = 1e-5 * 180 / 3.14159265358979323846;
    return p->turns ? degrees : 1;
}

static int is_sent(const fap_frame *f, int fap)
{
    return f->state[fap] != FAP_ABSENT && f->state[fap] != FAP_HELD;
}

static int is_used(const plot_content *p, int fap)
{
    for (size_t i = 0; i < p->frame_count; i++)
        if (is_sent(&p->frame[i], fap))
            return 1;
    return 0;
}

static int panel_used(const plot_content *p, const panel *pa)
{
    for (int i = 0; i < PANEL_MAX_FAPS && pa->fap[i]; i++)
        if (is_used(p, pa->fap[i]))
            return 1;
    return 0;
}

int curves_height(const plot_content *p)
{
    int used = 0;

    for (int i = 0; i < PANEL_COUNT; i++)
        used += panel_used(p, &panels[i]);
    used += is_used(p, 1) + is_used(p, 2);
    return KEY_PX + used * PANEL_PX + AXIS_PX;
}

/* --- time and value to places --- */

static double x_at(const frame_box *b, double time_s)
{
    return b->x + b->width * time_s / b->length_s;
}

static double y_at(const frame_box *b, double value)
{
    return b->y + b->height * (b->high - value) / (b->high - b->low);
}

static double time_of(const plot_content *p, size_t frame)
{
    return (double)(p->frame[frame].pts_us - p->frame[0].pts_us) * 1e-6;
}

/* 1, 2 or 5 times a power of ten, so that about @p wanted of them fill @p span. */
static double round_step(double span, int wanted)
{
    const double rough = span / wanted, ten = pow(10, floor(log10(rough)));
    const double times = rough / ten;

    return ten * (times < 1.5 ? 1 : times < 3.5 ? 2 : times < 7.5 ? 5 : 10);
}

/* --- what lies behind the curves --- */

typedef int (*frame_test)(const plot_content *p, const panel *pa, size_t frame);

/* None of the panel's FAPs is sent. */
static int is_gap(const plot_content *p, const panel *pa, size_t frame)
{
    for (int i = 0; i < PANEL_MAX_FAPS && pa->fap[i]; i++)
        if (is_sent(&p->frame[frame], pa->fap[i]))
            return 0;
    return 1;
}

static int is_filled(const plot_content *p, const panel *pa, size_t frame)
{
    for (int i = 0; p->filled && i < PANEL_MAX_FAPS && pa->fap[i]; i++)
        if (is_sent(&p->frame[frame], pa->fap[i]) && p->filled(p->user, frame, pa->fap[i]))
            return 1;
    return 0;
}

/* Boxes over the stretches of frames that pass. */
static void shade(canvas *c, const plot_content *p, const panel *pa, const frame_box *b, frame_test test,
                  double top, double height)
{
    const double frame_s = 1 / p->rate_hz;

    for (size_t i = 0; i < p->frame_count; i++) {
        if (!test(p, pa, i))
            continue;
        const size_t first = i;
        while (i + 1 < p->frame_count && test(p, pa, i + 1))
            i++;
        const double from = x_at(b, time_of(p, first)), to = x_at(b, time_of(p, i) + frame_s);
        canvas_box(c, from, top, fmax(fmin(to, b->x + b->width) - from, 1), height);
    }
}

static void draw_grid(canvas *c, const frame_box *b)
{
    const double step = round_step(b->high - b->low, 4);
    char text[32];

    for (double v = ceil(b->low / step) * step; v <= b->high + step * 1e-9; v += step) {
        const double y = y_at(b, v);
        canvas_colour(c, fabs(v) < step / 2 ? 0xaaaaaa : faint, 1);
        canvas_line(c, b->x, y, b->x + b->width, y, 1);
        snprintf(text, sizeof text, "%g", fabs(v) < step / 2 ? 0 : v);
        canvas_colour(c, ink, 1);
        canvas_text(c, b->x - 6, y + 4, 11, CANVAS_RIGHT, text);
    }
}

/* --- a curve --- */

/* The points of one unbroken stretch, at most a few for a column of pixels: long takes stay light. */
typedef struct stroke {
    double (*xy)[2];
    int count;
    double thickness, dash;
} stroke;

static void stroke_end(canvas *c, stroke *s)
{
    if (s->count == 1)
        canvas_disc(c, s->xy[0][0], s->xy[0][1], s->thickness);
    canvas_curve(c, s->xy, s->count, s->thickness, s->dash);
    s->count = 0;
}

/* In one column of pixels the first, the lowest, the highest and the last say all. */
static void stroke_add(stroke *s, double x, double y)
{
    enum { A_COLUMN = 4 };
    const double column = floor(x);
    int there = 0;

    while (there < A_COLUMN && there < s->count && floor(s->xy[s->count - 1 - there][0]) == column)
        there++;
    if (there < A_COLUMN) {
        s->xy[s->count][0] = x;
        s->xy[s->count++][1] = y;
        return;
    }
    double(*const of)[2] = &s->xy[s->count - A_COLUMN];
    if (y < of[1][1])
        of[1][1] = y;
    if (y > of[2][1])
        of[2][1] = y;
    of[3][1] = y;
}

static void draw_curve(canvas *c, const plot_content *p, const panel *pa, const frame_box *b, int fap,
                       double (*room)[2])
{
    stroke s = { .xy = room, .thickness = 1.3 };

    for (size_t i = 0; i < p->frame_count; i++) {
        const fap_frame *f = &p->frame[i];
        const double dash = p->filled && p->filled(p->user, i, fap) ? 3 : 0;
        if (!is_sent(f, fap) || dash != s.dash) {
            /* The point where line and dashes meet belongs to both. */
            if (is_sent(f, fap))
                stroke_add(&s, x_at(b, time_of(p, i)), y_at(b, f->value[fap] * scale_of(pa)));
            stroke_end(c, &s);
            s.dash = dash;
        }
        if (is_sent(f, fap))
            stroke_add(&s, x_at(b, time_of(p, i)), y_at(b, f->value[fap] * scale_of(pa)));
    }
    stroke_end(c, &s);
}

/* --- a panel --- */

static void span_of(const plot_content *p, const panel *pa, frame_box *b)
{
    double low = 0, high = 0;

    for (int k = 0; k < PANEL_MAX_FAPS && pa->fap[k]; k++)
        for (size_t i = 0; i < p->frame_count; i++) {
            if (!is_sent(&p->frame[i], pa->fap[k]))
                continue;
            low = fmin(low, p->frame[i].value[pa->fap[k]] * scale_of(pa));
            high = fmax(high, p->frame[i].value[pa->fap[k]] * scale_of(pa));
        }
    const double least = pa->turns ? 1 : 20, more = fmax(least - (high - low), 0) / 2;
    const double margin = 0.06 * (high - low + 2 * more);
    b->low = low - more - margin;
    b->high = high + more + margin;
}

static void draw_legend(canvas *c, const plot_content *p, const panel *pa, const frame_box *b)
{
    double y = b->y + 8;
    char text[96];

    for (int k = 0; k < PANEL_MAX_FAPS && pa->fap[k]; k++) {
        const int fap = pa->fap[k];
        if (!is_used(p, fap))
            continue;
        canvas_colour(c, palette[k], 1);
        canvas_line(c, b->x + b->width + 12, y - 3, b->x + b->width + 32, y - 3, 2);
        snprintf(text, sizeof text, "%d %s", fap, fap_info_get(fap)->name);
        canvas_colour(c, ink, 1);
        canvas_text(c, b->x + b->width + 38, y, 10, CANVAS_LEFT, text);
        y += 11;
    }
}

static void draw_name(canvas *c, const frame_box *b, const char *name, const char *unit)
{
    char text[96];

    snprintf(text, sizeof text, *unit ? "%s, %s" : "%s%s", name, unit);
    canvas_colour(c, ink, 1);
    canvas_text(c, b->x, b->y - 6, 12, CANVAS_LEFT, text);
}

static void draw_panel(canvas *c, const plot_content *p, const panel *pa, frame_box b, double (*room)[2])
{
    span_of(p, pa, &b);
    canvas_colour(c, gap_grey, 1);
    shade(c, p, pa, &b, is_gap, b.y, b.height);
    canvas_colour(c, fill_orange, 0.25);
    shade(c, p, pa, &b, is_filled, b.y, b.height);
    canvas_colour(c, fill_orange, 1);
    shade(c, p, pa, &b, is_filled, b.y + b.height - 3, 3);
    draw_grid(c, &b);
    draw_name(c, &b, pa->name, pa->turns ? "degrees" : "FAP units");
    for (int k = 0; k < PANEL_MAX_FAPS && pa->fap[k]; k++) {
        canvas_colour(c, palette[k], 1);
        draw_curve(c, p, pa, &b, pa->fap[k], room);
    }
    draw_legend(c, p, pa, &b);
}

/* --- visemes and expressions --- */

/* What a frame shows of FAP 1 or 2: up to two names and how much of each. */
typedef struct shown {
    int select[2];
    double amount[2];
} shown;

static shown shown_in(const fap_frame *f, int fap)
{
    const fap_viseme *v = &f->viseme;
    const fap_expression *e = &f->expression;

    if (!is_sent(f, fap))
        return (shown){ { 0, 0 }, { 0, 0 } };
    if (fap == 1)
        return (shown){ { v->select1, v->select2 }, { v->blend / 63.0, 1 - v->blend / 63.0 } };
    return (shown){ { e->select1, e->select2 }, { e->intensity1 / 63.0, e->intensity2 / 63.0 } };
}

static double amount_of(const fap_frame *f, int fap, int select)
{
    const shown s = shown_in(f, fap);
    return (s.select[0] == select) * s.amount[0] + (s.select[1] == select) * s.amount[1];
}

static double most_of(const plot_content *p, int fap, int select)
{
    double most = 0;

    for (size_t i = 0; i < p->frame_count; i++)
        most = fmax(most, amount_of(&p->frame[i], fap, select));
    return most;
}

static const char *select_name(int fap, int select)
{
    return fap == 1 ? fap_viseme_name(select) : fap_expression_name(select);
}

static void draw_amounts(canvas *c, const plot_content *p, const frame_box *b, int fap, int select,
                         double (*room)[2])
{
    stroke s = { .xy = room, .thickness = 1.3 };

    for (size_t i = 0; i < p->frame_count; i++)
        stroke_add(&s, x_at(b, time_of(p, i)), y_at(b, amount_of(&p->frame[i], fap, select)));
    stroke_end(c, &s);
}

static void draw_selects(canvas *c, const plot_content *p, int fap, frame_box b, double (*room)[2])
{
    const int count = fap == 1 ? FAP_VISEME_COUNT : FAP_EXPRESSION_COUNT;
    double y = b.y + 8;
    int drawn = 0;

    b.low = -0.05;
    b.high = 1.05;
    draw_grid(c, &b);
    draw_name(c, &b, fap == 1 ? "visemes (FAP 1)" : "expressions (FAP 2)", "");
    for (int select = 1; select <= count; select++) {
        if (most_of(p, fap, select) <= 0)
            continue;
        canvas_colour(c, palette[drawn++ % PANEL_MAX_FAPS], 1);
        draw_amounts(c, p, &b, fap, select, room);
        /* Two columns of names: there may be fourteen. */
        const double x = b.x + b.width + (drawn % 2 ? 12 : 130);
        canvas_line(c, x, y - 3, x + 20, y - 3, 2);
        canvas_colour(c, ink, 1);
        canvas_text(c, x + 26, y, 10, CANVAS_LEFT, select_name(fap, select));
        y += drawn % 2 ? 0 : 12;
    }
}

/* --- all of them --- */

static void draw_time(canvas *c, const frame_box *b)
{
    const double step = round_step(b->length_s, 12);
    char text[32];

    for (double t = 0; t <= b->length_s * (1 + 1e-9); t += step) {
        canvas_colour(c, 0x888888, 1);
        canvas_line(c, x_at(b, t), b->y, x_at(b, t), b->y + 5, 1);
        snprintf(text, sizeof text, "%g", t);
        canvas_colour(c, ink, 1);
        canvas_text(c, x_at(b, t), b->y + 18, 11, CANVAS_MIDDLE, text);
    }
    canvas_text(c, b->x + b->width + 12, b->y + 18, 11, CANVAS_LEFT, "seconds");
}

static void draw_key(canvas *c, const plot_content *p, double y)
{
    canvas_colour(c, gap_grey, 1);
    canvas_box(c, LEFT_PX, y, 26, 12);
    canvas_colour(c, ink, 1);
    canvas_text(c, LEFT_PX + 32, y + 10, 11, CANVAS_LEFT, "not sent");
    if (!p->filled)
        return;
    canvas_colour(c, fill_orange, 0.25);
    canvas_box(c, LEFT_PX + 120, y, 26, 12);
    canvas_colour(c, fill_orange, 1);
    canvas_box(c, LEFT_PX + 120, y + 9, 26, 3);
    canvas_colour(c, ink, 1);
    canvas_text(c, LEFT_PX + 152, y + 10, 11, CANVAS_LEFT, "from a filled gap (dashed)");
}

fap_err curves_draw(canvas *c, const plot_content *p, double y, int width)
{
    const double frame_s = 1 / p->rate_hz;
    frame_box b = { LEFT_PX, y + KEY_PX + 14, width - LEFT_PX - LEGEND_PX, CURVE_PX, 0, 1, frame_s };
    double(*const room)[2] = calloc(p->frame_count + 1, sizeof *room);

    if (!room)
        return FAP_E_NOMEM;
    b.length_s = time_of(p, p->frame_count - 1) + frame_s;
    draw_key(c, p, y);
    for (int fap = 1; fap <= 2; fap++)
        if (is_used(p, fap)) {
            draw_selects(c, p, fap, b, room);
            b.y += PANEL_PX;
        }
    for (int i = 0; i < PANEL_COUNT; i++)
        if (panel_used(p, &panels[i])) {
            draw_panel(c, p, &panels[i], b, room);
            b.y += PANEL_PX;
        }
    b.y -= PANEL_PX - CURVE_PX;
    draw_time(c, &b);
    free(room);
    return FAP_OK;
}
