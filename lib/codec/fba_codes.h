/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Start codes of an FBA stream and the stuffing in front of them. Planes without a start code follow the
 * plane before at the very next bit, so every question here is asked at the end of a plane. Source: ISO/IEC
 * 14496-2, next_start_code and start code values.
 */
#ifndef LIB_CODEC_FBA_CODES_H
#define LIB_CODEC_FBA_CODES_H

#include "codec/fba.h"

/* The last byte of the start code at @p *at, behind stuffing or not; -1: none. *at moves to the code. */
int fap_fba_code_at(const fap_bits *b, uint64_t *at);
/* Forward to the next start code or the end. */
void fap_fba_seek_code(fap_bits *b);
/* A start code follows at the next byte, but what is in front of it is no stuffing: some decoders look no closer. */
int fap_fba_is_badly_stuffed(const fap_bits *b);
/*
 * Forward to where a plane or object may begin, or the end code, or the end. Within planes the pattern of other codes does
 * come up (two arithmetic runs meet), so those of drafts count only with @p drafts.
 */
void fap_fba_seek_plane(fap_bits *b, int drafts);
/* Nothing is left but stuffing, and perhaps a start code that was cut. */
int fap_fba_is_used_up(const fap_bits *b);
/* What is left is less than a byte of 0s. */
int fap_fba_is_padding(const fap_bits *b);

#endif
