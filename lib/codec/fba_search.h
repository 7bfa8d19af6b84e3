/* SPDX-License-Identifier: BSD-2-Clause */
/* Levels by bits and errors: FAP_ENCODE_BITRATE and FAP_ENCODE_ERROR. All in integers. */
#ifndef LIB_CODEC_FBA_SEARCH_H
#define LIB_CODEC_FBA_SEARCH_H

#include "codec/fba_encode.h"

/* 0: no memory. */
int fap_fba_search_open(fap_encoder *e);
void fap_fba_search_close(fap_encoder *e);

/* Plans quantiser, ranges and lattice places of the first @p count frames of the queue. */
void fap_fba_search(fap_encoder *e, int count, int intra);

/*
 * Takes back changes of a P plane that are worth least for their bits: more of them the larger @p strength is, all
 * of them at -1. 0: nothing changed.
 */
int fap_fba_thin(fap_encoder *e, const fap_frame *want, const fba_coded_list *list, int32_t *level,
                 int strength);

#endif
