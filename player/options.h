/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapplay. */
#ifndef PLAYER_OPTIONS_H
#define PLAYER_OPTIONS_H

#include <stdint.h>

#include <fap/face.h>

#include "player/dress.h"
#include "player/lines.h"
#include "player/render/renderer.h"
#include "player/sinks/sink.h"

enum { PLAY_MAX_MOMENTS = 1024 };

typedef struct play_options {
    const char *stream; /* "-": standard input */
    const char *bank;   /* NULL: find the default face; "builtin" */
    const char *fit;    /* NULL: the one beside the stream, if any */
    const char *output, *golden, *audio;
    const play_sink *sink;      /* NULL: the window */
    const struct csv_kind *csv; /* --csv */
    fap_face_config face;
    const char *gl; /* how to draw without a window; NULL: what works */
    dress_options dress;
    render_camera camera;
    int width, height;
    double rate_hz;   /* 0: the stream's */
    int has_range;    /* --frames */
    int64_t from, to; /* to is INT64_MAX where it was left open */
    int moments;      /* --sheet; 0: none */
    int y4m;          /* what goes to standard output is video */
    int update, tolerance;
    double audio_offset_ms;       /* of the window: how much later the sound begins than the stream */
    int loop, paused, fullscreen; /* how the window begins */
    line_options lines;
    int json, quiet;
    char why[FAP_ERROR_TEXT_SIZE]; /* the last value was refused; "": for not being what is expected */
    int exit_status;               /* when parsing says not to run */
} play_options;

/* 1: run. 0: leave with exit_status; --help, --version or what is wrong has been printed. */
int play_options_parse(play_options *o, int argc, char **argv);

#endif
