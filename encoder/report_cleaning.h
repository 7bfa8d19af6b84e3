/* SPDX-License-Identifier: BSD-2-Clause */
/* What was done to each marker: in words those that it was done to most, in JSON all. */
#ifndef ENCODER_REPORT_CLEANING_H
#define ENCODER_REPORT_CLEANING_H

#include "common/json.h"
#include "encoder/run.h"

void report_cleaning_say(const run_report *rep, const fap_capture_report *r);
void report_cleaning_json(json *j, const run_report *rep, const fap_capture_report *r);

#endif
