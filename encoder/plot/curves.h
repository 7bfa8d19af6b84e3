/* SPDX-License-Identifier: BSD-2-Clause */
/* FAPs over time: a panel for each part of the face that moves. */
#ifndef ENCODER_PLOT_CURVES_H
#define ENCODER_PLOT_CURVES_H

#include "common/canvas/canvas.h"
#include "encoder/plot/plot.h"

/* Pixels that the panels need, and the panels from @y on. There is a frame at least. */
int curves_height(const plot_content *p);
fap_err curves_draw(canvas *c, const plot_content *p, double y, int width);

#endif
