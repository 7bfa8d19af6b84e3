/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * OptiTrack Motive exports: one line of keys and values, rows of headings (type, name, ID, parent, quantity),
 * then columns. Markers are kept, solved rigid bodies and bones are not; a rigid body's own markers serve
 * where no other marker has a name. Source: the layout of a real export of format 1.21; what differs in 1.24
 * and 1.25 as public parsers have it.
 */
#include <string.h>

#include "base/mem.h"
#include "take/grid.h"

/* The rows of headings, found by what is in them. */
typedef struct motive_head {
    text_row type, name, quantity, axis;
} motive_head;

static int motive_claims(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size);
    text line;

    return text_next(&lines, &line) && text_starts(text_trim(line), "Format Version") ? 95 : 0;
}

static text value_of(const text_row *row, const char *key)
{
    for (size_t i = 0; i + 1 < row->count; i += 2)
        if (text_is(row->cell[i], key))
            return row->cell[i + 1];
    return (text){ "", 0 };
}

static void read_first_line(take_grid *g, text line)
{
    char unit[16] = "";

    text_split(line, ',', &g->row);
    const text u = value_of(&g->row, "Length Units");
    memcpy(unit, u.start, u.length < sizeof unit ? u.length : sizeof unit - 1);
    g->mm_per_unit = fap_take_unit_mm(unit);
    if (text_number(value_of(&g->row, "Export Frame Rate"), &g->rate_hz) != TEXT_NUMBER)
        g->rate_hz = 0;
}

static int row_has(const text_row *row, const char *word)
{
    for (size_t i = 0; i < row->count; i++)
        if (text_is(row->cell[i], word))
            return 1;
    return 0;
}

/* The name row follows the type row; the quantity row is the one that says Position. */
static int read_headings(motive_head *h, text_lines *lines, text_row *row)
{
    int have_type = 0, have_name = 0;
    text line;

    while (text_next(lines, &line)) {
        text_split(line, ',', row);
        if (text_is(text_cell(row, 0), "Frame")) {
            h->axis = *row;
            return have_name && h->quantity.count;
        }
        if (!have_type && (row_has(row, "Marker") || row_has(row, "Rigid Body Marker"))) {
            h->type = *row;
            have_type = 1;
        } else if (have_type && !have_name) {
            h->name = *row;
            have_name = 1;
        } else if (row_has(row, "Position")) {
            h->quantity = *row;
        }
    }
    return 0;
}

static int is_position(const motive_head *h, size_t column, const char *axis, const char *type)
{
    return text_is(text_cell(&h->quantity, column), "Position") &&
           text_is(text_cell(&h->axis, column), axis) && text_is(text_cell(&h->type, column), type);
}

static void add_points(take_grid *g, const motive_head *h, const char *type)
{
    for (size_t c = 0; c + 2 < h->axis.count; c++) {
        const text name = text_cell(&h->name, c);
        if (is_position(h, c, "X", type) && is_position(h, c + 1, "Y", type) &&
            is_position(h, c + 2, "Z", type) && !text_starts(name, "Unlabeled"))
            grid_add(g, name, c, c + 1, c + 2);
    }
}

/* Columns X of a type and of names that are left out. */
static unsigned count_columns(const motive_head *h, const char *type, int unlabeled)
{
    unsigned n = 0;

    for (size_t c = 0; c < h->axis.count; c++)
        n += is_position(h, c, "X", type) && text_starts(text_cell(&h->name, c), "Unlabeled") == unlabeled;
    return n;
}

static void note_left_out(fap_take *take, const motive_head *h)
{
    const unsigned unlabeled = count_columns(h, "Marker", 1),
                   bodies = count_columns(h, "Rigid Body", 0) + count_columns(h, "Bone", 0);

    if (unlabeled)
        take_note(take, "%u unlabeled points are left out", unlabeled);
    if (bodies)
        take_note(take, "%u rigid bodies and bones are left out; their markers are used", bodies);
}

static fap_err read_head(take_source *src, take_grid *g, motive_head *h)
{
    text_lines lines = text_open(src->data, src->size);
    text line;

    if (text_next(&lines, &line))
        read_first_line(g, line);
    if (!read_headings(h, &lines, &g->row))
        return take_fail(src, FAP_E_NOT_FOUND, "motive: no columns of type Marker with quantity Position");
    g->separator = ',';
    g->frame_column = 0;
    g->time_column = text_starts(text_cell(&h->axis, 1), "Time") ? 1 : -1;
    add_points(g, h, "Marker");
    if (!g->point_count)
        add_points(g, h, "Rigid Body Marker");
    if (!g->point_count)
        return take_fail(src, FAP_E_NOT_FOUND, "motive: every marker is unlabeled");
    g->body = lines;
    return FAP_OK;
}

static fap_err motive_read(take_source *src, fap_take **take)
{
    take_grid *g = grid_open(src);
    motive_head *h = fap_mem_calloc(&src->alloc, 1, sizeof *h);

    fap_err err = g && h ? read_head(src, g, h) : FAP_E_NOMEM;
    if (err == FAP_OK)
        err = grid_read(src, g, "motive", take);
    if (err == FAP_OK)
        note_left_out(*take, h);
    fap_mem_free(&src->alloc, h);
    grid_close(src, g);
    return err;
}

const take_driver take_driver_motive = { "motive", motive_claims, motive_read };
