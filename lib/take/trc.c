/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * TRC takes (Motion Analysis, also Vicon, OpenSim, Pose2Sim): tab separated, three columns a point. The
 * stated number of markers is often wrong; the names decide, and columns past them are dropped. Source: the
 * layout of real files of these programs.
 */
#include <string.h>

#include "take/grid.h"

enum { FIRST_POINT_COLUMN = 2 };

static int trc_claims(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size);
    text line;

    return text_next(&lines, &line) && text_starts(text_trim(line), "PathFileType") ? 95 : 0;
}

/* Line 2 names the fields, line 3 holds their values. @p names must outlive @p g's row. */
static text field(const text_row *values, text_lines names, const char *name)
{
    text line;

    if (text_next(&names, &line)) {
        const char *at = line.start, *end = at + line.length;
        for (size_t column = 0; at <= end; column++) {
            const char *tab = memchr(at, '\t', (size_t)(end - at));
            const char *stop = tab ? tab : end;
            if (text_is(text_trim((text){ at, (size_t)(stop - at) }), name))
                return text_cell(values, column);
            at = stop + 1;
        }
    }
    return (text){ "", 0 };
}

/* What the head announces; 0: nothing. */
typedef struct announced {
    double markers, frames;
} announced;

static double count_in(const take_grid *g, text_lines names, const char *name)
{
    double v;
    return text_number(field(&g->row, names, name), &v) == TEXT_NUMBER && v > 0 ? v : 0;
}

static void read_fields(take_grid *g, text_lines names, announced *a)
{
    char unit[16] = "";
    const text u = field(&g->row, names, "Units");

    memcpy(unit, u.start, u.length < sizeof unit ? u.length : sizeof unit - 1);
    g->mm_per_unit = fap_take_unit_mm(unit);
    if (text_number(field(&g->row, names, "DataRate"), &g->rate_hz) != TEXT_NUMBER)
        g->rate_hz = 0;
    a->markers = count_in(g, names, "NumMarkers");
    a->frames = count_in(g, names, "NumFrames");
}

static void note_counts(fap_take *take, const announced *a)
{
    if (a->markers > 0 && a->markers != take->point_count)
        take_note(take, "the head announces %g markers, line 4 names %u; the names are used", a->markers,
                  (unsigned)take->point_count);
    if (a->frames > 0 && a->frames != take->frame_count)
        take_note(take, "the head announces %g frames, there are %u", a->frames, (unsigned)take->frame_count);
}

static void read_names(take_grid *g)
{
    for (size_t column = FIRST_POINT_COLUMN; column + 2 < TEXT_MAX_CELLS && column < g->row.count;
         column += 3)
        if (text_cell(&g->row, column).length)
            grid_add(g, text_cell(&g->row, column), column, column + 1, column + 2);
}

static int split_next(take_grid *g, text_lines *lines)
{
    text line;

    if (!text_next(lines, &line))
        return 0;
    text_split(line, '\t', &g->row);
    return 1;
}

static fap_err read_head(take_source *src, take_grid *g, announced *a)
{
    text_lines lines = text_open(src->data, src->size);
    text line;

    g->separator = '\t';
    g->frame_column = 0;
    g->time_column = 1;
    if (!text_next(&lines, &line))
        return take_fail(src, FAP_E_SYNTAX, "trc: empty");
    const text_lines names = lines;
    if (!text_next(&lines, &line) || !split_next(g, &lines))
        return take_fail(src, FAP_E_SYNTAX, "trc: ends inside its head, before the values of line 3");
    read_fields(g, names, a);
    if (!split_next(g, &lines) || !text_starts(text_cell(&g->row, 0), "Frame"))
        return take_fail(src, FAP_E_SYNTAX, "trc: line 4 should begin with Frame# and name the markers");
    read_names(g);
    if (!g->point_count)
        return take_fail(src, FAP_E_NOT_FOUND,
                         "trc: line 4 names no marker; unnamed points cannot be mapped");
    g->body = lines; /* line 5, X1 Y1 ..., has no number in its first cell and is skipped as such */
    return FAP_OK;
}

static fap_err trc_read(take_source *src, fap_take **take)
{
    take_grid *g = grid_open(src);
    announced a = { 0, 0 };

    if (!g)
        return FAP_E_NOMEM;
    fap_err err = read_head(src, g, &a);
    if (err == FAP_OK)
        err = grid_read(src, g, "trc", take);
    if (err == FAP_OK) {
        take_drop_zeros(*take);
        note_counts(*take, &a);
    }
    grid_close(src, g);
    return err;
}

const take_driver take_driver_trc = { "trc", trc_claims, trc_read };
