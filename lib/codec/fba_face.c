/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fba_face.h. Field names are the standard's.
 * Source: ISO/IEC 14496-2, face object plane syntax and arithmetic decoding of FAPs.
 */
#include <string.h>

#include <fap/derive.h>

#include "codec/fba_face.h"

enum { MARKER_EVERY = 4 };

static const int32_t value_limit = 1 << 30; /* far outside of anything a face does, and safe to add to */

static fap_err fail(fba_face_reader *r, fap_err err, uint64_t at, const char *what, const char *why)
{
    r->at = at;
    r->what = what;
    r->why = why;
    return err;
}

static fap_err check_bits(fba_face_reader *r, const char *what)
{
    if (r->bits->bad == BITS_FINE)
        return FAP_OK;
    return fail(r, FAP_E_BITSTREAM, r->bits->bad_at, what, fap_bits_why(r->bits));
}

/* --- masks and ranges --- */

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
    const int bound = fap_fba_bound((int)fap_bits_get(b, 5), s->quant);
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

/* The table's ranges, once, with the quantiser of that plane; what is there stays until it is sent again. */
static void install_default_ranges(fba_face_reader *r, fba_face *p)
{
    if (p->has_ranges)
        return;
    fap_fba_default_ranges(&p->setup, r->default_bound);
    p->has_ranges = 1;
}

fap_err fap_fba_face_set_up(fba_face_reader *r, fba_face *p)
{
    fap_bits *b = r->bits;

    for (int param = 0; param < FBA_PARAMS; param++)
        fap_model_clear(r->pool, &r->model[param]);
    p->setup.quant = (uint8_t)fap_bits_get(b, 5);
    for (int group = 1; group <= FAP_GROUPS; group++)
        read_group_mask(b, group, &p->setup);
    p->setup.gender = (uint8_t)fap_bits_get(b, 1);
    const uint32_t fba_object_coding_type = fap_bits_get(b, 1);
    const fap_err err = check_bits(r, "FAP group masks");
    if (err != FAP_OK)
        return err;
    if (fba_object_coding_type)
        return fail(r, FAP_E_UNSUPPORTED, b->at - 1, "fba_object_coding_type 1",
                    "DCT segments (ISO/IEC 14496-2, face segment syntax) are not supported");
    install_default_ranges(r, p);
    const uint32_t is_new = fap_bits_get(b, 4);
    r->ranges_at = b->at;
    for (int table = 0; table < 4; table++)
        if (is_new >> (3 - table) & 1)
            read_range_table(b, &p->setup, table);
    r->params_at = b->at;
    fap_fba_list_coded(&p->list, &p->setup);
    return check_bits(r, "symbol ranges");
}

/* --- values --- */

/* What one plane's values are read from and into. */
typedef struct plane_reader {
    fba_face_reader *r;
    fba_motion *motion;
    const fba_coded *next, *end; /* parameters still to come */
    int kind;                    /* FBA_P, FBA_I */
} plane_reader;

static int32_t limited(int64_t v)
{
    return (int32_t)(v > value_limit ? value_limit : v < -value_limit ? -value_limit : v);
}

/* The next symbol, -1: no memory to count it. In I planes all count 1. */
static int read_symbol(const plane_reader *p, arith_decoder *a, const fba_coded *c)
{
    const int size = c->symbols[p->kind].size;
    model *m = &p->r->model[c->param];
    arith_interval where;
    int symbol;

    if (p->kind == FBA_I) {
        symbol = fap_flat_symbol(size, fap_arith_target(a, (uint32_t)size));
        where = fap_flat_interval(size, symbol);
    } else {
        const uint32_t target = fap_arith_target(a, fap_model_total(m, size));
        symbol = fap_model_decode(p->r->pool, m, size, target, &where);
    }
    if (symbol >= 0)
        fap_arith_take(a, where);
    return symbol;
}

static int read_value(const plane_reader *p, arith_decoder *a, const fba_coded *c)
{
    const uint64_t before = a->shifts;
    const int symbol = read_symbol(p, a, c);
    fba_motion *m = p->motion;

    if (symbol < 0)
        return 0;
    const int64_t from = p->kind == FBA_I ? 0 : m->value[c->param];
    m->value[c->param] = limited(from + (int64_t)(symbol + c->symbols[p->kind].min) * c->step);
    m->fap_bits[c->fap] = (uint16_t)(m->fap_bits[c->fap] + (a->shifts - before));
    return 1;
}

/* One arithmetic run: the coded ones of the parameters in front of @p end. */
static fap_err read_run(plane_reader *p, int end)
{
    arith_decoder a;

    fap_arith_begin(&a, p->r->bits);
    for (; p->next < p->end && p->next->param < end; p->next++)
        if (!read_value(p, &a, p->next))
            return fail(p->r, FAP_E_LIMIT, p->r->bits->at, "P plane",
                        "more different symbols than symbol_memory holds");
    fap_arith_end(&a);
    return check_bits(p->r, "arithmetic code");
}

static int is_next(const plane_reader *p, int param)
{
    return p->next < p->end && p->next->param == param;
}

static int is_out(int32_t select, int32_t max)
{
    return select < 0 || select > max;
}

static fap_err read_viseme(plane_reader *p)
{
    fap_bits *b = p->r->bits;
    fba_motion *m = p->motion;

    const fap_err err = read_run(p, FBA_EXPRESSION_SELECT1);
    if (err != FAP_OK)
        return err;
    m->viseme_def = (uint8_t)fap_bits_get(b, 1);
    if (is_out(m->value[FBA_VISEME_SELECT1], FAP_VISEME_COUNT) ||
        is_out(m->value[FBA_VISEME_SELECT2], FAP_VISEME_COUNT))
        return fail(p->r, FAP_E_BITSTREAM, b->at, "viseme_select", "no such viseme");
    return check_bits(p->r, "viseme_def");
}

static fap_err read_expression(plane_reader *p)
{
    fap_bits *b = p->r->bits;
    fba_motion *m = p->motion;

    const fap_err err = read_run(p, FBA_FIRST_FAP);
    if (err != FAP_OK)
        return err;
    m->init_face = (uint8_t)fap_bits_get(b, 1);
    m->expression_def = (uint8_t)fap_bits_get(b, 1);
    if (is_out(m->value[FBA_EXPRESSION_SELECT1], FAP_EXPRESSION_COUNT) ||
        is_out(m->value[FBA_EXPRESSION_SELECT2], FAP_EXPRESSION_COUNT))
        return fail(p->r, FAP_E_BITSTREAM, b->at, "expression_select", "no such expression");
    return check_bits(p->r, "expression_def");
}

fap_err fap_fba_face_move(fba_face_reader *r, const fba_coded_list *list, fba_motion *motion, int intra)
{
    plane_reader p = { r, motion, list->of, list->of + list->count, intra ? FBA_I : FBA_P };
    fap_err err = FAP_OK;

    memset(motion->fap_bits, 0, sizeof motion->fap_bits);
    if (is_next(&p, FBA_VISEME_SELECT1))
        err = read_viseme(&p);
    if (err == FAP_OK && is_next(&p, FBA_EXPRESSION_SELECT1))
        err = read_expression(&p);
    if (err == FAP_OK)
        err = read_run(&p, FBA_PARAMS);
    return err;
}

/* --- frames --- */

static uint8_t clamp_strength(int32_t v)
{
    return (uint8_t)(v < 0 ? 0 : v > FRAME_STRENGTH_MAX ? FRAME_STRENGTH_MAX : v);
}

static fap_viseme viseme_of(const fba_motion *m)
{
    const int32_t *v = m->value;
    return (fap_viseme){ (uint8_t)v[FBA_VISEME_SELECT1], (uint8_t)v[FBA_VISEME_SELECT2],
                         clamp_strength(v[FBA_VISEME_BLEND]), m->viseme_def };
}

static fap_expression expression_of(const fba_motion *m, int swapped)
{
    const int32_t *v = m->value;
    const int select2 = swapped ? FBA_EXPRESSION_INTENSITY1 : FBA_EXPRESSION_SELECT2;
    const int intensity1 = swapped ? FBA_EXPRESSION_SELECT2 : FBA_EXPRESSION_INTENSITY1;

    return (fap_expression){ (uint8_t)v[FBA_EXPRESSION_SELECT1],
                             clamp_strength(v[intensity1]),
                             (uint8_t)v[select2],
                             clamp_strength(v[FBA_EXPRESSION_INTENSITY2]),
                             m->init_face,
                             m->expression_def };
}

int fap_fba_swap_evidence(const fba_motion *m)
{
    const int32_t *v = &m->value[FBA_EXPRESSION_SELECT1];
    const int32_t second = v[1], third = v[2], intensity2 = v[3];

    if (second < 0 || second > FAP_EXPRESSION_COUNT)
        return -1; /* no selection */
    return second && !third && intensity2;
}

static void show_coded(const fba_face *face, fap_frame *f)
{
    const fba_motion *m = &face->motion;

    for (const fba_coded *c = face->list.of; c < face->list.of + face->list.count; c++) {
        f->state[c->fap] = FAP_CODED;
        f->value[c->fap] = c->fap > 2 ? m->value[c->param] : 0;
    }
    if (face->setup.coded[1])
        f->viseme = viseme_of(m);
    if (face->setup.coded[2])
        f->expression = expression_of(m, face->swapped);
}

static int is_left_to_us(const fba_face *face, int fap)
{
    return !face->setup.coded[fap] && face->setup.mask_type[fap_info_get(fap)->group] == FBA_MASK_INTERPOLATE;
}

static int leaves_any_to_us(const fba_face *face)
{
    for (int group = 2; group <= FAP_GROUPS; group++)
        if (face->setup.mask_type[group] == FBA_MASK_INTERPOLATE)
            return 1;
    return 0;
}

/* Mask type 2: the decoder finds the values. Those it cannot find stay held. */
static void show_interpolated(const fba_face *face, const fap_fit *fit, fap_frame *f)
{
    fap_frame derived = *f;

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (is_left_to_us(face, fap))
            derived.state[fap] = FAP_ABSENT;
    fap_derive_with(fit, &derived);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (is_left_to_us(face, fap) && derived.state[fap] == FAP_DERIVED) {
            f->state[fap] = FAP_DERIVED;
            f->value[fap] = derived.value[fap];
        }
}

void fap_fba_face_show(const fba_face *face, const fap_fit *fit, fap_frame *frame)
{
    show_coded(face, frame);
    if (leaves_any_to_us(face)) /* rare, and most of the time of a plane when done for nothing */
        show_interpolated(face, fit, frame);
}
