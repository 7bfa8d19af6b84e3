/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What readers of coefficient files share. A reader says which channels there are and appends rows as the file has them, each
 * with what its clock shows; when the last one is in, coef_rows_settle() finds out the rate and puts every row where
 * its time says, so that rows that are not there become gaps.
 */
#ifndef LIB_TAKE_COEF_H
#define LIB_TAKE_COEF_H

#include <fap/studio/coefficients.h>

#include "take/take_driver.h"
#include "take/text.h"

/* What the rows' times are. */
typedef enum coef_clock {
    COEF_CLOCK_NONE,     /* a row is a frame */
    COEF_CLOCK_FRAMES,   /* numbers of frames; how many a second is known from elsewhere, or not at all */
    COEF_CLOCK_SECONDS,  /* since whenever */
    COEF_CLOCK_TIMECODE, /* seconds of the day, and frames in a base that nobody states */
} coef_clock;

typedef struct coef_rows {
    fap_coefficients *take; /* room for @c room rows; its first @c count are in */
    coef_clock clock;
    double *time, *part; /* [room]; part: frames within the second, of a time code */
    uint32_t room, count;
    double known_hz; /* what the file says in words; 0: nothing */
    fap_allocator alloc;
    double snap; /* a rate as near as this to a usual one is that one, as a share; 0: none */
} coef_rows;

typedef struct coef_driver {
    const char *name;
    int (*claims)(const uint8_t *data, size_t size); /* as in take_driver */
    fap_err (*read)(take_source *src, coef_rows *rows);
} coef_driver;

extern const coef_driver coef_driver_livelink, coef_driver_packets, coef_driver_openface, coef_driver_json;

/* Room for rows of @p channels columns; columns are named by the caller in rows->take->channel. */
fap_err coef_rows_open(take_source *src, coef_rows *rows, uint32_t channels, uint64_t room);
void coef_rows_close(coef_rows *rows);
/* A new row, all missing; -1: no room. */
int64_t coef_rows_add(coef_rows *rows, double time, double part);
/* A sample of it; what is no number, or beyond reason, stays missing. */
void coef_set(coef_rows *rows, int64_t row, uint32_t column, double value);
/* Rows into frames. */
fap_err coef_rows_settle(take_source *src, coef_rows *rows, double user_hz);

void coef_note(fap_coefficients *take, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* Channel of a column by its name: ARKit's, Live Link Face's, iFacialMocap's spelling; -1: none. */
int coef_channel_of(text name);

#endif
