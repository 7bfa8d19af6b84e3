/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Home-made tables: one row a frame, three columns a point that carry x, y and z at the end or the start of
 * their name (Chin_x, Chin.X, "Chin X", x_5, X5). Separator and decimal mark are found; other columns are
 * ignored. Source: tables as published by blenderFace and as research code writes them.
 */
#include "take/grid.h"
#include "take/picture.h"

/* A column heading taken apart. */
typedef struct heading {
    text base;
    char axis; /* the letter as written: X and x are different families; 0: not a coordinate */
    int prefixed;
} heading;

static int is_axis(char c)
{
    return (c >= 'x' && c <= 'z') || (c >= 'X' && c <= 'Z');
}

static int is_joint(char c)
{
    return c == '_' || c == '.' || c == ' ' || c == '-' || c == ':';
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static heading parse_heading(text t)
{
    const size_t n = t.length;

    if (n >= 3 && is_axis(t.start[n - 1]) && is_joint(t.start[n - 2]))
        return (heading){ text_trim((text){ t.start, n - 2 }), t.start[n - 1], 0 };
    if (n >= 3 && is_axis(t.start[0]) && is_joint(t.start[1]))
        return (heading){ text_trim((text){ t.start + 2, n - 2 }), t.start[0], 1 };
    if (n >= 2 && is_axis(t.start[0]) && is_digit(t.start[1]))
        return (heading){ { t.start + 1, n - 1 }, t.start[0], 1 };
    return (heading){ { "", 0 }, 0, 0 };
}

static int same_base(const heading *a, const heading *b)
{
    if (a->base.length != b->base.length || a->prefixed != b->prefixed)
        return 0;
    for (size_t i = 0; i < a->base.length; i++)
        if (a->base.start[i] != b->base.start[i])
            return 0;
    return 1;
}

/* The column that is axis @p letter of the point @p x belongs to, searched from its neighbour on; count:
 * none. */
static size_t partner(const text_row *row, size_t x_column, const heading *x, char letter)
{
    for (size_t step = 1; step < row->count; step++) {
        const size_t column = (x_column + step) % row->count;
        const heading h = parse_heading(row->cell[column]);
        if (h.axis == letter && same_base(x, &h))
            return column;
    }
    return row->count;
}

static void add_points(take_grid *g)
{
    for (size_t column = 0; column < g->row.count; column++) {
        const heading x = parse_heading(g->row.cell[column]);
        if (x.axis != 'x' && x.axis != 'X')
            continue;
        const size_t y = partner(&g->row, column, &x, (char)(x.axis + 1));
        const size_t z = y < g->row.count ? partner(&g->row, column, &x, (char)(x.axis + 2)) : g->row.count;
        if (z < g->row.count)
            grid_add(g, x.base, column, y, z);
    }
}

/* What one row says in a column of that name; 0 where it says nothing. */
static double value_in_body(const take_grid *g, text_row *row, size_t column)
{
    text_lines lines = g->body;
    double v = 0;
    text line;

    if (column == row->count || !text_next(&lines, &line))
        return 0;
    text_split(line, g->separator, row);
    return text_number(text_cell(row, column), &v) == TEXT_NUMBER && v > 0 ? v : 0;
}

static size_t column_of(const text_row *row, const char *name)
{
    size_t column = 0;

    while (column < row->count && !text_is(row->cell[column], name))
        column++;
    return column;
}

/* Landmarks as fractions of a picture (MediaPipe): x and z count widths, y heights, so lengths need both. */
static void scale_by_picture(take_grid *g)
{
    const size_t width_column = column_of(&g->row, "image_width"),
                 height_column = column_of(&g->row, "image_height");

    if (width_column == g->row.count || height_column == g->row.count)
        return;
    const double width = value_in_body(g, &g->row, width_column);
    const double height = value_in_body(g, &g->row, height_column);
    if (width > 0 && height > 0) {
        g->scale[1] = height / width;
        g->mm_per_unit = -1;
    }
}

static void find_keys(take_grid *g)
{
    for (size_t column = g->row.count; column-- > 0;) {
        const text t = g->row.cell[column];
        if (text_is(t, "frame") || text_is(t, "frame#") || text_is(t, "frame_number"))
            g->frame_column = (int)column;
        if (!text_starts(t, "time") || text_starts(t, "timecode"))
            continue;
        g->time_column = (int)column;
        g->time_scale =
            text_is(t, "time_ms") || text_is(t, "time (ms)") || text_is(t, "timestamp_ms") ? 1e-3 : 1;
    }
}

/* The first line that is neither blank nor a comment. */
static int head_line(text_lines *lines, text *line)
{
    while (text_next(lines, line)) {
        const text t = text_trim(*line);
        if (t.length && t.start[0] != '#')
            return 1;
    }
    return 0;
}

static int plain_claims(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size);
    int seen[3] = { 0 };
    text line;

    if (!head_line(&lines, &line))
        return 0;
    const char separator = text_separator(line);
    const char *end = line.start + line.length;
    for (const char *at = line.start, *stop; at < end; at = stop + 1) {
        for (stop = at; stop < end && *stop != separator;)
            stop++;
        const heading h = parse_heading(text_trim((text){ at, (size_t)(stop - at) }));
        if (h.axis)
            seen[(h.axis | 0x20) - 'x'] = 1;
    }
    return seen[0] && seen[1] && seen[2] ? 30 : 0;
}

static text trailing_digits(text t)
{
    size_t n = 0;

    while (n < t.length && is_digit(t.start[t.length - 1 - n]))
        n++;
    return (text){ t.start + t.length - n, n };
}

static int same_front(text a, text b)
{
    const size_t n = a.length - trailing_digits(a).length;

    if (n != b.length - trailing_digits(b).length)
        return 0;
    for (size_t i = 0; i < n; i++)
        if (a.start[i] != b.start[i])
            return 0;
    return 1;
}

/* landmark_0 to landmark_477: where all points of a known model are numbers with one word in front, the word is dropped. */
static void drop_front(take_grid *g)
{
    if (g->point_count != 68 && g->point_count != 468 && g->point_count != 478)
        return;
    for (uint32_t p = 0; p < g->point_count; p++)
        if (!trailing_digits(g->point[p].name).length || !same_front(g->point[0].name, g->point[p].name))
            return;
    for (uint32_t p = 0; p < g->point_count; p++)
        g->point[p].name = trailing_digits(g->point[p].name);
}

static fap_err plain_read(take_source *src, fap_take **take)
{
    text_lines lines = text_open(src->data, src->size);
    take_grid *g = grid_open(src);
    text line;

    if (!g || !head_line(&lines, &line)) {
        grid_close(src, g);
        return g ? take_fail(src, FAP_E_SYNTAX, "table: no head line") : FAP_E_NOMEM;
    }
    g->separator = text_separator(line);
    text_split(line, g->separator, &g->row);
    find_keys(g);
    add_points(g);
    g->body = lines;
    scale_by_picture(g);
    drop_front(g);
    const fap_err err = grid_read(src, g, "table", take);
    const int shape_unknown = g->mm_per_unit == 0;
    grid_close(src, g);
    if (err == FAP_OK && shape_unknown && picture_is_fractions(*take))
        picture_settle(*take, 0);
    return err;
}

const take_driver take_driver_plain = { "table", plain_claims, plain_read };
