/* SPDX-License-Identifier: BSD-2-Clause */
/* Which output frames are shown: all of a range, or some moments spread evenly over it. */
#ifndef PLAYER_PLAN_H
#define PLAYER_PLAN_H

#include <stdint.h>

typedef struct frame_plan {
    int64_t from, to; /* half-open, from < to */
    int64_t count;    /* shown frames, 1 to to - from */
} frame_plan;

/* @moments: 0 shows every frame. More moments than frames show every frame once. */
frame_plan frame_plan_make(int64_t from, int64_t to, int64_t moments);
/* The output frame shown as the @i-th: the middle of the i-th of count equal parts of the range. */
int64_t frame_plan_at(const frame_plan *plan, int64_t i);

#endif
