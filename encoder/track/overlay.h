/* SPDX-License-Identifier: BSD-2-Clause */
/* The video again, with a ring round every dot: green where it was seen, yellow where it should be, red where it was lost. */
#ifndef ENCODER_TRACK_OVERLAY_H
#define ENCODER_TRACK_OVERLAY_H

#include <fap/studio/track.h>

#include "common/child_pipe.h"
#include "common/fault.h"
#include "common/file.h"

typedef struct overlay {
    const char *path; /* NULL: there is none, and everything below does nothing */
    double rate_hz;
    int width_px, height_px;
    out_file file;
    child_pipe pipe;
    uint8_t *rgb;
} overlay;

/* Nothing is opened before the first picture, whose size it has. */
overlay overlay_of(const char *path, double rate_hz);
/* 0: @f says why. */
int overlay_draw(overlay *o, const fap_picture *picture, const fap_tracker *t, int count, fault *f);
int overlay_finish(overlay *o, fault *f);
/* Harmless after overlay_finish(). */
void overlay_close(overlay *o);

#endif
