/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fba_search.h. FAP_ENCODE_BITRATE looks for the quantiser with the least error at the mean rate, and then
 * lets lambda follow the load of the windows. FAP_ENCODE_ERROR looks for the quantiser with the fewest bits.
 */
#include <string.h>

#include "base/mem.h"
#include "bank/sensitivity.h"
#include "codec/fba_search.h"

enum { BALANCE_ROUNDS = 8, COARSE_ROUNDS = 4, FULL = 1024, COARSE = 2 * SEARCH_OCTAVE };

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
