/* SPDX-License-Identifier: BSD-2-Clause */
/* Writing frames to a .fap or an .fba, with the interpolation table that belongs to it: whole or not at all. */
#ifndef ENCODER_OUTPUT_H
#define ENCODER_OUTPUT_H

#include "encoder/options.h"
#include "encoder/source.h"

/* What was written. */
typedef struct written_report {
    int bits; /* 1: an .fba, and the rest counts */
    fap_encoder_stats stats;
    double length_s;
    char face[128]; /* errors were measured on; "": a typical face */
    int fit_gives;  /* FAPs that the learnt table gives */
    int64_t filled; /* frames of a .fap that the .fba had skipped: copies */
} written_report;

/*
 * @p header  name, rate and version; the count is found out
 * @p fit     of --fit, or NULL
 * @p path    set to the file that is to blame
 * @p where   FAP_ERROR_TEXT_SIZE bytes, or "" where the error says it all
 */
fap_err output_write(const options *opt, const fap_ascii_header *header, const frame_source *src,
                     const fap_fit *fit, written_report *written, const char **path, char *where);

#endif
