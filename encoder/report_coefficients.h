/* SPDX-License-Identifier: BSD-2-Clause */
/* What became of coefficients, in words and as JSON; and of FAPs that became coefficients. */
#ifndef ENCODER_REPORT_COEFFICIENTS_H
#define ENCODER_REPORT_COEFFICIENTS_H

#include "encoder/run.h"

void report_coefficients_say(const options *opt, const run_report *rep);
void report_coefficients_json(const options *opt, const run_report *rep);
void report_livelink_say(const options *opt, const run_report *rep);

#endif
