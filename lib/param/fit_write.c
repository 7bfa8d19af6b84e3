/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Writes the text of a FAP interpolation table: the shortest form that fit_text.c reads into the same table.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include <fap/tables.h>

#include "param/fit.h"

enum { PIECE_SIZE = 128 };

typedef struct fit_output {
    const fap_writer *out;
    int failed;
} fit_output;

static void put(fit_output *o, const char *text)
{
    if (!o->failed)
        o->failed = o->out->write(o->out->user, text, strlen(text)) != 0;
}

static void put_source(fit_output *o, int source)
{
    char name[8];
    put(o, fap_fit_source_name(source, name));
}

/* Digits without their sign: a point among them where that is short, a power of ten otherwise. */
static void put_number(fit_output *o, fit_number n)
{
    char digits[24], text[PIECE_SIZE];
    const int64_t size = n.digits < 0 ? -n.digits : n.digits;
    const int count = snprintf(digits, sizeof digits, "%" PRId64, size);

    if (n.power >= 0 && n.power <= 3 && count + n.power <= FIT_DIGITS)
        snprintf(text, sizeof text, "%s%.*s", digits, n.power, "000");
    else if (n.power < 0 && -n.power < count)
        snprintf(text, sizeof text, "%.*s.%s", count + n.power, digits, digits + count + n.power);
    else if (n.power < 0 && -n.power <= count + 3)
        snprintf(text, sizeof text, "0.%.*s%s", -n.power - count, "000", digits);
    else
        snprintf(text, sizeof text, "%se%d", digits, n.power);
    put(o, text);
}

static void put_factor(fit_output *o, fit_factor x)
{
    char exponent[8];

    put_source(o, x.source);
    if (x.exponent == 1)
        return;
    snprintf(exponent, sizeof exponent, "^%d", x.exponent);
    put(o, exponent);
}

static void put_guard(fit_output *o, const fit_term *term)
{
    char text[24];

    put(o, "[");
    put_source(o, term->guard);
    snprintf(text, sizeof text, " = %" PRId32 "]", term->equals);
    put(o, text);
}

static void put_term(fit_output *o, const fap_fit *t, const fit_term *term)
{
    const int has_factors = term->factors || term->guard;
    const int is_one = (term->written.digits == 1 || term->written.digits == -1) && !term->written.power;
    int written = !(is_one && has_factors);

    if (written)
        put_number(o, term->written);
    for (int i = 0; i < term->factors; i++, written = 1) {
        if (written)
            put(o, "*");
        put_factor(o, t->factor[term->first + (size_t)i]);
    }
    if (!term->guard)
        return;
    if (written)
        put(o, "*");
    put_guard(o, term);
}

static void put_sum(fit_output *o, const fap_fit *t, const fit_term *term, int count)
{
    if (!count)
        put(o, "0");
    for (int i = 0; i < count; i++) {
        const int negative = term[i].written.digits < 0;
        put(o, i ? (negative ? " - " : " + ") : negative ? "-" : "");
        put_term(o, t, &term[i]);
    }
}

static void put_rule(fit_output *o, const fap_fit *t, const fit_rule *r)
{
    const fit_term *const term = t->term + r->first;
    const int quotient = r->terms[FIT_DENOMINATOR] != 0;

    put(o, "    ");
    put_source(o, r->target);
    put(o, quotient ? " = (" : " = ");
    put_sum(o, t, term, r->terms[FIT_NUMERATOR]);
    if (quotient) {
        put(o, ") / (");
        put_sum(o, t, term + r->terms[FIT_NUMERATOR], r->terms[FIT_DENOMINATOR]);
        put(o, ")");
    }
    put(o, "  # ");
    put(o, fap_info_get(r->target)->name);
    put(o, "\n");
}

static void put_edge(fit_output *o, const fap_fit *t, const fit_edge *e)
{
    put(o, "\nfrom");
    for (int source = 1; source < FIT_SOURCE_END; source++)
        if (fit_set_has(&e->sources, source)) {
            put(o, " ");
            put_source(o, source);
        }
    put(o, "\n");
    for (uint32_t i = 0; i < e->rules; i++)
        put_rule(o, t, &t->rule[e->first + i]);
}

fap_err fap_fit_write(const fap_fit *fit, const fap_writer *out)
{
    fit_output o = { out, 0 };

    if (!fit || !out || !out->write)
        return FAP_E_ARG;
    put(&o, "fap-fit 1\n");
    for (size_t i = 0; i < fit->edge_count; i++)
        put_edge(&o, fit, &fit->edge[i]);
    return o.failed ? FAP_E_IO : FAP_OK;
}
