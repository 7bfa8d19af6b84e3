/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fba_search.h. A trial is a quantiser and a lambda for every frame: each parameter takes its best path, which
 * gives bits and error. FAP_ENCODE_BITRATE looks for the quantiser with the least error at the mean rate, and then
 * lets lambda follow the load of the windows. FAP_ENCODE_ERROR looks for the quantiser with the fewest bits.
 */
#include <string.h>

#include "base/mem.h"
#include "bank/sensitivity.h"
#include "codec/fba_search.h"

enum { PASSES = 2, BALANCE_ROUNDS = 8, COARSE_ROUNDS = 4, FULL = 1024, COARSE = 2 * SEARCH_OCTAVE };

static const uint8_t quants[] = { 1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 30, 31 };
enum { QUANTS = sizeof quants / sizeof *quants };

/* --- memory --- */

int fap_fba_search_open(fap_encoder *e)
{
    const size_t n = (size_t)e->capacity;
    const fap_allocator *a = &e->alloc;
    fba_search *s = e->search = fap_mem_calloc(a, 1, sizeof *s);

    if (!s)
        return 0;
    fap_fba_costs_init(&s->costs);
    s->want = fap_mem_calloc(a, n * FBA_PARAMS, sizeof *s->want);
    s->column = fap_mem_calloc(a, n, sizeof *s->column);
    s->next = fap_mem_calloc(a, n, sizeof *s->next);
    s->best = fap_mem_calloc(a, n, sizeof *s->best);
    s->best_left_out = fap_mem_calloc(a, n, sizeof *s->best_left_out);
    s->still = fap_mem_calloc(a, n, sizeof *s->still);
    s->lambda = fap_mem_calloc(a, n, sizeof *s->lambda);
    s->level = fap_mem_calloc(a, n, sizeof *s->level);
    s->best_level = fap_mem_calloc(a, n, sizeof *s->best_level);
    s->fixed = fap_mem_calloc(a, n, sizeof *s->fixed);
    s->moving = fap_mem_calloc(a, n, sizeof *s->moving);
    s->state = fap_mem_calloc(a, n, sizeof *s->state);
    s->mix_want = fap_mem_calloc(a, n, sizeof *s->mix_want);
    s->mix_path = fap_mem_calloc(a, n, sizeof *s->mix_path);
    s->mix_state = fap_mem_calloc(a, n, sizeof *s->mix_state);
    s->sum = fap_mem_calloc(a, 2 * (n + 2 * WINDOW_MAX), sizeof *s->sum);
    s->load = fap_mem_calloc(a, n + WINDOW_MAX, sizeof *s->load);
    return s->want && s->column && s->next && s->best && s->best_left_out && s->still && s->lambda &&
           s->level && s->best_level && s->fixed && s->moving && s->state && s->mix_want && s->mix_path &&
           s->mix_state && s->sum && s->load;
}

void fap_fba_search_close(fap_encoder *e)
{
    fba_search *s = e->search;

    if (!s)
        return;
    fap_mem_free(&e->alloc, s->mix_state);
    fap_mem_free(&e->alloc, s->mix_path);
    fap_mem_free(&e->alloc, s->mix_want);
    fap_mem_free(&e->alloc, s->load);
    fap_mem_free(&e->alloc, s->sum);
    fap_mem_free(&e->alloc, s->state);
    fap_mem_free(&e->alloc, s->moving);
    fap_mem_free(&e->alloc, s->fixed);
    fap_mem_free(&e->alloc, s->best_level);
    fap_mem_free(&e->alloc, s->level);
    fap_mem_free(&e->alloc, s->lambda);
    fap_mem_free(&e->alloc, s->still);
    fap_mem_free(&e->alloc, s->best_left_out);
    fap_mem_free(&e->alloc, s->best);
    fap_mem_free(&e->alloc, s->next);
    fap_mem_free(&e->alloc, s->column);
    fap_mem_free(&e->alloc, s->want);
    fap_mem_free(&e->alloc, s);
    e->search = NULL;
}

/* --- one parameter --- */

/* What a trial of one parameter needs to know. */
typedef struct lane {
    fap_encoder *e;
    const fba_coded *c;
    int count, intra;
    trellis t;
} lane;

/* A part of a viseme or an expression, which are found as a whole and have ranges of their own. */
static int is_mixed(const fba_coded *c)
{
    return c->param < FBA_FIRST_FAP;
}

static int32_t level_at(const lane *l, const int32_t *place, int i)
{
    return place[i] - (i ? place[i - 1] : l->e->at[l->c->param]);
}

/* Counts of the models so far and of a path, added or taken away. Returns the models' sum. */
static int load(const lane *l, const int32_t *place, int sign)
{
    fba_costs *costs = &l->e->search->costs;

    for (int i = l->intra; i < l->count; i++) {
        uint16_t *n = &costs->count[level_at(l, place, i) + COST_LEVELS];
        *n = (uint16_t)(*n + sign);
    }
    return l->intra ? 0
                    : fap_fba_costs_load(costs, &l->e->model[l->c->param], &l->e->pool,
                                         l->c->symbols[FBA_P].min, sign);
}

static fba_range widest_range(const lane *l)
{
    if (l->intra && !is_mixed(l->c))
        return (fba_range){ (int16_t)-l->t.widest, (int16_t)l->t.widest };
    return fap_fba_param_range(l->intra ? &l->e->plan : &l->e->face.setup, l->c->param, 0);
}

static fba_range range_of_path(const lane *l, const int32_t *place)
{
    if (!l->intra || is_mixed(l->c))
        return widest_range(l);
    fap_fba_fit_range(l->e, l->c->param, place, 1, l->count);
    return fap_fba_param_range(&l->e->plan, l->c->param, 0);
}

static void prepare(lane *l)
{
    fap_encoder *e = l->e;
    fba_search *s = e->search;
    const int quant = l->intra ? e->plan.quant : e->face.setup.quant;

    l->t = (trellis){ .want = s->want + (size_t)l->c->param * (size_t)e->capacity,
                      .lambda = s->lambda,
                      .still = s->still,
                      .state = s->state,
                      .costs = &s->costs,
                      .count = l->count,
                      .intra = l->intra,
                      .start = e->at[l->c->param],
                      .step = l->c->step,
                      .widest = fap_fba_bound(FBA_BOUND_MAX, quant),
                      .nm = e->sensitivity.nm[l->c->fap],
                      .permitted = e->cfg.mode == FAP_ENCODE_ERROR ? e->permitted[l->c->fap] : -1 };
    if (l->t.permitted >= 0 && l->t.permitted < l->c->step / 2)
        l->t.permitted = l->c->step / 2;
    l->t.range = widest_range(l);
}

static int32_t between(int32_t v, int32_t min, int32_t max)
{
    return v < min ? min : v > max ? max : v;
}

/* The nearest places that can be reached. */
static void round_path(const lane *l, int32_t *place)
{
    const trellis *t = &l->t;

    for (int i = 0; i < l->count; i++) {
        const int32_t nearest = fap_fba_nearest(t->want[i], t->step);
        const int32_t from = i ? place[i - 1] : t->start;
        if (i == 0 && t->intra)
            place[i] = between(nearest, -t->widest, t->widest);
        else
            place[i] = t->still[i] ? from : from + between(nearest - from, t->range.min, t->range.max);
    }
}

static uint64_t path_error(const lane *l, const int32_t *place)
{
    uint64_t error = 0;

    for (int i = 0; i < l->count; i++)
        error += fap_fba_error(&l->t, l->t.want[i], place[i]);
    return error;
}

/* The bits of a path as the models will charge them, weighed; into @p moving where that is not NULL. */
static uint64_t path_rate(const lane *l, const int32_t *place, const uint8_t *left_out, uint32_t *moving)
{
    fba_search *s = l->e->search;
    const fba_range range = range_of_path(l, place);
    int total = fba_range_size(range);
    uint64_t rate = 0;

    total +=
        l->intra ? 0 : fap_fba_costs_load(&s->costs, &l->e->model[l->c->param], &l->e->pool, range.min, 1);
    for (int i = l->intra; i < l->count; i++) {
        if (left_out && left_out[i])
            continue;
        uint16_t *n = &s->costs.count[level_at(l, place, i) + COST_LEVELS];
        const uint32_t bits = fba_cost_of_size(&s->costs, total++) - s->costs.log2[1 + (*n)++];
        rate += s->lambda[i] * bits / COST_BIT;
        if (moving)
            moving[i] += bits;
    }
    for (int i = l->intra; i < l->count; i++)
        if (!left_out || !left_out[i])
            s->costs.count[level_at(l, place, i) + COST_LEVELS]--;
    if (!l->intra)
        fap_fba_costs_load(&s->costs, &l->e->model[l->c->param], &l->e->pool, range.min, -1);
    return rate;
}

/* A parameter that never changes costs nothing in P planes. */
static void rest_path(const lane *l, int32_t *place)
{
    const trellis *t = &l->t;
    int64_t sum = 0;

    for (int i = 0; i < l->count; i++)
        sum += t->want[i];
    const int32_t at =
        t->intra ? between(fap_fba_nearest(sum / l->count, t->step), -t->widest, t->widest) : t->start;
    for (int i = 0; i < l->count; i++)
        place[i] = at;
}

static uint64_t sum_of(const lane *l, const int32_t *place)
{
    return path_error(l, place) + path_rate(l, place, NULL, NULL);
}

/* Into column. */
static void find_path(lane *l)
{
    fba_search *s = l->e->search;

    round_path(l, s->column);
    for (int pass = 0; pass < PASSES; pass++) {
        l->t.range = range_of_path(l, s->column);
        l->t.total = fba_range_size(l->t.range) + l->count - l->intra + load(l, s->column, 1);
        fap_fba_trellis(&l->t, s->next);
        load(l, s->column, -1);
        memcpy(s->column, s->next, (size_t)l->count * sizeof *s->column);
    }
    rest_path(l, s->next);
    if (sum_of(l, s->next) < sum_of(l, s->column))
        memcpy(s->column, s->next, (size_t)l->count * sizeof *s->column);
}

static void try_fap(lane *l)
{
    fap_encoder *e = l->e;

    prepare(l);
    find_path(l);
    for (int i = 0; i < l->count; i++)
        e->path[i][l->c->param] = e->search->column[i];
    e->search->error += path_error(l, e->search->column);
}

/* --- visemes and expressions --- */

static void load_mix(fap_encoder *e, const fba_coded *c, int fields, mix_search *m)
{
    fba_costs *costs = &e->search->costs;

    for (int k = 0; k < fields; k++) {
        const int min = c[k].symbols[FBA_P].min;
        m->size[k] = c[k].symbols[FBA_P].size;
        m->start.field[k] = (int8_t)e->at[c[k].param];
        memset(m->carried[k], 0, sizeof m->carried[k]);
        if (m->intra)
            continue;
        m->carried_sum = fap_fba_costs_load(costs, &e->model[c[k].param], &e->pool, min, 1);
        memcpy(&m->carried[k][1], &costs->count[COST_LEVELS - MIX_LEVELS + 1],
               (2 * MIX_LEVELS - 1) * sizeof(uint16_t));
        fap_fba_costs_load(costs, &e->model[c[k].param], &e->pool, min, -1);
    }
}

/* FAP 1 or 2, whose parameters are @p c and those behind it. */
static void try_mix(fap_encoder *e, const fba_coded *c, int count, int intra)
{
    fba_search *s = e->search;
    mix_search *m = &s->mix;
    const int is_expression = c->fap == 2, fields = is_expression ? 4 : 3;

    m->costs = &s->costs;
    m->want = s->mix_want;
    m->lambda = s->lambda;
    m->still = s->still;
    m->state = s->mix_state;
    m->count = count;
    m->intra = intra;
    m->is_expression = is_expression;
    m->step = c[is_expression ? 1 : 2].step;
    m->most = c[is_expression ? 1 : 2].symbols[FBA_I].size - 1;
    m->nm = e->sensitivity.nm[c->fap];
    m->permitted = e->cfg.mode == FAP_ENCODE_ERROR ? 2 * e->permitted[c->fap] : -1;
    m->carried_sum = 0;
    load_mix(e, c, fields, m);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < fields; k++)
            s->mix_want[i].field[k] = (int8_t)s->want[(size_t)c[k].param * (size_t)e->capacity + (size_t)i];
    s->error += fap_fba_mix(m, s->mix_path);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < fields; k++)
            e->path[i][c[k].param] = s->mix_path[i].field[k];
}

static uint64_t mix_error(fap_encoder *e, const fba_coded *c, int i, const int32_t *place)
{
    mix_search *m = &e->search->mix;
    mix_value want = { { 0 } }, got = { { 0 } };

    m->is_expression = c->fap == 2;
    m->step = c[m->is_expression ? 1 : 2].step;
    m->nm = e->sensitivity.nm[c->fap];
    for (int k = 0; k < (m->is_expression ? 4 : 3); k++) {
        want.field[k] = (int8_t)e->search->want[(size_t)c[k].param * (size_t)e->capacity + (size_t)i];
        got.field[k] = (int8_t)place[c[k].param];
    }
    return fap_fba_mix_error(m, &want, &got);
}

/* --- a trial --- */

static void charge(lane *l)
{
    fap_encoder *e = l->e;
    fba_search *s = e->search;

    for (int i = 0; i < l->count; i++)
        s->column[i] = e->path[i][l->c->param];
    prepare(l);
    path_rate(l, s->column, e->left_out, s->moving);
    if (!l->intra)
        return;
    if (!is_mixed(l->c))
        fap_fba_set_range(&e->plan, FBA_I, l->c->param, between(s->column[0], INT32_MIN, 0),
                          between(s->column[0], 0, INT32_MAX));
    s->fixed[0] += fba_cost_of_size(&s->costs, fba_range_size(fap_fba_param_range(&e->plan, l->c->param, 1)));
}

static void try_frames(fap_encoder *e, const fba_coded_list *list, int count, int intra)
{
    fba_search *s = e->search;

    s->error = s->bits = 0;
    for (int k = 0; k < list->count; k++)
        if (!is_mixed(&list->of[k]))
            try_fap(&(lane){ e, &list->of[k], count, intra, { 0 } });
        else if (k == 0 || list->of[k - 1].fap != list->of[k].fap)
            try_mix(e, &list->of[k], count, intra);
    fap_fba_mark_unchanged(e, list, count, intra);
    for (int i = 0; i < count; i++) {
        s->fixed[i] = fap_fba_overhead(e, i, intra);
        s->moving[i] = 0;
    }
    for (int k = 0; k < list->count; k++)
        charge(&(lane){ e, &list->of[k], count, intra, { 0 } });
    for (int i = 0; i < count; i++)
        s->bits += s->fixed[i] + s->moving[i];
}

uint64_t fap_fba_worth(fap_encoder *e, int fap, int count)
{
    fba_search *s = e->search;
    const fba_coded *c = e->plan_list.of;

    while (c->fap != fap)
        c++;
    lane l = { e, c, count, 1, { 0 } };
    for (int i = 0; i < count; i++)
        s->column[i] = e->path[i][c->param];
    prepare(&l);
    return path_error(&l, s->column) + path_rate(&l, s->column, e->left_out, NULL) +
           s->lambda[0] * fap_fba_table_bits();
}

/* --- frames that are not worth their bits --- */

/* Of frame @p i, if it shows what was planned for frame @p shown; -1: what was before. */
static uint64_t error_if_shown(fap_encoder *e, const fba_coded_list *list, int intra, int i, int shown)
{
    const int32_t *place = shown < 0 ? e->at : e->path[shown];
    uint64_t error = 0;

    for (int k = 0; k < list->count; k++) {
        const fba_coded *c = &list->of[k];
        const int is_head = k == 0 || list->of[k - 1].fap != c->fap;
        if (is_mixed(c) && is_head)
            error += mix_error(e, c, i, place);
        else if (!is_mixed(c)) {
            lane l = { e, c, 0, intra, { 0 } };
            prepare(&l);
            error += fap_fba_error(&l.t, l.t.want[i], place[c->param]);
        }
    }
    return error;
}

/* One after the other: would it cost less to show the last frame that is sent once more? */
static int mark_still(fap_encoder *e, const fba_coded_list *list, int count, int intra)
{
    fba_search *s = e->search;
    int last = intra ? 0 : -1, marked = 0;

    for (int i = intra; i < count; i++) {
        const uint64_t bits = s->fixed[i] + s->moving[i];
        const uint64_t stays = error_if_shown(e, list, intra, i, last),
                       moves = error_if_shown(e, list, intra, i, i);
        s->still[i] = bits && stays < moves + (s->lambda[i] * bits >> 8);
        marked += s->still[i];
        last = s->still[i] ? last : i;
    }
    return marked;
}

void fap_fba_try(fap_encoder *e, int count, int intra)
{
    static const uint16_t part[SEARCH_OCTAVE] = { /* 2^(i/16) in 1/4096 */
                                                  4096, 4277, 4467, 4664, 4871, 5087, 5312, 5547,
                                                  5793, 6049, 6317, 6597, 6889, 7194, 7512, 7845
    };
    fba_search *s = e->search;

    if (intra)
        fap_fba_list_coded(&e->plan_list, &e->plan);
    const fba_coded_list *list = intra ? &e->plan_list : &e->face.list;
    for (int i = 0; i < count; i++)
        s->lambda[i] = ((uint64_t)part[s->level[i] % SEARCH_OCTAVE] << s->level[i] / SEARCH_OCTAVE) >> 12;
    memset(s->still, 0, (size_t)count);
    try_frames(e, list, count, intra);
    if (e->cfg.skip && e->cfg.mode == FAP_ENCODE_BITRATE && mark_still(e, list, count, intra))
        try_frames(e, list, count, intra);
}

/* --- searches --- */

static void set_level(fap_encoder *e, int count, int level)
{
    for (int i = 0; i < count; i++)
        e->search->level[i] = level;
}

/* Long runs: by the mean; short ones by their windows. */
static int is_too_much(fap_encoder *e, int count, int intra)
{
    if (count < 2 * e->window.frames)
        return fap_fba_fullest(e, count, intra) > FULL;
    return (int64_t)(e->search->bits / COST_BIT) > fap_fba_allowance(e, count, intra);
}

static int try_level(fap_encoder *e, int count, int intra, int level)
{
    set_level(e, count, level);
    fap_fba_try(e, count, intra);
    return is_too_much(e, count, intra);
}

/* The least common lambda that is not too much, to @p grain; starts at the one before. Leaves its trial. */
static void find_level(fap_encoder *e, int count, int intra, int grain)
{
    fba_search *s = e->search;
    int level = s->common_level < SEARCH_LEAST ? SEARCH_LEAST : s->common_level, step = COARSE,
        low = SEARCH_LEAST, high = SEARCH_LEVELS;

    while (high - low > grain) {
        if (try_level(e, count, intra, level))
            low = level;
        else
            high = level;
        const int further = level == low ? level + step : level - step;
        level = further > low && further < high ? further : (low + high) / 2;
        step *= 2;
    }
    s->common_level = high;
    try_level(e, count, intra, high);
}

static void keep_trial(fap_encoder *e, int count)
{
    memcpy(e->search->best, e->path, (size_t)count * sizeof *e->path);
    memcpy(e->search->best_left_out, e->left_out, (size_t)count);
}

static void restore_trial(fap_encoder *e, int count)
{
    memcpy(e->path, e->search->best, (size_t)count * sizeof *e->path);
    memcpy(e->left_out, e->search->best_left_out, (size_t)count);
}

/* How good a trial is: those that keep to the windows come first, by their error. */
static uint64_t badness(int full, uint64_t error)
{
    const uint64_t over = (uint64_t)1 << 62;
    return full <= FULL ? (error < over ? error : over - 1) : over + (uint64_t)full;
}

/* The best of some rounds that keeps to the windows, or else the one that comes nearest to it. */
static uint64_t balance(fap_encoder *e, int count, int intra, int rounds)
{
    uint64_t least = UINT64_MAX;

    for (int round = 0; round < rounds; round++) {
        fap_fba_try(e, count, intra);
        const uint64_t bad = badness(fap_fba_fullest(e, count, intra), e->search->error);
        if (bad < least) {
            least = bad;
            keep_trial(e, count);
        }
        fap_fba_balance(e, count, intra, round);
    }
    restore_trial(e, count);
    return least;
}

/* Lambda is nearly the same for all quantisers: each goes on from the one before. */
static uint64_t error_at(fap_encoder *e, int count, int quant)
{
    e->plan.quant = quants[quant];
    return balance(e, count, 1, COARSE_ROUNDS);
}

static int index_of(int quant)
{
    int i = 0;

    while (i + 1 < QUANTS && quants[i] < quant)
        i++;
    return i;
}

/* Is quantiser @p k better than the best one so far? */
static void compare_quant(fap_encoder *e, int count, int k, int *best, uint64_t *least)
{
    fba_search *s = e->search;
    const uint64_t error = error_at(e, count, k);

    if (error >= *least)
        return;
    *least = error;
    *best = k;
    memcpy(s->best_level, s->level, (size_t)count * sizeof *s->level);
}

/* Errors over quantisers have several valleys: a coarse look at all, a fine one around the best. */
static void find_quant(fap_encoder *e, int count)
{
    enum { STRIDE = 3 };
    fba_search *s = e->search;
    const int begin = index_of(s->quant ? s->quant : 5);
    int best = begin;
    uint64_t least = UINT64_MAX;

    e->plan.quant = quants[begin];
    find_level(e, count, 1, SEARCH_OCTAVE);
    for (int k = begin % STRIDE; k < QUANTS; k += STRIDE)
        compare_quant(e, count, k, &best, &least);
    const int middle = best;
    for (int k = middle - 1; k <= middle + 1; k += 2)
        if (k >= 0 && k < QUANTS)
            compare_quant(e, count, k, &best, &least);
    memcpy(s->level, s->best_level, (size_t)count * sizeof *s->level);
    s->quant = e->plan.quant = quants[best];
}

/* --- FAP_ENCODE_ERROR --- */

/* Do two FAPs move the same place along its axes? */
static int share_place(int a, int b)
{
    const fap_info *i = fap_info_get(a), *k = fap_info_get(b);
    return i->point == k->point && (i->motion == FAP_MOTION_SIZE) == (k->motion == FAP_MOTION_SIZE);
}

/* Units that a FAP may be off so that its place is not off by more than what is asked for. */
static int64_t permitted_units(const fap_encoder *e, int fap)
{
    const uint64_t all = e->max_error;
    uint64_t axes = 0;

    for (int other = 1; other <= FAP_COUNT; other++)
        axes += e->plan_set[other] && share_place(fap, other);
    if (fap < 3) /* what one gains the other loses */
        return (int64_t)(all / 2 / e->sensitivity.nm[fap]);
    if (fap_info_get(fap)->group == fap_info_get(48)->group) /* arcs of a point off all axes may add up */
        return (int64_t)(all / axes / e->sensitivity.nm[fap]);
    return (int64_t)(fap_isqrt(all * all / axes) / e->sensitivity.nm[fap]);
}

/* Nothing that moves has steps larger than twice what is permitted. */
static int is_fine_enough(const fap_encoder *e, int count, int quant)
{
    const int tight = e->capacity >= e->cfg.intra;

    for (int param = FBA_VISEME_SELECT1; param < FBA_PARAMS; param++) {
        const int fap = fap_fba_fap(param);
        const int32_t *want = e->search->want + (size_t)param * (size_t)e->capacity;
        int moves = !tight;
        for (int i = 0; i < count && !moves; i++)
            moves = want[i] != 0;
        if (moves && e->plan.coded[fap] && fap_fba_step(param, quant) / 2 > e->permitted[fap])
            return fap_fba_step(param, 1) == fap_fba_step(param, quant);
    }
    return 1;
}

/* Out of reach of the ranges in force, but not of an I plane. */
static int asks_for_intra(fap_encoder *e, int i)
{
    int asks = 0;

    for (int k = 0; k < e->face.list.count; k++) {
        lane l = { e, &e->face.list.of[k], 0, 0, { 0 } };
        if (is_mixed(l.c))
            continue;
        prepare(&l);
        const int32_t place = fap_fba_nearest(l.t.want[i], l.t.step);
        if (!fap_fba_error(&l.t, l.t.want[i], e->path[i][l.c->param]) || place > l.t.widest ||
            place < -l.t.widest)
            continue;
        const int32_t from = i ? e->path[i - 1][l.c->param] : e->at[l.c->param];
        fap_fba_note_change(e, l.c->param, ((int64_t)place - from) * l.t.step);
        asks = 1;
    }
    return asks;
}

int fap_fba_search_carried(fap_encoder *e, int count)
{
    int i = 0;

    while (i < count && !asks_for_intra(e, i))
        i++;
    return i;
}

static void search_error(fap_encoder *e, int count, int intra)
{
    uint64_t fewest = UINT64_MAX;

    for (int fap = 1; intra && fap <= FAP_COUNT; fap++)
        e->permitted[fap] = e->plan.coded[fap] ? permitted_units(e, fap) : 0;
    set_level(e, count, 8 * SEARCH_OCTAVE); /* an error unit is 1/256 of a bit */
    if (!intra) {
        fap_fba_try(e, count, 0);
        return;
    }
    int best = 1;
    for (int k = 0; k < QUANTS; k++) {
        if (k && !is_fine_enough(e, count, quants[k]))
            break;
        e->plan.quant = quants[k];
        fap_fba_try(e, count, 1);
        if (e->search->bits < fewest) {
            fewest = e->search->bits;
            best = quants[k];
            keep_trial(e, count);
        }
    }
    e->plan.quant = (uint8_t)best;
    restore_trial(e, count);
}

/* --- */

void fap_fba_gather(fap_encoder *e, int count)
{
    for (int param = 0; param < FBA_PARAMS; param++) {
        int32_t *want = e->search->want + (size_t)param * (size_t)e->capacity;
        for (int i = 0; i < count; i++) {
            const fap_frame *f = &e->queue[i].frame;
            const int32_t before = i ? want[i - 1] : e->wanted[param];
            want[i] = f->state[fap_fba_fap(param)] == FAP_CODED ? fap_fba_wanted(f, param) : before;
        }
    }
}

/* What follows from other FAPs as they are needs no search. */
static void leave_out_exact(fap_encoder *e, int count)
{
    e->plan.quant = 1;
    fap_fba_list_coded(&e->plan_list, &e->plan);
    for (int k = 0; k < e->plan_list.count; k++) {
        const fba_coded *c = &e->plan_list.of[k];
        const int32_t *want = e->search->want + (size_t)c->param * (size_t)e->capacity;
        for (int i = 0; i < count; i++)
            e->path[i][c->param] = fap_fba_nearest(want[i], c->step);
    }
    fap_fba_leave_out(e, count, 1);
    fap_fba_list_coded(&e->plan_list, &e->plan);
}

/* Live, one frame says little: by the bits that there are for a symbol. */
static void guess_quant(fap_encoder *e)
{
    static const uint8_t by_bits[] = { 30, 20, 12, 8, 5, 3, 2 };
    const int64_t symbols = e->plan_list.count ? e->plan_list.count : 1;
    const int64_t bits = fap_fba_allowance(e, 1, 1) / symbols, last = sizeof by_bits - 1;

    e->plan.quant = bits > last ? 1 : by_bits[bits < 0 ? 0 : bits];
    e->search->quant = e->plan.quant;
}

static void search_bitrate(fap_encoder *e, int count, int intra)
{
    const int derives = intra && e->cfg.derive && e->capacity >= e->cfg.intra;

    if (derives)
        leave_out_exact(e, count);
    const int is_live = e->capacity < e->cfg.intra && count < e->window.frames;
    if (intra && is_live)
        guess_quant(e);
    if (intra && !is_live)
        find_quant(e, count);
    else
        find_level(e, count, intra, count > 1 ? SEARCH_OCTAVE : SEARCH_OCTAVE / 4);
    if (count == 1) {
        fap_fba_try(e, count, intra);
        return;
    }
    balance(e, count, intra, BALANCE_ROUNDS);
    if (derives && fap_fba_leave_out(e, count, 0))
        balance(e, count, intra, BALANCE_ROUNDS);
}

void fap_fba_search_run(fap_encoder *e, int count, int intra)
{
    if (!intra)
        fap_fba_gather(e, count);
    if (e->cfg.mode == FAP_ENCODE_BITRATE)
        search_bitrate(e, count, intra);
    else
        search_error(e, count, intra);
    if (e->cfg.mode == FAP_ENCODE_ERROR && intra && e->cfg.derive && e->capacity >= e->cfg.intra)
        fap_fba_leave_out(e, count, 0);
    if (intra)
        e->search->intra_bits = fap_fba_start_bits(e, count);
}

void fap_fba_search_done(fap_encoder *e, int done)
{
    if (!done)
        return;
    for (int param = 0; param < FBA_PARAMS; param++)
        e->wanted[param] = e->search->want[(size_t)param * (size_t)e->capacity + (size_t)done - 1];
}
