/* SPDX-License-Identifier: BSD-2-Clause */
/* fapenc --batch: every take of a folder, one process each, on as many machines as share the folders. docs/batch.md */
#ifndef ENCODER_BATCH_BATCH_H
#define ENCODER_BATCH_BATCH_H

#include "encoder/options.h"

/* Does it all and tells; the exit status. */
int batch_run(const options *opt);

#endif
