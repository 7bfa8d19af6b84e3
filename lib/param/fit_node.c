/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A FAP interpolation table from the fields of a FIT node. The fields are flat lists without lengths of their
 * own: they are read like streams, and each must end where the graph says.
 * Source: ISO/IEC 14496-1, FIT node, as far as include/fap/fit.h says.
 */
#include <stdio.h>

#include "param/fit.h"

enum { MAX_MEMBERS = FIT_SOURCE_END, FLOAT_DIGITS = 9 };

typedef struct fit_members {
    uint8_t count, fap[MAX_MEMBERS];
} fit_members;

typedef struct fit_node {
    const fap_fit_node *node;
    size_t impulse, terms[2], exponent[2], coefficient[2]; /* what of each field was read */
    char *where;
} fit_node;

static fap_err fail(fit_node *n, fap_err err, const char *field, const char *what)
{
    if (n->where)
        snprintf(n->where, FAP_ERROR_TEXT_SIZE, "FIT.%s: %s", field, what);
    return err;
}

/* --- sets --- */

/* Members of set @p index, and one more where there are too many. 0: no such set. */
static int find_set(const fap_fit_node *node, int32_t index, fit_members *m)
{
    size_t at = 0;

    m->count = 0;
    if (index < 0)
        return 0;
    for (; index > 0 && at < node->faps_count; at++)
        index -= node->faps[at] == -1;
    if (index > 0 || at == node->faps_count)
        return 0;
    for (; at < node->faps_count && node->faps[at] != -1 && m->count < MAX_MEMBERS; at++) {
        const int32_t fap = node->faps[at];
        m->fap[m->count++] = (uint8_t)(fap >= 1 && fap < FIT_SOURCE_END ? fap : 0);
    }
    return 1;
}

static fap_err check_set(fit_node *n, const fit_members *m, int last)
{
    for (int i = 0; i < m->count; i++) {
        if (!m->fap[i])
            return fail(n, FAP_E_DATA, "FAPs", "no such FAP");
        if (m->fap[i] <= 2)
            return fail(n, FAP_E_UNSUPPORTED, "FAPs", "FAPs 1 and 2 as a whole; their parts are 69 to 75");
        if (m->fap[i] > last)
            return fail(n, FAP_E_UNSUPPORTED, "FAPs", "visemes and expressions cannot be interpolated");
    }
    return m->count < MAX_MEMBERS ? FAP_OK : fail(n, FAP_E_LIMIT, "FAPs", "a set is too big");
}

static fap_err read_set(fit_node *n, int32_t index, int last, fit_members *m)
{
    if (!find_set(n->node, index, m))
        return fail(n, FAP_E_DATA, "Graph", "no such set");
    return check_set(n, m, last);
}

static int has_parts(const fit_members *m)
{
    for (int i = 0; i < m->count; i++)
        if (m->fap[i] > FAP_COUNT)
            return 1;
    return 0;
}

/* --- fields --- */

static const char *const terms_fields[] = { "numeratorTerms", "denominatorTerms" };
static const char *const exponent_fields[] = { "numeratorExp", "denominatorExp" };
static const char *const coefficient_fields[] = { "numeratorCoefs", "denominatorCoefs" };

static fap_err next_integer(fit_node *n, const char *field, const int32_t *list, size_t count, size_t *at,
                            int32_t max, int32_t *value)
{
    if (*at >= count)
        return fail(n, FAP_E_DATA, field, "too short");
    *value = list[(*at)++];
    if (*value < 0 || *value > max)
        return fail(n, *value < 0 ? FAP_E_DATA : FAP_E_LIMIT, field, "a number is out of range");
    return FAP_OK;
}

static fap_err next_terms(fit_node *n, int part, int32_t *terms)
{
    const fap_fit_node *const f = n->node;
    return part == FIT_NUMERATOR
               ? next_integer(n, terms_fields[part], f->numerator_terms, f->numerator_terms_count,
                              &n->terms[part], FAP_FIT_MAX_TERMS, terms)
               : next_integer(n, terms_fields[part], f->denominator_terms, f->denominator_terms_count,
                              &n->terms[part], FAP_FIT_MAX_TERMS, terms);
}

static fap_err next_exponent(fit_node *n, int part, int32_t *exponent)
{
    const fap_fit_node *const f = n->node;
    return part == FIT_NUMERATOR
               ? next_integer(n, exponent_fields[part], f->numerator_exp, f->numerator_exp_count,
                              &n->exponent[part], FAP_FIT_MAX_EXPONENT, exponent)
               : next_integer(n, exponent_fields[part], f->denominator_exp, f->denominator_exp_count,
                              &n->exponent[part], FAP_FIT_MAX_EXPONENT, exponent);
}

/* The fewest digits that make the same float. */
static int shortest(float v, fit_number *number)
{
    for (int digits = 1; digits <= FLOAT_DIGITS; digits++)
        if (fap_fit_round((double)v, digits, number) && (float)fap_fit_value(*number) == v)
            return 1;
    return 0;
}

static fap_err next_coefficient(fit_node *n, int part, fit_number *number)
{
    const fap_fit_node *const f = n->node;
    const float *const list = part == FIT_NUMERATOR ? f->numerator_coefs : f->denominator_coefs;
    const size_t count = part == FIT_NUMERATOR ? f->numerator_coefs_count : f->denominator_coefs_count;

    if (n->coefficient[part] >= count)
        return fail(n, FAP_E_DATA, coefficient_fields[part], "too short");
    if (!shortest(list[n->coefficient[part]++], number))
        return fail(n, FAP_E_DATA, coefficient_fields[part], "a number is out of range");
    return FAP_OK;
}

static fap_err read_impulse(fit_node *n, fit_builder *b, const fit_members *from)
{
    const fap_fit_node *const f = n->node;

    if (!has_parts(from))
        return FAP_OK;
    if (f->numerator_impulse_count < 2 || n->impulse > f->numerator_impulse_count - 2)
        return fail(n, FAP_E_DATA, "numeratorImpulse", "too short");
    const int32_t source = f->numerator_impulse[n->impulse], equals = f->numerator_impulse[n->impulse + 1];
    n->impulse += 2;
    if (!source)
        return FAP_OK;
    if (source < 0 || source >= FIT_SOURCE_END || !fit_set_has(&b->edge.sources, source))
        return fail(n, FAP_E_DATA, "numeratorImpulse", "not a source of its edge");
    if (equals < -FIT_EQUALS_MAX || equals > FIT_EQUALS_MAX)
        return fail(n, FAP_E_LIMIT, "numeratorImpulse", "a number is out of range");
    fap_fit_add_guard(b, source, equals);
    return FAP_OK;
}

/* --- terms, formulas, edges --- */

static fap_err read_factors(fit_node *n, fit_builder *b, int part, const fit_members *from)
{
    for (int i = 0; i < from->count; i++) {
        int32_t exponent = 0;
        const fap_err err = next_exponent(n, part, &exponent);
        if (err != FAP_OK)
            return err;
        if (fap_fit_add_factor(b, from->fap[i], (unsigned)exponent) != FAP_OK)
            return fail(n, FAP_E_LIMIT, exponent_fields[part], "too many, or too big");
    }
    return FAP_OK;
}

static fap_err read_term(fit_node *n, fit_builder *b, int part, const fit_members *from)
{
    fit_number coefficient;
    fap_err err = next_coefficient(n, part, &coefficient);

    if (err != FAP_OK)
        return err;
    if (fap_fit_add_term(b, part, coefficient) != FAP_OK)
        return fail(n, FAP_E_LIMIT, terms_fields[part], "too many");
    err = read_factors(n, b, part, from);
    if (err == FAP_OK && part == FIT_NUMERATOR)
        err = read_impulse(n, b, from);
    return err;
}

static fap_err read_sum(fit_node *n, fit_builder *b, int part, const fit_members *from)
{
    int32_t terms = 0;
    fap_err err = next_terms(n, part, &terms);

    for (int32_t i = 0; err == FAP_OK && i < terms; i++)
        err = read_term(n, b, part, from);
    if (err == FAP_OK && !terms && part == FIT_NUMERATOR)
        err = fap_fit_add_term(b, part, (fit_number){ 0, 0 });
    return err;
}

static fap_err read_formula(fit_node *n, fit_builder *b, const fit_members *from, int target)
{
    fap_err err = fap_fit_add_rule(b, target);

    if (err != FAP_OK)
        return fail(n, err, "Graph", "too many formulas");
    err = read_sum(n, b, FIT_NUMERATOR, from);
    if (err == FAP_OK)
        err = read_sum(n, b, FIT_DENOMINATOR, from);
    return err;
}

static fap_err read_edge(fit_node *n, fit_builder *b, const int32_t sets[2])
{
    fit_members from, to;
    fap_err err = read_set(n, sets[0], FIT_SOURCE_END - 1, &from);

    if (err == FAP_OK)
        err = read_set(n, sets[1], FAP_COUNT, &to);
    if (err != FAP_OK)
        return err;
    if (fap_fit_add_edge(b) != FAP_OK)
        return fail(n, FAP_E_LIMIT, "Graph", "too many edges");
    for (int i = 0; i < from.count; i++)
        fap_fit_add_source(b, from.fap[i]);
    for (int i = 0; err == FAP_OK && i < to.count; i++)
        err = read_formula(n, b, &from, to.fap[i]);
    return err;
}

/* Fields longer than the graph asks for were understood wrongly. */
static fap_err check_ends(fit_node *n)
{
    const fap_fit_node *const f = n->node;
    const struct {
        const char *field;
        size_t read, count;
    } fields[] = {
        { terms_fields[0], n->terms[0], f->numerator_terms_count },
        { terms_fields[1], n->terms[1], f->denominator_terms_count },
        { exponent_fields[0], n->exponent[0], f->numerator_exp_count },
        { exponent_fields[1], n->exponent[1], f->denominator_exp_count },
        { coefficient_fields[0], n->coefficient[0], f->numerator_coefs_count },
        { coefficient_fields[1], n->coefficient[1], f->denominator_coefs_count },
        { "numeratorImpulse", n->impulse, f->numerator_impulse_count },
    };
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (fields[i].read != fields[i].count)
            return fail(n, FAP_E_DATA, fields[i].field, "longer than the graph asks for");
    return FAP_OK;
}

static fap_err describe(fit_builder *b, void *user)
{
    fit_node *const caller = user;
    fit_node n = { .node = caller->node, .where = caller->where };
    const fap_fit_node *const f = n.node;
    fap_err err = FAP_OK;

    if (f->graph_count % 2)
        return fail(&n, FAP_E_DATA, "Graph", "an odd number of sets");
    for (size_t i = 0; err == FAP_OK && i < f->graph_count; i += 2)
        err = read_edge(&n, b, f->graph + i);
    return err == FAP_OK ? check_ends(&n) : err;
}

fap_err fap_fit_open(fap_fit **fit, const fap_fit_node *node, const fap_allocator *alloc, char *where)
{
    fit_node n = { .node = node, .where = where };

    if (where)
        where[0] = '\0';
    if (!fit)
        return FAP_E_ARG;
    *fit = NULL;
    return node ? fap_fit_build(fit, describe, &n, alloc) : FAP_E_ARG;
}
