/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Landmarks as fractions of a picture, MediaPipe's way: x and z count widths, y counts heights. Before a length can be
 * measured the picture's shape must be known.
 */
#ifndef LIB_TAKE_PICTURE_H
#define LIB_TAKE_PICTURE_H

#include "take/take_driver.h"

/* Whether the points are MediaPipe's face, 468 or with pupils 478, and count parts of a picture, not pixels. */
int picture_is_fractions(const fap_take *take);
/*
 * Makes y count widths too. @p height_per_width: 0 where the file does not say it; then the usual shape is taken that
 * gives the face a face's proportions, and a note says so.
 */
void picture_settle(fap_take *take, double height_per_width);

#endif
