/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What the next frames are coded with: where I planes stand, masks, ranges; and the lattice places of
 * FAP_ENCODE_QUANT. Source: ISO/IEC 14496-2, face object plane syntax.
 */
#include <string.h>

#include "codec/fba_encode.h"
#include "codec/fba_search.h"

enum { CLIPPED_PLANES_MAX = 4 }; /* in a row, then new ranges are worth an I plane */

int32_t fap_fba_wanted(const fap_frame *f, int param)
{
    switch (param) {
    case FBA_VISEME_SELECT1: return f->viseme.select1;
    case FBA_VISEME_SELECT2: return f->viseme.select2;
    case FBA_VISEME_BLEND: return f->viseme.blend;
    case FBA_EXPRESSION_SELECT1: return f->expression.select1;
    case FBA_EXPRESSION_INTENSITY1: return f->expression.intensity1;
    case FBA_EXPRESSION_SELECT2: return f->expression.select2;
    case FBA_EXPRESSION_INTENSITY2: return f->expression.intensity2;
    default: return f->value[param - FBA_FIRST_FAP + 3];
    }
}

int32_t fap_fba_nearest(int64_t value, int32_t step)
{
    if (value < 0)
        return -fap_fba_nearest(-value, step);
    if (value > ENCODER_VALUE_MAX)
        return (int32_t)(ENCODER_VALUE_MAX / step);
    return (int32_t)(value + step / 2) / step;
}

int fap_fba_in_set(const fap_frame *f, const uint8_t set[FAP_COUNT + 1], int exactly)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const int coded = f->state[fap] == FAP_CODED;
        if (coded > set[fap] || (exactly && coded < set[fap]))
            return 0;
    }
    return 1;
}

void fap_fba_note_change(fap_encoder *e, int param, int64_t change)
{
    const int64_t size = change < 0 ? -change : change, most = ENCODER_VALUE_MAX / 2;

    if (size > e->peak[param])
        e->peak[param] = (int32_t)(size < most ? size : most);
}

/* --- masks and ranges --- */

void fap_fba_set_masks(fba_setup *s)
{
    for (int group = 1; group <= FAP_GROUPS; group++) {
        const int first = fap_group_first(group), size = fap_group_count(group);
        int count = 0;
        for (int fap = first; fap < first + size; fap++)
            count += s->coded[fap];
        s->mask_type[group] = count == size ? FBA_MASK_ALL : count ? FBA_MASK_HOLD : FBA_MASK_NONE;
    }
}

static int16_t bound_that_holds(int32_t level, int quant)
{
    const int widest = fap_fba_bound(FBA_BOUND_MAX, quant), held = level > widest ? widest : level;
    return (int16_t)fap_fba_bound(fap_fba_bound_for(held, quant), quant);
}

void fap_fba_set_range(fba_setup *s, int kind, int param, int32_t min, int32_t max)
{
    if (param >= FBA_FIRST_FAP)
        s->range[kind][fap_fba_fap(param)] =
            (fba_range){ (int16_t)-bound_that_holds(-min, s->quant), bound_that_holds(max, s->quant) };
}

/* What a live encoder expects of a parameter: half as much again as it saw, or a part of the standard's range. */
static int32_t expected_change(const fap_encoder *e, int param, int32_t step)
{
    const int large = fap_info_get(fap_fba_fap(param))->p_max >= 300;

    if (e->peak[param])
        return (e->peak[param] + e->peak[param] / 2) / step + 1;
    return (large ? 2 * FBA_BOUND_UNIT : FBA_BOUND_UNIT) / (e->plan.quant ? e->plan.quant : 1);
}

void fap_fba_fit_range(fap_encoder *e, int param, const int32_t *place, size_t stride, int count)
{
    int32_t min = 0, max = 0;

    for (int i = 1; i < count; i++, place += stride) {
        const int32_t level = place[stride] - place[0];
        min = level < min ? level : min;
        max = level > max ? level : max;
    }
    if (e->capacity < e->cfg.intra) {
        const int32_t more = expected_change(e, param, fap_fba_step(param, e->plan.quant));
        min = -more < min ? -more : min;
        max = more > max ? more : max;
    }
    fap_fba_set_range(&e->plan, FBA_P, param, min, max);
}

static void fit_ranges(fap_encoder *e, int count)
{
    for (int param = FBA_FIRST_FAP; param < FBA_PARAMS; param++) {
        const int32_t first = e->path[0][param];
        fap_fba_set_range(&e->plan, FBA_P, param, 0, 0);
        fap_fba_set_range(&e->plan, FBA_I, param, 0, 0);
        if (!e->plan.coded[fap_fba_fap(param)])
            continue;
        fap_fba_fit_range(e, param, &e->path[0][param], FBA_PARAMS, count);
        fap_fba_set_range(&e->plan, FBA_I, param, first < 0 ? first : 0, first > 0 ? first : 0);
    }
}

/* --- FAP_ENCODE_QUANT --- */

/* Nearest place; of two that are equally near, the one where the parameter is. */
static int32_t settle(int32_t value, int32_t at, int32_t step)
{
    const int64_t away = (int64_t)value - (int64_t)at * step;

    return 2 * away <= step && -2 * away <= step ? at : fap_fba_nearest(value, step);
}

static int32_t between(int32_t v, int32_t min, int32_t max)
{
    return v < min ? min : v > max ? max : v;
}

/* As far as an I plane reaches, or a P plane from where it is. */
static void settle_all(fap_encoder *e, int count, int intra)
{
    const fba_coded_list *list = intra ? &e->plan_list : &e->face.list;
    const int32_t widest = fap_fba_bound(FBA_BOUND_MAX, e->cfg.quant);

    for (int i = 0; i < count; i++) {
        const int32_t *from = i ? e->path[i - 1] : e->at;
        for (const fba_coded *c = list->of; c < list->of + list->count; c++) {
            const int32_t value = fap_fba_wanted(&e->queue[i].frame, c->param);
            if (intra && !i)
                e->path[i][c->param] = between(fap_fba_nearest(value, c->step), -widest, widest);
            else
                e->path[i][c->param] = between(settle(value, from[c->param], c->step),
                                               from[c->param] - widest, from[c->param] + widest);
        }
    }
}

/* --- frames that change nothing --- */

static int says_the_same(const fap_frame *a, const fap_frame *b, const uint8_t *coded)
{
    return (!coded[1] || a->viseme.def == b->viseme.def) &&
           (!coded[2] ||
            (a->expression.def == b->expression.def && a->expression.init_face == b->expression.init_face));
}

void fap_fba_mark_unchanged(fap_encoder *e, const fba_coded_list *list, int count, int intra)
{
    const uint8_t *coded = intra ? e->plan.coded : e->face.setup.coded;

    for (int i = 0; i < count; i++) {
        const int32_t *from = i ? e->path[i - 1] : e->at;
        const fap_frame *before = i ? &e->queue[i - 1].frame : &e->last_frame;
        int same = e->cfg.skip && (i || !intra) && says_the_same(&e->queue[i].frame, before, coded);
        for (int k = 0; same && k < list->count; k++)
            same = e->path[i][list->of[k].param] == from[list->of[k].param];
        e->left_out[i] = (uint8_t)same;
    }
}

/* --- the plan --- */

/* What was seen long ago counts for less. */
static void fade_changes(fap_encoder *e)
{
    for (int param = 0; param < FBA_PARAMS; param++)
        e->peak[param] -= e->peak[param] / 4;
}

static int needs_intra(const fap_encoder *e)
{
    return !e->in_group || e->since_intra >= e->cfg.intra || e->clipped_planes >= CLIPPED_PLANES_MAX ||
           !fap_fba_in_set(&e->queue[0].frame, e->group_set, !e->search);
}

/* FAPs of the first frame, and those that the decoder knows and that come back later in the queue. */
static void choose_set(fap_encoder *e, int count)
{
    memset(e->plan_set, 0, sizeof e->plan_set);
    for (int i = 0; i < count; i++)
        for (int fap = 1; fap <= FAP_COUNT; fap++)
            if (e->queue[i].frame.state[fap] == FAP_CODED &&
                (i == 0 || e->shown_now.state[fap] != FAP_ABSENT))
                e->plan_set[fap] = 1;
}

static void begin_setup(fap_encoder *e, int count)
{
    if (e->search)
        choose_set(e, count);
    else
        for (int fap = 1; fap <= FAP_COUNT; fap++)
            e->plan_set[fap] = e->queue[0].frame.state[fap] == FAP_CODED;
    e->plan.quant = (uint8_t)e->cfg.quant;
    e->plan.gender = e->cfg.gender != 0;
    memcpy(e->plan.coded, e->plan_set, sizeof e->plan.coded);
    memset(e->plan_left, 0, sizeof e->plan_left);
    fap_fba_set_masks(&e->plan);
}

/* Would an I plane, but not a P plane, carry the frame? */
static int asks_for_intra(const fap_encoder *e, const int32_t *from, const int32_t *to)
{
    const int32_t widest = fap_fba_bound(FBA_BOUND_MAX, e->face.setup.quant);

    for (const fba_coded *c = e->face.list.of; c < e->face.list.of + e->face.list.count; c++) {
        const int32_t place = to[c->param], level = place - from[c->param] - c->symbols[FBA_P].min;
        if ((level < 0 || level >= c->symbols[FBA_P].size) && place >= -widest && place <= widest)
            return 1;
    }
    return 0;
}

/* The change that was asked for: the next ranges are to hold it. */
static void remember_change(fap_encoder *e, const int32_t *from, const int32_t *to)
{
    for (const fba_coded *c = e->face.list.of; c < e->face.list.of + e->face.list.count; c++)
        fap_fba_note_change(e, c->param, ((int64_t)to[c->param] - from[c->param]) * c->step);
}

/* How many frames P planes carry with the ranges that were guessed. */
static int carried(fap_encoder *e, int count)
{
    for (int i = 0; i < count; i++) {
        const int32_t *from = i ? e->path[i - 1] : e->at;
        if (asks_for_intra(e, from, e->path[i])) {
            remember_change(e, from, e->path[i]);
            return i;
        }
    }
    return count;
}

static void settle_run(fap_encoder *e, int count, int intra)
{
    settle_all(e, count, intra);
    if (intra && e->cfg.derive && e->capacity >= e->cfg.intra)
        fap_fba_leave_out(e, count, 0);
    if (e->cfg.skip)
        fap_fba_mark_unchanged(e, intra ? &e->plan_list : &e->face.list, count, intra);
}

static int plan_run(fap_encoder *e, int intra)
{
    const int left = e->cfg.intra - (intra ? 0 : e->since_intra), count = e->count < left ? e->count : left;

    if (intra)
        begin_setup(e, count);
    memset(e->left_out, 0, (size_t)count);
    if (intra && e->search && !fap_fba_search_begin(e, count))
        return e->left_out[0] = 1;
    fap_fba_list_coded(&e->plan_list, &e->plan);
    if (e->search)
        fap_fba_search_run(e, count, intra);
    else
        settle_run(e, count, intra);
    if (!intra && e->cfg.mode == FAP_ENCODE_ERROR)
        return fap_fba_search_carried(e, count);
    if (!intra)
        return e->cfg.mode == FAP_ENCODE_QUANT ? carried(e, count) : count;
    fit_ranges(e, count);
    fap_fba_list_coded(&e->plan_list, &e->plan);
    return count;
}

int fap_fba_plan(fap_encoder *e, int *intra)
{
    *intra = needs_intra(e);
    if (e->since_intra >= e->cfg.intra)
        fade_changes(e);
    int count = plan_run(e, *intra);
    if (!count) {
        *intra = 1;
        count = plan_run(e, 1);
    }
    return count;
}
