/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What became of one take of a batch: a row of the summary, and a small file of its own, so that a batch that was stopped, or that
 * several machines share, knows what is done.
 */
#ifndef ENCODER_BATCH_RESULT_H
#define ENCODER_BATCH_RESULT_H

#include "encoder/run.h"

/* Columns of the summary, in order; then what says which take it was made of. X(name, heading) */
#define RESULT_FIELDS(X)                                                                                     \
    X(take, "take")                                                                                          \
    X(status, "status")                                                                                      \
    X(format, "format")                                                                                      \
    X(points, "points")                                                                                      \
    X(take_frames, "take frames")                                                                            \
    X(take_rate_hz, "take Hz")                                                                               \
    X(length_s, "length, s")                                                                                 \
    X(frames, "frames")                                                                                      \
    X(rate_hz, "Hz")                                                                                         \
    X(faps, "FAPs")                                                                                          \
    X(samples_filled, "samples filled")                                                                      \
    X(gaps_left, "long gaps")                                                                                \
    X(head_rms_mm, "head rms, mm")                                                                           \
    X(neutral_s, "neutral, s")                                                                               \
    X(kbit_s, "kbit/s")                                                                                      \
    X(seconds, "took, s")                                                                                    \
    X(output, "output")                                                                                      \
    X(notes, "notes")                                                                                        \
    X(error, "error")

typedef enum result_field {
#define X(name, heading) RESULT_##name,
    RESULT_FIELDS(X)
#undef X
        RESULT_COLUMN_COUNT,
    RESULT_made_of = RESULT_COLUMN_COUNT, /* the take's size and time, the options */
    RESULT_FIELD_COUNT
} result_field;

enum { RESULT_VALUE_SIZE = 640 };

typedef struct result {
    char value[RESULT_FIELD_COUNT][RESULT_VALUE_SIZE];
} result;

/* What a status says. A worker that was shot tells nothing about its take: the next batch tries again. */
extern const char result_encoded[], result_failed[], result_no_take[], result_ended[];

/* "take_rate_hz" and "take Hz". */
const char *result_field_name(result_field field);
const char *result_heading(result_field field);

void result_set(result *r, result_field field, const char *fmt, ...) __attribute__((format(printf, 3, 4)));
/* From what fapenc found out; @err is what run() returned. */
void result_fill(result *r, const run_report *rep, fap_err err);

/* 0: errno says why. */
int result_write(const result *r, const char *path);
/* 0: there is none, or it is no result. */
int result_read(result *r, const char *path);

#endif
