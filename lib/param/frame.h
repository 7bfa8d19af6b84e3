/* SPDX-License-Identifier: BSD-2-Clause */
/* What the codecs ask of a frame before they write it, and do to it before they show it. */
#ifndef LIB_PARAM_FRAME_H
#define LIB_PARAM_FRAME_H

#include <fap/frame.h>

enum { FRAME_STRENGTH_MAX = 63 }; /* viseme_blend and expression_intensity */

int fap_viseme_is_sound(const fap_viseme *v);
int fap_expression_is_sound(const fap_expression *e);

/* Viseme and expression, where coded, are within their ranges. */
int fap_frame_is_sound(const fap_frame *f);
/* FAPs that are known become held: what the next plane does not code stays so. */
void fap_frame_hold(fap_frame *f);

#endif
