/* SPDX-License-Identifier: BSD-2-Clause */
/* A whole video's worth of dots: where each was in every picture. */
#ifndef ENCODER_TRACK_FOLLOW_H
#define ENCODER_TRACK_FOLLOW_H

#include <fap/studio/tracks.h>

#include "common/fault.h"
#include "encoder/track/overlay.h"
#include "encoder/track/video_in.h"

typedef struct followed {
    uint32_t frames;
    int width_px, height_px;
    fap_track_point *point; /* [frames][dots * FAP_TRACKS_VIEWS] */
    uint64_t busy_us;       /* what following alone took */
} followed;

/* @overlay may be closed. 0: @f says why; nothing is to be freed then. */
int follow(followed *out, video_in *v, const fap_track_dots *dots, double radius_px, overlay *o, fault *f);
void followed_free(followed *out);

#endif
