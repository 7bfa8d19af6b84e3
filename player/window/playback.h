/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A scene that plays: what a window shows, without the window. Whoever draws it says when the picture was seen, and learns how
 * far picture and sound are apart.
 */
#ifndef PLAYER_WINDOW_PLAYBACK_H
#define PLAYER_WINDOW_PLAYBACK_H

#include "player/lines.h"
#include "player/scene.h"
#include "player/window/session.h"

enum { PLAYBACK_PATH_SIZE = 1024 };

typedef struct playback {
    const play_options *opt;
    play_report *report;
    scene scene;
    play_clock clock;
    session session;
    gpio_lines lines;
    int64_t told_ends;                                          /* of which the lines know */
    int armed;                                                  /* they are listened to */
    fap_face_config face;                                       /* the method in force */
    char stream[PLAYBACK_PATH_SIZE], sound[PLAYBACK_PATH_SIZE]; /* paths; sound is "" where there is none */
    unsigned bank_number;                                       /* changes with the bank */
    char message[REPORT_TEXT_SIZE];                             /* for the person, until then */
    int64_t message_until_us;

    int starts; /* when the first picture is seen: sound does not wait for shaders */
    int stale;  /* the pose is of before */
    int fresh;  /* nobody has seen it yet */
    int64_t posed_us;
    int posed_expression;
    int64_t ticked_us; /* when the clock was asked for the picture that is being drawn */
    double ahead_us;   /* how long pictures take from there until they are seen, smoothed */
    int64_t seen_count, measured_count;
    double offset_sum_ms;
} playback;

/* Loads what the options name; with a trigger it waits for that. 0: the report's fault says why not. */
int playback_open(playback *p, const play_options *o, play_report *r);
void playback_close(playback *p); /* also after a failed open; completes the report */

/* What came in by lines since the last time; nothing before the first picture is seen. How many actions that were. */
int playback_obey(playback *p);
/* Asks the clock, exchanges the face where another method was chosen, poses. 1: there is something new to see. */
int playback_advance(playback *p);
/* The picture of the last advance is seen now; the first one arms the lines. */
void playback_seen(playback *p);

/* Somebody outside may start it at any time: look often. */
int playback_listens(const playback *p);

/* Files that were dropped: streams, faces and sounds. A message says what became of them. */
void playback_drop(playback *p, int count, const char *const *paths);
/* What the person reads for some seconds; NULL: nothing now. */
const char *playback_message(const playback *p);
void playback_say(playback *p, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* Writes a picture under a name of its own: STREAM-FRAME.png, or STREAM-FRAME-2.png where that is taken. */
void playback_save(playback *p, const image *picture);

#endif
