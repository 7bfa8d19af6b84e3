/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The FBA encoder. A group of frames with one mask is quantised in a closed loop first, which gives the
 * symbol ranges, and written afterwards. Field names are the standard's. Source: ISO/IEC 14496-2, face object
 * plane syntax and arithmetic coding of FAPs.
 */
#include <string.h>

#include <fap/encoder.h>

#include "base/mem.h"
#include "codec/fba.h"
#include "codec/fba_time.h"
#include "codec/models.h"
#include "param/frame.h"

enum {
    MAX_INTRA = 10000,
    MAX_SKIP = 4096,
    PLANE_BYTES = 512,  /* the largest P plane: 73 symbols of at most 15 bits, stuffing, header, skip */
    GROUP_BYTES = 1024, /* what an I plane has on top: masks, four tables of 66 bounds, start codes */
    RATE_MAX_16 = 255 * 16 + 15,
    MARKER_EVERY = 4,
};

typedef struct queued {
    fap_frame frame;
    int64_t number;   /* in the stream, from 0 */
    uint32_t skipped; /* frames left out in front of it */
} queued;

struct fap_encoder {
    fap_allocator alloc;
    fap_encoder_config cfg;
    uint32_t rate_16;
    int offset;
    int64_t number, first_pts_us, sent; /* of the last frame taken */
    int flushed, begun, ended;

    queued *queue; /* [intra] frames waiting */
    int count, ready;
    fap_frame *shown; /* [intra] the last packet, reconstructed */
    int shown_count;
    int16_t (*level)[FBA_PARAMS]; /* [intra] */

    fba_setup setup;
    int32_t value[FBA_PARAMS]; /* closed loop */
    model model[FBA_PARAMS];
    model_pool pool;
    model_node *node;
    fap_encoder_stats stats;
};

/* --- frames in --- */

/* The frame number nearest to the frame's time, always above the one before. */
static int64_t place(const fap_encoder *e, const fap_frame *f)
{
    if (!e->sent)
        return 0;
    const double rate = fap_fba_rate_hz(e->rate_16, e->offset);
    const double at = ((double)f->pts_us - (double)e->first_pts_us) * 1e-6 * rate + 0.5;
    return at >= (double)(e->number + 1) && at < 1e15 ? (int64_t)at : e->number + 1;
}

static int same_mask(const fap_frame *a, const fap_frame *b)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if ((a->state[fap] == FAP_CODED) != (b->state[fap] == FAP_CODED))
            return 0;
    return 1;
}

fap_err fap_encoder_send(fap_encoder *e, const fap_frame *frame)
{
    if (!e || !frame || e->flushed || !fap_frame_is_sound(frame))
        return FAP_E_ARG;
    if (e->count == e->cfg.intra || (e->count && !same_mask(&e->queue[0].frame, frame)))
        e->ready = 1;
    if (e->ready)
        return FAP_E_AGAIN;

    const int64_t number = place(e, frame), skipped = e->sent ? number - e->number - 1 : 0;
    if (skipped > MAX_SKIP)
        return FAP_E_LIMIT;
    if (!e->sent++)
        e->first_pts_us = frame->pts_us;
    e->number = number;
    e->queue[e->count++] = (queued){ *frame, number, (uint32_t)skipped };
    return FAP_OK;
}

void fap_encoder_flush(fap_encoder *e)
{
    e->flushed = e->ready = 1;
}

/* --- quantising --- */

static int32_t wanted(const fap_frame *f, int param)
{
    switch (param) {
    case FBA_VISEME_SELECT1: return f->viseme.select1;
    case FBA_VISEME_SELECT2: return f->viseme.select2;
    case FBA_VISEME_BLEND: return f->viseme.blend;
    case FBA_EXPRESSION_SELECT1: return f->expression.select1;
    case FBA_EXPRESSION_INTENSITY1: return f->expression.intensity1;
    case FBA_EXPRESSION_SELECT2: return f->expression.select2;
    case FBA_EXPRESSION_INTENSITY2: return f->expression.intensity2;
    default: return f->value[fap_fba_fap(param)];
    }
}

/* The largest range that a stream can state; FAPs 1 and 2 have fixed ones. */
static fba_range widest(const fba_setup *s, int param, int intra)
{
    if (param < FBA_FIRST_FAP)
        return fap_fba_param_range(s, param, intra);
    const int16_t bound = (int16_t)fap_fba_bound(FBA_BOUND_MAX, s->quant);
    return (fba_range){ (int16_t)-bound, bound };
}

/* Nearest level; halves away from zero. */
static int64_t nearest(int64_t difference, int32_t step)
{
    const int64_t size = difference < 0 ? -difference : difference, level = (size + step / 2) / step;
    return difference < 0 ? -level : level;
}

static int16_t quantise(fap_encoder *e, const fap_frame *f, int param, int intra)
{
    const int32_t step = fap_fba_step(param, e->setup.quant), from = intra ? 0 : e->value[param];
    const fba_range range = widest(&e->setup, param, intra);
    int64_t level = nearest((int64_t)wanted(f, param) - from, step);

    if (level < range.min || level > range.max) {
        e->stats.clipped += param >= FBA_FIRST_FAP;
        level = level < range.min ? range.min : range.max;
    }
    e->value[param] = (int32_t)(from + level * step);
    return (int16_t)level;
}

static uint8_t clamp_strength(int32_t v)
{
    return (uint8_t)(v > FRAME_STRENGTH_MAX ? FRAME_STRENGTH_MAX : v < 0 ? 0 : v);
}

static void show(const fap_encoder *e, fap_frame *f)
{
    const int32_t *v = e->value;

    f->viseme.blend = clamp_strength(v[FBA_VISEME_BLEND]);
    f->expression.intensity1 = clamp_strength(v[FBA_EXPRESSION_INTENSITY1]);
    f->expression.intensity2 = clamp_strength(v[FBA_EXPRESSION_INTENSITY2]);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (e->setup.coded[fap])
            f->value[fap] = v[FBA_FIRST_FAP + fap - 3];
}

/* All levels of the group, and what a decoder makes of them. */
static void quantise_group(fap_encoder *e)
{
    for (int i = 0; i < e->count; i++) {
        e->shown[i] = e->queue[i].frame;
        e->shown[i].number = e->queue[i].number;
        e->shown[i].pts_us = fap_fba_frames_us(e->rate_16, e->offset, e->queue[i].number);
        for (int param = 0; param < FBA_PARAMS; param++)
            if (e->setup.coded[fap_fba_fap(param)])
                e->level[i][param] = quantise(e, &e->queue[i].frame, param, i == 0);
        show(e, &e->shown[i]);
    }
}

static void widen(fba_range *r, int level)
{
    if (level > r->max)
        r->max = (int16_t)level;
    if (level < r->min)
        r->min = (int16_t)level;
}

/* The smallest bound that can be sent and holds @p level. */
static int bound_for(int level, int quant)
{
    int n = 0;
    while (fap_fba_bound(n, quant) < level)
        n++;
    return n;
}

static void fit_ranges(fap_encoder *e)
{
    for (int param = FBA_FIRST_FAP; param < FBA_PARAMS; param++) {
        const int fap = fap_fba_fap(param), quant = e->setup.quant;
        fba_range r[2] = { { 0, 0 }, { 0, 0 } };
        for (int i = 0; e->setup.coded[fap] && i < e->count; i++)
            widen(&r[i == 0 ? FBA_I : FBA_P], e->level[i][param]);
        for (int kind = 0; kind < 2; kind++)
            e->setup.range[kind][fap] =
                (fba_range){ (int16_t)-fap_fba_bound(bound_for(-r[kind].min, quant), quant),
                             (int16_t)fap_fba_bound(bound_for(r[kind].max, quant), quant) };
    }
}

static void choose_masks(fap_encoder *e)
{
    for (int group = 1; group <= FAP_GROUPS; group++) {
        const int first = fap_group_first(group), size = fap_group_count(group);
        int count = 0;
        for (int fap = first; fap < first + size; fap++)
            count += e->setup.coded[fap] = e->queue[0].frame.state[fap] == FAP_CODED;
        e->setup.mask_type[group] = count == size ? FBA_MASK_ALL : count ? FBA_MASK_HOLD : FBA_MASK_NONE;
    }
}

/* --- writing --- */

static void put_code(fap_bit_writer *w, int code)
{
    fap_bits_put(w, 24, FBA_START_PREFIX);
    fap_bits_put(w, 8, (uint32_t)code);
}

static void put_skip(fap_bit_writer *w, uint32_t skipped)
{
    fap_bits_put(w, 1, skipped > 0);
    if (!skipped)
        return;
    for (; skipped >= 15; skipped -= 15)
        fap_bits_put(w, 4, 15);
    fap_bits_put(w, 4, skipped);
}

static void put_header(const fap_encoder *e, fap_bit_writer *w, int intra, uint32_t skipped)
{
    fap_bits_put(w, 1, (uint32_t)intra);
    fap_bits_put(w, 2, 1); /* fba_object_mask: face */
    if (intra) {
        fap_bits_put(w, 1, 1); /* is_frame_rate */
        fap_bits_put(w, 8, e->rate_16 / 16);
        fap_bits_put(w, 4, e->rate_16 % 16);
        fap_bits_put(w, 1, (uint32_t)e->offset);
        fap_bits_put(w, 1, 0); /* is_time_code */
    }
    put_skip(w, skipped);
}

static void put_masks(const fap_encoder *e, fap_bit_writer *w)
{
    for (int group = 1; group <= FAP_GROUPS; group++) {
        const int first = fap_group_first(group), type = e->setup.mask_type[group];
        fap_bits_put(w, 1, 1);
        fap_bits_put(w, 2, (uint32_t)type);
        for (int fap = first; type == FBA_MASK_HOLD && fap < first + fap_group_count(group); fap++)
            fap_bits_put(w, 1, e->setup.coded[fap]);
    }
}

/* Tables 0..3: I max, I min, P max, P min. */
static void put_range_table(const fap_encoder *e, fap_bit_writer *w, int table)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const int place_in_group = fap - fap_group_first(fap_info_get(fap)->group);
        const fba_range r = e->setup.range[table < 2 ? FBA_I : FBA_P][fap];
        if (place_in_group % MARKER_EVERY == 0)
            fap_bits_put(w, 1, 1);
        if (e->setup.coded[fap])
            fap_bits_put(w, 5, (uint32_t)bound_for(table % 2 ? -r.min : r.max, e->setup.quant));
    }
}

static void put_setup(const fap_encoder *e, fap_bit_writer *w)
{
    fap_bits_put(w, 5, e->setup.quant);
    put_masks(e, w);
    fap_bits_put(w, 1, e->setup.gender);
    fap_bits_put(w, 1, 0);  /* fba_object_coding_type: predictive */
    fap_bits_put(w, 4, 15); /* all four range tables are new */
    for (int table = 0; table < 4; table++)
        put_range_table(e, w, table);
}

static int put_run(fap_encoder *e, fap_bit_writer *w, int i, int first, int end)
{
    static const model flat;
    arith_encoder a;

    fap_arith_encoder_begin(&a, w);
    for (int param = first; param < end; param++) {
        if (!e->setup.coded[fap_fba_fap(param)])
            continue;
        const fba_range range = fap_fba_param_range(&e->setup, param, i == 0);
        const int size = fba_range_size(range), symbol = e->level[i][param] - range.min;
        fap_arith_encoder_put(&a, fap_model_interval(&e->pool, i ? &e->model[param] : &flat, size, symbol));
        if (i && !fap_model_count(&e->pool, &e->model[param], size, symbol))
            return 0;
    }
    fap_arith_encoder_end(&a);
    return 1;
}

/* Frame @p i of the group; 0: no decoder is bound to have the memory for its symbols. */
static int put_params(fap_encoder *e, fap_bit_writer *w, int i)
{
    const fap_frame *f = &e->queue[i].frame;

    if (e->setup.coded[1]) {
        if (!put_run(e, w, i, FBA_VISEME_SELECT1, FBA_EXPRESSION_SELECT1))
            return 0;
        fap_bits_put(w, 1, f->viseme.def);
    }
    if (e->setup.coded[2]) {
        if (!put_run(e, w, i, FBA_EXPRESSION_SELECT1, FBA_FIRST_FAP))
            return 0;
        fap_bits_put(w, 1, f->expression.init_face);
        fap_bits_put(w, 1, f->expression.def);
    }
    return put_run(e, w, i, FBA_FIRST_FAP, FBA_PARAMS);
}

static int put_plane(fap_encoder *e, fap_bit_writer *w, int i)
{
    if (i && e->cfg.plane_codes) {
        fap_bits_put_stuffing(w);
        put_code(w, FBA_CODE_PLANE);
    }
    put_header(e, w, i == 0, e->queue[i].skipped);
    if (i == 0)
        put_setup(e, w);
    return put_params(e, w, i);
}

static void clear_models(fap_encoder *e)
{
    for (int param = 0; param < FBA_PARAMS; param++)
        fap_model_clear(&e->pool, &e->model[param]);
}

/* How many frames were written: all, or those before the one that no decoder need have memory for. */
static int put_group(fap_encoder *e, fap_bit_writer *w)
{
    clear_models(e);
    for (int i = 0; i < e->count; i++) {
        const uint64_t before = w->at;
        if (put_plane(e, w, i))
            continue;
        w->at = before;
        if (before % 8) /* bits behind the place must be 0 to be written again */
            w->data[before / 8] &= (uint8_t)(0xff00 >> before % 8);
        return i;
    }
    return e->count;
}

/* The object start code in front of the first plane stands for the plane's own. */
static void put_group_code(fap_encoder *e, fap_bit_writer *w)
{
    put_code(w, e->begun ? FBA_CODE_PLANE : FBA_CODE_OBJECT);
    e->begun = 1;
}

static void drop_frames(fap_encoder *e, int done)
{
    e->shown_count = done;
    e->count -= done;
    memmove(e->queue, e->queue + done, (size_t)e->count * sizeof *e->queue);
    e->ready = e->flushed;
    e->stats.frames += done;
    e->stats.intra_frames++;
}

static void encode_group(fap_encoder *e, fap_bit_writer *w)
{
    choose_masks(e);
    quantise_group(e);
    fit_ranges(e);
    put_group_code(e, w);
    drop_frames(e, put_group(e, w));
    fap_bits_put_stuffing(w);
}

static void encode_end(fap_encoder *e, fap_bit_writer *w)
{
    e->shown_count = 0;
    if (!e->begun) {
        put_group_code(e, w);
        fap_bits_put_stuffing(w);
    }
    put_code(w, FBA_CODE_END);
    e->ended = 1;
}

fap_err fap_encoder_receive(fap_encoder *e, uint8_t *data, size_t room, size_t *size)
{
    fap_bit_writer w;

    if (!e || !data || !size || room < fap_encoder_bound(e))
        return FAP_E_ARG;
    *size = 0;
    if (e->ended)
        return FAP_E_END;
    if (!e->ready)
        return FAP_E_AGAIN;
    fap_bit_writer_init(&w, data, room);
    if (e->count)
        encode_group(e, &w);
    else
        encode_end(e, &w);
    *size = (size_t)(w.at / 8);
    e->stats.bytes += (int64_t)*size;
    return FAP_OK;
}

size_t fap_encoder_bound(const fap_encoder *e)
{
    return GROUP_BYTES + (size_t)e->cfg.intra * PLANE_BYTES;
}

/* --- life --- */

void fap_encoder_config_init(fap_encoder_config *cfg)
{
    *cfg = (fap_encoder_config){ .struct_size = sizeof *cfg, .rate_hz = 25, .quant = 1, .intra = 250 };
}

static fap_err take_config(fap_encoder_config *to, const fap_encoder_config *cfg)
{
    fap_encoder_config_init(to);
    if (!cfg)
        return FAP_OK;
    if (cfg->struct_size < offsetof(fap_encoder_config, alloc))
        return FAP_E_ARG;
    memcpy(to, cfg, cfg->struct_size < sizeof *to ? cfg->struct_size : sizeof *to);
    if (to->quant < 0 || to->quant > 31 || to->intra < 1 || to->intra > MAX_INTRA ||
        !(to->rate_hz >= 1.0 / 32) || !(to->rate_hz <= RATE_MAX_16 / 16.0 + 0.01))
        return FAP_E_ARG;
    return FAP_OK;
}

static double away(double a, double b)
{
    return a > b ? a - b : b - a;
}

static uint32_t sixteenths(double rate_hz)
{
    const uint32_t n = (uint32_t)(rate_hz * 16 + 0.5);
    return n > RATE_MAX_16 ? RATE_MAX_16 : n ? n : 1;
}

static void choose_rate(fap_encoder *e)
{
    const double rate = e->cfg.rate_hz;
    const uint32_t plain = sixteenths(rate), slowed = sixteenths(rate * 1001 / 1000);

    e->offset = away(fap_fba_rate_hz(slowed, 1), rate) < away(fap_fba_rate_hz(plain, 0), rate) - 1e-6;
    e->rate_16 = e->offset ? slowed : plain;
}

fap_err fap_encoder_open(fap_encoder **encoder, const fap_encoder_config *cfg)
{
    fap_encoder_config config;

    if (!encoder)
        return FAP_E_ARG;
    *encoder = NULL;
    if (take_config(&config, cfg) != FAP_OK)
        return FAP_E_ARG;

    const fap_allocator alloc = fap_mem_allocator(&config.alloc);
    fap_encoder *e = fap_mem_calloc(&alloc, 1, sizeof *e);
    if (!e)
        return FAP_E_NOMEM;
    const size_t frames = (size_t)config.intra;
    e->alloc = alloc;
    e->cfg = config;
    e->queue = fap_mem_calloc(&alloc, frames, sizeof *e->queue);
    e->shown = fap_mem_calloc(&alloc, frames, sizeof *e->shown);
    e->level = fap_mem_calloc(&alloc, frames, sizeof *e->level);
    e->node = fap_mem_calloc(&alloc, MODEL_NODES + 1, sizeof *e->node);
    if (!e->queue || !e->shown || !e->level || !e->node) {
        fap_encoder_close(&e);
        return FAP_E_NOMEM;
    }
    fap_model_pool_init(&e->pool, e->node, MODEL_NODES);
    e->setup.quant = (uint8_t)config.quant;
    e->setup.gender = config.gender != 0;
    choose_rate(e);
    *encoder = e;
    return FAP_OK;
}

const fap_frame *fap_encoder_reconstruction(const fap_encoder *e, int *count)
{
    *count = e->shown_count;
    return e->shown;
}

fap_encoder_stats fap_encoder_get_stats(const fap_encoder *e)
{
    return e->stats;
}

void fap_encoder_close(fap_encoder **encoder)
{
    if (!encoder || !*encoder)
        return;
    fap_encoder *e = *encoder;
    const fap_allocator alloc = e->alloc;
    fap_mem_free(&alloc, e->node);
    fap_mem_free(&alloc, e->level);
    fap_mem_free(&alloc, e->shown);
    fap_mem_free(&alloc, e->queue);
    fap_mem_free(&alloc, e);
    *encoder = NULL;
}
