/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Which symbol ranges a stream means that sends none: the standard's, or +-1020 as an encoder of the reference software's
 * family used without saying so. Nothing in the stream tells, so it is read both ways; only the right one ends where the
 * planes do. Source: ../shared/spec/bitstream.md section 5, the trap.
 */
#ifndef LIB_CODEC_FBA_UNSAID_H
#define LIB_CODEC_FBA_UNSAID_H

#include "codec/fba_face.h"

enum { FBA_SILENT_BOUND = 1020 };

/*
 * The bound that fits the face data at @p bits better, 0: the standard's. @p face as it is in front of that first I plane;
 * nothing but models and pool changes, and those are cleared at every I plane.
 */
int fap_fba_unsaid_bound(const fap_bits *bits, const fba_face *face, model *models, model_pool *pool);

#endif
