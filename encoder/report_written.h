/* SPDX-License-Identifier: BSD-2-Clause */
/* What an .fba that was written holds, and what the options could not keep. */
#ifndef ENCODER_REPORT_WRITTEN_H
#define ENCODER_REPORT_WRITTEN_H

#include "common/json.h"
#include "encoder/options.h"
#include "encoder/output.h"

void report_written_say(const options *opt, const written_report *w);
/* "written": {...}; nothing for text. */
void report_written_json(json *j, const options *opt, const written_report *w);

#endif
