/* SPDX-License-Identifier: BSD-2-Clause */
/* See play_clock.h. The clock that only counts, and the calls that both share. */
#include <stdlib.h>
#include <time.h>

#include "player/audio/play_clock.h"

int64_t monotonic_us(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
}

typedef struct silent_clock {
    time_source now_us;
    int64_t base_us, since_us; /* position when the counting began, and when that was */
    double speed;
    int running;
} silent_clock;

static int64_t silent_position_us(void *state)
{
    const silent_clock *s = state;
    return s->running ? s->base_us + (int64_t)((double)(s->now_us() - s->since_us) * s->speed) : s->base_us;
}

/* Count from here on. */
static void count_from(silent_clock *s, int64_t position_us)
{
    s->base_us = position_us;
    s->since_us = s->now_us();
}

static void silent_start(void *state)
{
    silent_clock *s = state;

    count_from(s, silent_position_us(s));
    s->running = 1;
}

static void silent_pause(void *state)
{
    silent_clock *s = state;

    count_from(s, silent_position_us(s));
    s->running = 0;
}

static void silent_seek(void *state, int64_t position_us)
{
    count_from(state, position_us);
}

static void silent_set_speed(void *state, double speed)
{
    silent_clock *s = state;

    count_from(s, silent_position_us(s));
    s->speed = speed;
}

static const play_clock_kind silent_kind = {
    .name = "monotonic",
    .position_us = silent_position_us,
    .start = silent_start,
    .pause = silent_pause,
    .seek = silent_seek,
    .set_speed = silent_set_speed,
    .close = free,
};

fap_err play_clock_silent(play_clock *c, time_source now_us)
{
    silent_clock *s = calloc(1, sizeof *s);

    *c = (play_clock){ 0 };
    if (!s)
        return FAP_E_NOMEM;
    s->now_us = now_us;
    s->speed = 1;
    *c = (play_clock){ &silent_kind, s };
    return FAP_OK;
}

int64_t play_clock_position_us(const play_clock *c)
{
    return c->kind->position_us(c->state);
}

void play_clock_start(const play_clock *c)
{
    c->kind->start(c->state);
}

void play_clock_pause(const play_clock *c)
{
    c->kind->pause(c->state);
}

void play_clock_seek(const play_clock *c, int64_t position_us)
{
    c->kind->seek(c->state, position_us);
}

void play_clock_set_speed(const play_clock *c, double speed)
{
    c->kind->set_speed(c->state, speed);
}

void play_clock_close(play_clock *c)
{
    if (c->kind)
        c->kind->close(c->state);
    *c = (play_clock){ 0 };
}
