/* SPDX-License-Identifier: BSD-2-Clause */
/* Body data of a plane, parsed so that the decoder knows where it ends. No body animation parameter is kept.
 */
#ifndef LIB_CODEC_FBA_BODY_H
#define LIB_CODEC_FBA_BODY_H

#include <fap/error.h>

#include "codec/fba.h"
#include "codec/models.h"

enum { BODY_PARAMS = 296 };

/* What a body I plane sets. Parameters count in the order of the groups. */
typedef struct fba_body {
    uint8_t quant;
    uint8_t coded[BODY_PARAMS];
    fba_range range[2][BODY_PARAMS];
    model model[BODY_PARAMS];
} fba_body;

/* The values that a body without ranges of its own starts from. */
void fap_fba_body_init(fba_body *body);
/* FAP_OK, also when a read went wrong: b->bad says so. FAP_E_UNSUPPORTED, FAP_E_BITSTREAM, FAP_E_LIMIT else.
 */
fap_err fap_fba_body_skip(fba_body *body, fap_bits *b, int intra, model_pool *pool);

#endif
