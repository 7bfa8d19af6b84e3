/* SPDX-License-Identifier: BSD-2-Clause */
/* --speech, --phonemes, --text: what is said, as frames. */
#ifndef ENCODER_SPEECH_SPOKEN_H
#define ENCODER_SPEECH_SPOKEN_H

#include <fap/studio/speech.h>

#include "encoder/options.h"

typedef struct spoken {
    fap_speech *speech; /* its times are the sound's where there is one */
    fap_mouth_report mouth;
    double sound_s; /* 0: no sound */
    /* Of --text: where in the sound somebody was heard, and how much faster than the synthesizer speaks it was said. */
    double heard_from_s, heard_to_s, pace;
    double rate_hz;
    fap_frame *frame;
    size_t frame_count;
} spoken;

/*
 * @p path     set to what is to blame
 * @p missing  set to 1 where it is a program or a library
 * @p where    FAP_ERROR_TEXT_SIZE bytes, or "" where errno says it
 */
fap_err spoken_make(spoken *s, const options *opt, const char **path, int *missing, char *where);
void spoken_close(spoken *s);

#endif
