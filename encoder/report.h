/* SPDX-License-Identifier: BSD-2-Clause */
/* What fapenc tells about its work: words on standard error, or JSON on standard output. */
#ifndef ENCODER_REPORT_H
#define ENCODER_REPORT_H

#include "encoder/run.h"

/* Prints and picks the exit status. */
int report_print(const options *opt, const run_report *rep, fap_err err);

#endif
