/* SPDX-License-Identifier: BSD-2-Clause */
/* Where the markers of a capture sit on the face. */
#ifndef ENCODER_PLOT_MAP_H
#define ENCODER_PLOT_MAP_H

#include "common/canvas/canvas.h"
#include "encoder/plot/plot.h"

enum { MAP_HEIGHT_PX = 640 };

/* The face from the front and from the side with its markers, from @y on, MAP_HEIGHT_PX high. @where: FAP_ERROR_TEXT_SIZE bytes. */
fap_err map_draw(canvas *c, const plot_content *p, double y, int width, char *where);

#endif
