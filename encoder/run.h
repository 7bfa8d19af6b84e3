/* SPDX-License-Identifier: BSD-2-Clause */
/* What fapenc does; nothing here prints. */
#ifndef ENCODER_RUN_H
#define ENCODER_RUN_H

#include <fap/studio/capture.h>
#include <fap/studio/coefficients.h>
#include <fap/studio/naming.h>

#include "common/streams.h"
#include "encoder/inspection.h"
#include "encoder/livelink.h"
#include "encoder/options.h"
#include "encoder/output.h"
#include "encoder/speech/spoken.h"

/* Everything that report.c needs; parts that do not apply are empty. */
typedef struct run_report {
    char where[FAP_ERROR_TEXT_SIZE + 64]; /* what went wrong */
    const char *path;                     /* in which file */
    fap_take *take;                       /* as read */
    fap_capture *capture;
    fap_coefficients *coefficients; /* as read, where it has no points */
    fap_performance *performance;
    spoken spoken;    /* its speech is NULL where nothing is said */
    fap_frame *named; /* a capture's frames with FAP 1 and FAP 2; NULL: not asked for */
    fap_naming_report naming;
    stream_summary stream;
    inspection *inspection; /* of an .fba that was inspected */
    stream_options reading;
    char first_broken[FAP_ERROR_TEXT_SIZE]; /* why the first broken plane is */
    fap_fit *fit;                           /* of --fit, or beside the input */
    char fit_found[4096];                   /* beside the input, "" where not */
    written_report written;
    livelink_report livelink; /* of a .csv that was written */
    int no_device;            /* what went wrong is a device: exit 3 */
    int is_stream;            /* the input was a FAP file */
    int rate_assumed;         /* the take's rate is --fps, for want of a better one */
} run_report;

fap_err run(const options *opt, run_report *rep);
void run_close(run_report *rep);

#endif
