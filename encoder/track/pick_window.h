/* SPDX-License-Identifier: BSD-2-Clause */
/* The window in which dots are shown. */
#ifndef ENCODER_TRACK_PICK_WINDOW_H
#define ENCODER_TRACK_PICK_WINDOW_H

#include <fap/studio/track.h>

#include "common/fault.h"
#include "encoder/track/pick.h"

/* Until it is finished. 0: it was closed before, or there is no window to be had; @f says so. */
int pick_window_run(pick *p, const fap_picture *picture, fault *f);

#endif
