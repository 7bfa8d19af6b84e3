/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The part that all tables of points share: once a driver knows which columns make which point and where the
 * rows begin, reading them is the same. Rows are placed by their frame number, so dropped ones become gaps.
 */
#ifndef LIB_TAKE_GRID_H
#define LIB_TAKE_GRID_H

#include "take/take_driver.h"
#include "take/text.h"

typedef struct grid_point {
    text name;
    uint16_t column[3];
} grid_point;

typedef struct take_grid {
    text_lines body; /* the rows start here */
    char separator;
    uint8_t stop_at_blank;         /* a blank row ends the table; otherwise it is skipped */
    int frame_column, time_column; /* -1: none */
    double time_scale;             /* seconds in a unit of the time column */
    double rate_hz, mm_per_unit;   /* 0: unknown */
    double scale[3];               /* every coordinate is multiplied with it */
    /* Rows whose cell in a filter's column is a number below its least are missing. */
    struct {
        int column; /* -1: none */
        double least;
    } filter[2];
    /* Rows whose cell here is another number than this are somebody else's and no rows at all; -1: none. */
    int owner_column;
    double owner;
    uint32_t point_count;
    grid_point point[FAP_TAKE_MAX_POINTS];
    text_row row;
} take_grid;

/* An empty grid; NULL without memory. Free with grid_close(). */
take_grid *grid_open(take_source *src);
void grid_close(take_source *src, take_grid *grid);
/* Adds a point unless there are too many. */
void grid_add(take_grid *grid, text name, size_t x, size_t y, size_t z);
/* Reads every row. @p format is for messages. */
fap_err grid_read(take_source *src, take_grid *grid, const char *format, fap_take **take);

#endif
