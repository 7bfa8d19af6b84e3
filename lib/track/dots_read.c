/* SPDX-License-Identifier: BSD-2-Clause */
/* Where dots are in the first picture, from a table. See <fap/studio/tracks.h>. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <fap/studio/tracks.h>

#include "base/mem.h"
#include "take/text.h"

typedef struct reading {
    fap_track_dots *out;
    int views; /* dots in all views */
    unsigned line;
    char *where;
    text_row row;
} reading;

__attribute__((format(printf, 3, 4))) static fap_err fail(const reading *r, fap_err err, const char *fmt, ...)
{
    char words[FAP_ERROR_TEXT_SIZE - 16];
    va_list args;

    va_start(args, fmt);
    vsnprintf(words, sizeof words, fmt, args);
    va_end(args);
    snprintf(r->where, FAP_ERROR_TEXT_SIZE, "line %u: %s", r->line, words);
    return err;
}

/* Both numbers of a view: 1; both empty: 0; else -1. */
static int read_place(const text_row *row, int view, double at[2])
{
    int numbers = 0;

    for (size_t axis = 0; axis < 2; axis++) {
        const text cell = text_cell(row, 1 + 2 * (size_t)view + axis);
        const text_value value = text_number(cell, &at[axis]);
        if (value == TEXT_OTHER)
            return -1;
        numbers += value == TEXT_NUMBER;
    }
    return numbers == 2 ? 1 : numbers ? -1 : 0;
}

static int is_known(const reading *r, const char *name)
{
    for (int i = 0; i < r->out->count; i++)
        if (!strcasecmp(r->out->dot[i].name, name))
            return 1;
    return 0;
}

static fap_err read_places(reading *r, fap_track_dot *dot)
{
    int seen = 0;

    for (int view = 0; view < FAP_TRACKS_VIEWS; view++) {
        const int found = read_place(&r->row, view, dot->at_px[view]);
        if (found < 0)
            return fail(r, FAP_E_SYNTAX,
                        "\"%s\": expected label,x,y and x,y for each mirror, numbers or both empty",
                        dot->name);
        dot->has[view] = (uint8_t)found;
        seen += found;
        if (found && view > r->out->mirrors)
            r->out->mirrors = view;
    }
    if (!seen)
        return fail(r, FAP_E_DATA, "\"%s\" is seen in no view", dot->name);
    r->views += seen;
    return r->views > FAP_TRACK_MAX_POINTS
               ? fail(r, FAP_E_LIMIT, "more than %d dots in all views", FAP_TRACK_MAX_POINTS)
               : FAP_OK;
}

static fap_err read_dot(reading *r)
{
    const text label = text_cell(&r->row, 0);
    fap_track_dot dot = { .name = "" };

    memcpy(dot.name, label.start, label.length < sizeof dot.name ? label.length : sizeof dot.name - 1);
    if (!*dot.name)
        return fail(r, FAP_E_SYNTAX, "a dot without a label");
    if (is_known(r, dot.name))
        return fail(r, FAP_E_DATA, "the label \"%s\" was there already", dot.name);
    const fap_err err = read_places(r, &dot);
    if (err == FAP_OK)
        r->out->dot[r->out->count++] = dot;
    return err;
}

/* The first row may say what the columns are. */
static int is_heading(const reading *r)
{
    double at[2];

    return !r->out->count && read_place(&r->row, 0, at) < 0;
}

static fap_err read_rows(reading *r, const void *data, size_t size)
{
    text_lines lines = text_open(data, size);
    int first = 1;
    text line;

    while (text_next(&lines, &line)) {
        r->line = lines.number;
        text_split(line, text_separator(line), &r->row);
        if (text_row_is_blank(&r->row) || text_starts(text_trim(line), "#"))
            continue;
        const int heading = first && is_heading(r);
        first = 0;
        if (heading)
            continue;
        const fap_err err = read_dot(r);
        if (err != FAP_OK)
            return err;
    }
    return r->out->count ? FAP_OK : fail(r, FAP_E_NOT_FOUND, "no dot; expected lines like \"8.4,302.5,288\"");
}

fap_err fap_track_dots_read(fap_track_dots *dots, const void *data, size_t size, const fap_allocator *alloc,
                            char *where)
{
    *dots = (fap_track_dots){ .alloc = fap_mem_allocator(alloc) };
    *where = '\0';
    dots->dot = fap_mem_calloc(&dots->alloc, FAP_TRACK_MAX_POINTS, sizeof *dots->dot);
    reading *r = fap_mem_calloc(&dots->alloc, 1, sizeof *r);
    fap_err err = FAP_E_NOMEM;
    if (r && dots->dot) {
        r->out = dots;
        r->where = where;
        err = read_rows(r, data, size);
    }
    fap_mem_free(&dots->alloc, r);
    if (err != FAP_OK)
        fap_track_dots_close(dots);
    return err;
}

void fap_track_dots_close(fap_track_dots *dots)
{
    fap_mem_free(&dots->alloc, dots->dot);
    dots->dot = NULL;
    dots->count = 0;
}
