/* SPDX-License-Identifier: BSD-2-Clause */
/* Poses every frame and keeps nothing: for timing, and to see whether a stream plays at all. */
#include "player/sinks/sink.h"

static int open_nothing(void *state, const sink_setup *setup, fault *f)
{
    (void)state, (void)setup, (void)f;
    return 1;
}

static int show_nothing(void *state, const shown_frame *shown, fault *f)
{
    (void)state, (void)shown, (void)f;
    return 1;
}

static int finish_nothing(void *state, sink_result *result, fault *f)
{
    (void)state, (void)result, (void)f;
    return 1;
}

static void close_nothing(void *state)
{
    (void)state;
}

const play_sink sink_null = {
    .name = "null",
    .summary = "null, NAME.null     poses every frame, keeps nothing",
    .state_size = 1,
    .open = open_nothing,
    .show = show_nothing,
    .finish = finish_nothing,
    .close = close_nothing,
};
