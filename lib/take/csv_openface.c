/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * OpenFace 2.x tables: 68 points in millimetres, in the camera's frame (y down, z away), called 0 to 67 here.
 * X_5 is millimetres and x_5 pixels, so case counts. Rows that the tracker does not trust are missing.
 * Source: the columns of real exports of several releases.
 */
#include <stdio.h>

#include "take/grid.h"

enum { POINTS = 68 };

static int is_exactly(text t, const char *word)
{
    for (size_t i = 0; i < t.length; i++)
        if (!word[i] || t.start[i] != word[i]) /* a cell may hold NULs of its own */
            return 0;
    return word[t.length] == '\0';
}

/* Column of X_5 and its kin, the row's length where there is none. */
static size_t column_of(const text_row *row, const char *name)
{
    size_t column = 0;

    while (column < row->count && !is_exactly(row->cell[column], name))
        column++;
    return column;
}

static int openface_claims(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size);
    text line;
    int has_point = 0, has_confidence = 0;

    if (!text_next(&lines, &line))
        return 0;
    for (; line.length; line.start++, line.length--) {
        has_point |= text_starts(line, "X_67") && *line.start == 'X';
        has_confidence |= text_starts(line, "confidence");
    }
    return has_point && has_confidence ? 80 : 0;
}

static void add_points(take_grid *g)
{
    for (int i = 0; i < POINTS; i++) {
        char name[3][16];
        size_t column[3];
        for (int axis = 0; axis < 3; axis++) {
            snprintf(name[axis], sizeof name[axis], "%c_%d", 'X' + axis, i);
            column[axis] = column_of(&g->row, name[axis]);
        }
        if (column[0] < g->row.count && column[1] < g->row.count && column[2] < g->row.count)
            grid_add(g, (text){ g->row.cell[column[0]].start + 2, g->row.cell[column[0]].length - 2 },
                     column[0], column[1], column[2]);
    }
}

static int optional(const text_row *row, const char *name)
{
    const size_t column = column_of(row, name);
    return column < row->count ? (int)column : -1;
}

static fap_err openface_read(take_source *src, fap_take **take)
{
    text_lines lines = text_open(src->data, src->size);
    take_grid *g = grid_open(src);
    text line;

    if (!g || !text_next(&lines, &line)) {
        grid_close(src, g);
        return g ? take_fail(src, FAP_E_SYNTAX, "openface: no head line") : FAP_E_NOMEM;
    }
    g->separator = ',';
    text_split(line, g->separator, &g->row);
    g->frame_column = optional(&g->row, "frame");
    g->time_column = optional(&g->row, "timestamp");
    g->filter_column = optional(&g->row, "confidence");
    g->filter_least = 0.75;
    g->mm_per_unit = 1;
    g->scale[1] = g->scale[2] = -1;
    add_points(g);
    g->body = lines;
    const fap_err err = grid_read(src, g, "openface", take);
    grid_close(src, g);
    return err;
}

const take_driver take_driver_openface = { "openface", openface_claims, openface_read };
