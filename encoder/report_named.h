/* SPDX-License-Identifier: BSD-2-Clause */
/* What --visemes and --expressions found. */
#ifndef ENCODER_REPORT_NAMED_H
#define ENCODER_REPORT_NAMED_H

#include "common/json.h"
#include "encoder/run.h"

void report_named_say(const options *opt, const run_report *rep);
/* "named": {...}; nothing where neither was asked for. */
void report_named_json(json *j, const options *opt, const run_report *rep);

#endif
