/* SPDX-License-Identifier: BSD-2-Clause */
/* fapbank's work; prints nothing. */
#ifndef DATABANK_RUN_H
#define DATABANK_RUN_H

#include "databank/options.h"
#include "databank/report.h"

fap_err run(const options *opt, report *rep);

#endif
