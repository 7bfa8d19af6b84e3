/* SPDX-License-Identifier: BSD-2-Clause */
/* The window. window_glfw.c alone names GLFW: events become actions, the scene is drawn, panels lie over it. */
#ifndef PLAYER_WINDOW_WINDOW_H
#define PLAYER_WINDOW_WINDOW_H

#include "player/options.h"
#include "player/report.h"

/* Until it is closed. What went wrong is in the report's fault; without a display it names -o. */
void window_run(const play_options *o, play_report *r);

#endif
