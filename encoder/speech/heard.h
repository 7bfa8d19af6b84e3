/* SPDX-License-Identifier: BSD-2-Clause */
/* From when to when somebody is heard in a sound. */
#ifndef ENCODER_SPEECH_HEARD_H
#define ENCODER_SPEECH_HEARD_H

#include "common/sound_file.h"

/* 0: nobody is. Times in seconds. */
int heard_span(const sound *s, double *from_s, double *to_s);

#endif
