/* SPDX-License-Identifier: BSD-2-Clause */
/* How far the places of a take are from the truth, wherever the camera stood: after the one rigid motion that suits the whole take
 * best. Its size is not touched: a wrong ruler shows. */
#ifndef TESTS_TRACK_COMPARE_H
#define TESTS_TRACK_COMPARE_H

#include <fap/studio/take.h>

typedef struct take_difference {
    double rms_mm, p95_mm, max_mm;
    char worst[FAP_TAKE_NAME_SIZE]; /* the point of the largest, and when */
    double worst_s;
    uint32_t points, samples, missing; /* compared; and of the same points and times, what @got has not */
} take_difference;

/* Points are paired by name, frames by time, the ruler's ends left out. 0: nothing to compare, or no memory. */
int take_compare(const fap_take *truth, const fap_take *got, take_difference *d);

#endif
