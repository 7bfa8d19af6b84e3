/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Vicon Nexus ASCII exports: sections one after the other, of which Trajectories holds the markers. The rate
 * of another section (force plates: 2000 Hz) must not be taken for theirs. Some exports have only the
 * section's five head lines. Source: the layout of real exports.
 */
#include <string.h>

#include "take/grid.h"

enum { FIRST_POINT_COLUMN = 2, SHORT_HEAD_LINES = 6 };

/* Where the first cell ends: its separator, or the end of the line. */
static size_t first_end(text line)
{
    size_t n = 0;

    while (n < line.length && line.start[n] != ',' && line.start[n] != ';' && line.start[n] != '\t')
        n++;
    return n;
}

static text first_cell(text line)
{
    return text_trim((text){ line.start, first_end(line) });
}

static int is_column_line(text line)
{
    const size_t end = first_end(line);

    if (!text_is(first_cell(line), "Frame") || end == line.length)
        return 0;
    return text_is(first_cell((text){ line.start + end + 1, line.length - end - 1 }), "Sub Frame");
}

/* Leaves @p lines behind the line "Trajectories", or 0. */
static int seek_section(text_lines *lines)
{
    text line;

    while (text_next(lines, &line))
        if (text_is(first_cell(line), "Trajectories"))
            return 1;
    return 0;
}

static int nexus_claims(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size), head = lines;
    text line;

    if (seek_section(&lines))
        return 85;
    for (int n = 0; n < SHORT_HEAD_LINES && text_next(&head, &line); n++)
        if (is_column_line(line))
            return 60;
    return 0;
}

static void read_unit(take_grid *g, text line)
{
    char unit[16] = "";

    text_split(line, g->separator, &g->row);
    const text u = text_cell(&g->row, FIRST_POINT_COLUMN);
    memcpy(unit, u.start, u.length < sizeof unit ? u.length : sizeof unit - 1);
    g->mm_per_unit = fap_take_unit_mm(unit);
}

/* Names stand over the first of three columns; Nexus pads short lines, so a name's own column is what counts.
 */
static void read_names(take_grid *g, text line)
{
    text_split(line, g->separator, &g->row);
    for (size_t column = FIRST_POINT_COLUMN; column < g->row.count && column + 2 < TEXT_MAX_CELLS; column++)
        if (text_cell(&g->row, column).length)
            grid_add(g, text_cell(&g->row, column), column, column + 1, column + 2);
}

/* Rate, names, columns and units: the names are the line before the one that begins with Frame. */
static fap_err read_head(take_source *src, take_grid *g, text_lines lines)
{
    text line, before = { "", 0 };

    while (text_next(&lines, &line) && !is_column_line(line)) {
        double rate;
        if (text_number(first_cell(line), &rate) == TEXT_NUMBER && rate > 0)
            g->rate_hz = rate;
        before = line;
    }
    if (!is_column_line(line) || !text_next(&lines, &line))
        return take_fail(src, FAP_E_SYNTAX, "nexus: no line Frame, Sub Frame, X, Y, Z after Trajectories");
    g->separator = text_separator(before);
    g->frame_column = 0;
    g->stop_at_blank = 1;
    read_names(g, before);
    read_unit(g, line);
    g->body = lines;
    return FAP_OK;
}

static fap_err nexus_read(take_source *src, fap_take **take)
{
    text_lines lines = text_open(src->data, src->size), start = lines;
    take_grid *g = grid_open(src);

    if (!g)
        return FAP_E_NOMEM;
    fap_err err = read_head(src, g, seek_section(&lines) ? lines : start);
    if (err == FAP_OK)
        err = grid_read(src, g, "nexus", take);
    grid_close(src, g);
    return err;
}

const take_driver take_driver_nexus = { "nexus", nexus_claims, nexus_read };
