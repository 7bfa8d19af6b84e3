/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A sound that is the time: what has been handed to the device, less what is still queued there, moved on by the time since.
 * Names no sound library. At other speeds the sound is resampled, so its pitch follows; slower than half and faster than
 * twice it is silent, because nothing can be understood there, and still is the time.
 */
#ifndef PLAYER_AUDIO_SOUND_CLOCK_H
#define PLAYER_AUDIO_SOUND_CLOCK_H

#include "player/audio/play_clock.h"
#include "player/audio/sound_device.h"

typedef struct sound_clock sound_clock;

/* In two steps, because a device wants to know whom to ask. @s is taken over, also on failure. FAP_E_NOMEM. */
fap_err sound_clock_create(sound_clock **c, sound *s, double offset_ms, time_source now_us);
/* @device is taken over. */
void sound_clock_attach(sound_clock *c, const sound_device *device);
void sound_clock_destroy(void *c);

/* What the device asks for samples: sound_device_setup.fill. */
void sound_clock_fill(void *c, int16_t *out, int frames);

extern const play_clock_kind sound_clock_kind;

#endif
