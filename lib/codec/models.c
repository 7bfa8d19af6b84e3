/* SPDX-License-Identifier: BSD-2-Clause */
/* See models.h. Counts accumulate downwards: cum[k] is the sum of the counts of k and all symbols above. */
#include "codec/models.h"

enum { TOTAL_MAX = 16383 };

void fap_model_pool_init(model_pool *pool, model_node *node, uint16_t count)
{
    *pool = (model_pool){ .node = node, .count = count };
}

static void free_node(model_pool *pool, uint16_t i)
{
    pool->node[i].next = pool->free;
    pool->free = i;
}

static uint16_t new_node(model_pool *pool)
{
    const uint16_t i = pool->free;

    if (i) {
        pool->free = pool->node[i].next;
        return i;
    }
    return pool->used < pool->count ? ++pool->used : 0;
}

void fap_model_clear(model_pool *pool, model *m)
{
    for (uint16_t i = m->first, next; i; i = next) {
        next = pool->node[i].next;
        free_node(pool, i);
    }
    *m = (model){ 0 };
}

uint32_t fap_model_total(const model *m, int size)
{
    return (uint32_t)size + m->extra;
}

int fap_model_find(const model_pool *pool, const model *m, int size, uint32_t target, arith_interval *out)
{
    uint32_t cum = 0; /* counts of the symbols from upper on */
    int upper = size;

    for (uint16_t i = m->first; i; i = pool->node[i].next) {
        const model_node *n = &pool->node[i];
        const uint32_t above = cum + (uint32_t)(upper - 1 - n->symbol); /* untouched symbols count 1 each */
        if (target < above)
            break;
        if (target <= above + n->extra) {
            *out = (arith_interval){ above, above + 1 + n->extra, fap_model_total(m, size) };
            return n->symbol;
        }
        cum = above + 1 + n->extra;
        upper = n->symbol;
    }
    *out = (arith_interval){ target, target + 1, fap_model_total(m, size) };
    return upper - 1 - (int)(target - cum);
}

arith_interval fap_model_interval(const model_pool *pool, const model *m, int size, int symbol)
{
    uint32_t low = (uint32_t)(size - 1 - symbol), count = 1;
    uint16_t i = m->first;

    for (; i && pool->node[i].symbol > symbol; i = pool->node[i].next)
        low += pool->node[i].extra;
    if (i && pool->node[i].symbol == symbol)
        count += pool->node[i].extra;
    return (arith_interval){ low, low + count, fap_model_total(m, size) };
}

/* Every count becomes half of it, rounded up: what was added, 1 less than the count, half of it rounded down.
 */
static void halve(model_pool *pool, model *m)
{
    uint16_t *link = &m->first;

    m->extra = 0;
    while (*link) {
        const uint16_t i = *link;
        model_node *n = &pool->node[i];
        n->extra /= 2;
        m->extra = (uint16_t)(m->extra + n->extra);
        if (n->extra) {
            link = &n->next;
        } else {
            *link = n->next;
            free_node(pool, i);
        }
    }
}

int fap_model_count(model_pool *pool, model *m, int size, int symbol)
{
    if (fap_model_total(m, size) == TOTAL_MAX)
        halve(pool, m);

    uint16_t *link = &m->first;
    while (*link && pool->node[*link].symbol > symbol)
        link = &pool->node[*link].next;
    if (!*link || pool->node[*link].symbol != symbol) {
        const uint16_t i = new_node(pool);
        if (!i)
            return 0;
        pool->node[i] = (model_node){ (uint16_t)symbol, 0, *link };
        *link = i;
    }
    pool->node[*link].extra++;
    m->extra++;
    return 1;
}
