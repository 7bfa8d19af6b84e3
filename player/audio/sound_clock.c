/* SPDX-License-Identifier: BSD-2-Clause */
/* See sound_clock.h. Places are frames of the sound: at speed 1 they are whole, and samples pass unchanged. */
#include <math.h>
#include <stdlib.h>

#include "player/audio/sound_clock.h"

static const double slowest_heard = 0.5, fastest_heard = 2;

struct sound_clock {
    sound sound;
    sound_device device;
    time_source now_us;
    double offset_us;
    int running;
    double speed;
    double next;  /* place handed out next */
    double least; /* the clock is not in front of this: where it started, then what it said last */
    /* The buffer that was handed out last. */
    int has_buffer;
    double buffer_start, buffer_length, buffer_speed;
    int64_t buffer_us; /* when it was asked for */
};

/* The first that is not in front of it: who seeks to a frame does not find the one before. */
static double place_of(const sound_clock *c, int64_t position_us)
{
    const double rounding = 1e-6;
    return ceil(((double)position_us - c->offset_us) * 1e-6 * c->sound.rate_hz - rounding);
}

static int64_t position_of(const sound_clock *c, double place)
{
    return (int64_t)llround(place / c->sound.rate_hz * 1e6 + c->offset_us);
}

/* --- on the device's thread --- */

/* Silence in front of the sound and behind it. */
static double sample_at(const sound *s, double frame, int channel)
{
    if (frame < 0 || frame >= (double)s->frame_count)
        return 0;
    return s->sample[(int64_t)frame * s->channels + channel];
}

/* The line between the samples on either side. */
static int16_t sample_between(const sound *s, double place, int channel)
{
    const double whole = floor(place), share = place - whole;
    const double a = sample_at(s, whole, channel);

    return (int16_t)lround(share > 0 ? a + (sample_at(s, whole + 1, channel) - a) * share : a);
}

void sound_clock_fill(void *state, int16_t *out, int frames)
{
    sound_clock *c = state;
    const int heard = c->speed >= slowest_heard && c->speed <= fastest_heard;

    for (int i = 0; i < frames; i++)
        for (int k = 0; k < c->sound.channels; k++)
            *out++ = heard ? sample_between(&c->sound, c->next + i * c->speed, k) : 0;
    c->has_buffer = 1;
    c->buffer_start = c->next;
    c->buffer_length = frames * c->speed;
    c->buffer_speed = c->speed;
    c->buffer_us = c->now_us();
    c->next += c->buffer_length;
}

/* --- on the player's thread, the device's kept out --- */

/* What is heard now. A device that asks late holds the time: nothing is heard then. */
static double heard_place(sound_clock *c)
{
    if (c->running && c->has_buffer) {
        const double per_us = c->buffer_speed * c->sound.rate_hz * 1e-6;
        const double since = fmin((double)(c->now_us() - c->buffer_us) * per_us, c->buffer_length);
        const double place = c->buffer_start + since - (double)c->device.delay_us * per_us;
        c->least = fmax(c->least, place);
    }
    return c->least;
}

/* What is handed out next and heard next are the same again. */
static void go_on_from(sound_clock *c, double place)
{
    c->next = c->least = floor(place);
    c->has_buffer = 0;
}

static void lock(sound_clock *c)
{
    c->device.driver->lock(c->device.state);
}

static void unlock(sound_clock *c)
{
    c->device.driver->unlock(c->device.state);
}

static int64_t sound_position_us(void *state)
{
    sound_clock *c = state;

    lock(c);
    const double place = heard_place(c);
    unlock(c);
    return position_of(c, place);
}

static void set_running(sound_clock *c, int running)
{
    lock(c);
    go_on_from(c, heard_place(c));
    c->running = running;
    unlock(c);
    c->device.driver->run(c->device.state, running);
}

static void sound_start(void *state)
{
    if (!((sound_clock *)state)->running)
        set_running(state, 1);
}

static void sound_pause(void *state)
{
    set_running(state, 0);
}

static void sound_seek(void *state, int64_t position_us)
{
    sound_clock *c = state;

    lock(c);
    go_on_from(c, place_of(c, position_us));
    unlock(c);
}

/* The buffers that are on their way keep theirs. */
static void sound_set_speed(void *state, double speed)
{
    sound_clock *c = state;

    lock(c);
    heard_place(c);
    c->speed = speed;
    c->next = floor(c->next);
    unlock(c);
}

const play_clock_kind sound_clock_kind = {
    .name = "sound",
    .position_us = sound_position_us,
    .start = sound_start,
    .pause = sound_pause,
    .seek = sound_seek,
    .set_speed = sound_set_speed,
    .close = sound_clock_destroy,
};

/* --- from and to nothing --- */

fap_err sound_clock_create(sound_clock **out, sound *s, double offset_ms, time_source now_us)
{
    sound_clock *c = *out = calloc(1, sizeof *c);

    if (!c) {
        sound_free(s);
        return FAP_E_NOMEM;
    }
    *c = (sound_clock){ .sound = *s, .now_us = now_us, .offset_us = offset_ms * 1000, .speed = 1 };
    *s = (sound){ 0 };
    go_on_from(c, place_of(c, 0));
    return FAP_OK;
}

void sound_clock_attach(sound_clock *c, const sound_device *device)
{
    c->device = *device;
}

void sound_clock_destroy(void *state)
{
    sound_clock *c = state;

    if (c->device.driver)
        c->device.driver->close(c->device.state);
    sound_free(&c->sound);
    free(c);
}

fap_err play_clock_sound(play_clock *out, sound *s, double offset_ms, char *where)
{
    sound_clock *c;
    sound_device device;
    const int rate_hz = s->rate_hz, channels = s->channels;

    *out = (play_clock){ 0 };
    fap_err err = sound_clock_create(&c, s, offset_ms, monotonic_us);
    if (err)
        return err;
    err = sound_device_open(&device, &(sound_device_setup){ rate_hz, channels, sound_clock_fill, c }, where);
    if (err) {
        sound_clock_destroy(c);
        return err;
    }
    sound_clock_attach(c, &device);
    *out = (play_clock){ &sound_clock_kind, c };
    return FAP_OK;
}
