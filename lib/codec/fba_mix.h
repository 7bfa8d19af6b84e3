/* SPDX-License-Identifier: BSD-2-Clause */
/* The path of a viseme or an expression that costs least: errors plus lambda times bits. */
#ifndef LIB_CODEC_FBA_MIX_H
#define LIB_CODEC_FBA_MIX_H

#include "codec/fba_cost.h"

enum { MIX_FIELDS = 4, MIX_STATES = 4, MIX_LEVELS = 64 };

/* Levels in the order of the parameters: select, select, blend; or select, intensity, select, intensity. */
typedef struct mix_value {
    int8_t field[MIX_FIELDS];
} mix_value;

typedef struct mix_state {
    mix_value value;
    uint8_t from;
} mix_state;

typedef struct mix_search {
    const fba_costs *costs;
    const mix_value *want;          /* [count] numbers and strengths as asked for */
    const uint64_t *lambda;         /* [count] */
    const uint8_t *still;           /* [count] */
    mix_state (*state)[MIX_STATES]; /* [count] */
    int count, intra, is_expression;
    int step, most;       /* of strengths: a level's worth, and the highest level */
    mix_value start;      /* unless intra */
    uint32_t nm;          /* of a step of 63 */
    int64_t permitted;    /* steps of 63, all together; -1: errors count by their square */
    int size[MIX_FIELDS]; /* of the ranges of P levels */
    uint16_t carried[MIX_FIELDS][2 * MIX_LEVELS]; /* what the models count so far, level + MIX_LEVELS */
    int carried_sum;
    uint16_t hits[MIX_FIELDS][2 * MIX_LEVELS]; /* the same with the path before */
} mix_search;

/* What it costs to show @p got for @p want. */
uint64_t fap_fba_mix_error(const mix_search *m, const mix_value *want, const mix_value *got);
/* The path and its error. */
uint64_t fap_fba_mix(mix_search *m, mix_value *path);

#endif
