/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The FBA decoder: finds planes, parses them, keeps what P planes need. A plane is believed when it was
 * parsed to its end; until then everything it sets is a copy. Field names are the standard's. Source: ISO/IEC
 * 14496-2, face object plane syntax and arithmetic decoding of FAPs.
 */
#include <stdio.h>
#include <string.h>

#include <fap/decoder.h>

#include "base/mem.h"
#include "codec/conceal.h"
#include "codec/fba_body.h"
#include "codec/fba_codes.h"
#include "codec/fba_face.h"
#include "codec/fba_header.h"
#include "codec/fba_time.h"
#include "codec/fba_unsaid.h"

enum {
    STATE_MAX = 64 * 1024, /* bytes of a decoder with default options */
    DCT_FRAMES = 16,       /* frames of one plane of DCT segments */
    BOUND_MAX = FBA_BOUND_MAX * FBA_BOUND_UNIT,
};

#define DEVIATIONS(X)                                                                                        \
    X(NO_OBJECT_CODE, "the stream does not begin with an object start code")                                 \
    X(DRAFT_CODES, "start codes of a draft of the standard")                                                 \
    X(PADDING, "the unit ends in bits that are no stuffing")                                                 \
    X(FRAME_RATE, "a frame rate of 0 was ignored")                                                           \
    X(TIME_CODE, "a time code that goes back was ignored")                                                   \
    X(WAITING, "P planes without the I plane they need were left out")                                       \
    X(AFTER_END, "data behind the end code was left out")                                                    \
    X(STUFFING, "the bits in front of a start code are no stuffing")                                         \
    X(SILENT_BOUND, "no symbol ranges are sent, but +-1020 are used (an encoder known to do so)")            \
    X(SWAPPED, "select2 and intensity1 of expressions are swapped (an encoder known to do so)")

typedef enum deviation {
#define X(name, text) DEV_##name,
    DEVIATIONS(X)
#undef X
} deviation;

struct fap_decoder {
    fap_allocator alloc;
    fap_decoder_config cfg;
    uint32_t noticed;
    char text[FAP_ERROR_TEXT_SIZE];

    fap_bits bits;       /* the unit; data NULL: none */
    int64_t bits_before; /* in the units before it */
    int64_t planes;
    int started, plane_code;
    int face_ready, body_ready; /* an I plane was decoded: P planes can be */
    int segments;               /* the last I plane was in DCT segments */
    int lost;                   /* only a start code shows where the next plane is */
    int unit_lost;              /* send() was told that there is no unit */
    int waits;                  /* for an I plane, and what comes until then is concealed */
    int silent_bound;           /* the bound of an encoder that does not say it, once recognised */
    int swap;                   /* 1: slots of expressions are swapped; -1: they are not; 0: nothing told */
    fap_err late;               /* an error to be told after the frame that was saved */

    fba_face face;
    model model[FBA_PARAMS];
    fba_body body;
    model_pool pool;
    fba_time time;
    fap_frame frame; /* decoded last */
    fba_conceal conceal;
    fap_plane_info info;
    model_node node[]; /* [pool.count + 1] */
};

_Static_assert(sizeof(fap_decoder) + (MODEL_NODES + 1) * sizeof(model_node) <= STATE_MAX,
               "a decoder takes over 64 KiB");

static fap_err fail(fap_decoder *d, fap_err err, uint64_t at, const char *what, const char *why)
{
    snprintf(d->text, sizeof d->text, "bit %lld, plane %lld: %s: %s",
             (long long)(d->bits_before + (int64_t)at), (long long)d->planes, what, why);
    return err;
}

/* FAP_OK, or what the bit reader remembers to have gone wrong. */
static fap_err check_bits(fap_decoder *d, const char *what)
{
    const fap_bits *b = &d->bits;

    if (b->bad == BITS_FINE)
        return FAP_OK;
    return fail(d, FAP_E_BITSTREAM, b->bad_at, what, fap_bits_why(b));
}

static fap_err note(fap_decoder *d, deviation which)
{
    static const char *const texts[] = {
#define X(name, text) [DEV_##name] = text,
        DEVIATIONS(X)
#undef X
    };

    if (d->noticed & 1u << which)
        return FAP_OK;
    d->noticed |= 1u << which;
    if (d->cfg.strict)
        return fail(d, FAP_E_BITSTREAM, d->bits.at, "strict", texts[which]);
    if (d->cfg.notice)
        d->cfg.notice(d->cfg.notice_user, d->bits_before + (int64_t)d->bits.at, texts[which]);
    return FAP_OK;
}

static fap_err read_header(fap_decoder *d, fba_header *h)
{
    const char *what, *why;
    const fap_err err = fap_fba_header_read(&d->bits, h, &what, &why);

    return err == FAP_OK ? err : fail(d, err, d->bits.bad ? d->bits.bad_at : d->bits.at, what, why);
}

/* --- planes --- */

/* A first I plane without ranges; @p at: where its face data begins. */
static fap_err recognise_bound(fap_decoder *d, uint64_t at, const fba_header *h)
{
    const fap_bits here = d->bits;

    if (d->cfg.default_bound || h->has_body)
        return FAP_OK;
    d->bits.at = at;
    d->silent_bound = fap_fba_unsaid_bound(&d->bits, &d->face, d->model, &d->pool);
    d->bits = here;
    return d->silent_bound ? note(d, DEV_SILENT_BOUND) : FAP_OK;
}

/* Ranges are known, or they are sent, or the standard's or a recognised encoder's are taken. */
static fap_err set_up_face(fap_decoder *d, fba_face_reader *r, fba_face *copy, const fba_header *h)
{
    const uint64_t at = d->bits.at;
    fap_err err;

    *copy = d->face;
    err = fap_fba_face_set_up(r, copy);
    if (err != FAP_OK)
        return fail(d, err, r->at, r->what, r->why);
    if (d->face.has_ranges || r->params_at != r->ranges_at)
        return FAP_OK;
    err = recognise_bound(d, at, h);
    if (err != FAP_OK)
        return err;
    d->bits.at = at;
    *copy = d->face;
    r->default_bound = d->silent_bound ? d->silent_bound : d->cfg.default_bound;
    err = fap_fba_face_set_up(r, copy);
    return err == FAP_OK ? err : fail(d, err, r->at, r->what, r->why);
}

/* Of @p copy, P planes use the motion alone. */
static fap_err read_face(fap_decoder *d, fba_face *copy, const fba_header *h)
{
    const uint64_t start = d->bits.at;
    fba_face_reader r = { &d->bits, d->model, &d->pool, d->cfg.default_bound, start, start, 0, "", "" };
    fap_err err = FAP_OK;

    if (h->intra)
        err = set_up_face(d, &r, copy, h);
    else
        copy->motion = d->face.motion;
    if (err != FAP_OK)
        return err;
    d->info.setup_bits = (uint32_t)(r.ranges_at - start);
    d->info.range_bits = (uint32_t)(r.params_at - r.ranges_at);
    err = fap_fba_face_move(&r, h->intra ? &copy->list : &d->face.list, &copy->motion, h->intra);
    return err == FAP_OK ? err : fail(d, err, r.at, r.what, r.why);
}

/* A strength that can be no selection settles it for the whole stream. */
static fap_err recognise_swap(fap_decoder *d, const fba_motion *m)
{
    const int evidence = fap_fba_swap_evidence(m);

    if (evidence && d->swap >= 0)
        d->swap = evidence;
    return d->swap > 0 ? note(d, DEV_SWAPPED) : FAP_OK;
}

static fap_err read_body(fap_decoder *d, int intra)
{
    const fap_err err = fap_fba_body_skip(&d->body, &d->bits, intra, &d->pool);

    if (check_bits(d, "body data") != FAP_OK) /* first of all: what was read behind it means nothing */
        return FAP_E_BITSTREAM;
    if (err == FAP_E_UNSUPPORTED)
        return fail(d, err, d->bits.at, "body data", "DCT segments are not supported");
    if (err == FAP_E_LIMIT)
        return fail(d, err, d->bits.at, "body data", "more different symbols than symbol_memory holds");
    if (err != FAP_OK)
        return fail(d, err, d->bits.at, "bap_mask_type", "no such type");
    return FAP_OK;
}

static void keep_face(fap_decoder *d, const fba_face *copy, int intra)
{
    if (intra)
        d->face = *copy;
    else
        d->face.motion = copy->motion;
    d->face.swapped = d->swap > 0;
    d->face_ready = 1;
}

static void show_frame(fap_decoder *d, const fba_header *h)
{
    fap_frame_hold(&d->frame);
    if (h->has_face)
        fap_fba_face_show(&d->face, d->cfg.fit, &d->frame);
    d->frame.number = d->time.number;
    d->frame.pts_us = fap_fba_time_us(&d->time);
}

/* What an I plane sets for itself and those behind it. */
static void fill_info_of_setup(fap_plane_info *i, const fba_setup *s)
{
    i->quant = s->quant;
    i->gender = s->gender;
    memcpy(i->mask_type, s->mask_type, sizeof i->mask_type);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        i->i_min[fap] = s->range[FBA_I][fap].min;
        i->i_max[fap] = s->range[FBA_I][fap].max;
        i->p_min[fap] = s->range[FBA_P][fap].min;
        i->p_max[fap] = s->range[FBA_P][fap].max;
    }
}

static uint32_t bits_of_symbols(const fba_motion *m)
{
    uint32_t sum = 0;

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        sum += m->fap_bits[fap];
    return sum;
}

/* @p data: where the plane header ends. What the parts leave over is what arithmetic runs take to end, and flags. */
static void fill_info(fap_decoder *d, const fba_header *h, uint64_t start, uint64_t data)
{
    fap_plane_info *i = &d->info;

    i->header_bits = (uint32_t)(data - start);
    i->run_bits = (uint32_t)(d->bits.at - data) - i->setup_bits - i->range_bits - i->body_bits -
                  bits_of_symbols(&d->face.motion);
    i->concealed = 0;
    i->bit_position = d->bits_before + (int64_t)start;
    i->bit_count = (uint32_t)(d->bits.at - start);
    i->intra = (uint8_t)h->intra;
    i->start_code = (uint8_t)d->plane_code;
    i->has_face = (uint8_t)h->has_face;
    i->has_body = (uint8_t)h->has_body;
    i->skipped = h->time.skipped;
    i->rate_hz = fap_fba_rate_hz(d->time.rate_16, d->time.offset);
    memcpy(i->fap_bits, d->face.motion.fap_bits, sizeof i->fap_bits);
    if (h->intra && h->has_face)
        fill_info_of_setup(i, &d->face.setup);
}

/* Done as soon as the header is known: planes that cannot be decoded take their time all the same. */
static fap_err advance(fap_decoder *d, const fba_header *h)
{
    const unsigned ignored = fap_fba_time_advance(&d->time, &h->time, d->segments ? DCT_FRAMES : 1);
    fap_err err = FAP_OK;

    if (ignored & FBA_TIME_RATE_0)
        err = note(d, DEV_FRAME_RATE);
    if (err == FAP_OK && ignored & FBA_TIME_BACK)
        err = note(d, DEV_TIME_CODE);
    return err;
}

/*
 * Prediction is broken: what follows can only be found by its start code, and only an I plane helps. The
 * search begins where the plane did, at @p at: a broken plane may have been read past the next start code.
 */
static void lose(fap_decoder *d, uint64_t at)
{
    d->bits.at = at;
    d->lost = 1;
    d->face_ready = d->body_ready = 0;
}

static int can_decode(const fap_decoder *d, const fba_header *h)
{
    return h->intra || (h->has_face ? d->face_ready : d->body_ready);
}

/* Body data of the plane. What is wrong with it does not cost the face, when there is one. */
static fap_err pass_body(fap_decoder *d, const fba_header *h)
{
    fap_err err = FAP_E_BITSTREAM;

    if (!h->has_body)
        return FAP_OK;
    if (h->intra || d->body_ready)
        err = read_body(d, h->intra);
    else
        fail(d, err, d->bits.at, "body data", "a P plane without the I plane it needs");
    if (err == FAP_OK || !h->has_face)
        return err;
    d->late = err;
    return FAP_OK;
}

static fap_err read_data(fap_decoder *d, const fba_header *h, fba_face *copy)
{
    fap_err err = FAP_OK;

    d->info.setup_bits = d->info.range_bits = 0;
    if (h->has_face)
        err = read_face(d, copy, h);
    if (err == FAP_OK && h->has_face && (h->intra ? copy : &d->face)->setup.coded[2])
        err = recognise_swap(d, &copy->motion);
    const uint64_t body = d->bits.at;
    if (err == FAP_OK)
        err = pass_body(d, h);
    d->info.body_bits = (uint32_t)(d->bits.at - body);
    d->segments = err == FAP_E_UNSUPPORTED || d->late == FAP_E_UNSUPPORTED;
    return err;
}

/* --- losses --- */

/* In place of a frame that cannot be decoded. d->frame stays: what an I plane does not code is held from there. */
static void conceal(fap_decoder *d, fap_frame *out)
{
    *out = d->frame;
    out->number = d->time.number;
    out->pts_us = fap_fba_time_us(&d->time);
    fap_conceal_show(&d->conceal, out, (int)(d->time.rate_16 / 16));
    fap_plane_info *i = &d->info;
    i->concealed = 1;
    i->bit_position = d->bits_before + (int64_t)d->bits.at;
    i->bit_count = i->header_bits = i->setup_bits = i->range_bits = i->body_bits = i->run_bits = 0;
    i->intra = i->start_code = i->has_face = i->has_body = 0;
    i->skipped = 0;
    i->rate_hz = fap_fba_rate_hz(d->time.rate_16, d->time.offset);
    memset(i->fap_bits, 0, sizeof i->fap_bits);
}

/* The unit that send() was told of takes the time of one frame. */
static fap_err conceal_unit(fap_decoder *d, fap_frame *out)
{
    static const fba_time_fields one_frame;

    d->unit_lost = 0;
    d->planes++;
    fap_fba_time_advance(&d->time, &one_frame, d->segments ? DCT_FRAMES : 1);
    d->face_ready = d->body_ready = d->segments = 0;
    d->waits = 1;
    conceal(d, out);
    return FAP_OK;
}

/* A P plane without what it builds on. FAP_E_AGAIN: passed over. */
static fap_err pass_over(fap_decoder *d, uint64_t at, fap_frame *out)
{
    const fap_err err = note(d, DEV_WAITING);

    lose(d, at);
    if (err != FAP_OK)
        return err;
    if (!d->waits)
        return FAP_E_AGAIN;
    conceal(d, out);
    return FAP_OK;
}

/* --- a plane --- */

/* FAP_E_AGAIN: a P plane that cannot be decoded was passed over. */
static fap_err read_plane(fap_decoder *d, uint64_t start, fap_frame *out)
{
    const uint64_t at = d->bits.at;
    fba_header h;
    fba_face copy;

    d->planes++;
    fap_err err = read_header(d, &h);
    const uint64_t data = d->bits.at;
    if (err == FAP_OK)
        err = advance(d, &h);
    if (err == FAP_OK && !can_decode(d, &h))
        return pass_over(d, at, out);
    if (err == FAP_OK)
        err = read_data(d, &h, &copy);
    if (err != FAP_OK) {
        d->waits = d->conceal.started;
        return lose(d, at), err;
    }
    if (h.has_face)
        keep_face(d, &copy, h.intra);
    else
        memset(d->face.motion.fap_bits, 0, sizeof d->face.motion.fap_bits);
    d->body_ready |= h.has_body;
    show_frame(d, &h);
    fap_conceal_see(&d->conceal, &d->frame);
    d->waits = 0;
    fill_info(d, &h, start, data);
    *out = d->frame;
    if (d->late != FAP_OK) {
        d->waits = 1;
        lose(d, at);
    }
    return FAP_OK;
}

/* --- start codes --- */

static void begin_object(fap_decoder *d)
{
    d->face_ready = d->body_ready = d->lost = d->segments = d->waits = 0;
    d->face.has_ranges = d->silent_bound = d->face.swapped = d->swap = 0;
    fap_fba_body_init(&d->body);
}

static fap_err end_unit(fap_decoder *d, fap_err err)
{
    d->bits_before += (int64_t)d->bits.end;
    d->bits = (fap_bits){ 0 };
    return err;
}

/* As after open: what comes next has nothing to do with what was. */
static void reset_stream(fap_decoder *d)
{
    begin_object(d);
    d->started = 0;
    fap_fba_time_init(&d->time);
    d->frame = (fap_frame){ 0 };
    d->conceal = (fba_conceal){ 0 };
}

static fap_err take_end(fap_decoder *d)
{
    d->bits.at += 32;
    const fap_err err = d->bits.at < d->bits.end ? note(d, DEV_AFTER_END) : FAP_OK;
    reset_stream(d);
    return end_unit(d, err == FAP_OK ? FAP_E_END : err);
}

/* A start code at the reader. FAP_E_AGAIN: go on looking; FAP_OK: a plane follows. */
static fap_err take_code(fap_decoder *d, int code)
{
    fap_err err = FAP_E_AGAIN;

    if (code == FBA_CODE_END)
        return take_end(d);
    if ((code == FBA_CODE_DRAFT_OBJECT || code == FBA_CODE_DRAFT_PLANE) && note(d, DEV_DRAFT_CODES) != FAP_OK)
        return FAP_E_BITSTREAM;
    d->bits.at += 32;
    if (code == FBA_CODE_OBJECT || code == FBA_CODE_DRAFT_OBJECT) {
        begin_object(d);
        d->started = 1;
    } else if (code == FBA_CODE_PLANE || code == FBA_CODE_DRAFT_PLANE) {
        d->plane_code = 1;
        d->lost = 0;
        err = FAP_OK;
    } else {
        fap_fba_seek_code(
            &d->bits); /* sequence and object headers, user data: nothing in them concerns a face */
    }
    return err;
}

/*
 * The first bit of the next plane. FAP_E_AGAIN: the unit holds no more; FAP_E_END.
 * Data behind a plane that could not be parsed has no beginning until a start code gives it one.
 */
static fap_err find_plane(fap_decoder *d, uint64_t *start)
{
    fap_bits *b = &d->bits;

    d->plane_code = 0;
    for (;;) {
        if (d->lost)
            fap_fba_seek_plane(b, d->noticed >> DEV_DRAFT_CODES & 1);
        *start = b->at;
        if (fap_fba_is_used_up(b))
            return end_unit(d, FAP_E_AGAIN);
        int code = fap_fba_code_at(b, &b->at);
        if (code < 0 && fap_fba_is_badly_stuffed(b)) {
            if (note(d, DEV_STUFFING) != FAP_OK)
                return FAP_E_BITSTREAM;
            b->at = (b->at + 7) / 8 * 8;
            code = fap_fba_code_at(b, &b->at);
        }
        if (code < 0)
            break;
        const fap_err err = take_code(d, code);
        if (err != FAP_E_AGAIN)
            return err;
    }
    if (fap_fba_is_padding(b)) {
        const fap_err err = note(d, DEV_PADDING);
        return end_unit(d, err == FAP_OK ? FAP_E_AGAIN : err);
    }
    return FAP_OK;
}

fap_err fap_decoder_receive(fap_decoder *d, fap_frame *out)
{
    uint64_t start;
    fap_err err = FAP_E_AGAIN;

    if (!d || !out)
        return FAP_E_ARG;
    if (d->unit_lost)
        return conceal_unit(d, out);
    if (d->late != FAP_OK) {
        err = d->late;
        d->late = FAP_OK;
        return err;
    }
    while (err == FAP_E_AGAIN && d->bits.data) {
        err = find_plane(d, &start);
        if (err == FAP_OK && !d->started) {
            d->started = 1;
            err = note(d, DEV_NO_OBJECT_CODE);
        }
        if (err == FAP_OK)
            err = read_plane(d, start, out);
        d->bits.bad = BITS_FINE;
    }
    return err;
}

/* --- life --- */

void fap_decoder_config_init(fap_decoder_config *cfg)
{
    *cfg = (fap_decoder_config){ .struct_size = sizeof *cfg };
}

static fap_err take_config(fap_decoder_config *to, const fap_decoder_config *cfg)
{
    fap_decoder_config_init(to);
    if (!cfg)
        return FAP_OK;
    if (cfg->struct_size < offsetof(fap_decoder_config, alloc))
        return FAP_E_ARG;
    memcpy(to, cfg, cfg->struct_size < sizeof *to ? cfg->struct_size : sizeof *to);
    if (to->default_bound < 0 || to->default_bound > BOUND_MAX || to->symbol_memory < 0 ||
        to->symbol_memory > MODEL_POOL_MAX)
        return FAP_E_ARG;
    return FAP_OK;
}

fap_err fap_decoder_open(fap_decoder **decoder, const fap_decoder_config *cfg)
{
    fap_decoder_config config;

    if (!decoder)
        return FAP_E_ARG;
    *decoder = NULL;
    if (take_config(&config, cfg) != FAP_OK)
        return FAP_E_ARG;

    const fap_allocator alloc = fap_mem_allocator(&config.alloc);
    const size_t nodes = (config.symbol_memory ? (size_t)config.symbol_memory : MODEL_NODES) + 1;
    fap_decoder *d = fap_mem_calloc(&alloc, 1, sizeof *d + nodes * sizeof *d->node);
    if (!d)
        return FAP_E_NOMEM;
    d->alloc = alloc;
    d->cfg = config;
    fap_model_pool_init(&d->pool, d->node, (uint16_t)(nodes - 1));
    reset_stream(d);
    *decoder = d;
    return FAP_OK;
}

fap_err fap_decoder_send(fap_decoder *d, const uint8_t *data, size_t size)
{
    if (!d || !data != !size || size > SIZE_MAX / 16)
        return FAP_E_ARG;
    if (d->bits.data || d->unit_lost)
        return FAP_E_AGAIN;
    if (!data) {
        d->unit_lost = 1;
        return FAP_OK;
    }
    fap_bits_init(&d->bits, data, size);
    d->lost = 0;
    return FAP_OK;
}

void fap_decoder_flush(fap_decoder *d)
{
    end_unit(d, FAP_OK);
    d->face_ready = d->body_ready = d->unit_lost = d->waits = 0;
    d->late = FAP_OK;
}

const fap_plane_info *fap_decoder_plane(const fap_decoder *d)
{
    return &d->info;
}

const char *fap_decoder_last_error(const fap_decoder *d)
{
    return d ? d->text : "";
}

void fap_decoder_close(fap_decoder **decoder)
{
    if (!decoder || !*decoder)
        return;
    fap_decoder *d = *decoder;
    const fap_allocator alloc = d->alloc;
    fap_mem_free(&alloc, d);
    *decoder = NULL;
}
