/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fba_mix.h. One mix can be said in several ways: either order, any number where the strength is 0. A Viterbi
 * search finds the way of saying, and of not saying, that costs least.
 */
#include <string.h>

#include "bank/sensitivity.h"
#include "codec/fba_encode.h"
#include "codec/fba_mix.h"

enum { PASSES = 2, CANDIDATES = 40, ERROR_SHIFT = 6, ERROR_MAX = 1 << 24, SLOT_WAYS = 3 };

static const uint64_t not_permitted = (uint64_t)1 << 40;

typedef struct front {
    int count;
    mix_state state[CANDIDATES * MIX_STATES];
    uint64_t cost[CANDIDATES * MIX_STATES];
} front;

/* --- errors --- */

static uint8_t strength(const mix_search *m, int level)
{
    const int v = level * m->step;
    return (uint8_t)(v > FRAME_STRENGTH_MAX ? FRAME_STRENGTH_MAX : v);
}

static int64_t distance(const mix_search *m, const mix_value *want, const mix_value *got)
{
    const int8_t *w = want->field, *g = got->field;

    if (m->is_expression)
        return fap_expression_distance(
            &(fap_expression){ (uint8_t)w[0], (uint8_t)w[1], (uint8_t)w[2], (uint8_t)w[3], 0, 0 },
            &(fap_expression){ (uint8_t)g[0], strength(m, g[1]), (uint8_t)g[2], strength(m, g[3]), 0, 0 });
    return fap_viseme_distance(&(fap_viseme){ (uint8_t)w[0], (uint8_t)w[1], (uint8_t)w[2], 0 },
                               &(fap_viseme){ (uint8_t)g[0], (uint8_t)g[1], strength(m, g[2]), 0 });
}

uint64_t fap_fba_mix_error(const mix_search *m, const mix_value *want, const mix_value *got)
{
    const int64_t steps = distance(m, want, got);

    if (m->permitted >= 0)
        return steps <= m->permitted ? 0 : not_permitted + (uint64_t)(steps - m->permitted);
    const uint64_t error = (uint64_t)steps * m->nm >> ERROR_SHIFT;
    return error < ERROR_MAX ? error * error : (uint64_t)ERROR_MAX * ERROR_MAX;
}

/* --- ways to say a mix --- */

typedef struct ways {
    int count;
    mix_value value[CANDIDATES];
} ways;

static void propose(ways *w, int a, int b, int c, int d)
{
    if (w->count < CANDIDATES)
        w->value[w->count++] = (mix_value){ { (int8_t)a, (int8_t)b, (int8_t)c, (int8_t)d } };
}

static int nearest_level(const mix_search *m, int value)
{
    const int level = (value + m->step / 2) / m->step;
    return level > m->most ? m->most : level;
}

static void propose_viseme(const mix_search *m, const int8_t *from, int first, int second, int blend, ways *w)
{
    const int level = nearest_level(m, blend);

    propose(w, first, second, level, 0);
    if (level > 0)
        propose(w, first, second, level - 1, 0);
    if (level < m->most)
        propose(w, first, second, level + 1, 0);
    propose(w, first, second, from[2], 0);
    propose(w, first, from[1], m->most, 0);
    propose(w, from[0], second, 0, 0);
}

/* Ways to say one half of an expression, where @p from is what it says now. */
static int slot_ways(const mix_search *m, const int8_t *from, int number, int intensity,
                     int8_t out[SLOT_WAYS][2])
{
    const int level = nearest_level(m, intensity);
    const int8_t all[SLOT_WAYS][2] = { { (int8_t)number, (int8_t)level },
                                       { from[0], from[1] },
                                       { from[0], 0 } };

    memcpy(out, all, sizeof all);
    return number && intensity ? SLOT_WAYS - 1 : SLOT_WAYS;
}

static void propose_expression(const mix_search *m, const int8_t *from, const int8_t *first,
                               const int8_t *second, ways *w)
{
    int8_t a[SLOT_WAYS][2], b[SLOT_WAYS][2];
    const int as = slot_ways(m, from, first[0], first[1], a),
              bs = slot_ways(m, from + 2, second[0], second[1], b);

    for (int i = 0; i < as; i++)
        for (int k = 0; k < bs; k++)
            propose(w, a[i][0], a[i][1], b[k][0], b[k][1]);
}

static void list_ways(const mix_search *m, const mix_value *from, const mix_value *want, ways *w)
{
    const int8_t *f = from->field, *v = want->field;

    w->count = 0;
    propose(w, f[0], f[1], f[2], f[3]);
    if (m->is_expression) {
        propose_expression(m, f, v, v + 2, w);
        propose_expression(m, f, v + 2, v, w);
    } else {
        propose_viseme(m, f, v[0], v[1], v[2], w);
        propose_viseme(m, f, v[1], v[0], FRAME_STRENGTH_MAX - v[2], w);
    }
}

/* --- the search --- */

static void relax(front *f, const mix_value *value, uint64_t cost, int from)
{
    int i = 0;

    while (i < f->count && memcmp(&f->state[i].value, value, sizeof *value) != 0)
        i++;
    if (i == f->count)
        f->count++;
    else if (cost >= f->cost[i])
        return;
    f->state[i] = (mix_state){ *value, (uint8_t)from };
    f->cost[i] = cost;
}

static int fields(const mix_search *m)
{
    return m->is_expression ? 4 : 3;
}

static uint64_t bits_between(const mix_search *m, const mix_value *from, const mix_value *to)
{
    uint64_t bits = 0;

    for (int i = 0; i < fields(m); i++) {
        const int total = m->size[i] + m->carried_sum + m->count;
        bits += fba_cost_of_size(m->costs, total) -
                m->costs->log2[1 + m->hits[i][to->field[i] - from->field[i] + MIX_LEVELS]];
    }
    return bits;
}

static void prune(front *f)
{
    const int keep = f->count < MIX_STATES ? f->count : MIX_STATES;

    for (int i = 0; i < keep; i++) {
        int best = i;
        for (int k = i + 1; k < f->count; k++)
            if (f->cost[k] < f->cost[best])
                best = k;
        const mix_state s = f->state[i];
        const uint64_t c = f->cost[i];
        f->state[i] = f->state[best], f->cost[i] = f->cost[best];
        f->state[best] = s, f->cost[best] = c;
    }
    f->count = keep;
}

static void step_on(const mix_search *m, const front *from, front *to, int i, int is_free)
{
    ways w;

    to->count = 0;
    for (int k = 0; k < from->count; k++) {
        list_ways(m, &from->state[k].value, &m->want[i], &w);
        if (!is_free && (m->still[i] || !fap_fba_mix_error(m, &m->want[i], &from->state[k].value)))
            w.count = 1; /* to stay is the first way, and the best where nothing is wrong with it */
        for (int n = 0; n < w.count; n++) {
            const uint64_t bits = is_free ? 0 : bits_between(m, &from->state[k].value, &w.value[n]);
            relax(to, &w.value[n], from->cost[k] + (m->lambda[i] * bits >> 8), k);
        }
    }
    for (int k = 0; k < to->count; k++)
        to->cost[k] += fap_fba_mix_error(m, &m->want[i], &to->state[k].value);
    prune(to);
}

static void count_path(mix_search *m, const mix_value *path)
{
    memcpy(m->hits, m->carried, sizeof m->hits);
    for (int i = m->intra; i < m->count; i++) {
        const mix_value *from = i ? &path[i - 1] : &m->start;
        for (int k = 0; k < fields(m); k++)
            m->hits[k][path[i].field[k] - from->field[k] + MIX_LEVELS]++;
    }
}

static void find_path(mix_search *m, mix_value *path)
{
    front a, b, *from = &a, *to = &b;
    int k = 0;

    from->count = 0;
    relax(from, &m->start, 0, 0);
    for (int i = 0; i < m->count; i++) {
        step_on(m, from, to, i, m->intra && i == 0);
        front *const swap = from;
        from = to, to = swap;
        memcpy(m->state[i], from->state, (size_t)from->count * sizeof *from->state);
    }
    for (int i = 1; i < from->count; i++)
        k = from->cost[i] < from->cost[k] ? i : k;
    for (int i = m->count - 1; i >= 0; i--) {
        path[i] = m->state[i][k].value;
        k = m->state[i][k].from;
    }
}

/* As the source says it. */
static void plain_path(const mix_search *m, mix_value *path)
{
    for (int i = 0; i < m->count; i++) {
        path[i] = m->want[i];
        for (int k = m->is_expression ? 1 : 2; k < fields(m); k += 2)
            path[i].field[k] = (int8_t)nearest_level(m, path[i].field[k]);
        if (m->still[i] && i)
            path[i] = path[i - 1];
    }
}

uint64_t fap_fba_mix(mix_search *m, mix_value *path)
{
    uint64_t error = 0;

    plain_path(m, path);
    for (int pass = 0; pass < PASSES; pass++) {
        count_path(m, path);
        find_path(m, path);
    }
    for (int i = 0; i < m->count; i++)
        error += fap_fba_mix_error(m, &m->want[i], &path[i]);
    return error;
}
