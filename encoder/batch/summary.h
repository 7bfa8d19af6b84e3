/* SPDX-License-Identifier: BSD-2-Clause */
/* What became of a batch, as tables: OUT/summary.csv, OUT/index.html with the curves, JSON on standard output. */
#ifndef ENCODER_BATCH_SUMMARY_H
#define ENCODER_BATCH_SUMMARY_H

#include "encoder/batch/result.h"

typedef struct summary {
    const result *row;
    size_t count;
    size_t encoded, failed, no_take; /* failed: those whose worker was shot too */
} summary;

void summary_count(summary *s);
/* 0: errno says why. */
int summary_write_csv(const summary *s, const char *path);
/* @batch: the folder of the takes, for the title. */
int summary_write_html(const summary *s, const char *path, const char *batch);
void summary_print_json(const summary *s);

#endif
