/* SPDX-License-Identifier: BSD-2-Clause */
/* FAPs as the table that Live Link Face writes, for avatars that know ARKit's coefficients. */
#ifndef ENCODER_LIVELINK_H
#define ENCODER_LIVELINK_H

#include "encoder/options.h"
#include "encoder/source.h"

typedef struct livelink_report {
    int64_t frames;
    char face[128]; /* whose visemes, expressions and followers were taken */
    double rate_hz;
} livelink_report;

/* Errors as in output_write(). */
fap_err livelink_write(const options *opt, const frame_source *src, livelink_report *report,
                       const char **path, char *where);

#endif
