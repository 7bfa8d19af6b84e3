/* SPDX-License-Identifier: BSD-2-Clause */
/* See sound.h. */
#include <stdio.h>

#include "player/sound.h"

#ifdef HAVE_SNDFILE

#include <sndfile.h>

fap_err sound_measure(const char *path, double *duration_s, char *where)
{
    SF_INFO info = { 0 };
    SNDFILE *sound = sf_open(path, SFM_READ, &info);

    if (!sound) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", sf_strerror(NULL));
        return FAP_E_DATA;
    }
    sf_close(sound);
    if (info.frames <= 0 || info.samplerate <= 0) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "the sound is empty");
        return FAP_E_DATA;
    }
    *duration_s = (double)info.frames / info.samplerate;
    return FAP_OK;
}

#else

fap_err sound_measure(const char *path, double *duration_s, char *where)
{
    (void)path;
    *duration_s = 0;
    snprintf(where, FAP_ERROR_TEXT_SIZE,
             "this fapplay was built without libsndfile; install it and build again");
    return FAP_E_UNSUPPORTED;
}

#endif
