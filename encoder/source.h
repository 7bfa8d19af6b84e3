/* SPDX-License-Identifier: BSD-2-Clause */
/* The frames to be written: a capture's, in memory, or a stream that is read again. */
#ifndef ENCODER_SOURCE_H
#define ENCODER_SOURCE_H

#include <stddef.h>

#include "common/streams.h"

typedef struct frame_source {
    const fap_frame *frames; /* NULL: the stream in @c data */
    size_t count;
    const uint8_t *data;
    size_t size;
    const stream_options *options;
    double rate_hz;
    int fill; /* frames that an .fba skipped are given too, as copies of the one before */
} frame_source;

/*
 * Every frame to @p put, in order. FAPs that the decoder derived or predicted count as coded: whoever reads what is
 * written need not be able to.
 */
fap_err frame_source_each(const frame_source *src, fap_err (*put)(void *user, const fap_frame *frame),
                          void *user);
/* How many that are. */
fap_err frame_source_count(const frame_source *src, int64_t *count);
/* All of them in one array to free(), also where @p src has one. */
fap_err frame_source_load(const frame_source *src, fap_frame **frames, size_t *count);

#endif
