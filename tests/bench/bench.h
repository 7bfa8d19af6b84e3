/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The figures of "make bench". A figure is a function that measures; figures.c lists them in the order they are printed.
 */
#ifndef TESTS_BENCH_H
#define TESTS_BENCH_H

typedef struct bench_figure {
    const char *name, *unit;
    double (*measure)(void); /* negative: what it needs is not there */
    const char *remark;      /* what was measured, on which input */
    const char *needs;       /* what is missing when it cannot be measured */
} bench_figure;

extern const bench_figure bench_figures[]; /* ends with a NULL name */

/* Seconds on a monotonic clock. */
double bench_now_s(void);

/* Seconds of take encoded in a second. */
double bench_encode_x_realtime(void);

/* Pictures a second of a moving face, and what the moving costs against a still one. */
double bench_play_fps(void);
double bench_render_overhead(void);

/* Frames of 58 FAPs that the .fap reader takes in a second. */
double bench_ascii_parse_fps(void);

#endif
