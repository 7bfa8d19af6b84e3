/* SPDX-License-Identifier: BSD-2-Clause */
/* fapplay --send and --listen: a stream over RTP. */
#ifndef PLAYER_LIVE_LIVE_H
#define PLAYER_LIVE_LIVE_H

#include "common/fault.h"
#include "player/live/live_options.h"

/* @return the exit status */
int live_run(int argc, char **argv);

/* Both print their report. 0: the fault says why. */
int live_send(const live_options *o, fault *f);
int live_listen(const live_options *o, fault *f);

#endif
