/* SPDX-License-Identifier: BSD-2-Clause */
/* What was found in a capture, mapped, cleaned and measured. */
#ifndef ENCODER_REPORT_CAPTURE_H
#define ENCODER_REPORT_CAPTURE_H

#include "encoder/run.h"

void report_capture_say(const options *opt, const run_report *rep);
void report_capture_json(const options *opt, const run_report *rep);

#endif
