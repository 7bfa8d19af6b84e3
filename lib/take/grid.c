/* SPDX-License-Identifier: BSD-2-Clause */
/* See grid.h. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "take/clock.h"
#include "take/grid.h"

/* What a first pass over the rows finds out. */
typedef struct row_census {
    uint64_t rows;
    int64_t first, last; /* frame numbers */
    int numbered;        /* frame numbers rise from row to row */
    double first_s, last_s;
    int timed;
} row_census;

take_grid *grid_open(take_source *src)
{
    take_grid *g = fap_mem_calloc(&src->alloc, 1, sizeof *g);

    if (!g)
        return NULL;
    g->frame_column = g->time_column = g->owner_column = -1;
    g->filter[0].column = g->filter[1].column = -1;
    g->time_scale = 1;
    g->scale[0] = g->scale[1] = g->scale[2] = 1;
    return g;
}

void grid_close(take_source *src, take_grid *grid)
{
    fap_mem_free(&src->alloc, grid);
}

void grid_add(take_grid *grid, text name, size_t x, size_t y, size_t z)
{
    if (grid->point_count == FAP_TAKE_MAX_POINTS)
        return;
    grid->point[grid->point_count++] = (grid_point){ name, { (uint16_t)x, (uint16_t)y, (uint16_t)z } };
}

static int number_in(const take_grid *g, int column, double *value)
{
    return column >= 0 && text_number(text_cell(&g->row, (size_t)column), value) == TEXT_NUMBER;
}

static int is_somebody_elses(const take_grid *g)
{
    double v;
    return number_in(g, g->owner_column, &v) && v != g->owner;
}

/* A row counts when the column that every row must have is a number; without such a column any row that is
 * not blank. */
static int is_data_row(const take_grid *g)
{
    const int key = g->frame_column >= 0 ? g->frame_column : g->time_column;
    double v;

    if (is_somebody_elses(g))
        return 0;
    return key < 0 ? !text_row_is_blank(&g->row) : number_in(g, key, &v);
}

/* The next data row, in g->row; 0 at the end of the table. */
static int next_row(take_grid *g, text_lines *lines)
{
    text line;

    while (text_next(lines, &line)) {
        text_split(line, g->separator, &g->row);
        if (is_data_row(g))
            return 1;
        if (g->stop_at_blank && text_row_is_blank(&g->row))
            return 0;
    }
    return 0;
}

static void census_row(const take_grid *g, row_census *c)
{
    double frame = 0, time = 0;
    const int has_frame = number_in(g, g->frame_column, &frame) && fabs(frame) < 1e9 && frame == floor(frame);

    if (!has_frame || (c->rows && (int64_t)frame <= c->last))
        c->numbered = 0;
    if (c->rows == 0 && has_frame)
        c->first = (int64_t)frame;
    c->last = has_frame ? (int64_t)frame : c->last;
    if (number_in(g, g->time_column, &time)) {
        if (!c->timed)
            c->first_s = time * g->time_scale;
        c->last_s = time * g->time_scale;
        c->timed = 1;
    }
    c->rows++;
}

static row_census take_census(take_grid *g)
{
    text_lines lines = g->body;
    row_census c = { .numbered = 1 };

    while (next_row(g, &lines))
        census_row(g, &c);
    /* A few absent rows are gaps; numbers all over the place say nothing about time. */
    if (c.numbered && (uint64_t)(c.last - c.first + 1) > c.rows * 4 + 100)
        c.numbered = 0;
    return c;
}

static int row_is_trusted(const take_grid *g)
{
    double v;

    for (size_t i = 0; i < sizeof g->filter / sizeof *g->filter; i++)
        if (number_in(g, g->filter[i].column, &v) && v < g->filter[i].least)
            return 0;
    return 1;
}

static void read_row(const take_grid *g, fap_take *take, uint32_t frame)
{
    for (uint32_t p = 0; p < g->point_count; p++) {
        float xyz[3];
        int known = 1;
        for (int axis = 0; axis < 3; axis++) {
            double v = 0;
            known &= number_in(g, g->point[p].column[axis], &v);
            xyz[axis] = (float)(g->scale[axis] * v);
        }
        if (known)
            fap_take_set(take, frame, p, xyz);
    }
}

static void read_rows(take_grid *g, const row_census *c, fap_take *take)
{
    text_lines lines = g->body;

    for (uint32_t row = 0; row < c->rows && next_row(g, &lines); row++) {
        double number = 0;
        const int placed = c->numbered && number_in(g, g->frame_column, &number);
        const uint32_t frame = placed ? (uint32_t)((int64_t)number - c->first) : row;
        if (frame < take->frame_count && row_is_trusted(g))
            read_row(g, take, frame);
    }
}

double take_usual_rate(double hz)
{
    static const double usual[] = { 23.976, 24, 25, 29.97, 30, 50, 59.94, 60, 90, 100, 120, 200, 240 };

    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (fabs(hz - usual[i]) < 0.0005 * usual[i])
            return usual[i];
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (fabs(hz - usual[i]) < 0.002 * usual[i])
            return usual[i];
    return hz;
}

static void settle_rate(const take_grid *g, const row_census *c, fap_take *take)
{
    static const double fastest_hz = 600;
    const double length_s = c->last_s - c->first_s;
    const double timed = c->timed && length_s > 0 ? take_usual_rate((take->frame_count - 1) / length_s) : 0;

    take->rate_hz = g->rate_hz > 0 ? g->rate_hz : timed;
    if (take->rate_hz > fastest_hz && !(g->rate_hz > 0)) {
        take_note(take, "the times say %.4g frames a second: an image sequence without times?", timed);
        take->rate_hz = 0;
    }
    if (g->rate_hz > 0 && timed > 0 && fabs(timed - g->rate_hz) > 0.02 * g->rate_hz)
        take_note(take, "the head says %g frames a second, the times say %.4g; the head is used", g->rate_hz,
                  timed);
}

static void name_points(const take_grid *g, fap_take *take)
{
    for (uint32_t p = 0; p < g->point_count; p++)
        take_set_name(take, p, g->point[p].name.start, g->point[p].name.length);
    take_finish_names(take);
}

/* Rows that nothing but their times places. */
static int needs_clock(const take_grid *g, const row_census *c)
{
    return c->timed && !c->numbered && !(g->rate_hz > 0);
}

static void read_times(take_grid *g, take_clock *clock, uint32_t rows)
{
    text_lines lines = g->body;

    for (uint32_t row = 0; row < rows && next_row(g, &lines); row++)
        number_in(g, g->time_column, &clock->time[row]);
}

static fap_err place_by_time(take_source *src, take_grid *g, fap_take **take)
{
    take_clock clock = { .unit_s = g->time_scale, .timed = 1 };

    if (!take_clock_open(src, &clock, (*take)->frame_count))
        return FAP_E_NOMEM;
    read_times(g, &clock, (*take)->frame_count);
    const double mean_hz = (*take)->rate_hz;
    fap_err err = FAP_OK;
    if (mean_hz > 0) /* else they are no times */
        err = take_clock_settle(&clock, take);
    if (err == FAP_OK && !((*take)->rate_hz > 0))
        (*take)->rate_hz = mean_hz;
    take_clock_close(src, &clock);
    return err == FAP_OK ? err : take_fail(src, err, "no room for the frames that the times leave out");
}

fap_err grid_read(take_source *src, take_grid *g, const char *format, fap_take **out)
{
    const row_census c = take_census(g);
    const uint64_t frames = c.numbered && c.rows ? (uint64_t)(c.last - c.first + 1) : c.rows;

    if (!g->point_count)
        return take_fail(src, FAP_E_NOT_FOUND, "%s: no named point", format);
    if (!frames)
        return take_fail(src, FAP_E_NOT_FOUND, "%s: %u points and not one row of numbers", format,
                         (unsigned)g->point_count);
    if (frames * g->point_count > FAP_TAKE_MAX_SAMPLES)
        return take_fail(src, FAP_E_LIMIT, "%s: %llu frames of %u points are too many", format,
                         (unsigned long long)frames, (unsigned)g->point_count);
    const fap_err err = fap_take_create(out, g->point_count, (uint32_t)frames, &src->alloc);
    if (err != FAP_OK)
        return take_fail(src, err, "%s: no room for %u points", format, (unsigned)g->point_count);
    fap_take *take = *out;
    take->mm_per_unit = g->mm_per_unit;
    take->first_frame = c.numbered ? c.first : 1;
    settle_rate(g, &c, take);
    name_points(g, take);
    read_rows(g, &c, take);
    if (frames > c.rows)
        take_note(take, "%llu frames are absent", (unsigned long long)(frames - c.rows));
    return needs_clock(g, &c) ? place_by_time(src, g, out) : FAP_OK;
}
