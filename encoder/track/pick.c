/* SPDX-License-Identifier: BSD-2-Clause */
/* See pick.h. */
#include <stdlib.h>
#include <string.h>

#include "encoder/track/pick.h"

/* Brows, nose, cheeks, mouth, chin, forehead, ears: from above to below, as far as that goes. */
static const char usual_labels[] =
    "11.1\n11.2\n11.3\n4.6\n4.4\n4.2\n4.1\n4.3\n4.5\n10.6\n10.5\n9.6\n9.7\n9.12\n9.3\n9.2\n9.1\n9.15\n"
    "5.4\n5.3\n5.2\n5.1\n8.4\n8.6\n8.9\n8.1\n8.10\n8.5\n8.3\n8.7\n8.2\n8.8\n2.10\n2.12\n2.11\n2.14\n2.13\n"
    "ruler A\nruler B\n";

static fap_err add_label(pick *p, const char *start, size_t length)
{
    if (p->dots.count == FAP_TRACK_MAX_POINTS)
        return FAP_E_LIMIT;
    char *name = p->dots.dot[p->dots.count++].name;
    memcpy(name, start, length < FAP_TAKE_NAME_SIZE ? length : FAP_TAKE_NAME_SIZE - 1);
    return FAP_OK;
}

fap_err pick_open(pick *p, const char *list, int mirrors)
{
    fap_err err = FAP_OK;

    *p = (pick){ .mirrors = mirrors };
    p->dots.dot = calloc(FAP_TRACK_MAX_POINTS, sizeof *p->dots.dot);
    if (!p->dots.dot)
        return FAP_E_NOMEM;
    for (const char *line = list ? list : usual_labels; *line && err == FAP_OK;) {
        const size_t length = strcspn(line, "\r\n,");
        if (length && *line != '#')
            err = add_label(p, line, length);
        line += length;
        line += strcspn(line, "\n");
        line += *line == '\n';
    }
    if (err == FAP_OK && !p->dots.count)
        err = FAP_E_NOT_FOUND;
    if (err != FAP_OK)
        pick_close(p);
    return err;
}

void pick_close(pick *p)
{
    free(p->dots.dot);
    p->dots.dot = NULL;
}

/* --- steps --- */

static void go_on(pick *p)
{
    if (++p->label < p->dots.count)
        return;
    p->label = 0;
    if (p->view < p->mirrors) {
        p->view++;
        return;
    }
    p->finished = 1;
}

static void put(pick *p, int has, double x, double y)
{
    fap_track_dot *d = &p->dots.dot[p->label];

    d->has[p->view] = (uint8_t)has;
    d->at_px[p->view][0] = x;
    d->at_px[p->view][1] = y;
}

void pick_click(pick *p, double x, double y)
{
    if (p->finished)
        return;
    put(p, 1, x, y);
    go_on(p);
}

void pick_skip(pick *p)
{
    if (p->finished)
        return;
    put(p, 0, 0, 0);
    go_on(p);
}

void pick_back(pick *p)
{
    if (p->finished) {
        p->finished = 0;
        p->view = p->mirrors;
        p->label = p->dots.count;
    }
    if (p->label > 0)
        p->label--;
    else if (p->view > 0) {
        p->view--;
        p->label = p->dots.count - 1;
    }
    put(p, 0, 0, 0);
}

void pick_go_to_view(pick *p, int view)
{
    if (view > p->mirrors)
        return;
    p->finished = 0;
    p->view = view;
    for (p->label = 0; p->label < p->dots.count - 1 && p->dots.dot[p->label].has[view]; p->label++)
        continue;
}

/* --- what came of it --- */

const char *pick_view_name(int view)
{
    static const char *const names[FAP_TRACKS_VIEWS] = { "direct", "mirror 1", "mirror 2" };
    return names[view];
}

int pick_count(const pick *p, int label)
{
    const uint8_t *has = p->dots.dot[label].has;
    return has[0] + has[1] + has[2];
}

/* Hundredths of a pixel, without the locale. */
static void write_number(double v, FILE *out)
{
    const int hundredths = v > 0 ? (int)(100 * v + 0.5) : 0;

    fprintf(out, ",%d.%02d", hundredths / 100, hundredths % 100);
}

void pick_write(const pick *p, FILE *out)
{
    fputs("label,x,y", out);
    for (int m = 1; m <= p->mirrors; m++)
        fprintf(out, ",mirror%d_x,mirror%d_y", m, m);
    fputs("\n", out);
    for (int i = 0; i < p->dots.count; i++) {
        const fap_track_dot *d = &p->dots.dot[i];
        if (!pick_count(p, i))
            continue;
        fputs(d->name, out);
        for (int view = 0; view <= p->mirrors; view++) {
            if (!d->has[view]) {
                fputs(",,", out);
                continue;
            }
            write_number(d->at_px[view][0], out);
            write_number(d->at_px[view][1], out);
        }
        fputs("\n", out);
    }
}
