/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba_cost.h. */
#include "codec/fba_cost.h"

/* log2 of @p v in 1/256, rounded down: bit by bit, squaring a mantissa of 31 bits. */
static uint16_t log2_of(uint32_t v)
{
    uint32_t whole = 0, part = 0;

    while (v >> (whole + 1))
        whole++;
    uint64_t mantissa = (uint64_t)v << (31 - whole);
    for (int i = 0; i < 8; i++) {
        mantissa = mantissa * mantissa >> 31;
        part = part << 1 | (mantissa >> 32 & 1);
        mantissa >>= mantissa >> 32 & 1;
    }
    return (uint16_t)(whole << 8 | part);
}

void fap_fba_costs_init(fba_costs *c)
{
    *c = (fba_costs){ { 0 }, { 0 } };
    for (uint32_t i = 1; i <= COST_TOTAL_MAX; i++)
        c->log2[i] = log2_of(i);
}

static int load_list(fba_costs *c, const model_pool *pool, uint16_t first, int min, int sign)
{
    int sum = 0;

    for (uint16_t i = first; i; i = pool->node[i].next) {
        const model_node *n = &pool->node[i];
        uint16_t *count = &c->count[n->symbol + min + COST_LEVELS];
        *count = (uint16_t)(*count + sign * n->extra);
        sum += n->extra;
    }
    return sum;
}

int fap_fba_costs_load(fba_costs *c, const model *m, const model_pool *pool, int min, int sign)
{
    return load_list(c, pool, m->down, min, sign) + load_list(c, pool, m->up, min, sign);
}
