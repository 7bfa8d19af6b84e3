/* SPDX-License-Identifier: BSD-2-Clause */
/* See report_coefficients.h. */
#include <stdio.h>
#include <string.h>

#include <fap/tables.h>

#include "common/json.h"
#include "common/tool.h"
#include "encoder/report_coefficients.h"
#include "encoder/report_named.h"
#include "encoder/report_written.h"

/* --- in words --- */

/* Text in the making; a list that is too long ends with dots. */
typedef struct line {
    char text[1024];
    size_t used;
    unsigned count;
} line;

static void add(line *l, const char *name)
{
    const int n = snprintf(l->text + l->used, sizeof l->text - l->used, "%s%s", l->used ? ", " : "", name);

    l->count++;
    if (n > 0 && l->used + (size_t)n + 8 < sizeof l->text)
        l->used += (size_t)n;
    else
        snprintf(l->text + l->used, sizeof l->text - l->used, " ...");
}

static void say_channels(const fap_coefficients_report *r)
{
    line still = { .used = 0 }, wide = { .used = 0 };
    unsigned present = 0;

    for (int c = 0; c < FAP_CHANNEL_COUNT; c++) {
        const fap_channel_report *ch = &r->channel[c];
        const int is_angle = c >= FAP_CHANNEL_ANGLE && c < FAP_CHANNEL_ANGLE + FAP_ARKIT_ANGLE_COUNT;
        if (!ch->present)
            continue;
        present++;
        if (!ch->moved)
            add(&still, fap_channel_name(c));
        if (!is_angle && (ch->min < -0.01f || ch->max > 1.01f))
            add(&wide, fap_channel_name(c));
    }
    tool_note("  %u columns, %u of them never leave 0%s%s", present, still.count, still.count ? ": " : "",
              still.text);
    if (wide.count)
        tool_note("  beyond 0 and 1, cut off at the end (%u samples): %s", (unsigned)r->clamped, wide.text);
}

static void say_cleaning(const fap_coefficients_report *r)
{
    if (r->frames_missing)
        tool_note("  %u frames missing, %u of them filled", (unsigned)r->frames_missing,
                  (unsigned)r->frames_filled);
    if (r->spikes)
        tool_note("  %u spikes of one frame taken out", (unsigned)r->spikes);
    if (r->neutral_s >= 0)
        tool_note("  at rest at %.2f s: taken off", r->neutral_s);
}

static void say_faps(const fap_coefficients_report *r)
{
    unsigned count = 0, beyond = 0;

    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        count += r->fap[fap].coded > 0;
        beyond += r->fap[fap].beyond > 0;
    }
    tool_note("  %u FAPs%s", count, r->fap[48].coded ? ", the head among them" : ", without the head");
    if (beyond)
        tool_note("  %u of them go beyond the range that Table C-1 gives", beyond);
}

/* Said, not refused: a batch has points and coefficients under one command line. */
static void say_unused(const options *opt)
{
    if (opt->markers_path || opt->fapu_path || opt->capture.axes || opt->capture.rigid ||
        opt->mm_per_unit > 0)
        tool_note(
            "note: --markers, --fapu, --axes, --rigid and --unit are for points; these are coefficients");
}

void report_coefficients_say(const options *opt, const run_report *rep)
{
    const fap_coefficients_report *r = fap_performance_report(rep->performance);

    tool_note("%s: %s, %u frames at %g Hz, %.2f s", opt->input, r->format, (unsigned)r->take_frames,
              r->take_rate_hz, r->take_length_s);
    if (rep->rate_assumed)
        tool_note("note: the take says no rate; %g frames a second (--fps) is assumed", r->take_rate_hz);
    for (uint32_t i = 0; i < rep->coefficients->note_count; i++)
        tool_note("note: %s", rep->coefficients->note[i]);
    for (uint32_t i = 0; i < r->note_count; i++)
        tool_note("note: %s", r->note[i]);
    say_unused(opt);
    say_channels(r);
    say_cleaning(r);
    tool_note("%s: %u frames at %g Hz", opt->output, (unsigned)r->frames, r->rate_hz);
    say_faps(r);
}

void report_livelink_say(const options *opt, const run_report *rep)
{
    tool_note("%s: %lld frames at %g Hz of ARKit's coefficients, as %s shows them", opt->output,
              (long long)rep->livelink.frames, rep->livelink.rate_hz, rep->livelink.face);
}

/* --- as JSON --- */

static void json_take(json *j, const options *opt, const run_report *rep, const fap_coefficients_report *r)
{
    json_open(j, "take", '{');
    json_string(j, "path", opt->input);
    json_string(j, "format", r->format);
    json_integer(j, "frames", r->take_frames);
    json_number(j, "rate_hz", r->take_rate_hz);
    json_bool(j, "rate_assumed", rep->rate_assumed);
    json_number(j, "length_s", r->take_length_s);
    json_close(j, '}');
}

static void json_channels(json *j, const fap_coefficients_report *r)
{
    json_open(j, "coefficients", '[');
    for (int c = 0; c < FAP_CHANNEL_COUNT; c++) {
        const fap_channel_report *ch = &r->channel[c];
        if (!ch->present)
            continue;
        json_open(j, NULL, '{');
        json_string(j, "name", fap_channel_name(c));
        json_float(j, "min", ch->min);
        json_float(j, "max", ch->max);
        json_bool(j, "moved", ch->moved);
        if (r->neutral_s >= 0)
            json_float(j, "rest", ch->rest);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_cleaning(json *j, const fap_coefficients_report *r)
{
    json_open(j, "cleaning", '{');
    json_integer(j, "frames_missing", r->frames_missing);
    json_integer(j, "frames_filled", r->frames_filled);
    json_integer(j, "spikes", r->spikes);
    json_integer(j, "clamped", r->clamped);
    json_close(j, '}');
    if (r->neutral_s >= 0)
        json_number(j, "neutral_s", r->neutral_s);
}

static void json_faps(json *j, const fap_coefficients_report *r)
{
    json_open(j, "faps", '[');
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const fap_capture_fap *f = &r->fap[fap];
        if (!f->coded)
            continue;
        json_open(j, NULL, '{');
        json_integer(j, "fap", fap);
        json_string(j, "name", fap_info_get(fap)->name);
        json_integer(j, "frames", f->coded);
        json_integer(j, "min", f->min);
        json_integer(j, "max", f->max);
        json_integer(j, "beyond_range", f->beyond);
        json_close(j, '}');
    }
    json_close(j, ']');
    json_open(j, "unseen", '[');
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (!r->fap[fap].coded)
            json_integer(j, NULL, fap);
    json_close(j, ']');
}

static void json_notes(json *j, const run_report *rep, const fap_coefficients_report *r)
{
    json_open(j, "notes", '[');
    for (uint32_t i = 0; i < rep->coefficients->note_count; i++)
        json_string(j, NULL, rep->coefficients->note[i]);
    for (uint32_t i = 0; i < r->note_count; i++)
        json_string(j, NULL, r->note[i]);
    json_close(j, ']');
}

void report_coefficients_json(const options *opt, const run_report *rep)
{
    const fap_coefficients_report *r = fap_performance_report(rep->performance);
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_take(&j, opt, rep, r);
    json_string(&j, "output", opt->output);
    json_integer(&j, "frames", r->frames);
    json_number(&j, "rate_hz", r->rate_hz);
    report_named_json(&j, opt, rep);
    report_written_json(&j, opt, &rep->written);
    json_channels(&j, r);
    json_cleaning(&j, r);
    json_faps(&j, r);
    json_notes(&j, rep, r);
    json_close(&j, '}');
    putchar('\n');
}
