/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Adaptive frequency tables, kept sparse: every symbol counts 1, and only what was added to it takes memory.
 * A table of 3,721 symbols would take 7 KiB in full and a decoder has up to 369 of them; a talking head
 * touches some 20 symbols of each. Source: ISO/IEC 14496-2, arithmetic decoding of FAPs (models of P planes).
 */
#ifndef LIB_CODEC_MODELS_H
#define LIB_CODEC_MODELS_H

#include "codec/arith.h"

/* A symbol that was coded: its count is 1 + extra. */
typedef struct model_node {
    uint16_t symbol, extra, next; /* 0 ends the list */
} model_node;

/*
 * The nodes of a table, in two lists that lead away from the symbol coded last: what comes next is seldom far from
 * it. All 0: every symbol counts 1.
 */
typedef struct model {
    uint16_t down, up;     /* the nearest nodes: of the symbol or a lower one, of a higher one; 0: none */
    uint16_t above, extra; /* sums of extra: over the list up, over both */
} model;

typedef struct model_pool {
    model_node *node; /* [count + 1], slot 0 unused */
    uint16_t count, used, free;
} model_pool;

/*
 * MODEL_NODES is what a decoder has by default and what an encoder may ask of it: at least 123 P planes whose
 * symbols are all new, and no end of them for a face that repeats itself.
 */
enum { MODEL_NODES = 9000, MODEL_POOL_MAX = 65534 };

void fap_model_pool_init(model_pool *pool, model_node *node, uint16_t count);
/* All symbols count 1 again. */
void fap_model_clear(model_pool *pool, model *m);

uint32_t fap_model_total(const model *m, int size);
/* The symbol of @p size that holds @p target, and its interval; counts it. -1: the pool is used up. */
int fap_model_decode(model_pool *pool, model *m, int size, uint32_t target, arith_interval *out);
/* The interval of @p symbol, as it is before counting it; 0: the pool is used up. */
int fap_model_encode(model_pool *pool, model *m, int size, int symbol, arith_interval *out);

/* The two halves of fap_model_encode(), for those who must know before they decide. */
arith_interval fap_model_interval(const model_pool *pool, const model *m, int size, int symbol);
int fap_model_count(model_pool *pool, model *m, int size, int symbol);

/* Where every symbol counts 1. */
static inline arith_interval fap_flat_interval(int size, int symbol)
{
    const uint32_t low = (uint32_t)(size - 1 - symbol);
    return (arith_interval){ low, low + 1, (uint32_t)size };
}
static inline int fap_flat_symbol(int size, uint32_t target)
{
    return size - 1 - (int)target;
}

#endif
