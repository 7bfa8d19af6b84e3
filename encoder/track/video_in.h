/* SPDX-License-Identifier: BSD-2-Clause */
/* Pictures of a video, by the programs ffprobe and ffmpeg behind pipes: whatever they can read. */
#ifndef ENCODER_TRACK_VIDEO_IN_H
#define ENCODER_TRACK_VIDEO_IN_H

#include <fap/studio/track.h>

#include "common/child_pipe.h"
#include "common/fault.h"
#include "encoder/track/track_options.h"

typedef struct video_in {
    const char *path;
    fap_picture picture; /* the last one; none before the first video_in_next() */
    double rate_hz;      /* pictures a second: twice the frames' where fields are followed */
    int fields;          /* 1: each picture is a field, made whole */
    int64_t expected;    /* pictures, as the file says; 0: it does not */
    uint32_t pictures;   /* so far */
    child_pipe pipe;
    uint8_t *rgb;
    size_t room;
} video_in;

/* 0: no such video, or ffmpeg is missing; @f says so. */
int video_in_open(video_in *v, const track_options *opt, fault *f);
/* The next picture: 1; 0 at the end and on a fault, which @f has. */
int video_in_next(video_in *v, fault *f);
/* Harmless when it was never opened. */
void video_in_close(video_in *v);

#endif
