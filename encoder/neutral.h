/* SPDX-License-Identifier: BSD-2-Clause */
/* --neutral: a frame of the take or a time in it, or a stretch of either. */
#ifndef ENCODER_NEUTRAL_H
#define ENCODER_NEUTRAL_H

#include <stdint.h>

typedef struct neutral_option {
    int given;       /* --neutral was there */
    int in_seconds;  /* else frames of the take */
    double from, to; /* from < 0: to be found; to < 0: from alone */
} neutral_option;

/* "auto", "120", "120-135", "4.8s", "4.8-5.4s". 0: none of these. */
int neutral_option_parse(neutral_option *n, const char *text);
/* In frames of a take; -1 as above. */
void neutral_option_frames(const neutral_option *n, double rate_hz, int64_t *first, int64_t *last);

#endif
