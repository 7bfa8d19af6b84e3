/* SPDX-License-Identifier: BSD-2-Clause */
/* stream -> timeline -> face -> sink. Prints nothing but a progress bar, and that it waits for a trigger. */
#ifndef PLAYER_RUN_H
#define PLAYER_RUN_H

#include "player/options.h"
#include "player/report.h"

/* What went wrong is in the report's fault. */
void play_run(const play_options *o, play_report *r);

#endif
