/* SPDX-License-Identifier: BSD-2-Clause */
/* How well a face was fitted, in words and as JSON. */
#ifndef DATABANK_FIT_FIT_REPORT_H
#define DATABANK_FIT_FIT_REPORT_H

#include "databank/fit/fit.h"

void fit_report_say(const fit_work *w);
void fit_report_json(const fit_work *w);

#endif
