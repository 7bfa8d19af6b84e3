/* SPDX-License-Identifier: BSD-2-Clause */
/* The header of a plane. Source: ISO/IEC 14496-2, face object plane syntax. */
#ifndef LIB_CODEC_FBA_HEADER_H
#define LIB_CODEC_FBA_HEADER_H

#include <fap/error.h>

#include "codec/bits.h"
#include "codec/fba_time.h"

typedef struct fba_header {
    int intra, has_face, has_body;
    fba_time_fields time;
} fba_header;

/* FAP_OK; otherwise @p what names the element and @p why what is wrong with it. */
fap_err fap_fba_header_read(fap_bits *b, fba_header *h, const char **what, const char **why);

#endif
