/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The FBA decoder: finds planes, parses them, keeps what P planes need. A plane is believed when it was
 * parsed to its end; until then everything it sets is a copy. Field names are the standard's. Source: ISO/IEC
 * 14496-2, face object plane syntax and arithmetic decoding of FAPs.
 */
#include <stdio.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/derive.h>

#include "base/mem.h"
#include "codec/fba.h"
#include "codec/fba_body.h"

enum {
    STATE_MAX = 64 * 1024,     /* bytes of a decoder with default options */
    SKIP_MAX = 1 << 20,        /* frames; twelve hours at 25 a second */
    DCT_FRAMES = 16,           /* frames of one plane of DCT segments */
    DEFAULT_RATE_16 = 30 * 16, /* frames in 16 seconds, before the stream says */
    BOUND_MAX = FBA_BOUND_MAX * FBA_BOUND_UNIT,
    MARKER_EVERY = 4,
};

static const int32_t value_limit = 1 << 30; /* far outside of anything a face does, and safe to add to */

#define DEVIATIONS(X)                                                                                        \
    X(NO_OBJECT_CODE, "the stream does not begin with an object start code")                                 \
    X(DRAFT_CODES, "start codes of a draft of the standard")                                                 \
    X(PADDING, "the unit ends in bits that are no stuffing")                                                 \
    X(FRAME_RATE, "a frame rate of 0 was ignored")                                                           \
    X(TIME_CODE, "a time code that goes back was ignored")                                                   \
    X(WAITING, "P planes without the I plane they need were left out")                                       \
    X(AFTER_END, "data behind the end code was left out")

typedef enum deviation {
#define X(name, text) DEV_##name,
    DEVIATIONS(X)
#undef X
} deviation;

/* Frames are counted from where the rate last changed, so that rounding does not add up. */
typedef struct timing {
    uint32_t rate_16; /* frames in 16 seconds */
    int offset;       /* frequency_offset: times 1000/1001 */
    int started;
    int64_t number; /* of the last frame */
    int64_t base_us, since_base;
    int64_t epoch_us; /* time code minus media time */
    int has_epoch;
} timing;

typedef struct plane_header {
    int intra, has_face, has_body;
    int is_frame_rate, is_time_code;
    uint32_t rate_16, offset, time_code_s, skipped;
} plane_header;

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

    int has_ranges;
    fba_setup setup;
    int32_t value[FBA_PARAMS];
    uint8_t flags[3]; /* viseme_def, init_face, expression_def */
    model model[FBA_PARAMS];
    fba_body body;
    model_pool pool;
    timing time;
    fap_frame frame;
    fap_plane_info info;
    model_node node[]; /* [pool.count + 1] */
};

_Static_assert(sizeof(fap_decoder) + (MODEL_NODES + 1) * sizeof(model_node) <= STATE_MAX,
               "a decoder takes over 64 KiB");

/* A face plane while it is parsed. */
typedef struct face_plane {
    fba_setup setup;
    int has_ranges;
    int32_t value[FBA_PARAMS];
    uint8_t flags[3];
    uint16_t fap_bits[FAP_COUNT + 1];
} face_plane;

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
    return fail(d, FAP_E_BITSTREAM, b->bad_at, what,
                b->bad == BITS_MARKER ? "a marker bit is 0" : "the data is cut");
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

/* --- plane header
 * --------------------------------------------------------------------------------------------------- */

static void read_frame_rate(fap_bits *b, plane_header *h)
{
    const uint32_t frame_rate = fap_bits_get(b, 8), seconds = fap_bits_get(b, 4);

    h->rate_16 = 16 * frame_rate + seconds;
    h->offset = fap_bits_get(b, 1);
}

static void read_time_code(fap_bits *b, plane_header *h)
{
    const uint32_t hours = fap_bits_get(b, 5), minutes = fap_bits_get(b, 6);

    fap_bits_marker(b);
    h->time_code_s = 3600 * hours + 60 * minutes + fap_bits_get(b, 6);
}

static void read_skip(fap_bits *b, plane_header *h)
{
    uint32_t n;

    do {
        n = fap_bits_get(b, 4);
        h->skipped += n;
    } while (n == 15 && h->skipped <= SKIP_MAX);
}

static fap_err read_header(fap_decoder *d, plane_header *h)
{
    fap_bits *b = &d->bits;

    *h = (plane_header){ 0 };
    h->intra = (int)fap_bits_get(b, 1);
    const uint32_t fba_object_mask = fap_bits_get(b, 2);
    h->has_face = fba_object_mask & 1;
    h->has_body = fba_object_mask >> 1;
    if (b->bad == BITS_FINE && !fba_object_mask)
        return fail(d, FAP_E_BITSTREAM, b->at, "fba_object_mask", "neither face nor body");
    if (h->intra) {
        h->is_frame_rate = (int)fap_bits_get(b, 1);
        if (h->is_frame_rate)
            read_frame_rate(b, h);
        h->is_time_code = (int)fap_bits_get(b, 1);
        if (h->is_time_code)
            read_time_code(b, h);
    }
    if (fap_bits_get(b, 1))
        read_skip(b, h);
    if (h->skipped > SKIP_MAX)
        return fail(d, FAP_E_LIMIT, b->at, "number_of_frames_to_skip", "too many");
    return check_bits(d, "plane header");
}

/* --- time
 * -----------------------------------------------------------------------------------------------------------
 */

static int64_t frames_us(const timing *t, int64_t frames)
{
    const int64_t us_16 = t->offset ? 16016000 : 16000000;
    return (frames * us_16 + t->rate_16 / 2) / t->rate_16;
}

static int64_t now_us(const timing *t)
{
    return t->base_us + frames_us(t, t->since_base);
}

static void rebase(timing *t, int64_t us)
{
    t->base_us = us;
    t->since_base = 0;
}

static fap_err take_rate(fap_decoder *d, const plane_header *h)
{
    timing *t = &d->time;

    if (!h->is_frame_rate || (h->rate_16 == t->rate_16 && (int)h->offset == t->offset))
        return FAP_OK;
    if (!h->rate_16)
        return note(d, DEV_FRAME_RATE);
    rebase(t, now_us(t));
    t->rate_16 = h->rate_16;
    t->offset = (int)h->offset;
    return FAP_OK;
}

/* A time code counts whole seconds: it moves the time only when it says another second than the frames do. */
static fap_err take_time_code(fap_decoder *d, const plane_header *h)
{
    timing *t = &d->time;
    const int64_t code_us = (int64_t)h->time_code_s * 1000000, now = now_us(t);

    if (!h->is_time_code)
        return FAP_OK;
    if (!t->has_epoch) {
        t->has_epoch = 1;
        t->epoch_us = code_us - now;
    }
    const int64_t here = now + t->epoch_us;
    if (here >= code_us && here < code_us + 1000000)
        return FAP_OK;
    if (code_us < here)
        return note(d, DEV_TIME_CODE);
    rebase(t, code_us - t->epoch_us);
    return FAP_OK;
}

/* Done as soon as the header is known: planes that cannot be decoded take their time all the same. */
static fap_err advance(fap_decoder *d, const plane_header *h)
{
    timing *t = &d->time;
    fap_err err = take_rate(d, h);
    if (err != FAP_OK)
        return err;

    const int64_t step = h->skipped + (t->started ? d->segments ? DCT_FRAMES : 1 : 0);
    t->number += step;
    t->since_base += step;
    t->started = 1;
    return take_time_code(d, h);
}

/* --- I plane: masks and ranges
 * ---------------------------------------------------------------------------------------- */

static void read_group_mask(fap_bits *b, int group, fba_setup *s)
{
    const int first = fap_group_first(group), end = first + fap_group_count(group);

    fap_bits_marker(b);
    s->mask_type[group] = (uint8_t)fap_bits_get(b, 2);
    for (int fap = first; fap < end; fap++) {
        switch (s->mask_type[group]) {
        case FBA_MASK_NONE: s->coded[fap] = 0; break;
        case FBA_MASK_ALL: s->coded[fap] = 1; break;
        default: s->coded[fap] = (uint8_t)fap_bits_get(b, 1); break;
        }
    }
}

static void read_bound(fap_bits *b, fba_setup *s, int fap, int table)
{
    const int bound = fba_bound((int)fap_bits_get(b, 5), s->quant);
    fba_range *r = &s->range[table < 2 ? FBA_I : FBA_P][fap];

    if (table % 2 == 0)
        r->max = (int16_t)bound;
    else
        r->min = (int16_t)-bound;
}

/* Tables 0..3: I max, I min, P max, P min. Markers are counted over all FAPs of a group, coded or not. */
static void read_range_table(fap_bits *b, fba_setup *s, int table)
{
    for (int group = 2; group <= FAP_GROUPS; group++)
        for (int i = 0; i < fap_group_count(group); i++) {
            const int fap = fap_group_first(group) + i;
            if (i % MARKER_EVERY == 0)
                fap_bits_marker(b);
            if (s->coded[fap])
                read_bound(b, s, fap, table);
        }
}

/* The table's ranges are installed once, with the quantiser of that plane; later ones stay until they are
 * sent again. */
static void install_default_ranges(fap_decoder *d, face_plane *p)
{
    if (p->has_ranges)
        return;
    fba_default_ranges(&p->setup, d->cfg.default_bound);
    p->has_ranges = 1;
}

static fap_err read_setup(fap_decoder *d, face_plane *p)
{
    fap_bits *b = &d->bits;

    p->setup.quant = (uint8_t)fap_bits_get(b, 5);
    for (int group = 1; group <= FAP_GROUPS; group++)
        read_group_mask(b, group, &p->setup);
    p->setup.gender = (uint8_t)fap_bits_get(b, 1);
    const uint32_t fba_object_coding_type = fap_bits_get(b, 1);
    const fap_err err = check_bits(d, "FAP group masks");
    if (err != FAP_OK)
        return err;
    if (fba_object_coding_type)
        return fail(d, FAP_E_UNSUPPORTED, b->at - 1, "fba_object_coding_type 1",
                    "DCT segments (ISO/IEC 14496-2, face segment syntax) are not supported");
    install_default_ranges(d, p);
    const uint32_t is_new = fap_bits_get(b, 4);
    for (int table = 0; table < 4; table++)
        if (is_new >> (3 - table) & 1)
            read_range_table(b, &p->setup, table);
    return check_bits(d, "symbol ranges");
}

/* --- values
 * ------------------------------------------------------------------------------------------------------------
 */

static void add_value(face_plane *p, int param, int32_t level, int intra)
{
    const int64_t v = (int64_t)level * fba_step(param, p->setup.quant) + (intra ? 0 : p->value[param]);

    p->value[param] = (int32_t)(v > value_limit ? value_limit : v < -value_limit ? -value_limit : v);
}

/* One symbol. 0: no memory to count it. */
static int read_symbol(fap_decoder *d, arith_decoder *a, face_plane *p, int param, int intra)
{
    static const model flat; /* I symbols are coded with counts of 1 */
    model *const adaptive = &d->model[param];
    const model *const m = intra ? &flat : adaptive;
    const fba_range range = fba_param_range(&p->setup, param, intra);
    const int size = fba_range_size(range);
    const uint64_t before = a->shifts;
    arith_interval where;

    const int symbol = model_find(&d->pool, m, size, arith_target(a, model_total(m, size)), &where);
    arith_take(a, where);
    p->fap_bits[fba_fap(param)] = (uint16_t)(p->fap_bits[fba_fap(param)] + (a->shifts - before));
    add_value(p, param, symbol + range.min, intra);
    return intra || model_count(&d->pool, adaptive, size, symbol);
}

/* One arithmetic run: the coded ones of params [first, end). */
static fap_err read_run(fap_decoder *d, face_plane *p, int first, int end, int intra)
{
    arith_decoder a;

    arith_begin(&a, &d->bits);
    for (int param = first; param < end; param++)
        if (p->setup.coded[fba_fap(param)] && !read_symbol(d, &a, p, param, intra))
            return fail(d, FAP_E_LIMIT, d->bits.at, "P plane",
                        "more different symbols than symbol_memory holds");
    arith_end(&a);
    return check_bits(d, "arithmetic code");
}

static int is_out(int32_t select, int32_t max)
{
    return select < 0 || select > max;
}

static fap_err read_viseme(fap_decoder *d, face_plane *p, int intra)
{
    const fap_err err = read_run(d, p, FBA_VISEME_SELECT1, FBA_EXPRESSION_SELECT1, intra);
    if (err != FAP_OK)
        return err;
    p->flags[0] = (uint8_t)fap_bits_get(&d->bits, 1);
    if (is_out(p->value[FBA_VISEME_SELECT1], FAP_VISEME_COUNT) ||
        is_out(p->value[FBA_VISEME_SELECT2], FAP_VISEME_COUNT))
        return fail(d, FAP_E_BITSTREAM, d->bits.at, "viseme_select", "no such viseme");
    return check_bits(d, "viseme_def");
}

static fap_err read_expression(fap_decoder *d, face_plane *p, int intra)
{
    const fap_err err = read_run(d, p, FBA_EXPRESSION_SELECT1, FBA_FIRST_FAP, intra);
    if (err != FAP_OK)
        return err;
    p->flags[1] = (uint8_t)fap_bits_get(&d->bits, 1);
    p->flags[2] = (uint8_t)fap_bits_get(&d->bits, 1);
    if (is_out(p->value[FBA_EXPRESSION_SELECT1], FAP_EXPRESSION_COUNT) ||
        is_out(p->value[FBA_EXPRESSION_SELECT2], FAP_EXPRESSION_COUNT))
        return fail(d, FAP_E_BITSTREAM, d->bits.at, "expression_select", "no such expression");
    return check_bits(d, "expression_def");
}

static fap_err read_params(fap_decoder *d, face_plane *p, int intra)
{
    fap_err err = FAP_OK;

    if (p->setup.coded[1])
        err = read_viseme(d, p, intra);
    if (err == FAP_OK && p->setup.coded[2])
        err = read_expression(d, p, intra);
    if (err == FAP_OK)
        err = read_run(d, p, FBA_FIRST_FAP, FBA_PARAMS, intra);
    return err;
}

/* --- planes
 * ------------------------------------------------------------------------------------------------------------
 */

static fap_err read_face(fap_decoder *d, face_plane *p, int intra)
{
    p->setup = d->setup;
    p->has_ranges = d->has_ranges;
    memcpy(p->value, d->value, sizeof p->value);
    memcpy(p->flags, d->flags, sizeof p->flags);
    memset(p->fap_bits, 0, sizeof p->fap_bits);
    if (intra) {
        for (int param = 0; param < FBA_PARAMS; param++)
            model_clear(&d->pool, &d->model[param]);
        const fap_err err = read_setup(d, p);
        if (err != FAP_OK)
            return err;
    }
    return read_params(d, p, intra);
}

static fap_err read_body(fap_decoder *d, int intra)
{
    const fap_err err = fba_body_skip(&d->body, &d->bits, intra, &d->pool);

    if (err == FAP_E_UNSUPPORTED)
        return fail(d, err, d->bits.at, "body data", "DCT segments are not supported");
    if (err == FAP_E_LIMIT)
        return fail(d, err, d->bits.at, "body data", "more different symbols than symbol_memory holds");
    if (err != FAP_OK)
        return fail(d, err, d->bits.at, "bap_mask_type", "no such type");
    return check_bits(d, "body data");
}

static void keep_face(fap_decoder *d, const face_plane *p)
{
    d->setup = p->setup;
    d->has_ranges = p->has_ranges;
    memcpy(d->value, p->value, sizeof d->value);
    memcpy(d->flags, p->flags, sizeof d->flags);
    memcpy(d->info.fap_bits, p->fap_bits, sizeof d->info.fap_bits);
    d->face_ready = 1;
    d->segments = 0;
}

static uint8_t clamp_strength(int32_t v)
{
    return (uint8_t)(v < 0 ? 0 : v > FBA_STRENGTH_MAX ? FBA_STRENGTH_MAX : v);
}

static void show_viseme(fap_decoder *d)
{
    d->frame.viseme =
        (fap_viseme){ (uint8_t)d->value[FBA_VISEME_SELECT1], (uint8_t)d->value[FBA_VISEME_SELECT2],
                      clamp_strength(d->value[FBA_VISEME_BLEND]), d->flags[0] };
}

static void show_expression(fap_decoder *d)
{
    d->frame.expression = (fap_expression){
        (uint8_t)d->value[FBA_EXPRESSION_SELECT1],
        clamp_strength(d->value[FBA_EXPRESSION_INTENSITY1]),
        (uint8_t)d->value[FBA_EXPRESSION_SELECT2],
        clamp_strength(d->value[FBA_EXPRESSION_INTENSITY2]),
        d->flags[1],
        d->flags[2],
    };
}

static void show_coded(fap_decoder *d)
{
    fap_frame *f = &d->frame;

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (d->setup.coded[fap]) {
            f->state[fap] = FAP_CODED;
            f->value[fap] = fap > 2 ? d->value[FBA_FIRST_FAP + fap - 3] : 0;
        }
    if (d->setup.coded[1])
        show_viseme(d);
    if (d->setup.coded[2])
        show_expression(d);
}

static int is_left_to_us(const fap_decoder *d, int fap)
{
    return !d->setup.coded[fap] && d->setup.mask_type[fap_info_get(fap)->group] == FBA_MASK_INTERPOLATE;
}

/* Mask type 2: the decoder finds the values. Those it cannot find stay held. */
static void show_interpolated(fap_decoder *d)
{
    fap_frame derived = d->frame;

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (is_left_to_us(d, fap))
            derived.state[fap] = FAP_ABSENT;
    fap_derive(&derived);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (is_left_to_us(d, fap) && derived.state[fap] == FAP_DERIVED) {
            d->frame.state[fap] = FAP_DERIVED;
            d->frame.value[fap] = derived.value[fap];
        }
}

static void hold_all(fap_frame *f)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (f->state[fap] != FAP_ABSENT)
            f->state[fap] = FAP_HELD;
}

static void show_frame(fap_decoder *d, const plane_header *h)
{
    hold_all(&d->frame);
    if (h->has_face) {
        show_coded(d);
        show_interpolated(d);
    }
    d->frame.number = d->time.number;
    d->frame.pts_us = now_us(&d->time);
}

static void fill_info(fap_decoder *d, const plane_header *h, uint64_t start)
{
    fap_plane_info *i = &d->info;

    i->bit_position = d->bits_before + (int64_t)start;
    i->bit_count = (uint32_t)(d->bits.at - start);
    i->intra = (uint8_t)h->intra;
    i->start_code = (uint8_t)d->plane_code;
    i->has_face = (uint8_t)h->has_face;
    i->has_body = (uint8_t)h->has_body;
    i->quant = d->setup.quant;
    i->gender = d->setup.gender;
    memcpy(i->mask_type, d->setup.mask_type, sizeof i->mask_type);
    i->skipped = h->skipped;
    i->rate_hz = d->time.rate_16 / 16.0 * (d->time.offset ? 1000.0 / 1001 : 1);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        i->i_min[fap] = d->setup.range[FBA_I][fap].min;
        i->i_max[fap] = d->setup.range[FBA_I][fap].max;
        i->p_min[fap] = d->setup.range[FBA_P][fap].min;
        i->p_max[fap] = d->setup.range[FBA_P][fap].max;
    }
}

/*
 * Prediction is broken: what follows can only be found by its start code, and only an I plane helps. The
 * search begins at
 * @p at, where the plane did: a broken plane may have been read past the next start code.
 */
static void lose(fap_decoder *d, uint64_t at)
{
    d->bits.at = at;
    d->lost = 1;
    d->face_ready = d->body_ready = 0;
}

static int can_decode(const fap_decoder *d, const plane_header *h)
{
    return h->intra || ((!h->has_face || d->face_ready) && (!h->has_body || d->body_ready));
}

static fap_err read_data(fap_decoder *d, const plane_header *h, face_plane *p)
{
    fap_err err = FAP_OK;

    if (h->has_face)
        err = read_face(d, p, h->intra);
    if (err == FAP_OK && h->has_body)
        err = read_body(d, h->intra);
    if (err == FAP_E_UNSUPPORTED)
        d->segments = 1;
    return err;
}

/* FAP_E_AGAIN: a P plane that cannot be decoded was passed over. */
static fap_err read_plane(fap_decoder *d, uint64_t start)
{
    const uint64_t at = d->bits.at;
    plane_header h;
    face_plane p;

    d->planes++;
    fap_err err = read_header(d, &h);
    if (err == FAP_OK)
        err = advance(d, &h);
    if (err == FAP_OK && !can_decode(d, &h)) {
        err = note(d, DEV_WAITING);
        lose(d, at);
        return err == FAP_OK ? FAP_E_AGAIN : err;
    }
    if (err == FAP_OK)
        err = read_data(d, &h, &p);
    if (err != FAP_OK)
        return lose(d, at), err;
    memset(d->info.fap_bits, 0, sizeof d->info.fap_bits);
    if (h.has_face)
        keep_face(d, &p);
    d->body_ready |= h.has_body;
    show_frame(d, &h);
    fill_info(d, &h, start);
    return FAP_OK;
}

/* --- start codes
 * ---------------------------------------------------------------------------------------------------------
 */

static int is_start_code(const fap_bits *b, uint64_t at)
{
    return at % 8 == 0 && at + 32 <= b->end && fap_bits_peek(b, at, 24) == FBA_START_PREFIX;
}

/* Bits of stuffing at @p at: a 0, then 1s to the byte boundary. 0: something else is there. */
static int stuffing(const fap_bits *b, uint64_t at)
{
    const int n = 8 - (int)(at % 8);
    return at + (uint64_t)n <= b->end && fap_bits_peek(b, at, n) == (1u << (n - 1)) - 1 ? n : 0;
}

/* The last byte code of a start code at @p at, behind stuffing or not; -1: none. *@p at moves to the code. */
static int find_code_here(const fap_bits *b, uint64_t *at)
{
    const int n = stuffing(b, *at);

    if (n && is_start_code(b, *at + (uint64_t)n))
        *at += (uint64_t)n;
    if (!is_start_code(b, *at))
        return -1;
    return (int)fap_bits_peek(b, *at + 24, 8);
}

static void seek_start_code(fap_bits *b)
{
    b->at = (b->at + 7) / 8 * 8;
    while (b->at < b->end && !is_start_code(b, b->at))
        b->at += 8;
}

/* What is behind the last plane of a unit: nothing, stuffing, or less than a plane. */
static int is_used_up(const fap_bits *b)
{
    return b->at == b->end || (b->at + 8 >= b->end && b->at + (uint64_t)stuffing(b, b->at) == b->end);
}

/* A plane cannot begin with three 0s: fba_object_mask would be 0. */
static int is_padding(const fap_bits *b)
{
    return b->end - b->at < 8 && !fap_bits_peek(b, b->at, (int)(b->end - b->at));
}

static void begin_object(fap_decoder *d)
{
    d->face_ready = d->body_ready = d->has_ranges = d->lost = d->segments = 0;
    fba_body_init(&d->body);
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
    d->time = (timing){ .rate_16 = DEFAULT_RATE_16 };
    d->frame = (fap_frame){ 0 };
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
        seek_start_code(
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
            seek_start_code(b);
        *start = b->at;
        if (is_used_up(b))
            return end_unit(d, FAP_E_AGAIN);
        const int code = find_code_here(b, &b->at);
        if (code < 0)
            break;
        const fap_err err = take_code(d, code);
        if (err != FAP_E_AGAIN || !b->data)
            return err;
    }
    if (is_padding(b)) {
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
    while (err == FAP_E_AGAIN && d->bits.data) {
        err = find_plane(d, &start);
        if (err == FAP_OK && !d->started) {
            d->started = 1;
            err = note(d, DEV_NO_OBJECT_CODE);
        }
        if (err == FAP_OK)
            err = read_plane(d, start);
        d->bits.bad = BITS_FINE;
    }
    if (err == FAP_OK)
        *out = d->frame;
    return err;
}

/* --- life
 * -------------------------------------------------------------------------------------------------------------
 */

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
    model_pool_init(&d->pool, d->node, (uint16_t)(nodes - 1));
    reset_stream(d);
    *decoder = d;
    return FAP_OK;
}

fap_err fap_decoder_send(fap_decoder *d, const uint8_t *data, size_t size)
{
    if (!d || !data || !size || size > SIZE_MAX / 16)
        return FAP_E_ARG;
    if (d->bits.data)
        return FAP_E_AGAIN;
    fap_bits_init(&d->bits, data, size);
    d->lost = 0;
    return FAP_OK;
}

void fap_decoder_flush(fap_decoder *d)
{
    end_unit(d, FAP_OK);
    d->face_ready = d->body_ready = 0;
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
