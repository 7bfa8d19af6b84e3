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

/* Frames of real streams that the FBA codec writes and reads in a second; the same with 58 FAPs in motion. */
double bench_fba_decode_fps(void);
double bench_fba_encode_fps(void);
double bench_fba_decode_fps_58(void);
double bench_fba_encode_fps_58(void);
/* What a decoder with default options allocates. */
double bench_decoder_state_bytes(void);
double bench_libfap_text_bytes(void);

/* Microseconds a pose takes by each method, and what normals add. */
double bench_face_ga_us(void);
double bench_face_qp_us(void);
double bench_face_zhu_us(void);
double bench_face_normals_us(void);
/* Mean cosine reached on 20 mixes of three keys; the thesis's way over 10 seeds (Zhu 2006, table 3.1). */
double bench_zhu_fitness_midpoint(void);
double bench_zhu_fitness_line(void);
double bench_zhu_fitness_blx(void);
double bench_ga_fitness(void);

#endif
