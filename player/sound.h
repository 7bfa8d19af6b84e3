/* SPDX-License-Identifier: BSD-2-Clause */
/* Sound files: whether they are any, and how long. sound.c alone names libsndfile. */
#ifndef PLAYER_SOUND_H
#define PLAYER_SOUND_H

#include <fap/error.h>

/*
 * FAP_E_UNSUPPORTED: a build without libsndfile. FAP_E_DATA: no sound, or an empty one. @where
 * (FAP_ERROR_TEXT_SIZE bytes) says why.
 */
fap_err sound_measure(const char *path, double *duration_s, char *where);

#endif
