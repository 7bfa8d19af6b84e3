/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What a person does to a playing face, and what comes of it: actions in, state out. Knows no window, no key and no line of
 * a chip, so all of them act alike and tests need none. The clock alone says where playing is.
 */
#ifndef PLAYER_WINDOW_SESSION_H
#define PLAYER_WINDOW_SESSION_H

#include <stdint.h>

#include <fap/face.h>

#include "player/audio/play_clock.h"
#include "player/render/view.h"

typedef enum play_action {
    PLAY_NOTHING,
    PLAY_PAUSE,      /* and go on again; behind the end: from the beginning */
    PLAY_START,      /* not when playing already */
    PLAY_STOP,       /* pause, whatever was before */
    PLAY_STEP,       /* value: frames, negative goes back; pauses */
    PLAY_SEEK,       /* value: seconds from the beginning */
    PLAY_SKIP,       /* value: seconds from here */
    PLAY_NEXT,       /* from the beginning, playing */
    PLAY_SPEED,      /* value: the factor */
    PLAY_SPEED_STEP, /* value: steps along the usual factors */
    PLAY_LOOP,       /* on or off, like all below that take no value */
    PLAY_CAMERA,     /* value: a render_camera */
    PLAY_ORBIT,      /* value, other: degrees to the right, up */
    PLAY_PAN,        /* value, other: halves of the picture's height to the right, up */
    PLAY_ZOOM,       /* value: steps nearer */
    PLAY_RESET_VIEW,
    PLAY_WIREFRAME,
    PLAY_POINTS,
    PLAY_BARS,
    PLAY_PANELS,
    PLAY_HELP,
    PLAY_BLEND,      /* value: a fap_blend */
    PLAY_NEXT_BLEND, /* of those the library has, in its order */
    PLAY_EXPRESSION, /* value: of FAP 2, 1 joy to 6 surprise; 0, or the one that is shown: none */
    PLAY_FULLSCREEN,
    PLAY_SCREENSHOT,
    PLAY_QUIT, /* value: 1 closes the help instead where it is open */
    PLAY_ACTION_COUNT
} play_action;

typedef struct play_event {
    play_action action;
    double value, other;
} play_event;

typedef struct session {
    const play_clock *clock; /* borrowed */
    double rate_hz;
    int64_t frame_count, length_us;

    int playing, loop;
    double speed;
    int64_t at_us; /* what is shown, 0 to length_us */
    render_view view;
    int camera; /* the fixed view that @view is; -1: none any more */
    int wireframe, points, bars, panels, help, fullscreen;
    fap_blend blend;
    int expression; /* 0: the stream's */

    int64_t late_frames; /* of the stream, never shown because the time went past them */
    int64_t loops;       /* how often it began again */
    int64_t ends;        /* how often the end came, with a loop or without */
    int screenshots;     /* asked for and not yet taken; the window counts down */
    int quit;
} session;

/* Paused at the beginning. @rate_hz: what steps and frame numbers go by. */
void session_open(session *s, const play_clock *clock, int64_t length_us, double rate_hz);
/* Another stream, or another clock: at the beginning, playing as before. The rest stays. */
void session_change(session *s, const play_clock *clock, int64_t length_us, double rate_hz);

void session_act(session *s, play_event event);
/*
 * Looks at the clock. @ahead_us: how long it takes from here until the picture is seen, so that it shows the time of then.
 * At the end the last frame stays, or with loop it all begins again.
 */
void session_tick(session *s, int64_t ahead_us);

/* The frame that is shown, 0 to frame_count - 1. */
int64_t session_frame(const session *s);

#endif
