/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fba_trellis.h. A Viterbi search: from each survivor to the lattice places around the value, as far as the
 * range lets it, and to where it is, since a parameter that rests costs least to tell about.
 */
#include "codec/fba_trellis.h"

#include "codec/fba_encode.h"

enum {
    ERROR_SHIFT = 6,     /* errors count in units of 64 nm */
    ERROR_MAX = 1 << 24, /* a metre of them; squares of 10,000 frames still add up */
    CANDIDATES = 3 * TRELLIS_STATES,
};

static const uint64_t not_permitted = (uint64_t)1 << 40;

typedef struct front {
    int count;
    trellis_state state[CANDIDATES];
    uint64_t cost[CANDIDATES];
} front;

uint64_t fap_fba_error(const trellis *t, int32_t want, int32_t place)
{
    const int64_t away = (int64_t)want - (int64_t)place * t->step, units = away < 0 ? -away : away;

    if (t->permitted >= 0)
        return units <= t->permitted ? 0 : not_permitted + (uint64_t)(units - t->permitted);
    const uint64_t error = (uint64_t)units * t->nm >> ERROR_SHIFT;
    return error < ERROR_MAX ? error * error : (uint64_t)ERROR_MAX * ERROR_MAX;
}

static void relax(front *f, int32_t place, uint64_t cost, int from)
{
    int i = 0;

    while (i < f->count && f->state[i].place != place)
        i++;
    if (i == f->count)
        f->count++;
    else if (cost >= f->cost[i])
        return;
    f->state[i] = (trellis_state){ place, (uint8_t)from };
    f->cost[i] = cost;
}

static int32_t between(int32_t v, int32_t min, int32_t max)
{
    return v < min ? min : v > max ? max : v;
}

static void move_by(const trellis *t, const front *from, int k, int i, int32_t level, front *to)
{
    const uint32_t bits = fba_cost_of_level(t->costs, level, t->total);
    relax(to, from->state[k].place + level, from->cost[k] + (t->lambda[i] * bits >> 8), k);
}

/* From survivor @p k to wherever it may go: nowhere, or to the places on both sides of the value. */
static void spread(const trellis *t, const front *from, int k, int i, int32_t near, front *to)
{
    const int32_t at = from->state[k].place,
                  other = (int64_t)near * t->step < t->want[i] ? near + 1 : near - 1;

    move_by(t, from, k, i, 0, to);
    if (near == at)
        return;
    move_by(t, from, k, i, between(near - at, t->range.min, t->range.max), to);
    if (other != at)
        move_by(t, from, k, i, between(other - at, t->range.min, t->range.max), to);
}

static void add_errors(const trellis *t, front *f, int i)
{
    for (int k = 0; k < f->count; k++)
        f->cost[k] += fap_fba_error(t, t->want[i], f->state[k].place);
}

/* The best ones, best first. */
static void prune(front *f)
{
    const int keep = f->count < TRELLIS_STATES ? f->count : TRELLIS_STATES;

    for (int i = 0; i < keep; i++) {
        int best = i;
        for (int k = i + 1; k < f->count; k++)
            if (f->cost[k] < f->cost[best])
                best = k;
        const trellis_state s = f->state[i];
        const uint64_t c = f->cost[i];
        f->state[i] = f->state[best], f->cost[i] = f->cost[best];
        f->state[best] = s, f->cost[best] = c;
    }
    f->count = keep;
}

static void begin(const trellis *t, front *f)
{
    f->count = 0;
    if (!t->intra) {
        relax(f, t->start, 0, 0);
        return;
    }
    const int32_t near = fap_fba_nearest(t->want[0], t->step);
    for (int32_t move = -1; move <= 1; move++)
        relax(f, between(near + move, -t->widest, t->widest), 0, 0);
    add_errors(t, f, 0);
}

static void step_on(const trellis *t, const front *from, front *to, int i)
{
    const int32_t near = fap_fba_nearest(t->want[i], t->step);

    to->count = 0;
    for (int k = 0; k < from->count; k++)
        if (t->still[i])
            relax(to, from->state[k].place, from->cost[k], k);
        else
            spread(t, from, k, i, near, to);
    add_errors(t, to, i);
    prune(to);
}

static void trace_back(const trellis *t, const front *last, int32_t *path)
{
    int k = 0;

    for (int i = 1; i < last->count; i++)
        k = last->cost[i] < last->cost[k] ? i : k;
    for (int i = t->count - 1; i >= 0; i--) {
        path[i] = t->state[i][k].place;
        k = t->state[i][k].from;
    }
}

void fap_fba_trellis(const trellis *t, int32_t *path)
{
    front a, b, *from = &a, *to = &b;

    begin(t, from);
    for (int i = 0; i < t->count; i++) {
        if (i || !t->intra) {
            step_on(t, from, to, i);
            front *const swap = from;
            from = to, to = swap;
        }
        for (int k = 0; k < from->count; k++)
            t->state[i][k] = from->state[k];
    }
    trace_back(t, from, path);
}
