/* SPDX-License-Identifier: BSD-2-Clause */
/* Sound files: whether they are any, how long, and their samples. sound_file.c alone names libsndfile. */
#ifndef COMMON_SOUND_FILE_H
#define COMMON_SOUND_FILE_H

#include <stddef.h>
#include <stdint.h>

#include <fap/error.h>

/* A whole sound in memory. */
typedef struct sound {
    int16_t *sample; /* [frame_count][channels] */
    int64_t frame_count;
    int rate_hz, channels; /* 1 or 2; more were mixed into one */
} sound;

/*
 * FAP_E_UNSUPPORTED: a build without libsndfile. FAP_E_DATA: no sound, or an empty one. @where
 * (FAP_ERROR_TEXT_SIZE bytes) says why.
 */
fap_err sound_measure(const char *path, double *duration_s, char *where);
/* Also FAP_E_LIMIT past 1 GiB of samples (1.5 hours of stereo at 48 kHz); FAP_E_NOMEM. @out is empty unless FAP_OK. */
fap_err sound_load(sound *out, const char *path, char *where);
void sound_free(sound *s);

#endif
