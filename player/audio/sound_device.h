/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Something that sound is played on: it asks for samples whenever it needs some, from a thread of its own. One driver file
 * (device_sdl.c); tests bring one that asks when they say so.
 */
#ifndef PLAYER_AUDIO_SOUND_DEVICE_H
#define PLAYER_AUDIO_SOUND_DEVICE_H

#include <stdint.h>

#include <fap/error.h>

typedef struct sound_device_setup {
    int rate_hz, channels;
    /* Fills @out[frames][channels]; between lock and unlock, only while running. */
    void (*fill)(void *user, int16_t *out, int frames);
    void *user;
} sound_device_setup;

typedef struct sound_device_driver {
    void (*run)(void *state, int running); /* opened not running */
    void (*lock)(void *state);             /* keeps fill out */
    void (*unlock)(void *state);
    void (*close)(void *state);
} sound_device_driver;

typedef struct sound_device {
    const sound_device_driver *driver;
    void *state;
    char name[64];
    /* From asking for samples until the first of them is heard: what is queued in front of them. */
    int64_t delay_us;
} sound_device;

/* FAP_E_UNSUPPORTED: there is none, or this build has no driver; @where (FAP_ERROR_TEXT_SIZE bytes) says which. */
fap_err sound_device_open(sound_device *d, const sound_device_setup *setup, char *where);

#endif
