/* SPDX-License-Identifier: BSD-2-Clause */
/* What fapenc does; nothing here prints. */
#ifndef ENCODER_RUN_H
#define ENCODER_RUN_H

#include <fap/ascii.h>
#include <fap/studio/capture.h>

#include "encoder/options.h"

enum { RUN_MAX_NOTICES = 16 };

/* A FAP over a whole stream. */
typedef struct stream_fap {
    uint64_t coded;
    int32_t min, max;
    double sum;
} stream_fap;

/* What a FAP file holds. */
typedef struct stream_summary {
    fap_ascii_header header;
    uint64_t frames;
    stream_fap fap[FAP_COUNT + 1];
    struct {
        int64_t line;
        const char *text;
    } notice[RUN_MAX_NOTICES];
    int notice_count;
} stream_summary;

/* Everything that report.c needs; parts that do not apply are empty. */
typedef struct run_report {
    char where[FAP_ERROR_TEXT_SIZE + 64]; /* what went wrong */
    const char *path;                     /* in which file */
    fap_take *take;                       /* as read */
    fap_capture *capture;
    stream_summary stream;
    int is_stream;    /* the input was a FAP file */
    int rate_assumed; /* the take's rate is --fps, for want of a better one */
} run_report;

fap_err run(const options *opt, run_report *rep);
void run_close(run_report *rep);

#endif
