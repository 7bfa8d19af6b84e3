/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Learns an interpolation table from a take: which FAPs to go on sending, and formulas for the others. FAPs to send
 * are chosen one by one, each the one that explains most of what is not explained yet; whatever has a formula by
 * then is left out. At the end those that no formula turned out to need get a second chance to have one themselves.
 */
#include <stddef.h>
#include <string.h>

#include <fap/fit.h>
#include <fap/tables.h>

#include "base/mem.h"
#include "codec/fit_regress.h"

enum { MAX_ROWS = 4096, ROWS_PER_TERM = 8 };

typedef enum fit_role { OPEN, SENT, GIVEN } fit_role;

typedef struct fit_learner {
    fit_data data;
    const fap_frame *frames;
    size_t count;
    int terms, quant;
    double cost[FIT_MAX_COLUMNS]; /* about how many bits it takes to send */
    uint8_t role[FIT_MAX_COLUMNS];
    fit_formula formula[FIT_MAX_COLUMNS];
    double left[FIT_MAX_COLUMNS][FIT_MAX_COLUMNS]; /* covariance that the FAPs sent do not explain */
} fit_learner;

/* --- the take --- */

static int is_known_throughout(const fap_frame *frames, size_t count, int fap)
{
    for (size_t i = 0; i < count; i++)
        if (frames[i].state[fap] == FAP_ABSENT)
            return 0;
    return count > 0;
}

static double bound_of(const fap_fit_learn_config *cfg, const fap_sensitivity *s, int fap)
{
    if (cfg->error)
        return cfg->error[fap];
    return s->nm[fap] ? (double)(cfg->error_nm / s->nm[fap]) : fap_info_get(fap)->quant_step;
}

static void choose_columns(fit_learner *l, const fap_fit_learn_config *cfg)
{
    fap_sensitivity s;

    if (cfg->sensitivity)
        s = *cfg->sensitivity;
    else
        fap_sensitivity_typical(&s);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        if (!is_known_throughout(l->frames, l->count, fap))
            continue;
        l->data.bound[l->data.columns] = bound_of(cfg, &s, fap);
        l->data.fap[l->data.columns++] = (uint8_t)fap;
    }
}

/* The nearest level, as the decoder will show it. */
static int32_t quantise(int32_t v, int step)
{
    if (step <= 1)
        return v;
    const int64_t size = v < 0 ? -(int64_t)v : v, level = (size + step / 2) / step;
    return (int32_t)(v < 0 ? -level * step : level * step);
}

static int32_t clamp(int32_t v)
{
    const int32_t limit = 1 << 28; /* quantised and squared it stays exact enough, and no face gets there */
    return v > limit ? limit : v < -limit ? -limit : v;
}

static int bit_length(int64_t v)
{
    int bits = 0;
    for (v = v < 0 ? -v : v; v; v >>= 1)
        bits++;
    return bits;
}

static void fill_column(fit_learner *l, int column)
{
    fit_data *const d = &l->data;
    const int fap = d->fap[column], step = l->quant * fap_info_get(fap)->quant_step;
    int32_t *const value = d->value + (size_t)column * d->rows, *const source =
                                                                    d->source + (size_t)column * d->rows;
    int64_t before = 0;

    l->cost[column] = 1;
    for (size_t row = 0; row < d->rows; row++) {
        value[row] = clamp(l->frames[row * l->count / d->rows].value[fap]);
        source[row] = quantise(value[row], step);
        l->cost[column] += 2 * bit_length((source[row] - before) / (step > 0 ? step : 1));
        before = source[row];
    }
}

static size_t share_of(size_t count, int per_thousand)
{
    return count / 1000 * (size_t)per_thousand + count % 1000 * (size_t)per_thousand / 1000;
}

/* --- which to send --- */

static void begin_covariance(fit_learner *l)
{
    const fit_data *const d = &l->data;

    for (int a = 0; a < d->columns; a++)
        for (int b = 0; b < d->columns; b++) {
            const int fa = fit_feature(a, 1), fb = fit_feature(b, 1);
            l->left[a][b] = d->gram[fa][fb] - d->gram[fa][0] * d->gram[fb][0] / (double)d->rows;
        }
}

static void explain(fit_learner *l, int by)
{
    const int n = l->data.columns;
    const double own = l->left[by][by];
    double row[FIT_MAX_COLUMNS];

    if (!(own > 0))
        return;
    memcpy(row, l->left[by], sizeof row);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            l->left[a][b] -= row[a] * row[b] / own;
    for (int a = 0; a < n; a++)
        l->left[a][by] = l->left[by][a] = 0;
}

/* The share of what is open that @p by would explain, by what it costs to send. */
static double explained(const fit_learner *l, int by)
{
    const double own = l->left[by][by];
    double sum = 0;

    for (int c = 0; own > 0 && c < l->data.columns; c++)
        if (l->role[c] == OPEN && l->left[c][c] > 0)
            sum += l->cost[c] * (l->left[by][c] * l->left[by][c] / (own * l->left[c][c]));
    return sum;
}

static int next_to_send(const fit_learner *l)
{
    double most = -1;
    int best = -1;

    for (int c = 0; c < l->data.columns; c++) {
        const double share = l->role[c] == OPEN ? explained(l, c) : -1;
        if (share > most) {
            most = share;
            best = c;
        }
    }
    return best;
}

/* --- which to leave out --- */

static void mark_sent(const fit_learner *l, int but, uint8_t allowed[FIT_MAX_COLUMNS])
{
    memset(allowed, 0, FIT_MAX_COLUMNS);
    for (int c = 0; c < l->data.columns; c++)
        allowed[c] = l->role[c] == SENT && c != but;
}

static int find(fit_learner *l, int column, int but, fit_formula *f)
{
    uint8_t allowed[FIT_MAX_COLUMNS];

    mark_sent(l, but, allowed);
    return fap_fit_find(&l->data, column, allowed, l->terms, f);
}

static void leave_out_what_can_be(fit_learner *l)
{
    for (int c = 0; c < l->data.columns; c++)
        if (l->role[c] == OPEN && find(l, c, c, &l->formula[c]))
            l->role[c] = GIVEN;
}

static int uses(const fit_formula *f, int column)
{
    for (int i = 0; i < f->terms; i++)
        if (f->feature[i] && (f->feature[i] - 1) / 2 == column)
            return 1;
    return 0;
}

/* A FAP sent need not be when it and all that follow from it have a formula without it. */
static void try_without(fit_learner *l, int column)
{
    fit_formula without[FIT_MAX_COLUMNS];

    for (int c = 0; c < l->data.columns; c++) {
        const int follows = c == column || (l->role[c] == GIVEN && uses(&l->formula[c], column));
        without[c] = l->formula[c];
        if (follows && !find(l, c, column, &without[c]))
            return;
    }
    memcpy(l->formula, without, sizeof without);
    l->role[column] = GIVEN;
}

static void choose(fit_learner *l)
{
    int send;

    begin_covariance(l);
    leave_out_what_can_be(l);
    while ((send = next_to_send(l)) >= 0) {
        l->role[send] = SENT;
        explain(l, send);
        leave_out_what_can_be(l);
    }
    for (int c = 0; c < l->data.columns; c++)
        if (l->role[c] == SENT)
            try_without(l, c);
}

/* --- the table --- */

static fit_set sources_of(const fit_learner *l, int column)
{
    const fit_formula *const f = &l->formula[column];
    fit_set s = { { 0, 0 } };

    for (int i = 0; i < f->terms; i++)
        if (f->feature[i])
            fit_set_add(&s, l->data.fap[(f->feature[i] - 1) / 2]);
    return s;
}

static int is_same(fit_set a, fit_set b)
{
    return a.word[0] == b.word[0] && a.word[1] == b.word[1];
}

/* The first to have these sources. */
static int begins_edge(const fit_learner *l, int column)
{
    for (int c = 0; c < column; c++)
        if (l->role[c] == GIVEN && is_same(sources_of(l, c), sources_of(l, column)))
            return 0;
    return 1;
}

static fap_err describe_formula(const fit_learner *l, int column, fit_builder *b)
{
    const fit_formula *const f = &l->formula[column];
    fap_err err = fap_fit_add_rule(b, l->data.fap[column]);

    if (err == FAP_OK && !f->terms)
        err = fap_fit_add_term(b, FIT_NUMERATOR, (fit_number){ 0, 0 });
    for (int i = 0; err == FAP_OK && i < f->terms; i++) {
        const int feature = f->feature[i];
        err = fap_fit_add_term(b, FIT_NUMERATOR, f->coefficient[i]);
        if (err == FAP_OK && feature)
            err = fap_fit_add_factor(b, l->data.fap[(feature - 1) / 2], feature % 2 ? 1 : 2);
    }
    return err;
}

static fap_err describe_edge(const fit_learner *l, int first, fit_builder *b)
{
    const fit_set sources = sources_of(l, first);
    fap_err err = fap_fit_add_edge(b);

    for (int fap = 3; err == FAP_OK && fap <= FAP_COUNT; fap++)
        if (fit_set_has(&sources, fap))
            fap_fit_add_source(b, fap);
    for (int c = first; err == FAP_OK && c < l->data.columns; c++)
        if (l->role[c] == GIVEN && is_same(sources_of(l, c), sources))
            err = describe_formula(l, c, b);
    return err;
}

static fap_err describe(fit_builder *b, void *user)
{
    const fit_learner *const l = user;
    fap_err err = FAP_OK;

    for (int c = 0; err == FAP_OK && c < l->data.columns; c++)
        if (l->role[c] == GIVEN && begins_edge(l, c))
            err = describe_edge(l, c, b);
    return err;
}

/* --- the proof --- */

/* What a decoder makes of a frame of which only the FAPs sent are left. */
static fap_frame decoded(const fit_learner *l, const fap_fit *fit, const fap_frame *frame)
{
    fap_frame f = { 0 };

    for (int c = 0; c < l->data.columns; c++) {
        const int fap = l->data.fap[c];
        if (l->role[c] == GIVEN)
            continue;
        f.state[fap] = FAP_CODED;
        f.value[fap] = quantise(clamp(frame->value[fap]), l->quant * fap_info_get(fap)->quant_step);
    }
    fap_fit_apply(fit, &f);
    return f;
}

static void count_misses(const fit_learner *l, const fap_fit *fit, size_t misses[FIT_MAX_COLUMNS])
{
    for (size_t i = 0; i < l->count; i++) {
        const fap_frame f = decoded(l, fit, &l->frames[i]);
        for (int c = 0; c < l->data.columns; c++) {
            const int fap = l->data.fap[c];
            const double miss = (double)f.value[fap] - l->frames[i].value[fap];
            misses[c] += l->role[c] == GIVEN &&
                         (f.state[fap] == FAP_ABSENT || miss > l->data.bound[c] || -miss > l->data.bound[c]);
        }
    }
}

/* Formulas were found on a part of the frames, in another order of operations: the table itself decides, on all
 * frames. 1: some FAP has to be sent after all. */
static int take_back(fit_learner *l, const fap_fit *fit, int exceptions)
{
    size_t misses[FIT_MAX_COLUMNS] = { 0 };
    int taken = 0;

    count_misses(l, fit, misses);
    for (int c = 0; c < l->data.columns; c++)
        if (l->role[c] == GIVEN && misses[c] > share_of(l->count, exceptions)) {
            l->role[c] = SENT;
            taken = 1;
        }
    return taken;
}

static fap_err make_table(fit_learner *l, const fap_fit_learn_config *cfg, fap_fit **fit)
{
    fap_err err = fap_fit_build(fit, describe, l, &cfg->alloc);

    if (err == FAP_OK && take_back(l, *fit, cfg->exceptions)) {
        fap_fit_close(fit);
        err = fap_fit_build(fit, describe, l, &cfg->alloc);
    }
    return err;
}

/* --- the call --- */

void fap_fit_learn_config_init(fap_fit_learn_config *cfg)
{
    *cfg = (fap_fit_learn_config){ .struct_size = sizeof *cfg, .error_nm = 200000, .quant = 1, .terms = 4 };
}

static fap_err take_config(fap_fit_learn_config *to, const fap_fit_learn_config *cfg)
{
    fap_fit_learn_config_init(to);
    if (!cfg)
        return FAP_OK;
    if (cfg->struct_size < offsetof(fap_fit_learn_config, alloc))
        return FAP_E_ARG;
    memcpy(to, cfg, cfg->struct_size < sizeof *to ? cfg->struct_size : sizeof *to);
    const int fine = to->exceptions >= 0 && to->exceptions <= 1000 && to->quant >= 0 && to->quant <= 31 &&
                     to->terms >= 1 && to->terms <= FIT_FORMULA_MAX;
    return fine ? FAP_OK : FAP_E_ARG;
}

static void learn(fit_learner *l, const fap_fit_learn_config *cfg)
{
    const int most = (int)(l->data.rows / ROWS_PER_TERM);

    l->terms = cfg->terms < most ? cfg->terms : most;
    l->data.exceptions = share_of(l->data.rows, cfg->exceptions);
    for (int c = 0; c < l->data.columns; c++)
        fill_column(l, c);
    fap_fit_sum(&l->data);
    choose(l);
}

/* The learner and its rows in one block. */
static fit_learner *new_learner(const fap_frame *frames, size_t count, const fap_fit_learn_config *cfg,
                                const fap_allocator *alloc)
{
    const size_t rows = count < MAX_ROWS ? count : MAX_ROWS, cells = FIT_MAX_COLUMNS * rows;
    fit_learner *l =
        fap_mem_calloc(alloc, 1, sizeof *l + rows * sizeof(double) + 2 * cells * sizeof(int32_t));

    if (!l)
        return NULL;
    l->data.rows = rows;
    l->data.weight = (double *)(void *)(l + 1);
    l->data.value = (int32_t *)(void *)(l->data.weight + rows);
    l->data.source = l->data.value + cells;
    l->frames = frames;
    l->count = count;
    l->quant = cfg->quant;
    choose_columns(l, cfg);
    return l;
}

fap_err fap_fit_learn(fap_fit **fit, const fap_frame *frames, size_t count, const fap_fit_learn_config *cfg)
{
    fap_fit_learn_config config;

    if (!fit)
        return FAP_E_ARG;
    *fit = NULL;
    if ((!frames && count) || take_config(&config, cfg) != FAP_OK)
        return FAP_E_ARG;
    const fap_allocator alloc = fap_mem_allocator(&config.alloc);
    fit_learner *l = new_learner(frames, count, &config, &alloc);
    if (!l)
        return FAP_E_NOMEM;
    learn(l, &config);
    const fap_err err = make_table(l, &config, fit);
    fap_mem_free(&alloc, l);
    return err;
}
