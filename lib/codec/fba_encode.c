/* SPDX-License-Identifier: BSD-2-Clause */
/* The FBA encoder's outside: frames in, packets out, options, life. See fba_encode.h for what happens between. */
#include <string.h>

#include "base/mem.h"
#include "codec/fba_encode.h"
#include "codec/fba_search.h"
#include "codec/fba_time.h"
#include "param/frame.h"

enum {
    PLANE_BYTES = 512,  /* the largest P plane: 73 symbols of at most 15 bits, stuffing, header, skip */
    GROUP_BYTES = 1024, /* what an I plane has on top: masks, four tables of 66 bounds, start codes */
    RATE_MAX_16 = 255 * 16 + 15,
    BITRATE_MIN = 100,
    BITRATE_MAX = 1 << 30,
    SKIP_SHARE = 8, /* of a window's bits at most the 8th is spent on saying how many frames were left out */
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

static int longest_gap(const fap_encoder *e)
{
    const int64_t most = e->window.limit / (SKIP_SHARE * 4) * 15;
    return most < ENCODER_SKIP_MAX ? (int)most : ENCODER_SKIP_MAX;
}

/* What the queue may hold behind its first frame. */
static void begin_set(fap_encoder *e, const fap_frame *frame)
{
    if (e->in_group && fap_fba_in_set(frame, e->group_set, !e->search)) {
        memcpy(e->set, e->group_set, sizeof e->set);
        return;
    }
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        e->set[fap] = frame->state[fap] == FAP_CODED;
}

fap_err fap_encoder_send(fap_encoder *e, const fap_frame *frame)
{
    if (!e || !frame || e->flushed || !fap_frame_is_sound(frame))
        return FAP_E_ARG;
    if (e->count == e->capacity || (e->count && !fap_fba_in_set(frame, e->set, !e->search)))
        e->ready = 1;
    if (e->ready)
        return FAP_E_AGAIN;

    const int64_t number = place(e, frame);
    if (e->sent && number - e->number - 1 > longest_gap(e))
        return FAP_E_LIMIT;
    if (!e->sent++)
        e->first_pts_us = frame->pts_us;
    e->number = number;
    if (!e->count)
        begin_set(e, frame);
    e->queue[e->count++] = (fba_queued){ *frame, number };
    e->ready = !e->cfg.look_ahead;
    return FAP_OK;
}

void fap_encoder_flush(fap_encoder *e)
{
    e->flushed = e->ready = 1;
}

/* --- packets out --- */

static void drop_frames(fap_encoder *e, int done)
{
    e->last_frame = e->queue[done - 1].frame;
    if (e->search)
        fap_fba_search_done(e, done);
    e->count -= done;
    memmove(e->queue, e->queue + done, (size_t)e->count * sizeof *e->queue);
    e->ready = e->flushed || (e->count && !e->cfg.look_ahead);
}

/* A group that ends where a decoder's memory does may end before its first frame. */
static void encode_frames(fap_encoder *e, fap_bit_writer *w)
{
    int done = 0;

    while (!done) {
        int intra;
        const int count = fap_fba_plan(e, &intra);
        done = fap_fba_put_frames(e, w, count, intra);
    }
    drop_frames(e, done);
}

static void end_packet(fap_encoder *e, fap_bit_writer *w)
{
    const uint64_t before = w->at;

    e->stuffing = 0;
    if (!w->at)
        return;
    fap_bits_put_stuffing(w);
    e->stuffing = (uint32_t)(w->at - before);
    if (e->last_coded >= 0)
        fap_fba_window_add(&e->window, e->last_coded, e->stuffing);
}

static void encode_end(fap_encoder *e, fap_bit_writer *w)
{
    e->shown_count = 0;
    if (e->begun && e->last_coded < e->number) {
        fap_fba_put_repeat(e, w);
        end_packet(e, w);
    }
    if (!e->begun) {
        fap_fba_put_code(w, FBA_CODE_OBJECT);
        fap_bits_put_stuffing(w);
    }
    fap_fba_put_code(w, FBA_CODE_END);
    if (e->last_coded >= 0)
        fap_fba_window_add(&e->window, e->last_coded, 32);
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
    if (e->count) {
        encode_frames(e, &w);
        end_packet(e, &w);
    } else if (e->flushed) {
        encode_end(e, &w);
    }
    *size = (size_t)(w.at / 8);
    e->stats.bytes += (int64_t)*size;
    return FAP_OK;
}

size_t fap_encoder_bound(const fap_encoder *e)
{
    return GROUP_BYTES + (size_t)e->capacity * PLANE_BYTES;
}

/* --- life --- */

void fap_encoder_config_init(fap_encoder_config *cfg)
{
    *cfg = (fap_encoder_config){ .struct_size = sizeof *cfg,
                                 .rate_hz = 25,
                                 .mode = FAP_ENCODE_QUANT,
                                 .quant = 1,
                                 .bitrate_bps = 2000,
                                 .max_error_mm = 0.5,
                                 .intra = 250,
                                 .look_ahead = 250,
                                 .derive = -1,
                                 .skip = -1 };
}

static int is_sound(const fap_encoder_config *c)
{
    return c->quant >= 0 && c->quant <= 31 && c->intra >= 1 && c->intra <= ENCODER_INTRA_MAX &&
           c->rate_hz >= 1.0 / 32 && c->rate_hz <= RATE_MAX_16 / 16.0 + 0.01 && c->look_ahead >= 0 &&
           c->mode >= FAP_ENCODE_QUANT && c->mode <= FAP_ENCODE_ERROR && c->bitrate_bps >= BITRATE_MIN &&
           c->bitrate_bps <= BITRATE_MAX && c->max_error_mm > 0 && c->max_error_mm <= 1000;
}

static fap_err take_config(fap_encoder_config *to, const fap_encoder_config *cfg)
{
    fap_encoder_config_init(to);
    if (!cfg)
        return FAP_OK;
    if (cfg->struct_size < offsetof(fap_encoder_config, alloc))
        return FAP_E_ARG;
    memcpy(to, cfg, cfg->struct_size < sizeof *to ? cfg->struct_size : sizeof *to);
    if (!is_sound(to))
        return FAP_E_ARG;
    if (to->derive < 0)
        to->derive = to->mode != FAP_ENCODE_QUANT;
    if (to->skip < 0)
        to->skip = to->mode != FAP_ENCODE_QUANT;
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

static void begin_stream(fap_encoder *e)
{
    if (e->cfg.sensitivity)
        e->sensitivity = *e->cfg.sensitivity;
    else
        fap_sensitivity_typical(&e->sensitivity);
    e->cfg.sensitivity = NULL;
    e->max_error = (uint64_t)(e->cfg.max_error_mm * 1e6 + 0.5);
    e->last_coded = -1;
    choose_rate(e);
    fap_fba_window_init(&e->window, e->rate_16, e->offset,
                        e->cfg.mode == FAP_ENCODE_BITRATE ? 2 * (int64_t)e->cfg.bitrate_bps : INT64_MAX);
    fap_model_pool_init(&e->pool, e->node, MODEL_NODES);
}

static int take_memory(fap_encoder *e)
{
    const size_t frames = (size_t)e->capacity;

    e->queue = fap_mem_calloc(&e->alloc, frames, sizeof *e->queue);
    e->shown = fap_mem_calloc(&e->alloc, frames, sizeof *e->shown);
    e->path = fap_mem_calloc(&e->alloc, frames, sizeof *e->path);
    e->left_out = fap_mem_calloc(&e->alloc, frames, sizeof *e->left_out);
    e->node = fap_mem_calloc(&e->alloc, MODEL_NODES + 1, sizeof *e->node);
    return e->queue && e->shown && e->path && e->left_out && e->node &&
           (e->cfg.mode == FAP_ENCODE_QUANT || fap_fba_search_open(e));
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
    e->alloc = alloc;
    e->cfg = config;
    e->capacity = config.look_ahead < config.intra ? config.look_ahead : config.intra;
    if (!e->capacity)
        e->capacity = 1;
    if (!take_memory(e)) {
        fap_encoder_close(&e);
        return FAP_E_NOMEM;
    }
    begin_stream(e);
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
    fap_encoder_stats stats = e->stats;

    stats.largest_window_bits = e->window.largest;
    stats.mean_error_mm =
        e->error_items ? (double)((e->error_sum_nm + e->error_items / 2) / e->error_items) * 1e-6 : 0;
    stats.max_error_mm = (double)e->max_error_nm * 1e-6;
    return stats;
}

void fap_encoder_close(fap_encoder **encoder)
{
    if (!encoder || !*encoder)
        return;
    fap_encoder *e = *encoder;
    const fap_allocator alloc = e->alloc;
    fap_fba_search_close(e);
    fap_mem_free(&alloc, e->node);
    fap_mem_free(&alloc, e->left_out);
    fap_mem_free(&alloc, e->path);
    fap_mem_free(&alloc, e->shown);
    fap_mem_free(&alloc, e->queue);
    fap_mem_free(&alloc, e);
    *encoder = NULL;
}
