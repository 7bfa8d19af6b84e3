/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The sound device of this machine through SDL2's audio subsystem; this file alone names SDL. SDL does not tell how long a device
 * queues, so it is taken for what its drivers ask of devices: two buffers, one heard while the other is filled. The drivers
 * "dummy" and "disk" (SDL_AUDIODRIVER) queue nothing and pace in real time without a sound card.
 */
#include <stdio.h>

#include "player/audio/sound_device.h"

#ifdef HAVE_SDL2

#include <stdlib.h>
#include <string.h>

#define SDL_MAIN_HANDLED
#include <SDL.h>

typedef struct sdl_state {
    SDL_AudioDeviceID id;
    sound_device_setup setup;
} sdl_state;

static void fill(void *user, Uint8 *out, int size)
{
    const sdl_state *s = user;
    const int frame_size = s->setup.channels * (int)sizeof(int16_t);

    s->setup.fill(s->setup.user, (int16_t *)(void *)out, size / frame_size);
}

static void sdl_run(void *state, int running)
{
    SDL_PauseAudioDevice(((sdl_state *)state)->id, !running);
}

static void sdl_lock(void *state)
{
    SDL_LockAudioDevice(((sdl_state *)state)->id);
}

static void sdl_unlock(void *state)
{
    SDL_UnlockAudioDevice(((sdl_state *)state)->id);
}

static void sdl_close(void *state)
{
    sdl_state *s = state;

    if (s->id)
        SDL_CloseAudioDevice(s->id);
    SDL_QuitSubSystem(SDL_INIT_AUDIO);
    free(s);
}

static const sound_device_driver sdl_driver = { sdl_run, sdl_lock, sdl_unlock, sdl_close };

/* A power of two, as drivers like it, of 16 to 32 ms: short enough that a seek is heard at once. */
static int buffer_frames(int rate_hz)
{
    int frames = 64;

    while (frames < rate_hz / 64 && frames < 8192)
        frames *= 2;
    return frames;
}

static int queues_nothing(const char *driver)
{
    return !strcmp(driver, "dummy") || !strcmp(driver, "disk");
}

static fap_err open_device(sound_device *d, sdl_state *s)
{
    const SDL_AudioSpec want = {
        .freq = s->setup.rate_hz,
        .format = AUDIO_S16SYS,
        .channels = (Uint8)s->setup.channels,
        .samples = (Uint16)buffer_frames(s->setup.rate_hz),
        .callback = fill,
        .userdata = s,
    };
    SDL_AudioSpec got;

    s->id = SDL_OpenAudioDevice(NULL, 0, &want, &got, 0); /* 0: SDL converts to what the device can */
    if (!s->id)
        return FAP_E_UNSUPPORTED;
    const char *driver = SDL_GetCurrentAudioDriver();
    snprintf(d->name, sizeof d->name, "%s", driver);
    d->delay_us = queues_nothing(driver) ? 0 : INT64_C(1000000) * got.samples / got.freq;
    return FAP_OK;
}

fap_err sound_device_open(sound_device *d, const sound_device_setup *setup, char *where)
{
    *d = (sound_device){ 0 };
    sdl_state *s = calloc(1, sizeof *s);
    if (!s)
        return FAP_E_NOMEM;
    s->setup = *setup;
    if (SDL_InitSubSystem(SDL_INIT_AUDIO)) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "no sound device: %s", SDL_GetError());
        free(s);
        return FAP_E_UNSUPPORTED;
    }
    *d = (sound_device){ .driver = &sdl_driver, .state = s };
    if (open_device(d, s) == FAP_OK)
        return FAP_OK;
    snprintf(where, FAP_ERROR_TEXT_SIZE, "no sound device: %s", SDL_GetError());
    sdl_close(s);
    *d = (sound_device){ 0 };
    return FAP_E_UNSUPPORTED;
}

#else

fap_err sound_device_open(sound_device *d, const sound_device_setup *setup, char *where)
{
    (void)setup;
    *d = (sound_device){ 0 };
    snprintf(where, FAP_ERROR_TEXT_SIZE, "this fapplay was built without SDL2");
    return FAP_E_UNSUPPORTED;
}

#endif
