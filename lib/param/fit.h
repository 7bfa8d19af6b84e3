/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A FAP interpolation table from the inside, and the one way to make it. Whoever makes a table describes it to
 * a builder twice: the first time the builder counts, the second time it stores, so that a table is one block.
 * Source: ISO/IEC 14496-1, FIT node; Tekalp and Ostermann, Face and 2-D mesh animation in MPEG-4, 2000.
 */
#ifndef LIB_PARAM_FIT_H
#define LIB_PARAM_FIT_H

#include <stddef.h>
#include <stdint.h>

#include <fap/fit.h>

/* What a formula reads: FAPs 3..68 by their number, the parts of FAPs 1 and 2 behind them. Those numbers are the
 * node's (UNVERIFIED, from memory). */
enum {
    FIT_VISEME_SELECT1 = FAP_COUNT + 1,
    FIT_VISEME_SELECT2,
    FIT_VISEME_BLEND,
    FIT_EXPRESSION_SELECT1,
    FIT_EXPRESSION_INTENSITY1,
    FIT_EXPRESSION_SELECT2,
    FIT_EXPRESSION_INTENSITY2,
    FIT_SOURCE_END
};

enum {
    FIT_DIGITS = 15, /* of a coefficient: below 2^53, hence exact in a double */
    FIT_EQUALS_MAX = 1 << 30,
    FIT_POWER_MAX = 22 /* of ten, the largest that is exact in a double */
};

/* A set of sources, a bit each. */
typedef struct fit_set {
    uint64_t word[2];
} fit_set;

static inline int fit_set_has(const fit_set *s, int source)
{
    return (int)(s->word[source >> 6] >> (source & 63) & 1);
}

static inline void fit_set_add(fit_set *s, int source)
{
    s->word[source >> 6] |= (uint64_t)1 << (source & 63);
}

/* 1: some member of @p s is not in @p in. */
static inline int fit_set_lacks(const fit_set *s, const fit_set *in)
{
    return (s->word[0] & ~in->word[0]) != 0 || (s->word[1] & ~in->word[1]) != 0;
}

/* digits * 10^power, no trailing zero in digits. Decimal, so that what is written is what is meant. */
typedef struct fit_number {
    int64_t digits;
    int power;
} fit_number;

typedef struct fit_factor {
    uint8_t source, exponent;
} fit_factor;

/* coefficient * product of factors; 0 where source @c guard, if there is one, does not equal @c equals. */
typedef struct fit_term {
    double coefficient;
    fit_number written;
    int32_t equals;
    uint32_t first;
    uint8_t factors, guard;
} fit_term;

/* One FAP's formula: numerator terms, then denominator terms; no denominator terms: 1. */
typedef struct fit_rule {
    uint32_t first;
    uint16_t terms[2];
    uint8_t target;
} fit_rule;

typedef struct fit_edge {
    fit_set sources, targets;
    uint32_t first, rules;
} fit_edge;

struct fap_fit {
    fap_allocator alloc;
    fit_set targets;
    size_t edge_count, rule_count, term_count, factor_count;
    fit_edge *edge;
    fit_rule *rule;
    fit_term *term;
    fit_factor *factor;
};

enum { FIT_NUMERATOR, FIT_DENOMINATOR };

/* Counts while @c fit is NULL. After the first error it takes nothing more. */
typedef struct fit_builder {
    fap_fit *fit;
    size_t edges, rules, terms, factors;
    fit_edge edge; /* the last ones, also while counting */
    fit_rule rule;
    fit_term term;
    fit_factor last[FIT_SOURCE_END]; /* factors of the last term */
} fit_builder;

/* In this order: an edge, its sources, its rules; of a rule numerator terms, then denominator terms; of a term
 * its factors and guard. FAP_OK; FAP_E_LIMIT. */
fap_err fap_fit_add_edge(fit_builder *b);
void fap_fit_add_source(fit_builder *b, int source);
fap_err fap_fit_add_rule(fit_builder *b, int target);
fap_err fap_fit_add_term(fit_builder *b, int part, fit_number coefficient);
fap_err fap_fit_add_factor(fit_builder *b, int source, unsigned exponent);
void fap_fit_add_guard(fit_builder *b, int source, int32_t equals);

/* Calls @p describe twice; it must do the same both times. Its error, FAP_E_NOMEM or FAP_OK. */
fap_err fap_fit_build(fap_fit **fit, fap_err (*describe)(fit_builder *b, void *user), void *user,
                      const fap_allocator *alloc);

/* The number's double, rounded once. */
double fap_fit_value(fit_number n);
/* @p digits and @p power without trailing zeros. 0: out of range. */
int fap_fit_normal(fit_number *n);
/* @p v rounded to @p digits significant digits (1..15). 0: not finite or out of range. */
int fap_fit_round(double v, int digits, fit_number *n);

/* "f3" for FAPs, "viseme_blend" for parts, in @p buf. */
const char *fap_fit_source_name(int source, char buf[8]);
/* The part of that name (FIT_VISEME_SELECT1 ...), 0: none. */
int fap_fit_part_by_name(const char *name);

#endif
