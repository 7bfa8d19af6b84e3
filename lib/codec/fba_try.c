/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * One trial of the search: a quantiser and a lambda for every frame. Each parameter takes its best path, which gives bits
 * and error; then frames that are not worth their bits are left out. See fba_search.h.
 */
#include <string.h>

#include "bank/sensitivity.h"
#include "codec/fba_search.h"

enum { PASSES = 2 };

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

/* --- planes that do not reach --- */

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
