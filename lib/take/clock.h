/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The rate of a take whose rows carry times, and the rows at their times: what a camera or a script has left out becomes a
 * gap. For files that count frames the numbers do as well.
 */
#ifndef LIB_TAKE_CLOCK_H
#define LIB_TAKE_CLOCK_H

#include "take/take_driver.h"

typedef struct take_clock {
    double *time;   /* [rows], NAN: unknown; or the frames' numbers */
    double *step;   /* room for as many */
    double unit_s;  /* seconds in a unit of the times; 0: to be guessed */
    double rate_hz; /* what the file says; 0: nothing */
    int timed;      /* not only numbered */
} take_clock;

/* Every time unknown. 0: no memory. */
int take_clock_open(take_source *src, take_clock *c, uint32_t rows);
void take_clock_close(take_source *src, take_clock *c);
/* Sets the rate, 0 where nothing tells it. A take with gaps in between replaces @p take. */
fap_err take_clock_settle(const take_clock *c, fap_take **take);

#endif
