/* SPDX-License-Identifier: BSD-2-Clause */
/* See models.h. Counts accumulate downwards: low of a symbol is the sum of the counts of all symbols above. */
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

static void free_list(model_pool *pool, uint16_t first)
{
    for (uint16_t i = first, next; i; i = next) {
        next = pool->node[i].next;
        free_node(pool, i);
    }
}

void fap_model_clear(model_pool *pool, model *m)
{
    free_list(pool, m->down);
    free_list(pool, m->up);
    *m = (model){ 0 };
}

uint32_t fap_model_total(const model *m, int size)
{
    return (uint32_t)size + m->extra;
}

/* --- to a symbol --- */

static void step_up(model_pool *pool, model *m)
{
    const uint16_t i = m->up;
    model_node *n = &pool->node[i];

    m->above = (uint16_t)(m->above - n->extra);
    m->up = n->next;
    n->next = m->down;
    m->down = i;
}

static void step_down(model_pool *pool, model *m)
{
    const uint16_t i = m->down;
    model_node *n = &pool->node[i];

    m->above = (uint16_t)(m->above + n->extra);
    m->down = n->next;
    n->next = m->up;
    m->up = i;
}

static void seek(model_pool *pool, model *m, int symbol)
{
    while (m->up && pool->node[m->up].symbol <= symbol)
        step_up(pool, m);
    while (m->down && pool->node[m->down].symbol > symbol)
        step_down(pool, m);
}

/* The first count of a node that is first in the list down; the last one of a node that is first in up. */
static uint32_t edge(const model_pool *pool, const model *m, int size, uint16_t node)
{
    return (uint32_t)(size - 1 - pool->node[node].symbol) + m->above;
}

/* To the symbol of @p target, which is returned. */
static int seek_target(model_pool *pool, model *m, int size, uint32_t target)
{
    while (m->up && target <= edge(pool, m, size, m->up))
        step_up(pool, m);
    while (m->down && target > edge(pool, m, size, m->down) + pool->node[m->down].extra)
        step_down(pool, m);
    if (m->down && target >= edge(pool, m, size, m->down))
        return pool->node[m->down].symbol;
    return size - 1 - (int)(target - m->above);
}

/* --- at a symbol --- */

static arith_interval interval_here(const model_pool *pool, const model *m, int size, int symbol)
{
    const int is_known = m->down && pool->node[m->down].symbol == symbol;
    const uint32_t low = (uint32_t)(size - 1 - symbol) + m->above,
                   extra = is_known ? pool->node[m->down].extra : 0;

    return (arith_interval){ low, low + 1 + extra, fap_model_total(m, size) };
}

/* Every count becomes half of it, rounded up: what was added, 1 less than the count, half of it rounded down. */
static uint16_t halve(model_pool *pool, uint16_t *link)
{
    uint16_t sum = 0;

    while (*link) {
        const uint16_t i = *link;
        model_node *n = &pool->node[i];
        n->extra /= 2;
        sum = (uint16_t)(sum + n->extra);
        if (n->extra) {
            link = &n->next;
        } else {
            *link = n->next;
            free_node(pool, i);
        }
    }
    return sum;
}

static int insert_here(model_pool *pool, model *m, int symbol)
{
    const uint16_t i = new_node(pool);

    if (i) {
        pool->node[i] = (model_node){ (uint16_t)symbol, 0, m->down };
        m->down = i;
    }
    return i != 0;
}

static int count_here(model_pool *pool, model *m, int size, int symbol)
{
    if (fap_model_total(m, size) == TOTAL_MAX) {
        m->above = halve(pool, &m->up);
        m->extra = (uint16_t)(m->above + halve(pool, &m->down));
    }
    if ((!m->down || pool->node[m->down].symbol != symbol) && !insert_here(pool, m, symbol))
        return 0;
    pool->node[m->down].extra++;
    m->extra++;
    return 1;
}

/* --- both --- */

int fap_model_decode(model_pool *pool, model *m, int size, uint32_t target, arith_interval *out)
{
    const int symbol = seek_target(pool, m, size, target);

    *out = interval_here(pool, m, size, symbol);
    return count_here(pool, m, size, symbol) ? symbol : -1;
}

int fap_model_encode(model_pool *pool, model *m, int size, int symbol, arith_interval *out)
{
    seek(pool, m, symbol);
    *out = interval_here(pool, m, size, symbol);
    return count_here(pool, m, size, symbol);
}

int fap_model_count(model_pool *pool, model *m, int size, int symbol)
{
    seek(pool, m, symbol);
    return count_here(pool, m, size, symbol);
}

/* What seek() would do to a copy of the model, without moving nodes. */
arith_interval fap_model_interval(const model_pool *pool, const model *m, int size, int symbol)
{
    uint32_t low = (uint32_t)(size - 1 - symbol) + m->above, extra = 0;
    uint16_t i;

    for (i = m->up; i && pool->node[i].symbol <= symbol; i = pool->node[i].next) {
        extra = pool->node[i].symbol == symbol ? pool->node[i].extra : 0;
        low -= pool->node[i].extra;
    }
    for (i = m->down; i && pool->node[i].symbol > symbol; i = pool->node[i].next)
        low += pool->node[i].extra;
    if (i && pool->node[i].symbol == symbol)
        extra = pool->node[i].extra;
    return (arith_interval){ low, low + 1 + extra, fap_model_total(m, size) };
}
