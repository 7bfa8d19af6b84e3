/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The fields of a FIT node from a table. Each edge has two sets of its own, twice its number and the one behind it:
 * sets that edges share are worth less than a list that is easy to follow.
 * Source: ISO/IEC 14496-1, FIT node, as far as include/fap/fit.h says.
 */
#include <string.h>

#include "base/mem.h"
#include "param/fit.h"

/* The node, and what its lists are filled through. First member: it is what callers hold. */
typedef struct fit_own_node {
    fap_fit_node node;
    fap_allocator alloc;
    int32_t *integer[7]; /* where the next goes; NULL while counting */
    float *coefficient[2];
    size_t integers[7], coefficients[2];
} fit_own_node;

enum { FAPS, GRAPH, EXPONENTS, IMPULSES = EXPONENTS + 2, TERMS, LISTS = TERMS + 2 };

static void put(fit_own_node *n, int list, int32_t v)
{
    if (n->integer[list])
        n->integer[list][n->integers[list]] = v;
    n->integers[list]++;
}

static void put_coefficient(fit_own_node *n, int part, double v)
{
    if (n->coefficient[part])
        n->coefficient[part][n->coefficients[part]] = (float)v;
    n->coefficients[part]++;
}

static int exponent_of(const fap_fit *t, const fit_term *term, int source)
{
    for (int i = 0; i < term->factors; i++)
        if (t->factor[term->first + (size_t)i].source == source)
            return t->factor[term->first + (size_t)i].exponent;
    return 0;
}

static int has_parts(const fit_edge *e)
{
    return (e->sources.word[1] >> (FIT_VISEME_SELECT1 - 64)) != 0;
}

static void put_term(fit_own_node *n, const fap_fit *t, const fit_edge *e, const fit_term *term, int part)
{
    put_coefficient(n, part, term->coefficient);
    for (int source = 1; source < FIT_SOURCE_END; source++)
        if (fit_set_has(&e->sources, source))
            put(n, EXPONENTS + part, exponent_of(t, term, source));
    if (part == FIT_DENOMINATOR || !has_parts(e))
        return;
    put(n, IMPULSES, term->guard);
    put(n, IMPULSES, term->equals);
}

static void put_rule(fit_own_node *n, const fap_fit *t, const fit_edge *e, const fit_rule *r)
{
    const fit_term *term = t->term + r->first;

    for (int part = FIT_NUMERATOR; part <= FIT_DENOMINATOR; part++) {
        put(n, TERMS + part, r->terms[part]);
        for (int i = 0; i < r->terms[part]; i++)
            put_term(n, t, e, term++, part);
    }
}

static void put_edge(fit_own_node *n, const fap_fit *t, const fit_edge *e, int32_t set)
{
    for (int source = 1; source < FIT_SOURCE_END; source++)
        if (fit_set_has(&e->sources, source))
            put(n, FAPS, source);
    put(n, FAPS, -1);
    for (uint32_t i = 0; i < e->rules; i++)
        put(n, FAPS, t->rule[e->first + i].target);
    put(n, FAPS, -1);
    put(n, GRAPH, set);
    put(n, GRAPH, set + 1);
    for (uint32_t i = 0; i < e->rules; i++)
        put_rule(n, t, e, &t->rule[e->first + i]);
}

static void put_table(fit_own_node *n, const fap_fit *t)
{
    memset(n->integers, 0, sizeof n->integers);
    memset(n->coefficients, 0, sizeof n->coefficients);
    for (size_t i = 0; i < t->edge_count; i++)
        put_edge(n, t, &t->edge[i], (int32_t)(2 * i));
}

/* A condition stands in the node only where its edge has viseme or expression parts. */
static int can_say(const fap_fit *t, const fit_edge *e)
{
    if (has_parts(e))
        return 1;
    for (uint32_t i = 0; i < e->rules; i++) {
        const fit_rule *const r = &t->rule[e->first + i];
        for (int k = 0; k < r->terms[FIT_NUMERATOR]; k++)
            if (t->term[r->first + (size_t)k].guard)
                return 0;
    }
    return 1;
}

static fit_own_node *new_node(const fit_own_node *count, const fap_allocator *alloc)
{
    size_t integers = 0;
    for (int list = 0; list < LISTS; list++)
        integers += count->integers[list];
    fit_own_node *n = fap_mem_calloc(alloc, 1,
                                     sizeof *n + integers * sizeof(int32_t) +
                                         (count->coefficients[0] + count->coefficients[1]) * sizeof(float));
    if (!n)
        return NULL;
    n->alloc = *alloc;
    int32_t *at = (int32_t *)(void *)(n + 1);
    for (int list = 0; list < LISTS; at += count->integers[list++])
        n->integer[list] = at;
    n->coefficient[0] = (float *)(void *)at;
    n->coefficient[1] = n->coefficient[0] + count->coefficients[0];
    return n;
}

static void show_lists(fit_own_node *n)
{
    int32_t *const *const i = n->integer;
    const size_t *const c = n->integers;

    n->node = (fap_fit_node){
        i[FAPS],           c[FAPS],
        i[GRAPH],          c[GRAPH],
        i[EXPONENTS],      c[EXPONENTS],
        i[EXPONENTS + 1],  c[EXPONENTS + 1],
        i[IMPULSES],       c[IMPULSES],
        i[TERMS],          c[TERMS],
        i[TERMS + 1],      c[TERMS + 1],
        n->coefficient[0], n->coefficients[0],
        n->coefficient[1], n->coefficients[1],
    };
}

fap_err fap_fit_to_node(const fap_fit *fit, fap_fit_node **node, const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);
    fit_own_node count = { 0 };

    if (node)
        *node = NULL;
    if (!fit || !node)
        return FAP_E_ARG;
    for (size_t i = 0; i < fit->edge_count; i++)
        if (!can_say(fit, &fit->edge[i]))
            return FAP_E_UNSUPPORTED;
    put_table(&count, fit);
    fit_own_node *n = new_node(&count, &a);
    if (!n)
        return FAP_E_NOMEM;
    put_table(n, fit);
    show_lists(n);
    *node = &n->node;
    return FAP_OK;
}

void fap_fit_node_close(fap_fit_node **node)
{
    if (!node || !*node)
        return;
    fit_own_node *n = (fit_own_node *)(void *)*node;
    const fap_allocator alloc = n->alloc;
    fap_mem_free(&alloc, n);
    *node = NULL;
}
