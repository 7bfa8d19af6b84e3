/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What figures of streams are measured on: the real .fap streams of 10 seconds or more beside the project, found
 * at run time, else the demo take; and the face that errors are measured on.
 */
#ifndef TESTS_BENCH_TAKES_H
#define TESTS_BENCH_TAKES_H

#include <fap/bank.h>
#include <fap/encoder.h>
#include <fap/frame.h>

enum { BENCH_MAX_TAKES = 32 };

/* Frames, and room for the stream that they make. */
typedef struct bench_take {
    char name[64];
    fap_frame *frame;
    int count, room;
    double rate_hz;
    uint8_t *data;
    size_t size, data_room;
} bench_take;

typedef struct bench_takes {
    bench_take take[BENCH_MAX_TAKES];
    int count;
} bench_takes;

/* Told of every packet of a stream. */
typedef struct bench_packet_sink {
    void (*put)(void *user, size_t size, int frames);
    void *user;
} bench_packet_sink;

/* Adds the takes there are; none where not even the demo take is. */
void bench_takes_add(bench_takes *t);
/* Adds the streams however short they are, and the demo take. */
void bench_takes_add_every(bench_takes *t);
/* Adds 58 FAPs that never rest: 6,000 frames of sines. */
void bench_takes_add_waves(bench_takes *t);
void bench_takes_free(bench_takes *t);

/* 0: no memory. */
int bench_take_add_frame(bench_take *t, const fap_frame *f);
/* Room for @p more bytes behind what is there. 0: no memory. */
int bench_take_reserve(bench_take *t, size_t more);
/* A sink of bytes, user is the take: appends. */
int bench_take_write(void *user, const void *data, size_t size);
/* From the first frame to the end of the last. */
double bench_take_length_s(const bench_take *t);

/* The whole stream into the take's bytes, at the take's own rate. @p packet: NULL, or told the size and the frames
 * of each packet. 0: it failed. */
int bench_take_encode(bench_take *t, const fap_encoder_config *cfg, const bench_packet_sink *packet);

/* build/default.fbank where it was made, else the built-in face; NULL without memory. */
fap_bank *bench_bank(void);

#endif
