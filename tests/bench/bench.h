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

/* A value of one stream, printed behind the figure being measured: "# stream NAME VALUE UNIT". */
void bench_note(const char *stream, double value, const char *unit);

/* The middle one of @p value[count], which is sorted; the mean of the two where count is even. */
double bench_median(double *value, int count);

/* Seconds on a monotonic clock. */
double bench_now_s(void);

/* Seconds of take encoded in a second. */
double bench_encode_x_realtime(void);

/* Pictures a second of a moving face, and what the moving costs against a still one. */
double bench_play_fps(void);
double bench_render_overhead(void);

/* Frames of 58 FAPs that the .fap reader takes in a second. */
double bench_ascii_parse_fps(void);
double bench_ascii_write_fps(void);

/* Frames of real streams that the FBA codec writes and reads in a second; the same with 58 FAPs in motion. */
double bench_fba_decode_fps(void);
double bench_fba_encode_fps(void);
double bench_fba_decode_fps_58(void);
double bench_fba_encode_fps_58(void);
/* Kbit/s of real streams at three quantisers; the error at 2,000 bit/s, and the most bits in any 2 s there. */
double bench_fba_kbps_q1(void);
double bench_fba_kbps_q4(void);
double bench_fba_kbps_q8(void);
double bench_fba_kbps_2k_error_mm(void);
double bench_fba_2k_window_bits(void);
/* The same streams as text, packed by general tools. */
double bench_gzip_kbps(void);
double bench_xz_kbps(void);
/* Errors of feature points where units are lost. */
double bench_loss_error_mm_0(void);
double bench_loss_error_mm_5(void);
double bench_loss_error_mm_10(void);
double bench_loss_error_mm_20(void);
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
