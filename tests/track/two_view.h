/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Places from two views of which nothing is known but the lens: the general way that Lin, Yeh, Ouhyoung 2001, section 4.3, compare
 * mirrors with. Normalised eight points (Hartley 1995), the essential matrix taken apart (Longuet-Higgins 1981), points midway
 * between rays. A mirrored picture becomes that of a second camera when left and right are exchanged.
 */
#ifndef TESTS_TRACK_TWO_VIEW_H
#define TESTS_TRACK_TWO_VIEW_H

#include <fap/studio/mirror.h>

/* The second camera: place2 = turn place1 + shift, the shift of length 1. */
typedef struct two_view {
    double turn[3][3], shift[3];
} two_view;

/* @pair: 8 at least; the mirrored halves as they appear, not exchanged. 0: no camera has the points before it. */
int two_view_find(two_view *v, const fap_mirror_pair *pair, int count);
/* In coordinates of the first camera, in units of the shift. 0: the rays do not meet before both. */
int two_view_place(const two_view *v, const fap_mirror_pair *pair, double place[3]);

#endif
