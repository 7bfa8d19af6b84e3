/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See models.h. Counts accumulate downwards: low of a symbol is the sum of the counts of all symbols above. The
 * upper list is the lower one in a mirror, where symbols and counts run the other way; both are walked by the
 * same code, in numbers of their own side: a symbol's rank is how many symbols lie beyond the other end.
 */
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
    for (int side = 0; side < 2; side++)
        for (uint16_t i = m->first[side], next; i; i = next) {
            next = pool->node[i].next;
            free_node(pool, i);
        }
    *m = (model){ 0 };
}

uint32_t fap_model_total(const model *m, int size)
{
    return (uint32_t)size + m->sum[MODEL_DOWN] + m->sum[MODEL_UP];
}

/* --- where a symbol is --- */

typedef struct place {
    int side, symbol;
    uint16_t before, node; /* in the list; 0: at its head; not there */
    uint32_t low, extra;   /* low in numbers of the side */
} place;

/* Symbol to rank and back. */
static uint32_t mirrored(int side, int size, uint32_t n)
{
    return side == MODEL_UP ? n : (uint32_t)size - 1 - n;
}

static place place_of_symbol(const model_pool *pool, const model *m, int size, int symbol)
{
    const uint16_t up = m->first[MODEL_UP];
    const int side = up && symbol >= pool->node[up].symbol ? MODEL_UP : MODEL_DOWN;
    const uint32_t rank = mirrored(side, size, (uint32_t)symbol);
    uint32_t sum = m->sum[!side];
    uint16_t before = 0, i = m->first[side];

    for (; i && mirrored(side, size, pool->node[i].symbol) < rank; before = i, i = pool->node[i].next)
        sum += pool->node[i].extra;
    const int found = i && pool->node[i].symbol == symbol;
    return (place){ side, symbol, before, found ? i : 0, rank + sum, found ? pool->node[i].extra : 0 };
}

static place place_of_target(const model_pool *pool, const model *m, int size, uint32_t target)
{
    const uint16_t up = m->first[MODEL_UP];
    const int side =
        up && target < (uint32_t)size - pool->node[up].symbol + m->sum[MODEL_UP] ? MODEL_UP : MODEL_DOWN;
    const uint32_t t = side == MODEL_UP ? fap_model_total(m, size) - 1 - target : target;
    uint32_t sum = m->sum[!side];
    uint16_t before = 0;

    for (uint16_t i = m->first[side]; i; before = i, i = pool->node[i].next) {
        const model_node *n = &pool->node[i];
        const uint32_t low = mirrored(side, size, n->symbol) + sum;
        if (t < low)
            break;
        if (t <= low + n->extra)
            return (place){ side, n->symbol, before, i, low, n->extra };
        sum += n->extra;
    }
    return (place){ side, (int)mirrored(side, size, t - sum), before, 0, t, 0 };
}

static arith_interval interval_at(const place *p, uint32_t total)
{
    const uint32_t low = p->low, high = low + 1 + p->extra;
    return p->side == MODEL_UP ? (arith_interval){ total - high, total - low, total }
                               : (arith_interval){ low, high, total };
}

/* --- counting --- */

/* Every count becomes half of it, rounded up: what was added, 1 less than the count, half of it rounded down. */
static void halve(model_pool *pool, model *m, int side)
{
    uint16_t *link = &m->first[side];

    m->sum[side] = 0;
    while (*link) {
        const uint16_t i = *link;
        model_node *n = &pool->node[i];
        n->extra /= 2;
        m->sum[side] = (uint16_t)(m->sum[side] + n->extra);
        if (n->extra) {
            link = &n->next;
        } else {
            *link = n->next;
            free_node(pool, i);
        }
    }
}

static uint16_t insert(model_pool *pool, model *m, const place *p)
{
    const uint16_t i = new_node(pool);

    if (i) {
        uint16_t *link = p->before ? &pool->node[p->before].next : &m->first[p->side];
        pool->node[i] = (model_node){ (uint16_t)p->symbol, 0, *link };
        *link = i;
    }
    return i;
}

/* The first node of @p side goes over when that side stays the heavier one without it. */
static void balance(model_pool *pool, model *m, int side)
{
    const uint16_t i = m->first[side];
    model_node *n = &pool->node[i];

    if (m->sum[side] - n->extra <= m->sum[!side])
        return;
    m->first[side] = n->next;
    m->sum[side] = (uint16_t)(m->sum[side] - n->extra);
    n->next = m->first[!side];
    m->first[!side] = i;
    m->sum[!side] = (uint16_t)(m->sum[!side] + n->extra);
}

static int count_at(model_pool *pool, model *m, const place *p)
{
    const uint16_t i = p->node ? p->node : insert(pool, m, p);

    if (!i)
        return 0;
    pool->node[i].extra++;
    m->sum[p->side]++;
    balance(pool, m, p->side);
    return 1;
}

/* Counts the symbol at @p p, of a table whose counts add up to @p total. */
static int count(model_pool *pool, model *m, int size, const place *p, uint32_t total)
{
    if (total < TOTAL_MAX)
        return count_at(pool, m, p);
    halve(pool, m, MODEL_DOWN);
    halve(pool, m, MODEL_UP);
    const place moved = place_of_symbol(pool, m, size, p->symbol);
    return count_at(pool, m, &moved);
}

int fap_model_decode(model_pool *pool, model *m, int size, uint32_t target, arith_interval *out)
{
    const place p = place_of_target(pool, m, size, target);

    *out = interval_at(&p, fap_model_total(m, size));
    return count(pool, m, size, &p, out->total) ? p.symbol : -1;
}

int fap_model_encode(model_pool *pool, model *m, int size, int symbol, arith_interval *out)
{
    const place p = place_of_symbol(pool, m, size, symbol);

    *out = interval_at(&p, fap_model_total(m, size));
    return count(pool, m, size, &p, out->total);
}

arith_interval fap_model_interval(const model_pool *pool, const model *m, int size, int symbol)
{
    const place p = place_of_symbol(pool, m, size, symbol);
    return interval_at(&p, fap_model_total(m, size));
}

int fap_model_count(model_pool *pool, model *m, int size, int symbol)
{
    arith_interval unused;
    return fap_model_encode(pool, m, size, symbol, &unused);
}
