/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fba_search.h. What 2 seconds hold: the load of windows over frames that were sent, that are planned, and that
 * will come; the share of an I plane; thinning what does not fit. Windows are counted in frames, as if no frame were
 * missing from the source: missing ones only make them emptier.
 */
#include <string.h>

#include "bank/sensitivity.h"
#include "codec/fba_search.h"

enum {
    FULL = 1024,
    FULL_MAX = 64 * FULL,
    P_BITS = 4 + 2, /* header without skip, flush of the last run */
    VISEME_BITS = 3,
    EXPRESSION_BITS = 4, /* flush and flags of their runs */
    CODE_BITS = 32 + 8,  /* with the stuffing in front */
    STUFFING_BITS = 8,
    I_HEADER_BITS = 19,
    TIME_CODE_BITS = 18,
    SKIP_BITS = 4,
    SLACK = 64,    /* a 64th of a window is kept for what estimates miss */
    GAIN = 5,      /* lambda moves 2.5 octaves for one of load, in 1/2 */
    MOVE_MAX = 48, /* 3 octaves at once */
};

static int64_t window_bits(const fap_encoder *e)
{
    return e->window.limit - ENCODER_END_BITS - e->window.limit / SLACK;
}

uint64_t fap_fba_square(const fap_encoder *e, int fap, int64_t units)
{
    const uint64_t nm = (uint64_t)(units < 0 ? -units : units) * e->sensitivity.nm[fap] >> 6;
    return nm < 1 << 24 ? nm * nm : (uint64_t)1 << 48;
}

/* --- what planes take besides symbols --- */

static int setup_bits(const fba_setup *s)
{
    uint8_t scratch[256];
    fap_bit_writer w;

    fap_bit_writer_init(&w, scratch, sizeof scratch);
    fap_fba_put_setup(&w, s);
    return (int)w.at;
}

static int64_t skipped_before(const fap_encoder *e, int i)
{
    int k = i - 1;

    while (k >= 0 && e->left_out[k])
        k--;
    return e->queue[i].number - (k >= 0 ? e->queue[k].number : e->last_coded) - 1;
}

static int run_bits(const fba_setup *s)
{
    return (s->coded[1] ? VISEME_BITS : 0) + (s->coded[2] ? EXPRESSION_BITS : 0);
}

static int intra_overhead(const fap_encoder *e)
{
    return CODE_BITS + I_HEADER_BITS + (e->cfg.time_codes ? TIME_CODE_BITS : 0) + setup_bits(&e->plan) + 2 +
           run_bits(&e->plan);
}

uint32_t fap_fba_overhead(const fap_encoder *e, int i, int intra)
{
    if (e->left_out[i])
        return 0;
    const int64_t skipped = skipped_before(e, i);
    int64_t bits = skipped > 0 ? SKIP_BITS * (skipped / 15 + 1) : 0;
    if (intra && i == 0)
        bits += intra_overhead(e);
    else
        bits += P_BITS + run_bits(intra ? &e->plan : &e->face.setup);
    if ((e->cfg.plane_codes && i) || (!intra && i == 0 && (e->cfg.look_ahead || e->cfg.plane_codes)))
        bits += CODE_BITS;
    if (!e->cfg.look_ahead)
        bits += STUFFING_BITS;
    return (uint32_t)(bits * COST_BIT);
}

/* --- windows --- */

/* What a frame behind the run may be expected to take: the mean, but for the next I plane. */
static int64_t future_bits(const fap_encoder *e, int ahead, int to_intra)
{
    const int is_live =
        e->capacity < e->cfg.intra; /* models that are to be cheap must learn first: half the mean */
    const int64_t all = window_bits(e) / (is_live ? 2 : 1), most = all - all / 4;
    const int64_t next = e->search->intra_bits < most ? e->search->intra_bits : most;

    if (to_intra >= e->window.frames)
        return all / e->window.frames;
    return ahead == to_intra ? next : (all - next) / e->window.frames;
}

static int is_last_run(const fap_encoder *e, int count)
{
    return e->flushed && count == e->count;
}

/* Sums of all that lambda does not change, and of what it does, up to each place; sum[0] is that of none. */
static void sum_up(fap_encoder *e, int count, int intra, int64_t *fixed, int64_t *moving)
{
    const fba_search *s = e->search;
    const int past = e->window.frames - 1, ahead = past;
    const int to_intra = e->cfg.intra - (intra ? 0 : e->since_intra) - count;
    int n = 0;

    fixed[0] = moving[0] = 0;
    for (int i = -past; i < count + ahead; i++, n++) {
        int64_t bits = 0;
        if (i < 0)
            bits = (int64_t)fap_fba_window_at(&e->window, e->queue[0].number + i) * COST_BIT;
        else if (i < count)
            bits = s->fixed[i];
        else if (!is_last_run(e, count))
            bits = future_bits(e, i - count, to_intra) * COST_BIT;
        fixed[n + 1] = fixed[n] + bits;
        moving[n + 1] = moving[n] + (i >= 0 && i < count ? s->moving[i] : 0);
    }
}

/* How full the windows are that end with each frame of the run or up to a window behind it. Into load. */
static int measure(fap_encoder *e, int count, int intra)
{
    const int frames = e->window.frames;
    int64_t *fixed = e->search->sum, *moving = fixed + count + 2 * WINDOW_MAX;
    int fullest = 0;

    sum_up(e, count, intra, fixed, moving);
    for (int end = 0; end < count + frames - 1; end++) {
        const int64_t room = window_bits(e) * COST_BIT - (fixed[end + frames] - fixed[end]);
        const int64_t load = moving[end + frames] - moving[end];
        int64_t full = load == 0 ? 0 : room > 0 ? load / COST_BIT * FULL / (room / COST_BIT + 1) : FULL_MAX;
        full = full < FULL_MAX ? full : FULL_MAX;
        e->search->load[end] = (int32_t)full;
        fullest = full > fullest ? (int)full : fullest;
    }
    return fullest;
}

int fap_fba_fullest(fap_encoder *e, int count, int intra)
{
    return measure(e, count, intra);
}

static int move_for(const fba_search *s, int full, int round)
{
    const int octaves = (int)s->costs.log2[full < 1                ? 1
                                           : full < COST_TOTAL_MAX ? full
                                                                   : COST_TOTAL_MAX] -
                        (int)s->costs.log2[FULL];
    const int move = octaves * SEARCH_OCTAVE * GAIN / 2 / COST_BIT * 4 / (4 + round);

    return move > MOVE_MAX ? MOVE_MAX : move < -MOVE_MAX ? -MOVE_MAX : move;
}

void fap_fba_balance(fap_encoder *e, int count, int intra, int round)
{
    fba_search *s = e->search;

    measure(e, count, intra);
    for (int i = 0; i < count; i++) {
        int full = 0;
        for (int end = i; end < i + e->window.frames; end++)
            full = s->load[end] > full ? s->load[end] : full;
        const int level = s->level[i] + move_for(s, full, round);
        s->level[i] = level < SEARCH_LEAST ? SEARCH_LEAST : level > SEARCH_LEVELS ? SEARCH_LEVELS : level;
    }
}

int64_t fap_fba_allowance(const fap_encoder *e, int count, int intra)
{
    const int64_t all = window_bits(e), mean = all * count / e->window.frames;
    const int ends_group = (intra ? 0 : e->since_intra) + count >= e->cfg.intra;

    if (is_last_run(e, count) || !ends_group)
        return mean;
    return mean - (e->search->intra_bits < all * 3 / 4 ? e->search->intra_bits : all * 3 / 4);
}

int64_t fap_fba_start_bits(const fap_encoder *e, int count)
{
    const fba_search *s = e->search;
    const int frames = e->window.frames;
    int64_t early = 0, late = 0;

    for (int i = 0; i < count; i++)
        *(i < frames ? &early : &late) += s->moving[i];
    const int64_t more = count >= 3 * frames ? early - late * frames / (count - frames) : 0;
    return (s->fixed[0] + (more > 0 ? more : 0)) / COST_BIT + 1;
}

/* --- I planes --- */

/* At fap_quant 1, where levels are most. */
static int64_t intra_bits(const fap_encoder *e)
{
    int64_t bits = intra_overhead(e) * COST_BIT;

    for (int param = 0; param < FBA_PARAMS; param++) {
        const int fap = fap_fba_fap(param);
        if (!e->plan.coded[fap])
            continue;
        const int32_t want = e->search->want[(size_t)param * (size_t)e->capacity];
        const int32_t level = fap_fba_nearest(want < 0 ? -(int64_t)want : want, fap_fba_step(param, 1));
        const int units =
            level >= COST_LEVELS ? FBA_BOUND_MAX : (level + FBA_BOUND_UNIT - 1) / FBA_BOUND_UNIT;
        bits += fba_cost_of_size(&e->search->costs, param < FBA_FIRST_FAP ? 64 : 1 + units * FBA_BOUND_UNIT);
    }
    return bits / COST_BIT + 1;
}

/* What is lost if a FAP is not coded. */
static uint64_t effect_of(const fap_encoder *e, int fap, int count)
{
    uint64_t sum = 0;

    for (int i = 0; i < count; i++) {
        const fap_frame *f = &e->queue[i].frame;
        if (f->state[fap] != FAP_CODED)
            continue;
        int64_t units = (int64_t)f->value[fap] - e->shown_now.value[fap];
        if (fap == 1)
            units = fap_viseme_distance(&f->viseme, &e->shown_now.viseme);
        if (fap == 2)
            units = fap_expression_distance(&f->expression, &e->shown_now.expression);
        sum += fap_fba_square(e, fap, units);
    }
    return sum;
}

static void leave_out_least(fap_encoder *e, const uint64_t effect[FAP_COUNT + 1])
{
    int least = 0;

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (e->plan.coded[fap] && (!least || effect[fap] < effect[least]))
            least = fap;
    e->plan.coded[least] = 0;
    fap_fba_set_masks(&e->plan);
}

int fap_fba_search_begin(fap_encoder *e, int count)
{
    const int64_t share = window_bits(e) - window_bits(e) / 4;
    uint64_t effect[FAP_COUNT + 1] = { 0 };

    fap_fba_gather(e, count);
    if (e->cfg.mode != FAP_ENCODE_BITRATE)
        return 1;
    if (intra_bits(e) > share)
        for (int fap = 1; fap <= FAP_COUNT; fap++)
            effect[fap] = effect_of(e, fap, count);
    for (int left = FAP_COUNT; left && intra_bits(e) > share; left--)
        leave_out_least(e, effect);
    e->plan.coded[0] = 0;
    return intra_bits(e) + fap_fba_window_used(&e->window, e->queue[0].number) <= window_bits(e);
}

/* --- thinning --- */

/* Bits of a level beyond those of staying, 1/256. */
static int64_t extra_bits(const fap_encoder *e, const fba_coded *c, int32_t level)
{
    const int min = c->symbols[FBA_P].min, size = c->symbols[FBA_P].size;
    const arith_interval move = fap_model_interval(&e->pool, &e->model[c->param], size, level - min),
                         stay = fap_model_interval(&e->pool, &e->model[c->param], size, -min);
    const uint16_t *log2 = e->search->costs.log2;

    return (int64_t)log2[stay.high - stay.low] - log2[move.high - move.low];
}

static int is_worth(const fap_encoder *e, const fap_frame *want, const fba_coded *c, int32_t level,
                    int strength)
{
    const int32_t value = fap_fba_wanted(want, c->param), at = e->at[c->param];
    const uint64_t stay = fap_fba_square(e, c->fap, (int64_t)value - (int64_t)at * c->step),
                   move = fap_fba_square(e, c->fap, (int64_t)value - (int64_t)(at + level) * c->step);
    const int64_t bits = extra_bits(e, c, level);
    const int octaves = e->search->common_level / SEARCH_OCTAVE + 2 * strength;

    return bits <= 0 ||
           (stay > move && (stay - move) / (uint64_t)bits >= (uint64_t)1 << (octaves > 8 ? octaves - 8 : 0));
}

int fap_fba_thin(fap_encoder *e, const fap_frame *want, const fba_coded_list *list, int32_t *level,
                 int strength)
{
    int changed = 0;

    for (int k = 0; k < list->count; k++) {
        const fba_coded *c = &list->of[k];
        if (!level[k] || (strength >= 0 && (c->fap < 3 || is_worth(e, want, c, level[k], strength))))
            continue;
        level[k] = 0;
        changed = 1;
    }
    return changed;
}
