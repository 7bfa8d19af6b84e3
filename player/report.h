/* SPDX-License-Identifier: BSD-2-Clause */
/* What a run did, and how it is told: in one line for people, in JSON for programs. */
#ifndef PLAYER_REPORT_H
#define PLAYER_REPORT_H

#include <stdint.h>

#include "common/fault.h"
#include "player/options.h"
#include "player/window/session.h"

enum { REPORT_MAX_NOTES = 32, REPORT_TEXT_SIZE = 256 };

/* What a window did. */
typedef struct window_report {
    char clock[16];                         /* "sound" or "monotonic" */
    double av_offset_ms, av_offset_mean_ms; /* between clock and picture as it was seen, at speed 1 */
    session session;                        /* as it was left */
    int screenshot_count;
    char screenshot[REPORT_TEXT_SIZE]; /* the last one */
} window_report;

typedef struct play_report {
    fault fault;
    char note[REPORT_MAX_NOTES][REPORT_TEXT_SIZE]; /* for people, in the order of happening */
    int note_count;
    char face[REPORT_TEXT_SIZE];     /* name of the bank */
    char renderer[REPORT_TEXT_SIZE]; /* "" where no pictures were made */
    int64_t stream_frames, shown_frames;
    double stream_rate_hz, stream_s, rate_hz, sound_s;
    double error_mm, residual_mm; /* largest RMS of a shown frame: before, after the residual */
    int triggers;                 /* edges that started something */
    double trigger_ms;            /* from the last one to the first frame shown */
    sink_result result;
    window_report window; /* where o->sink is NULL */
} play_report;

void play_report_note(play_report *r, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
/* Words the result and returns the exit status. */
int play_report_print(const play_report *r, const play_options *o);

#endif
