/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Bits before they are spent, in 1/256 bit and integers: what the adaptive models will charge. The order of symbols
 * does not matter to their sum, so counts say nearly all.
 */
#ifndef LIB_CODEC_FBA_COST_H
#define LIB_CODEC_FBA_COST_H

#include "codec/fba.h"
#include "codec/models.h"

enum {
    COST_BIT = 256,
    COST_TOTAL_MAX = 16384,
    COST_LEVELS = FBA_BOUND_UNIT * FBA_BOUND_MAX, /* largest level, either sign */
};

typedef struct fba_costs {
    uint16_t log2[COST_TOTAL_MAX + 1];   /* [0] unused */
    uint16_t count[2 * COST_LEVELS + 1]; /* of P levels, what was added to 1; 0 between uses */
} fba_costs;

void fap_fba_costs_init(fba_costs *c);
/* Counts that a model already has, times @p sign. Returns their sum. */
int fap_fba_costs_load(fba_costs *c, const model *m, const model_pool *pool, int min, int sign);

static inline uint32_t fba_cost_of_size(const fba_costs *c, int size)
{
    return c->log2[size < COST_TOTAL_MAX ? size : COST_TOTAL_MAX];
}

/* A level, where the counts of its range are @p total. */
static inline uint32_t fba_cost_of_level(const fba_costs *c, int32_t level, int total)
{
    return fba_cost_of_size(c, total) - c->log2[1 + c->count[level + COST_LEVELS]];
}

#endif
