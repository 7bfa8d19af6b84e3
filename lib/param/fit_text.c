/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The text of a FAP interpolation table, read and written: docs/fit.md has the grammar. Line oriented, one edge
 * ("from ...") and then a formula a line. It is libfap's own: the node has no text in the standard.
 */
#include <stdio.h>
#include <string.h>

#include <fap/tables.h>

#include "param/fit.h"

enum { WORD_SIZE = 32 };

static const char head[] = "fap-fit";

/* --- lines and words --- */

typedef struct fit_text {
    const char *text;
    size_t size;
    const char *line, *p, *end; /* the line without comment; p: what is read next */
    const char *next;           /* line */
    int number;
    char *where;
} fit_text;

static fap_err fail(fit_text *t, fap_err err, const char *what)
{
    if (t->where)
        snprintf(t->where, FAP_ERROR_TEXT_SIZE, "line %d, column %d: %s", t->number,
                 (int)(t->p - t->line) + 1, what);
    return err;
}

static fap_err fail_about(fit_text *t, const char *at, const char *word, const char *what)
{
    char text[FAP_ERROR_TEXT_SIZE - 64];

    t->p = at;
    snprintf(text, sizeof text, "%s %s", word, what);
    return fail(t, FAP_E_SYNTAX, text);
}

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static void skip_blanks(fit_text *t)
{
    while (t->p < t->end && is_blank(*t->p))
        t->p++;
}

/* 0: no more lines. */
static int next_line(fit_text *t)
{
    const char *const end = t->text + t->size;

    if (t->next == end)
        return 0;
    t->line = t->p = t->next;
    t->number++;
    const char *newline = memchr(t->line, '\n', (size_t)(end - t->line));
    t->next = newline ? newline + 1 : end;
    t->end = newline ? newline : end;
    const char *comment = memchr(t->line, '#', (size_t)(t->end - t->line));
    if (comment)
        t->end = comment;
    return 1;
}

/* The next line that says something. */
static int next_statement(fit_text *t)
{
    while (next_line(t)) {
        skip_blanks(t);
        if (t->p < t->end)
            return 1;
    }
    return 0;
}

static int is_at_end(fit_text *t)
{
    skip_blanks(t);
    return t->p == t->end;
}

/* Takes @p c where it is next. */
static int take(fit_text *t, char c)
{
    skip_blanks(t);
    if (t->p == t->end || *t->p != c)
        return 0;
    t->p++;
    return 1;
}

static int is_next(fit_text *t, char c)
{
    skip_blanks(t);
    return t->p < t->end && *t->p == c;
}

/* A name, cut to fit. "" where none starts. */
static void take_word(fit_text *t, char word[WORD_SIZE])
{
    size_t n = 0;

    skip_blanks(t);
    while (t->p < t->end && (is_letter(*t->p) || (n && is_digit(*t->p)))) {
        if (n < WORD_SIZE - 1)
            word[n++] = *t->p;
        t->p++;
    }
    word[n] = '\0';
}

static int is_word_next(fit_text *t)
{
    skip_blanks(t);
    return t->p < t->end && is_letter(*t->p);
}

/* --- numbers --- */

/* Digits and where the point is among them. -1: too many. */
static int take_digits(fit_text *t, fit_number *n, int sign, int *count)
{
    for (*count = 0; t->p < t->end && is_digit(*t->p); t->p++, ++*count) {
        if (n->digits > 99999999999999 || n->digits < -99999999999999)
            return -1;
        n->digits = n->digits * 10 + sign * (*t->p - '0');
    }
    return 0;
}

static int take_power(fit_text *t, int *power)
{
    fit_number n = { 0, 0 };
    int count;

    if (t->p == t->end || (*t->p != 'e' && *t->p != 'E'))
        return 1;
    t->p++;
    const int sign = t->p < t->end && *t->p == '-' ? -1 : 1;
    if (t->p < t->end && (*t->p == '-' || *t->p == '+'))
        t->p++;
    if (take_digits(t, &n, sign, &count) || !count || n.digits > 99 || n.digits < -99)
        return 0;
    *power = (int)n.digits;
    return 1;
}

static fap_err take_number(fit_text *t, int sign, fit_number *n)
{
    const char *const start = t->p;
    int whole, decimals = 0, power = 0;
    int bad = 0;

    *n = (fit_number){ 0, 0 };
    bad = take_digits(t, n, sign, &whole);
    if (!bad && t->p < t->end && *t->p == '.') {
        t->p++;
        bad = take_digits(t, n, sign, &decimals);
    }
    if (bad || decimals > 99)
        return fail_about(t, start, "a number", "of more than 15 digits");
    if (!(whole + decimals) || !take_power(t, &power) || (t->p < t->end && is_letter(*t->p)))
        return fail_about(t, start, "a number", "was expected");
    n->power = power - decimals;
    if (!fap_fit_normal(n))
        return fail_about(t, start, "this number", "is beyond what a coefficient can be (1e-22 to 1e22)");
    return FAP_OK;
}

static fap_err take_integer(fit_text *t, int max, int32_t *value)
{
    fit_number n;

    skip_blanks(t);
    const char *const start = t->p;
    const int sign = take(t, '-') ? -1 : 1;
    const fap_err err = take_number(t, sign, &n);
    if (err != FAP_OK)
        return err;
    const double v = fap_fit_value(n);
    if (v > max || v < -max || v != (double)(int32_t)v)
        return fail_about(t, start, "this number", "is not an integer in range");
    *value = (int32_t)v;
    return FAP_OK;
}

/* --- sources and targets --- */

/* "f53": the number; 0: not of that form. */
static int numbered(const char *word)
{
    if (word[0] != 'f' || !is_digit(word[1]) || word[1] == '0')
        return 0;
    if (!word[2])
        return word[1] - '0';
    if (!is_digit(word[2]) || word[3])
        return 0;
    const int fap = (word[1] - '0') * 10 + word[2] - '0';
    return fap <= FAP_COUNT ? fap : 0;
}

static fap_err take_source(fit_text *t, int *source)
{
    char word[WORD_SIZE];

    skip_blanks(t);
    const char *const start = t->p;
    take_word(t, word);
    if (!word[0])
        return fail(t, FAP_E_SYNTAX, "a FAP was expected, like f53 or open_jaw");
    *source = numbered(word);
    if (!*source)
        *source = fap_by_name(word);
    if (!*source)
        *source = fap_fit_part_by_name(word);
    if (!*source)
        return fail_about(t, start, word, "is no FAP");
    if (*source == 1)
        return fail_about(t, start, word, "has parts: viseme_select1, viseme_select2, viseme_blend");
    if (*source == 2)
        return fail_about(t, start, word, "has parts: expression_select1, expression_intensity1, ...");
    return FAP_OK;
}

static fap_err take_own_source(fit_text *t, const fit_builder *b, int *source)
{
    char name[8];

    skip_blanks(t);
    const char *const start = t->p;
    const fap_err err = take_source(t, source);
    if (err == FAP_OK && !fit_set_has(&b->edge.sources, *source))
        return fail_about(t, start, fap_fit_source_name(*source, name),
                          "is not among the FAPs behind \"from\"");
    return err;
}

/* --- formulas --- */

static fap_err too_big(fit_text *t)
{
    return fail(t, FAP_E_LIMIT, "the table is too big");
}

/* [viseme_select1 = 3], the bracket taken. */
static fap_err read_guard(fit_text *t, fit_builder *b, int part)
{
    int source = 0;
    int32_t equals = 0;

    if (part != FIT_NUMERATOR)
        return fail(t, FAP_E_SYNTAX, "a denominator has no [conditions]");
    if (b->term.guard)
        return fail(t, FAP_E_SYNTAX, "a term has one [condition] at most");
    fap_err err = take_own_source(t, b, &source);
    if (err == FAP_OK && !take(t, '='))
        return fail(t, FAP_E_SYNTAX, "\"=\" was expected");
    if (err == FAP_OK)
        err = take_integer(t, FIT_EQUALS_MAX, &equals);
    if (err == FAP_OK && !take(t, ']'))
        return fail(t, FAP_E_SYNTAX, "\"]\" was expected");
    if (err == FAP_OK)
        fap_fit_add_guard(b, source, equals);
    return err;
}

static fap_err read_factor(fit_text *t, fit_builder *b, int part)
{
    int source;
    int32_t exponent = 1;

    if (take(t, '['))
        return read_guard(t, b, part);
    fap_err err = take_own_source(t, b, &source);
    if (err == FAP_OK && take(t, '^'))
        err = take_integer(t, FAP_FIT_MAX_EXPONENT, &exponent);
    if (err != FAP_OK)
        return err;
    if (exponent < 0 || fap_fit_add_factor(b, source, (unsigned)exponent) != FAP_OK)
        return fail(t, FAP_E_LIMIT, "exponents go from 0 to 16");
    return FAP_OK;
}

static fap_err read_term(fit_text *t, fit_builder *b, int part, int sign)
{
    fit_number coefficient = { sign, 0 };
    fap_err err = FAP_OK;

    skip_blanks(t);
    const int bare = is_word_next(t) || is_next(t, '[');
    if (!bare)
        err = take_number(t, sign, &coefficient);
    if (err != FAP_OK)
        return err;
    if (fap_fit_add_term(b, part, coefficient) != FAP_OK)
        return too_big(t);
    if (bare)
        err = read_factor(t, b, part);
    while (err == FAP_OK && take(t, '*'))
        err = read_factor(t, b, part);
    return err;
}

static fap_err read_sum(fit_text *t, fit_builder *b, int part)
{
    int sign = take(t, '-') ? -1 : 1;
    if (sign > 0)
        take(t, '+');
    for (;;) {
        const fap_err err = read_term(t, b, part, sign);
        if (err != FAP_OK)
            return err;
        if (take(t, '-'))
            sign = -1;
        else if (take(t, '+'))
            sign = 1;
        else
            return FAP_OK;
    }
}

static fap_err read_group(fit_text *t, fit_builder *b, int part)
{
    if (!take(t, '('))
        return fail(t, FAP_E_SYNTAX, "\"(\" was expected: denominators stand in parentheses");
    const fap_err err = read_sum(t, b, part);
    if (err == FAP_OK && !take(t, ')'))
        return fail(t, FAP_E_SYNTAX, "\"+\", \"-\", \"*\" or \")\" was expected");
    return err;
}

static fap_err read_quotient(fit_text *t, fit_builder *b)
{
    const int grouped = is_next(t, '(');
    fap_err err = grouped ? read_group(t, b, FIT_NUMERATOR) : read_sum(t, b, FIT_NUMERATOR);

    if (err == FAP_OK && !grouped && is_next(t, '/'))
        return fail(t, FAP_E_SYNTAX, "the numerator of a quotient stands in parentheses");
    if (err == FAP_OK && take(t, '/'))
        err = read_group(t, b, FIT_DENOMINATOR);
    if (err == FAP_OK && !is_at_end(t))
        err = fail(t, FAP_E_SYNTAX,
                   grouped ? "\"/\" or the end of the line was expected"
                           : "\"+\", \"-\", \"*\" or the end of the line was expected");
    return err;
}

/* --- statements --- */

static fap_err read_edge(fit_text *t, fit_builder *b)
{
    if (fap_fit_add_edge(b) != FAP_OK)
        return too_big(t);
    while (is_word_next(t)) {
        int source;
        const fap_err err = take_source(t, &source);
        if (err != FAP_OK)
            return err;
        fap_fit_add_source(b, source);
    }
    return is_at_end(t) ? FAP_OK : fail(t, FAP_E_SYNTAX, "a FAP was expected, like f53 or open_jaw");
}

static fap_err read_formula(fit_text *t, fit_builder *b)
{
    const char *const start = t->p;
    int target;

    if (!b->edges)
        return fail(t, FAP_E_SYNTAX, "\"from\" and the FAPs to interpolate from were expected");
    const fap_err err = take_source(t, &target);
    if (err != FAP_OK)
        return err;
    if (target > FAP_COUNT)
        return fail_about(t, start, "visemes and expressions", "cannot be interpolated");
    if (!take(t, '='))
        return fail(t, FAP_E_SYNTAX, "\"=\" was expected");
    if (fap_fit_add_rule(b, target) != FAP_OK)
        return too_big(t);
    return read_quotient(t, b);
}

static fap_err read_statement(fit_text *t, fit_builder *b)
{
    const char *const start = t->p;
    char word[WORD_SIZE];

    take_word(t, word);
    if (!strcmp(word, "from"))
        return read_edge(t, b);
    t->p = start;
    return read_formula(t, b);
}

static fap_err read_head(fit_text *t)
{
    const size_t size = sizeof head - 1;
    int32_t version = 0;

    if (!next_statement(t) || (size_t)(t->end - t->p) < size || memcmp(t->p, head, size) != 0)
        return fail(t, FAP_E_SYNTAX, "\"fap-fit 1\" was expected");
    t->p += size;
    const fap_err err = take_integer(t, 999, &version);
    if (err == FAP_OK && version != 1)
        return fail(t, FAP_E_SYNTAX, "only version 1 is known");
    if (err == FAP_OK && !is_at_end(t))
        return fail(t, FAP_E_SYNTAX, "the end of the line was expected");
    return err;
}

static fap_err describe(fit_builder *b, void *user)
{
    fit_text *t = user;
    t->line = t->p = t->end = t->next = t->text;
    t->number = 0;
    fap_err err = read_head(t);

    while (err == FAP_OK && next_statement(t))
        err = read_statement(t, b);
    return err;
}

fap_err fap_fit_parse(fap_fit **fit, const char *text, size_t size, const fap_allocator *alloc, char *where)
{
    fit_text t = { .text = text ? text : "", .size = size, .where = where };

    if (where)
        where[0] = '\0';
    if (!fit)
        return FAP_E_ARG;
    *fit = NULL;
    if (!text && size)
        return FAP_E_ARG;
    if (size > FAP_FIT_MAX_TEXT) {
        t.line = t.p = t.text;
        return too_big(&t);
    }
    return fap_fit_build(fit, describe, &t, alloc);
}
