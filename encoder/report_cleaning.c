/* SPDX-License-Identifier: BSD-2-Clause */
/* See report_cleaning.h. */
#include <stdio.h>

#include "common/tool.h"
#include "encoder/report_cleaning.h"
#include "encoder/report_line.h"

static uint32_t filled(const fap_clean_point *c)
{
    uint32_t sum = 0;

    for (int kind = 0; kind < FAP_SAMPLE_KINDS; kind++)
        sum += c->filled[kind];
    return sum;
}

static int is_touched(const fap_clean_point *c)
{
    return c->spikes || c->gaps;
}

/* --- in words --- */

/* "2 spline, 1 motion": gaps by method. */
static void add_methods(report_line *l, const uint32_t gaps_by[FAP_SAMPLE_KINDS])
{
    char text[32];

    for (int kind = 0; kind < FAP_SAMPLE_KINDS; kind++) {
        if (!gaps_by[kind])
            continue;
        snprintf(text, sizeof text, "%u %s", (unsigned)gaps_by[kind], fap_sample_name((fap_sample)kind));
        report_line_add(l, ", ", text);
    }
}

static void say_point(const char *name, const fap_clean_point *c, double rate_hz)
{
    report_line methods = { "", 0 };
    char error[48] = "";

    add_methods(&methods, c->gaps_by);
    if (c->error_mm > 0)
        snprintf(error, sizeof error, ", about %.2f mm off", (double)c->error_mm);
    tool_note("  %-20s %u spikes, %u gaps, the longest %.2f s; %u samples filled (%s)%s, %u left", name,
              (unsigned)c->spikes, (unsigned)c->gaps, c->longest_gap / rate_hz, (unsigned)filled(c),
              methods.used ? methods.text : "none", error, (unsigned)c->unfilled);
}

/* What is lost is worse than what was filled, and that than a spike. */
static int is_worse(const fap_clean_point *a, const fap_clean_point *b)
{
    if (a->unfilled != b->unfilled)
        return a->unfilled > b->unfilled;
    if (filled(a) != filled(b))
        return filled(a) > filled(b);
    return a->spikes > b->spikes;
}

/* Keeps @p worst sorted, the worst first. */
static void rank(uint32_t worst[REPORT_MOST], uint32_t *count, const fap_clean_point *points, uint32_t point)
{
    uint32_t at = *count < REPORT_MOST ? (*count)++ : REPORT_MOST;

    while (at && is_worse(&points[point], &points[worst[at - 1]])) {
        if (at < REPORT_MOST)
            worst[at] = worst[at - 1];
        at--;
    }
    if (at < REPORT_MOST)
        worst[at] = point;
}

static void say_points(const run_report *rep, const fap_capture_report *r)
{
    const fap_clean_point *points = fap_capture_clean_points(rep->capture);
    uint32_t worst[REPORT_MOST], count = 0, touched = 0;

    for (uint32_t i = 0; i < r->take_points; i++)
        if (is_touched(&points[i])) {
            rank(worst, &count, points, i);
            touched++;
        }
    for (uint32_t i = 0; i < count; i++)
        say_point(rep->take->name[worst[i]], &points[worst[i]], r->take_rate_hz);
    if (touched > count)
        tool_note("  and %u more markers, touched less: --json has all, --plot shows what they give",
                  (unsigned)(touched - count));
}

void report_cleaning_say(const run_report *rep, const fap_capture_report *r)
{
    const fap_clean_point *points = fap_capture_clean_points(rep->capture);
    const fap_clean_report *c = &r->clean;
    uint32_t gaps_by[FAP_SAMPLE_KINDS] = { 0 };
    report_line methods = { "", 0 };

    for (uint32_t i = 0; i < r->take_points; i++)
        for (int kind = 0; kind < FAP_SAMPLE_KINDS; kind++)
            gaps_by[kind] += points[i].gaps_by[kind];
    add_methods(&methods, gaps_by);
    tool_note("cleaned: %u spikes out, %u gaps closed (%u samples%s%s), %u gaps left, of feature points %u "
              "by the bank, %u eased",
              (unsigned)c->spikes, (unsigned)c->gaps_closed, (unsigned)c->samples_filled,
              methods.used ? ": " : "", methods.text, (unsigned)c->gaps_left, (unsigned)r->gaps_by_bank,
              (unsigned)r->gaps_eased);
    say_points(rep, r);
}

/* --- in JSON --- */

static void json_cleaned_point(json *j, const char *name, const fap_clean_point *c)
{
    json_open(j, name, '{');
    json_integer(j, "spikes", c->spikes);
    json_integer(j, "gaps", c->gaps);
    json_integer(j, "longest_gap", c->longest_gap);
    json_open(j, "gaps_by", '{');
    for (int kind = 0; kind < FAP_SAMPLE_KINDS; kind++)
        if (c->gaps_by[kind])
            json_integer(j, fap_sample_name((fap_sample)kind), c->gaps_by[kind]);
    json_close(j, '}');
    json_integer(j, "filled", filled(c));
    json_integer(j, "unfilled", c->unfilled);
    json_number(j, "error_mm", (double)c->error_mm);
    json_close(j, '}');
}

void report_cleaning_json(json *j, const run_report *rep, const fap_capture_report *r)
{
    const fap_clean_point *points = fap_capture_clean_points(rep->capture);

    json_open(j, "cleaning", '{');
    json_integer(j, "spikes", r->clean.spikes);
    json_integer(j, "gaps_closed", r->clean.gaps_closed);
    json_integer(j, "samples_filled", r->clean.samples_filled);
    json_integer(j, "gaps_left", r->clean.gaps_left);
    json_integer(j, "gaps_by_bank", r->gaps_by_bank);
    json_integer(j, "gaps_eased", r->gaps_eased);
    json_open(j, "markers", '{');
    for (uint32_t i = 0; i < r->take_points; i++)
        if (is_touched(&points[i]))
            json_cleaned_point(j, rep->take->name[i], &points[i]);
    json_close(j, '}');
    json_close(j, '}');
}
