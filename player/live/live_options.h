/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapplay --send and --listen. */
#ifndef PLAYER_LIVE_LIVE_OPTIONS_H
#define PLAYER_LIVE_LIVE_OPTIONS_H

#include "player/sinks/csv.h"
#include "player/sinks/sink.h"

typedef struct live_options {
    const char *send, *listen; /* an URL; one of both. listen: or a description's file */
    const char *stream;        /* to send */
    const char *sdp;           /* of send: a description to be written; NULL: none */
    const char *output;        /* of listen; NULL: null */
    const char *bank;
    const play_sink *sink;
    const struct csv_kind *csv;
    double max_error_mm, seconds; /* seconds: 0: until the stream ends, or for ever */
    int intra;                    /* 0: one a second */
    int aggregate, redundancy, delay_ms, any_source, loop, json;
    int exit_status; /* when parsing says to stop */
} live_options;

/* 1: the command line is one of ours. */
int live_options_are(int argc, char **argv);
/* 0: stop with exit_status; help or what is wrong has been printed. */
int live_options_parse(live_options *o, int argc, char **argv);

#endif
