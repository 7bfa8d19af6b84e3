/* SPDX-License-Identifier: BSD-2-Clause */
/* A builder's bank without a file. */
#ifndef DATABANK_REWRITE_H
#define DATABANK_REWRITE_H

#include <fap/studio/bank_build.h>

/* Replaces @p *bank, which may be NULL, by what the builder writes, loaded. Vertices may come in another order. */
fap_err bank_rewrite(fap_bank **bank, fap_bank_builder *b);

#endif
