/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba_write.h. */
#include "codec/fba_write.h"

enum { MARKER_EVERY = 4, TABLE_BITS = 4 * 5 };

void fap_fba_put_code(fap_bit_writer *w, int code)
{
    fap_bits_put(w, 24, FBA_START_PREFIX);
    fap_bits_put(w, 8, (uint32_t)code);
}

/* --- header --- */

static void put_skip(fap_bit_writer *w, uint32_t skipped)
{
    fap_bits_put(w, 1, skipped > 0);
    if (!skipped)
        return;
    for (; skipped >= 15; skipped -= 15)
        fap_bits_put(w, 4, 15);
    fap_bits_put(w, 4, skipped);
}

static void put_time_code(fap_bit_writer *w, int64_t seconds)
{
    fap_bits_put(w, 1, seconds >= 0);
    if (seconds < 0)
        return;
    fap_bits_put(w, 5, (uint32_t)(seconds / 3600));
    fap_bits_put(w, 6, (uint32_t)(seconds / 60 % 60));
    fap_bits_put(w, 1, 1); /* marker */
    fap_bits_put(w, 6, (uint32_t)(seconds % 60));
}

void fap_fba_put_header(fap_bit_writer *w, const fba_plane *p)
{
    fap_bits_put(w, 1, (uint32_t)p->intra);
    fap_bits_put(w, 2, 1); /* fba_object_mask: face */
    if (p->intra) {
        fap_bits_put(w, 1, 1); /* is_frame_rate */
        fap_bits_put(w, 8, p->rate_16 / 16);
        fap_bits_put(w, 4, p->rate_16 % 16);
        fap_bits_put(w, 1, (uint32_t)p->offset);
        put_time_code(w, p->time_code_s);
    }
    put_skip(w, p->skipped);
}

/* --- setup --- */

int fap_fba_bound_for(int level, int quant)
{
    int n = 0;

    while (fap_fba_bound(n, quant) < level)
        n++;
    return n;
}

static void put_masks(fap_bit_writer *w, const fba_setup *s)
{
    for (int group = 1; group <= FAP_GROUPS; group++) {
        const int first = fap_group_first(group), type = s->mask_type[group];
        fap_bits_put(w, 1, 1);
        fap_bits_put(w, 2, (uint32_t)type);
        for (int fap = first; fap < first + fap_group_count(group); fap++)
            if (type == FBA_MASK_HOLD || type == FBA_MASK_INTERPOLATE)
                fap_bits_put(w, 1, s->coded[fap]);
    }
}

/* Tables 0..3: I max, I min, P max, P min. */
static void put_range_table(fap_bit_writer *w, const fba_setup *s, int table)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const int place_in_group = fap - fap_group_first(fap_info_get(fap)->group);
        const fba_range r = s->range[table < 2 ? FBA_I : FBA_P][fap];
        if (place_in_group % MARKER_EVERY == 0)
            fap_bits_put(w, 1, 1);
        if (s->coded[fap])
            fap_bits_put(w, 5, (uint32_t)fap_fba_bound_for(table % 2 ? -r.min : r.max, s->quant));
    }
}

static int has_tables(const fba_setup *s)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (s->coded[fap])
            return 1;
    return 0;
}

void fap_fba_put_setup(fap_bit_writer *w, const fba_setup *s)
{
    fap_bits_put(w, 5, s->quant);
    put_masks(w, s);
    fap_bits_put(w, 1, s->gender);
    fap_bits_put(w, 1, 0); /* fba_object_coding_type: predictive */
    fap_bits_put(w, 4, has_tables(s) ? 15 : 0);
    for (int table = 0; table < 4 && has_tables(s); table++)
        put_range_table(w, s, table);
}

int fap_fba_table_bits(void)
{
    return TABLE_BITS;
}

/* --- symbols --- */

/* Where symbols go and how they are counted. */
typedef struct symbol_writer {
    fap_bit_writer *w;
    const fba_plane *p;
    const fba_coded *first, *next, *end; /* parameters still to come */
    model *model;
    model_pool *pool;
    int count;
} symbol_writer;

static int interval_of(const symbol_writer *s, arith_interval *out)
{
    const fba_coded *c = s->next;
    const int size = c->symbols[s->p->intra ? FBA_I : FBA_P].size, symbol = s->p->symbol[c - s->first];

    if (s->p->intra)
        *out = fap_flat_interval(size, symbol);
    else if (s->count)
        return fap_model_encode(s->pool, &s->model[c->param], size, symbol, out);
    else
        *out = fap_model_interval(s->pool, &s->model[c->param], size, symbol);
    return 1;
}

/* One arithmetic run: the coded ones of the parameters in front of @p end. */
static int put_run(symbol_writer *s, int end)
{
    arith_encoder a;
    arith_interval where;

    fap_arith_encoder_begin(&a, s->w);
    for (; s->next < s->end && s->next->param < end; s->next++) {
        if (!interval_of(s, &where))
            return 0;
        fap_arith_encoder_put(&a, where);
    }
    fap_arith_encoder_end(&a);
    return 1;
}

static int is_next(const symbol_writer *s, int param)
{
    return s->next < s->end && s->next->param == param;
}

int fap_fba_put_symbols(fap_bit_writer *w, const fba_plane *p, const fba_coded_list *list, model *m,
                        model_pool *pool, int count)
{
    symbol_writer s = { w, p, list->of, list->of, list->of + list->count, m, pool, count };

    if (is_next(&s, FBA_VISEME_SELECT1)) {
        if (!put_run(&s, FBA_EXPRESSION_SELECT1))
            return 0;
        fap_bits_put(w, 1, p->viseme_def);
    }
    if (is_next(&s, FBA_EXPRESSION_SELECT1)) {
        if (!put_run(&s, FBA_FIRST_FAP))
            return 0;
        fap_bits_put(w, 1, p->init_face);
        fap_bits_put(w, 1, p->expression_def);
    }
    return put_run(&s, FBA_PARAMS);
}

int fap_fba_count_symbols(const fba_plane *p, const fba_coded_list *list, model *m, model_pool *pool)
{
    for (int i = 0; i < list->count; i++) {
        const fba_coded *c = &list->of[i];
        if (!fap_model_count(pool, &m[c->param], c->symbols[FBA_P].size, p->symbol[i]))
            return 0;
    }
    return 1;
}
