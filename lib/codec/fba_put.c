/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Planned frames into planes, in a closed loop: what a range cannot hold is clipped, and later planes catch up.
 * Where bits are limited, a plane that does not fit is thinned, at last left out.
 */
#include <string.h>

#include "codec/fba_encode.h"
#include "codec/fba_search.h"
#include "codec/fba_time.h"

enum { SECONDS_A_DAY = 86400, THIN_MAX = 12 };

typedef enum put_result { PUT_DONE, PUT_LEFT_OUT, PUT_NO_MEMORY } put_result;

/* --- levels --- */

/* What is going to be put: levels by place in the list of coded parameters. */
typedef struct plane_levels {
    const fba_coded_list *list;
    int kind, clipped;
    int32_t level[FBA_PARAMS];
} plane_levels;

static void follow_path(fap_encoder *e, const int32_t *path, plane_levels *l)
{
    for (int k = 0; k < l->list->count; k++) {
        const fba_coded *c = &l->list->of[k];
        const int32_t min = c->symbols[l->kind].min, max = min + c->symbols[l->kind].size - 1;
        const int32_t level = path[c->param] - (l->kind == FBA_I ? 0 : e->at[c->param]);
        l->level[k] = level < min ? min : level > max ? max : level;
        if (level != l->level[k])
            l->clipped++;
    }
}

/* Sets parameter @p param to 0, if it is there. */
static void clear_param(const fap_encoder *e, plane_levels *l, int param)
{
    for (int k = 0; k < l->list->count; k++)
        if (l->list->of[k].param == param)
            l->level[k] = l->kind == FBA_I ? 0 : -e->at[param];
}

/*
 * Decoders tell an encoder that swaps the slots of expressions by a second intensity of nothing. Nobody sees that, so it
 * is not sent where it would be taken for one.
 */
static void avoid_doubt(const fap_encoder *e, plane_levels *l)
{
    fba_motion m = e->face.motion;

    for (int k = 0; k < l->list->count; k++) {
        const fba_coded *c = &l->list->of[k];
        m.value[c->param] = ((l->kind == FBA_I ? 0 : e->at[c->param]) + l->level[k]) * c->step;
    }
    if (fap_fba_swap_evidence(&m) > 0)
        clear_param(e, l, FBA_EXPRESSION_INTENSITY2);
}

/* With a fixed quantiser: farther than half a step, since no plane could carry more. */
static int is_behind(const fap_frame *want, const fba_coded *c, int32_t at)
{
    const int64_t away =
        c->param < FBA_FIRST_FAP ? 0 : 2 * ((int64_t)fap_fba_wanted(want, c->param) - (int64_t)at * c->step);
    return away > c->step || -away > c->step;
}

/* Where the parameters are after the plane, and what the decoder shows. */
static void take_levels(fap_encoder *e, const fba_queued *q, const int32_t *path, const plane_levels *l)
{
    for (int k = 0; k < l->list->count; k++) {
        const fba_coded *c = &l->list->of[k];
        const int32_t from = l->kind == FBA_I ? 0 : e->at[c->param];
        if (l->kind == FBA_P)
            fap_fba_note_change(e, c->param, ((int64_t)path[c->param] - from) * c->step);
        e->at[c->param] = from + l->level[k];
        e->face.motion.value[c->param] = e->at[c->param] * c->step;
        e->stats.clipped += e->cfg.mode == FAP_ENCODE_QUANT && is_behind(&q->frame, c, e->at[c->param]);
    }
    e->stats.clipped += e->cfg.mode == FAP_ENCODE_QUANT ? 0 : l->clipped;
    e->clipped_planes = l->clipped ? e->clipped_planes + 1 : 0;
}

/* --- one plane --- */

static int64_t time_code_of(const fap_encoder *e, int64_t number)
{
    const int64_t us = fap_fba_frames_us(e->rate_16, e->offset, number);

    if (!e->cfg.time_codes || us % 1000000 || us / 1000000 >= SECONDS_A_DAY)
        return -1;
    return us / 1000000;
}

static void describe(const fap_encoder *e, const fba_queued *q, int intra, fba_plane *p)
{
    p->intra = intra;
    p->rate_16 = e->rate_16;
    p->offset = e->offset;
    p->time_code_s = time_code_of(e, q->number);
    p->skipped = (uint32_t)(q->number - e->last_coded - 1);
    p->viseme_def = q->frame.viseme.def;
    p->init_face = q->frame.expression.init_face;
    p->expression_def = q->frame.expression.def;
}

/* The object start code in front of the first plane stands for the plane's own. */
static void put_start(fap_encoder *e, fap_bit_writer *w, int intra)
{
    if (!e->begun) {
        fap_fba_put_code(w, FBA_CODE_OBJECT);
        return;
    }
    if (!intra && !e->cfg.plane_codes && (w->at || !e->cfg.look_ahead))
        return;
    if (w->at)
        fap_bits_put_stuffing(w);
    fap_fba_put_code(w, FBA_CODE_PLANE);
}

static int put_plane(fap_encoder *e, fap_bit_writer *w, fba_plane *p, const plane_levels *l, int count)
{
    for (int k = 0; k < l->list->count; k++)
        p->symbol[k] = (uint16_t)(l->level[k] - l->list->of[k].symbols[l->kind].min);
    put_start(e, w, p->intra);
    fap_fba_put_header(w, p);
    if (p->intra)
        fap_fba_put_setup(w, &e->plan);
    return fap_fba_put_symbols(w, p, l->list, e->model, &e->pool, count && !p->intra);
}

/* Bits behind the place must be 0 to be written again. */
static void undo(fap_bit_writer *w, const fap_bit_writer *before)
{
    *w = *before;
    if (w->at % 8)
        w->data[w->at / 8] &= (uint8_t)(0xff00 >> w->at % 8);
}

/* Within the window? Stuffing in front of a start code counts for the planes on both sides of it. */
static int fits(const fap_encoder *e, const fap_bit_writer *w, uint64_t before, int64_t number)
{
    const int64_t bits = (int64_t)(w->at - before) + (before ? 0 : e->stuffing);
    return bits + fap_fba_window_used(&e->window, number) + ENCODER_END_BITS <= e->window.limit;
}

/* Thins the plane until it fits. Symbols are counted afterwards. */
static put_result put_within(fap_encoder *e, fap_bit_writer *w, fba_plane *p, plane_levels *l,
                             const fba_queued *q)
{
    const fap_bit_writer before = *w;

    for (int thin = 0; thin <= THIN_MAX; thin++) {
        if (thin && !fap_fba_thin(e, &q->frame, l->list, l->level, thin == THIN_MAX ? -1 : thin))
            continue;
        put_plane(e, w, p, l, 0);
        if (fits(e, w, before.at, q->number)) {
            if (p->intra || fap_fba_count_symbols(p, l->list, e->model, &e->pool))
                return PUT_DONE;
            undo(w, &before);
            return PUT_NO_MEMORY;
        }
        undo(w, &before);
        if (p->intra)
            break;
    }
    return PUT_LEFT_OUT;
}

static put_result put_unlimited(fap_encoder *e, fap_bit_writer *w, fba_plane *p, const plane_levels *l)
{
    const fap_bit_writer before = *w;

    if (put_plane(e, w, p, l, 1))
        return PUT_DONE;
    undo(w, &before);
    return PUT_NO_MEMORY;
}

static void begin_group(fap_encoder *e)
{
    e->face.setup = e->plan;
    e->face.list = e->plan_list;
    memcpy(e->group_set, e->plan_set, sizeof e->group_set);
    for (int param = 0; param < FBA_PARAMS; param++)
        fap_model_clear(&e->pool, &e->model[param]);
    e->in_group = 1;
    e->since_intra = e->clipped_planes = 0;
    e->stats.intra_frames++;
}

static put_result put_frame(fap_encoder *e, fap_bit_writer *w, const fba_queued *q, const int32_t *path,
                            int intra)
{
    plane_levels l = { .list = intra ? &e->plan_list : &e->face.list, .kind = intra ? FBA_I : FBA_P };
    fba_plane p;
    const uint64_t before = w->at;

    describe(e, q, intra, &p);
    follow_path(e, path, &l);
    const int has_expression = (intra ? &e->plan : &e->face.setup)->coded[2];
    if (has_expression)
        avoid_doubt(e, &l);
    const put_result r =
        e->window.limit == INT64_MAX ? put_unlimited(e, w, &p, &l) : put_within(e, w, &p, &l, q);
    if (r != PUT_DONE)
        return r;
    fap_fba_window_add(&e->window, q->number, (uint32_t)(w->at - before) + (before ? 0 : e->stuffing));
    if (intra)
        begin_group(e);
    take_levels(e, q, path, &l);
    e->face.motion.viseme_def = p.viseme_def;
    e->face.motion.init_face = p.init_face;
    e->face.motion.expression_def = p.expression_def;
    e->begun = 1;
    e->last_coded = q->number;
    return PUT_DONE;
}

/* --- what is shown --- */

/* As the decoder does it. P planes send what the I plane did, so states only change where some are derived. */
static void show_coded(fap_encoder *e, int intra)
{
    int derives = 0;

    for (int group = 2; group <= FAP_GROUPS; group++)
        derives |= e->face.setup.mask_type[group] == FBA_MASK_INTERPOLATE;
    if (intra || derives)
        fap_frame_hold(&e->shown_now);
    fap_fba_face_show(&e->face, e->cfg.fit, &e->shown_now);
    for (int fap = 3; derives && fap <= FAP_COUNT; fap++)
        e->stats.derived += e->shown_now.state[fap] == FAP_DERIVED;
}

static void note_error(fap_encoder *e, const fap_frame *want, const fap_frame *got)
{
    fap_frame_error error;

    fap_sensitivity_compare(&e->sensitivity, want, got, &error);
    e->error_sum_nm += error.sum_nm;
    e->error_items += (uint64_t)error.items;
    if (error.max_nm > e->max_error_nm)
        e->max_error_nm = error.max_nm;
}

static void show(fap_encoder *e, const fba_queued *q, put_result r, int intra)
{
    fap_frame *out = &e->shown[e->shown_count++];

    if (r == PUT_DONE)
        show_coded(e, intra);
    *out = e->shown_now;
    if (r != PUT_DONE)
        fap_frame_hold(out);
    out->number = q->number;
    out->pts_us = fap_fba_frames_us(e->rate_16, e->offset, q->number);
    note_error(e, &q->frame, out);
    e->stats.frames++;
    e->stats.skipped += r != PUT_DONE;
    e->since_intra++;
}

int fap_fba_put_frames(fap_encoder *e, fap_bit_writer *w, int count, int intra)
{
    e->shown_count = 0;
    for (int i = 0; i < count; i++) {
        const int is_last = e->flushed && i == e->count - 1, is_intra = intra && i == 0;
        const put_result r = e->left_out[i] && (is_intra || !is_last)
                                 ? PUT_LEFT_OUT
                                 : put_frame(e, w, &e->queue[i], e->path[i], is_intra);
        if (r == PUT_NO_MEMORY) {
            e->in_group = 0;
            return i;
        }
        show(e, &e->queue[i], r, is_intra);
        if (is_intra && r != PUT_DONE) {
            e->in_group = 0;
            return 1;
        }
    }
    return count;
}

void fap_fba_put_repeat(fap_encoder *e, fap_bit_writer *w)
{
    const fba_queued last = { e->shown_now, e->number };
    int32_t path[FBA_PARAMS];

    memcpy(path, e->at, sizeof path);
    if (!e->in_group || put_frame(e, w, &last, path, 0) != PUT_DONE)
        return;
    e->stats.skipped--;
    show_coded(e, 0);
    e->shown[0] = e->shown_now;
    e->shown[0].number = e->number;
    e->shown[0].pts_us = fap_fba_frames_us(e->rate_16, e->offset, e->number);
    e->shown_count = 1;
}
