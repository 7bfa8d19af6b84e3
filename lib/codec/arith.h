/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The arithmetic coder of the face object plane: 16-bit interval, integer divisions, a 1 slipped in after 22
 * zeros so that no start code can appear. A run is begun, codes symbols, and is ended; bits stand before and
 * behind it in clear. Source: ISO/IEC 14496-2, arithmetic decoding of FAPs; the core is the coder of H.263
 * Annex E.
 */
#ifndef LIB_CODEC_ARITH_H
#define LIB_CODEC_ARITH_H

#include "codec/bits.h"

/* Where a symbol lies among the counts: [low, high) of [0, total). total is at most 16383. */
typedef struct arith_interval {
    uint32_t low, high, total;
} arith_interval;

typedef struct arith_decoder {
    fap_bits *bits;
    uint32_t low, span; /* the interval */
    uint32_t offset;    /* of the code in it */
    int zeros;          /* code bits 0 in a row */
    uint64_t shifts;    /* renormalisations done; 16 code bits more were read */
    uint64_t at;        /* in the stream */
    uint64_t stuffed;   /* number of the code bit in front of which the last stuffed bit was; 0: none */
    uint64_t not_a_1;   /* the same of the first stuffed bit that was 0 */
} arith_decoder;

void fap_arith_begin(arith_decoder *a, fap_bits *bits);
/* In [0, total): the symbol whose interval holds it is the one coded. */
uint32_t fap_arith_target(const arith_decoder *a, uint32_t total);
/* The symbol was found: go on behind it. */
void fap_arith_take(arith_decoder *a, arith_interval i);
/* Sets the bit reader exactly behind the run; marks it bad if the run was cut or its stuffing wrong. */
void fap_arith_end(arith_decoder *a);

typedef struct arith_encoder {
    fap_bit_writer *bits;
    uint32_t low, span; /* the interval */
    int zeros;
    int pending; /* bits that will be the opposite of the next one */
} arith_encoder;

void fap_arith_encoder_begin(arith_encoder *a, fap_bit_writer *bits);
void fap_arith_encoder_put(arith_encoder *a, arith_interval i);
void fap_arith_encoder_end(arith_encoder *a);

#endif
