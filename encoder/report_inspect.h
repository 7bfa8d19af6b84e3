/* SPDX-License-Identifier: BSD-2-Clause */
/* What is inside a FAP stream, for people and for programs. */
#ifndef ENCODER_REPORT_INSPECT_H
#define ENCODER_REPORT_INSPECT_H

#include "encoder/run.h"

/* How many FAPs have a value somewhere in the stream. */
int stream_coded_faps(const stream_summary *s);
double stream_length_s(const stream_summary *s);
double stream_kbit_s(const stream_summary *s);

/* Short name of a FAP group. */
const char *group_name(int group);

/* On standard output, at most 100 columns. */
void inspect_say(const options *opt, const run_report *rep);
void inspect_json(const options *opt, const run_report *rep);

#endif
