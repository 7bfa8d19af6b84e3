/* SPDX-License-Identifier: BSD-2-Clause */
/* The plot of what fapenc has just encoded. */
#ifndef ENCODER_PLOT_SHEET_H
#define ENCODER_PLOT_SHEET_H

#include "encoder/run.h"

/* To opt->plot_path. @where: FAP_ERROR_TEXT_SIZE bytes, "" where errno says it. */
fap_err sheet_write(const options *opt, const run_report *rep, const frame_source *src, char *where);

#endif
