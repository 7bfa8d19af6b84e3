/* SPDX-License-Identifier: BSD-2-Clause */
/* Exports whose size goes with frames times vertices are refused before the first byte, not when the disk is full. */
#ifndef PLAYER_SINKS_EXPORT_LIMIT_H
#define PLAYER_SINKS_EXPORT_LIMIT_H

#include "common/fault.h"
#include "player/sinks/sink.h"

/* 1: @size bytes are not too many. 0: they are, and @f says what would be fewer. */
int export_fits(const sink_setup *setup, double size, fault *f);

#endif
