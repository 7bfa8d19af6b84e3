/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A whole stream in memory, asked for any time: what is shown is a function of time alone, so that pausing,
 * seeking, dropping frames and testing are one operation.
 */
#ifndef PLAYER_TIMELINE_H
#define PLAYER_TIMELINE_H

#include <stddef.h>
#include <stdint.h>

#include <fap/frame.h>

#include "common/streams.h"

enum { TIMELINE_MAX_FRAMES = 1 << 19 }; /* 5.8 hours at 25 Hz, 200 MB */

typedef struct timeline {
    fap_frame *frame; /* [count], times never go back; what could be derived is derived; where an .fba skips
                         frames, the one before stands a second time in front of the next */
    uint32_t *bits;   /* [count]: that an .fba spent on each; 0 for text */
    size_t count, capacity;
    double rate_hz; /* the stream's own */
    int64_t end_us; /* when the last frame is over */
} timeline;

/*
 * Reads a stream of either kind. Malformed or empty ones and those past the limits fail and leave @t empty.
 * @options  how the stream is read; its table also serves FAPs that no frame carries
 * @summary  filled: what was read, and the deviations that were tolerated
 * @where    FAP_ERROR_TEXT_SIZE bytes: place and reason; of the first broken plane when all went well
 */
fap_err timeline_load(timeline *t, const uint8_t *data, size_t size, const stream_options *options,
                      stream_summary *summary, char *where);
void timeline_free(timeline *t);

/* How many frames of @rate_hz begin before the stream is over. At the stream's own rate: as many as it has.
 */
int64_t timeline_frame_count(const timeline *t, double rate_hz);
/* The same of anything that lasts @length_us; at least 1. */
int64_t timeline_count_frames(int64_t length_us, double rate_hz);
/* When output frame @k begins, microseconds. */
int64_t timeline_time_us(int64_t k, double rate_hz);
/* Kbit/s of an .fba over the second before @time_us, or over what there is of it; 0 for text. */
double timeline_kbit_s(const timeline *t, int64_t time_us);
/*
 * The face at @time_us, which may lie outside the stream (the first or last frame then). Values are
 * interpolated linearly; states, viseme and expression are those of the stream's frame before. pts_us is
 * @time_us.
 */
void timeline_sample(const timeline *t, int64_t time_us, fap_frame *out);

#endif
