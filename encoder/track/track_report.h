/* SPDX-License-Identifier: BSD-2-Clause */
/* What fapenc track tells: words on standard error, or JSON on standard output. */
#ifndef ENCODER_TRACK_TRACK_REPORT_H
#define ENCODER_TRACK_TRACK_REPORT_H

#include "encoder/track/follow.h"
#include "encoder/track/track_options.h"

/* A video from its dots to its take. */
typedef struct track_work {
    const track_options *opt;
    fap_track_dots dots;
    fap_camera camera; /* as it was used: of the video's size */
    int camera_known;
    int ruler[2]; /* dots; -1: there is none */
    video_in video;
    overlay over;
    followed seen;
    fap_tracks_report report;
    fap_take *take;
} track_work;

void track_report_say(const track_work *w);
void track_report_json(const track_work *w);

#endif
