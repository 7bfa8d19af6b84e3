/* SPDX-License-Identifier: BSD-2-Clause */
/* What was spoken, in words and as JSON. */
#ifndef ENCODER_SPEECH_REPORT_SPEECH_H
#define ENCODER_SPEECH_REPORT_SPEECH_H

#include "encoder/run.h"

void report_speech_say(const options *opt, const run_report *rep);
void report_speech_json(const options *opt, const run_report *rep);

#endif
