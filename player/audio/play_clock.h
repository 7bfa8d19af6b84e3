/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Where playing is: one interface, two clocks. Where there is sound, what is heard is the time and pictures follow it; else a
 * clock that only counts. Positions are microseconds of stream time. Asking never waits, and a picture that comes late
 * changes nothing here: that is why dropped frames cannot delay sound.
 */
#ifndef PLAYER_AUDIO_PLAY_CLOCK_H
#define PLAYER_AUDIO_PLAY_CLOCK_H

#include <stdint.h>

#include "common/sound_file.h"

/* Microseconds that never go back, from any origin. Tests bring their own. */
typedef int64_t (*time_source)(void);
int64_t monotonic_us(void);

typedef struct play_clock_kind {
    const char *name; /* for reports */
    int64_t (*position_us)(void *state);
    void (*start)(void *state);
    void (*pause)(void *state);
    void (*seek)(void *state, int64_t position_us); /* running or not; it stays what it is */
    void (*set_speed)(void *state, double speed);
    void (*close)(void *state);
} play_clock_kind;

/* Opened paused at 0 with speed 1. */
typedef struct play_clock {
    const play_clock_kind *kind;
    void *state;
} play_clock;

/* Counts without a sound. FAP_E_NOMEM. */
fap_err play_clock_silent(play_clock *c, time_source now_us);
/*
 * Plays @s on the sound device of this machine.
 * @s          taken over, also on failure
 * @offset_ms  the sound begins that much after the stream; negative: before
 * FAP_E_UNSUPPORTED: no sound device, or a build without one; @where (FAP_ERROR_TEXT_SIZE bytes) says which.
 */
fap_err play_clock_sound(play_clock *c, sound *s, double offset_ms, char *where);

int64_t play_clock_position_us(const play_clock *c);
void play_clock_start(const play_clock *c);
void play_clock_pause(const play_clock *c);
void play_clock_seek(const play_clock *c, int64_t position_us);
/* @speed: PLAY_SLOWEST to PLAY_FASTEST */
void play_clock_set_speed(const play_clock *c, double speed);
void play_clock_close(play_clock *c); /* harmless on a zeroed one */

#define PLAY_SLOWEST 0.1
#define PLAY_FASTEST 4.0

#endif
