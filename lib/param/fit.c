/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FAP interpolation tables: making and applying them. See fit.h for what they hold.
 * Only + - * / on doubles, in the order of the table: every machine gives the same values.
 * Source: ISO/IEC 14496-1, FIT node; US patent 6130679 (expired) prints the formula with its impulses.
 */
#include <string.h>

#include "base/mem.h"
#include "param/fit.h"

static const double smallest_denominator = 1e-9;
static const double largest_double = 1.7976931348623157e308;
static const int32_t value_limit = 1 << 30;

/* --- numbers --- */

static double power_of_ten(int n)
{
    double p = 1;
    while (n-- > 0)
        p *= 10;
    return p;
}

double fap_fit_value(fit_number n)
{
    const double digits = (double)n.digits;
    return n.power >= 0 ? digits * power_of_ten(n.power) : digits / power_of_ten(-n.power);
}

int fap_fit_normal(fit_number *n)
{
    if (!n->digits)
        n->power = 0;
    while (n->digits && n->digits % 10 == 0) {
        n->digits /= 10;
        n->power++;
    }
    return n->power >= -FIT_POWER_MAX && n->power <= FIT_POWER_MAX;
}

static int64_t round_to_integer(double v)
{
    const int64_t whole = (int64_t)v;
    const double rest = v - (double)whole;
    return rest >= 0.5 ? whole + 1 : rest <= -0.5 ? whole - 1 : whole;
}

int fap_fit_round(double v, int digits, fit_number *n)
{
    const double top = power_of_ten(digits), size = v < 0 ? -v : v;
    int power = 0;

    *n = (fit_number){ 0, 0 };
    if (!(size <= 1e36))
        return 0;
    if (size < 1e-36)
        return size == 0;
    /* One scaling by an exact power: the digits are right but for ties that are none in the double either. */
    while (power < 40 && size / power_of_ten(power) >= top)
        power++;
    while (power > -40 && size * power_of_ten(-power) < top / 10)
        power--;
    n->digits = round_to_integer(power >= 0 ? v / power_of_ten(power) : v * power_of_ten(-power));
    n->power = power;
    return fap_fit_normal(n);
}

/* --- names --- */

static const char *const part_names[FIT_SOURCE_END - FIT_VISEME_SELECT1] = {
    "viseme_select1",        "viseme_select2",     "viseme_blend",          "expression_select1",
    "expression_intensity1", "expression_select2", "expression_intensity2",
};

const char *fap_fit_source_name(int source, char buf[8])
{
    char *p = buf;

    if (source >= FIT_VISEME_SELECT1)
        return part_names[source - FIT_VISEME_SELECT1];
    *p++ = 'f';
    if (source >= 10)
        *p++ = (char)('0' + source / 10);
    *p++ = (char)('0' + source % 10);
    *p = '\0';
    return buf;
}

int fap_fit_part_by_name(const char *name)
{
    for (int i = 0; i < FIT_SOURCE_END - FIT_VISEME_SELECT1; i++)
        if (!strcmp(part_names[i], name))
            return FIT_VISEME_SELECT1 + i;
    return 0;
}

/* --- making --- */

fap_err fap_fit_add_edge(fit_builder *b)
{
    if (b->edges == FAP_FIT_MAX_EDGES)
        return FAP_E_LIMIT;
    b->edge = (fit_edge){ .first = (uint32_t)b->rules };
    b->edges++;
    return FAP_OK;
}

void fap_fit_add_source(fit_builder *b, int source)
{
    fit_set_add(&b->edge.sources, source);
    if (b->fit)
        b->fit->edge[b->edges - 1] = b->edge;
}

fap_err fap_fit_add_rule(fit_builder *b, int target)
{
    if (b->rules == FAP_FIT_MAX_FORMULAS)
        return FAP_E_LIMIT;
    b->rule = (fit_rule){ .first = (uint32_t)b->terms, .target = (uint8_t)target };
    b->rules++;
    b->edge.rules++;
    fit_set_add(&b->edge.targets, target);
    if (b->fit) {
        b->fit->edge[b->edges - 1] = b->edge;
        b->fit->rule[b->rules - 1] = b->rule;
        fit_set_add(&b->fit->targets, target);
    }
    return FAP_OK;
}

static void store_term(fit_builder *b)
{
    if (b->fit)
        b->fit->term[b->terms - 1] = b->term;
}

fap_err fap_fit_add_term(fit_builder *b, int part, fit_number coefficient)
{
    if (b->terms == FAP_FIT_MAX_TERMS)
        return FAP_E_LIMIT;
    b->term = (fit_term){ .coefficient = fap_fit_value(coefficient),
                          .written = coefficient,
                          .first = (uint32_t)b->factors };
    b->terms++;
    b->rule.terms[part]++;
    if (b->fit)
        b->fit->rule[b->rules - 1] = b->rule;
    store_term(b);
    return FAP_OK;
}

/* Where @p source stands, or would, among the factors of the last term: they are in order. */
static int place_of(const fit_builder *b, int source)
{
    int at = 0;
    while (at < b->term.factors && b->last[at].source < source)
        at++;
    return at;
}

static void store_factors(fit_builder *b)
{
    if (b->fit)
        memcpy(b->fit->factor + b->term.first, b->last, b->term.factors * sizeof *b->last);
    store_term(b);
}

/* A source named twice is one factor: there is one way to hold a product. */
fap_err fap_fit_add_factor(fit_builder *b, int source, unsigned exponent)
{
    const int at = place_of(b, source), is_there = at < b->term.factors && b->last[at].source == source;
    const unsigned sum = exponent + (is_there ? b->last[at].exponent : 0);

    if (exponent > FAP_FIT_MAX_EXPONENT || sum > FAP_FIT_MAX_EXPONENT)
        return FAP_E_LIMIT;
    if (!exponent)
        return FAP_OK;
    if (!is_there && b->factors == FAP_FIT_MAX_FACTORS)
        return FAP_E_LIMIT;
    if (!is_there) {
        memmove(&b->last[at + 1], &b->last[at], (size_t)(b->term.factors - at) * sizeof *b->last);
        b->term.factors++;
        b->factors++;
    }
    b->last[at] = (fit_factor){ (uint8_t)source, (uint8_t)sum };
    store_factors(b);
    return FAP_OK;
}

void fap_fit_add_guard(fit_builder *b, int source, int32_t equals)
{
    b->term.guard = (uint8_t)source;
    b->term.equals = equals;
    store_term(b);
}

/* One block: the members in falling order of alignment. */
static fap_fit *new_table(const fit_builder *b, const fap_allocator *alloc)
{
    const size_t edges = b->edges * sizeof(fit_edge), terms = b->terms * sizeof(fit_term),
                 rules = b->rules * sizeof(fit_rule), factors = b->factors * sizeof(fit_factor);
    fap_fit *t = fap_mem_calloc(alloc, 1, sizeof *t + edges + terms + rules + factors);

    if (!t)
        return NULL;
    t->alloc = *alloc;
    t->edge_count = b->edges;
    t->rule_count = b->rules;
    t->term_count = b->terms;
    t->factor_count = b->factors;
    char *at = (char *)(t + 1);
    t->edge = (void *)at;
    t->term = (void *)(at += edges);
    t->rule = (void *)(at += terms);
    t->factor = (void *)(at + rules);
    return t;
}

fap_err fap_fit_build(fap_fit **fit, fap_err (*describe)(fit_builder *b, void *user), void *user,
                      const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);
    fit_builder count = { 0 }, store = { 0 };

    *fit = NULL;
    fap_err err = describe(&count, user);
    if (err != FAP_OK)
        return err;
    store.fit = new_table(&count, &a);
    if (!store.fit)
        return FAP_E_NOMEM;
    err = describe(&store, user);
    if (err == FAP_OK)
        *fit = store.fit;
    else
        fap_mem_free(&a, store.fit);
    return err;
}

void fap_fit_close(fap_fit **fit)
{
    if (!fit || !*fit)
        return;
    const fap_allocator alloc = (*fit)->alloc;
    fap_mem_free(&alloc, *fit);
    *fit = NULL;
}

/* --- applying --- */

int fap_fit_gives(const fap_fit *fit, int fap)
{
    return fit && fap >= 1 && fap <= FAP_COUNT && fit_set_has(&fit->targets, fap);
}

/* A frame as formulas read it. */
typedef struct fit_sources {
    fit_set known;
    double value[FIT_SOURCE_END];
} fit_sources;

static void read_parts(fit_sources *s, const fap_frame *f)
{
    const fap_viseme *const v = &f->viseme;
    const fap_expression *const e = &f->expression;

    s->value[FIT_VISEME_SELECT1] = v->select1;
    s->value[FIT_VISEME_SELECT2] = v->select2;
    s->value[FIT_VISEME_BLEND] = v->blend;
    s->value[FIT_EXPRESSION_SELECT1] = e->select1;
    s->value[FIT_EXPRESSION_INTENSITY1] = e->intensity1;
    s->value[FIT_EXPRESSION_SELECT2] = e->select2;
    s->value[FIT_EXPRESSION_INTENSITY2] = e->intensity2;
    for (int part = FIT_VISEME_SELECT1; part < FIT_SOURCE_END; part++)
        if (f->state[part < FIT_EXPRESSION_SELECT1 ? 1 : 2] != FAP_ABSENT)
            fit_set_add(&s->known, part);
}

static void read_sources(fit_sources *s, const fap_frame *f)
{
    uint64_t low = 0, high = 0;

    for (int fap = 3; fap < 64; fap++)
        low |= (uint64_t)(f->state[fap] != FAP_ABSENT) << fap;
    for (int fap = 64; fap <= FAP_COUNT; fap++)
        high |= (uint64_t)(f->state[fap] != FAP_ABSENT) << (fap - 64);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        s->value[fap] = f->value[fap];
    s->known = (fit_set){ { low, high } };
    read_parts(s, f);
}

static double term_value(const fap_fit *t, const fit_term *term, const fit_sources *s)
{
    double v = term->coefficient;

    if (term->guard && s->value[term->guard] != term->equals)
        return 0;
    for (const fit_factor *x = t->factor + term->first, *end = x + term->factors; x < end; x++)
        for (int i = 0; i < x->exponent; i++)
            v *= s->value[x->source];
    return v;
}

static double sum_of_terms(const fap_fit *t, const fit_term *term, int count, const fit_sources *s)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += term_value(t, &term[i], s);
    return sum;
}

static int is_finite(double v)
{
    return v >= -largest_double && v <= largest_double;
}

static int32_t value_of(double v)
{
    return v >= value_limit ? value_limit : v <= -value_limit ? -value_limit : (int32_t)round_to_integer(v);
}

/* 0: the formula has no value for these sources. */
static int evaluate(const fap_fit *t, const fit_rule *r, const fit_sources *s, int32_t *value)
{
    const fit_term *term = t->term + r->first;
    const double n = sum_of_terms(t, term, r->terms[FIT_NUMERATOR], s);
    double d = 1;

    if (r->terms[FIT_DENOMINATOR])
        d = sum_of_terms(t, term + r->terms[FIT_NUMERATOR], r->terms[FIT_DENOMINATOR], s);
    if (!is_finite(n) || !is_finite(d) || (d < smallest_denominator && d > -smallest_denominator))
        return 0;
    *value = value_of(d == 1 ? n : n / d);
    return 1;
}

static int follow(const fap_fit *t, const fit_edge *e, fap_frame *f, fit_sources *s)
{
    int given = 0;

    for (const fit_rule *r = t->rule + e->first, *end = r + e->rules; r < end; r++) {
        int32_t value;
        if (fit_set_has(&s->known, r->target) || !evaluate(t, r, s, &value))
            continue;
        f->value[r->target] = value;
        f->state[r->target] = FAP_DERIVED;
        s->value[r->target] = value;
        fit_set_add(&s->known, r->target);
        given = 1;
    }
    return given;
}

/* Known FAPs never change: an edge once followed has nothing more to give, in this call or in the next. */
void fap_fit_apply(const fap_fit *fit, fap_frame *frame)
{
    uint8_t followed[FAP_FIT_MAX_EDGES] = { 0 };
    int given = 1;

    if (!fit || !frame)
        return;
    fit_sources sources;
    read_sources(&sources, frame);
    while (given && fit_set_lacks(&fit->targets, &sources.known)) {
        given = 0;
        for (size_t i = 0; i < fit->edge_count; i++) {
            const fit_edge *const e = &fit->edge[i];
            if (followed[i] || fit_set_lacks(&e->sources, &sources.known))
                continue;
            followed[i] = 1;
            given |= follow(fit, e, frame, &sources);
        }
    }
}
