/* SPDX-License-Identifier: BSD-2-Clause */
/* See report_capture.h. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "common/json.h"
#include "common/tool.h"
#include "encoder/report_capture.h"
#include "encoder/report_cleaning.h"
#include "encoder/report_line.h"
#include "encoder/report_named.h"
#include "encoder/report_written.h"

static const char *const fapu_names[5] = { "IRISD", "ES", "ENS", "MNS", "MW" };

static float fapu_mm(const fap_fapu *f, int i)
{
    const float mm[5] = { f->irisd_mm, f->es_mm, f->ens_mm, f->mns_mm, f->mw_mm };
    return mm[i];
}

static const char *point_name(int point)
{
    const fap_point_info *info = fap_point_get(point);
    return info ? info->name : "head";
}

/* --- a capture, in words --- */

static void say_markers(const run_report *rep, const fap_capture_report *r)
{
    report_line unknown = { "", 0 };
    unsigned count = 0;

    for (uint32_t i = 0; i < r->take_points && i < FAP_TAKE_MAX_POINTS; i++)
        if (!r->markers.role[i] && count++ < REPORT_MOST)
            report_line_add(&unknown, ", ", rep->take->name[i]);
    tool_note("markers: %u of %u known%s%s", (unsigned)r->markers.used, (unsigned)r->take_points,
              *r->markers.set ? ", set " : "", r->markers.set);
    if (count > REPORT_MOST)
        tool_note("  not used: %s and %u more", unknown.text, count - REPORT_MOST);
    else if (count)
        tool_note("  not used: %s", unknown.text);
}

static void say_head(const options *opt, const run_report *rep, const fap_capture_report *r)
{
    report_line rigid = { "", 0 };

    for (uint32_t i = 0; i < r->rigid_count; i++)
        report_line_add(&rigid, ", ", rep->take->name[r->rigid[i]]);
    if (r->rigid_count)
        tool_note("head: rigid markers %s (%s), %.2f mm rms", rigid.text, fap_origin_name(r->rigid_origin),
                  r->rigid_rms_mm);
    if (opt->capture.head == FAP_HEAD_NOSE)
        tool_note("  carried by the nose's tip, which is hidden in %u frames",
                  (unsigned)r->frames_without_nose);
    if (r->frames_without_head)
        tool_note("  not seen in %u frames", (unsigned)r->frames_without_head);
    tool_note("axes: %s of the take%s, turned by %.1f degrees", r->axes, r->axes_found ? ", found" : "",
              r->axes_turn_deg);
    tool_note("neutral: %.2f s, mean of %.2f s%s", r->neutral_s, r->neutral_length_s,
              r->neutral_found ? ", found" : ", given");
}

static void say_fapu(const fap_capture_report *r)
{
    report_line l = { "", 0 };
    char text[64];

    for (int i = 0; i < 5; i++) {
        snprintf(text, sizeof text, "%s %.1f (%s)", fapu_names[i], (double)fapu_mm(&r->fapu, i),
                 fap_origin_name(r->fapu_origin[i]));
        report_line_add(&l, ", ", text);
    }
    tool_note("FAPU, mm: %s", l.text);
}

/* "Mouth_Up", "Mouth_Up 0.7, Mouth_UpL1 0.3": what a FAP was taken from. */
static void add_markers(report_line *l, const run_report *rep, const fap_capture_origin *o)
{
    char text[FAP_TAKE_NAME_SIZE + 16];

    for (int i = 0; i < o->marker_count; i++) {
        snprintf(text, sizeof text, o->how == FAP_HOW_RBF ? "%s %.2f" : "%s", rep->take->name[o->marker[i]],
                 (double)o->share[i]);
        report_line_add(l, ", ", text);
    }
}

static void say_fap(const run_report *rep, int fap, const fap_capture_fap *f)
{
    report_line markers = { "", 0 };
    char beyond[48] = "";

    add_markers(&markers, rep, &f->origin);
    if (f->beyond)
        snprintf(beyond, sizeof beyond, "; %u frames beyond the usual range", (unsigned)f->beyond);
    tool_note("  %2d %-24s %6d .. %-6d in %u frames, from %s%s%s%s%s%s%s", fap, fap_info_get(fap)->name,
              (int)f->min, (int)f->max, (unsigned)f->coded, f->near ? "near " : "", point_name(f->point),
              markers.used ? ", " : "", markers.used ? fap_how_name((fap_how)f->origin.how) : "",
              markers.used ? ": " : "", markers.text, beyond);
}

/* FAPs not sent for the same reason share a line. */
static void say_missing(const fap_capture_report *r, int first)
{
    const char *reason = r->fap[first].reason;
    report_line l = { "", 0 };
    char number[16];

    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        if (!r->fap[fap].reason || strcmp(r->fap[fap].reason, reason) != 0)
            continue;
        if (fap < first)
            return;
        snprintf(number, sizeof number, "%d", fap);
        report_line_add(&l, " ", number);
    }
    tool_note("  not sent: %s: %s", l.text, reason);
}

/* --visemes, --expressions: no marker measures them, yet they are sent. */
static int is_named(const run_report *rep, int fap)
{
    return rep->named && fap <= 2 && rep->named[0].state[fap] == FAP_CODED;
}

static void say_faps(const run_report *rep, const fap_capture_report *r)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (r->fap[fap].coded)
            say_fap(rep, fap, &r->fap[fap]);
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (r->fap[fap].reason && !is_named(rep, fap))
            say_missing(r, fap);
}

static void say_notes(const run_report *rep, const fap_capture_report *r)
{
    for (uint32_t i = 0; i < rep->take->note_count; i++)
        tool_note("note: %s", rep->take->note[i]);
    for (uint32_t i = 0; i < r->note_count; i++)
        tool_note("note: %s", r->note[i]);
    if (rep->rate_assumed)
        tool_note("note: the take says no rate; %g frames a second (--fps) is assumed", r->take_rate_hz);
}

void report_capture_say(const options *opt, const run_report *rep)
{
    const fap_capture_report *r = fap_capture_report_get(rep->capture);

    tool_note("%s: %s, %u points, %u frames at %g Hz, %.2f s", opt->input, r->format,
              (unsigned)r->take_points, (unsigned)r->take_frames, r->take_rate_hz, r->take_length_s);
    say_notes(rep, r);
    say_markers(rep, r);
    report_cleaning_say(rep, r);
    say_head(opt, rep, r);
    say_fapu(r);
    tool_note("%s: %u frames at %g Hz", opt->output, (unsigned)r->frames, r->rate_hz);
    say_faps(rep, r);
}

/* --- a capture, in JSON --- */

static void json_take(json *j, const options *opt, const run_report *rep, const fap_capture_report *r)
{
    json_open(j, "take", '{');
    json_string(j, "path", opt->input);
    json_string(j, "format", r->format);
    json_integer(j, "points", r->take_points);
    json_integer(j, "frames", r->take_frames);
    json_number(j, "rate_hz", r->take_rate_hz);
    json_bool(j, "rate_assumed", rep->rate_assumed);
    json_number(j, "mm_per_unit", rep->take->mm_per_unit);
    json_bool(j, "unit_known", rep->take->unit_known);
    json_close(j, '}');
}

static void json_markers(json *j, const run_report *rep, const fap_capture_report *r)
{
    json_open(j, "markers", '{');
    json_string(j, "set", r->markers.set);
    json_integer(j, "known", r->markers.used);
    json_integer(j, "fitted", r->fitted);
    if (r->fitted)
        json_number(j, "fit_mm", r->fit_mm);
    json_open(j, "points", '{');
    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_marker_source *s = &r->markers.point[i];
        if (!s->count)
            continue;
        json_open(j, point_name(i), '[');
        for (int k = 0; k < s->count; k++)
            json_string(j, NULL, rep->take->name[s->index[k]]);
        json_close(j, ']');
    }
    json_close(j, '}');
    json_open(j, "unknown", '[');
    for (uint32_t i = 0; i < r->take_points && i < FAP_TAKE_MAX_POINTS; i++)
        if (!r->markers.role[i])
            json_string(j, NULL, rep->take->name[i]);
    json_close(j, ']');
    json_close(j, '}');
}

static void json_head(json *j, const options *opt, const run_report *rep, const fap_capture_report *r)
{
    json_open(j, "head", '{');
    json_string(j, "origin", fap_origin_name(r->rigid_origin));
    json_open(j, "rigid", '[');
    for (uint32_t i = 0; i < r->rigid_count; i++)
        json_string(j, NULL, rep->take->name[r->rigid[i]]);
    json_close(j, ']');
    json_number(j, "rms_mm", r->rigid_rms_mm);
    json_string(j, "carried_by", opt->capture.head == FAP_HEAD_NOSE ? "nose" : "rigid");
    json_integer(j, "frames_not_seen", r->frames_without_head);
    json_string(j, "axes", r->axes);
    json_bool(j, "axes_found", r->axes_found);
    json_bool(j, "sides_swapped", r->sides_swapped);
    json_number(j, "turned_deg", r->axes_turn_deg);
    json_close(j, '}');
}

static void json_neutral(json *j, const fap_capture_report *r)
{
    json_open(j, "neutral", '{');
    json_number(j, "time_s", r->neutral_s);
    json_integer(j, "frame", (int64_t)(r->neutral_s * r->take_rate_hz + 0.5));
    json_number(j, "length_s", r->neutral_length_s);
    json_bool(j, "found", r->neutral_found);
    json_close(j, '}');
    json_open(j, "fapu", '{');
    for (int i = 0; i < 5; i++) {
        json_open(j, fapu_names[i], '{');
        json_number(j, "mm", (double)fapu_mm(&r->fapu, i));
        json_string(j, "origin", fap_origin_name(r->fapu_origin[i]));
        json_close(j, '}');
    }
    json_close(j, '}');
}

static void json_origin(json *j, const run_report *rep, const fap_capture_origin *o)
{
    json_string(j, "how", fap_how_name((fap_how)o->how));
    json_open(j, "markers", '[');
    for (int i = 0; i < o->marker_count; i++) {
        json_open(j, NULL, '{');
        json_string(j, "name", rep->take->name[o->marker[i]]);
        json_number(j, "share", (double)o->share[i]);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_fap(json *j, const run_report *rep, int fap, const fap_capture_fap *f)
{
    json_open(j, NULL, '{');
    json_integer(j, "fap", fap);
    json_string(j, "name", fap_info_get(fap)->name);
    json_integer(j, "frames", f->coded);
    json_integer(j, "min", f->min);
    json_integer(j, "max", f->max);
    json_integer(j, "beyond_range", f->beyond);
    json_string(j, "point", point_name(f->point));
    json_bool(j, "near", f->near);
    if (f->point >= 0)
        json_origin(j, rep, &f->origin);
    json_close(j, '}');
}

static void json_faps(json *j, const run_report *rep, const fap_capture_report *r)
{
    json_open(j, "faps", '[');
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (r->fap[fap].coded)
            json_fap(j, rep, fap, &r->fap[fap]);
    json_close(j, ']');
    json_open(j, "unseen", '[');
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (!r->fap[fap].coded && !is_named(rep, fap))
            json_integer(j, NULL, fap);
    json_close(j, ']');
    json_open(j, "not_sent", '[');
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        if (!r->fap[fap].reason || is_named(rep, fap))
            continue;
        json_open(j, NULL, '{');
        json_integer(j, "fap", fap);
        json_string(j, "reason", r->fap[fap].reason);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_notes(json *j, const run_report *rep, const fap_capture_report *r)
{
    json_open(j, "notes", '[');
    for (uint32_t i = 0; i < rep->take->note_count; i++)
        json_string(j, NULL, rep->take->note[i]);
    for (uint32_t i = 0; i < r->note_count; i++)
        json_string(j, NULL, r->note[i]);
    json_close(j, ']');
}

void report_capture_json(const options *opt, const run_report *rep)
{
    const fap_capture_report *r = fap_capture_report_get(rep->capture);
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_take(&j, opt, rep, r);
    json_string(&j, "output", opt->output);
    json_integer(&j, "frames", r->frames);
    json_number(&j, "rate_hz", r->rate_hz);
    report_named_json(&j, opt, rep);
    report_written_json(&j, opt, &rep->written);
    json_markers(&j, rep, r);
    report_cleaning_json(&j, rep, r);
    json_head(&j, opt, rep, r);
    json_neutral(&j, r);
    json_faps(&j, rep, r);
    json_notes(&j, rep, r);
    json_close(&j, '}');
    putchar('\n');
}
