/* SPDX-License-Identifier: BSD-2-Clause */
/* See fit_report.h. */
#include <stdio.h>

#include "common/json.h"
#include "common/tool.h"
#include "databank/fit/fit_report.h"

void fit_report_say(const fit_work *w)
{
    const fap_registration_report *r = fap_registration_report_get(w->registration);
    const fap_surface *s = w->scan;

    tool_note("%s: %s, %u vertices, %u triangles", w->opt->scan, s->format, (unsigned)s->vertex_count,
              (unsigned)s->triangle_count);
    for (uint32_t i = 0; i < s->note_count; i++)
        tool_note("note: %s", s->note[i]);
    tool_note("  %s; turned by %.0f degrees; the head has %.3f of the generic one's size",
              r->unit_known ? "unit known or found"
                            : "no metric unit makes this a head: it has the generic one's size",
              r->turned_deg, r->scale);
    tool_note("  one unit is %.4g mm", r->mm_per_unit);
    tool_note("landmarks: %u on the skin, %u of them followed, %u contradict the others and are left out; "
              "%.2f mm rms",
              (unsigned)r->pins, (unsigned)w->followed, (unsigned)r->pins_out, r->pin_rms_mm);
    for (uint32_t i = 0; i < r->note_count; i++)
        tool_note("note: %s", r->note[i]);
    tool_note("%s: %s on %s, %.2f s", w->opt->output, fap_registration_name(w->opt->fit.method),
              fap_bank_name(w->bank), w->seconds);
    tool_note("  surface: %.3f mm rms, %.2f mm at most; %u of %u vertices of the skin lie on the scan",
              r->surface_rms_mm, r->surface_max_mm, (unsigned)r->seen, (unsigned)r->skin);
    tool_note("  folded edges: %u", (unsigned)r->folded);
    tool_note("  motions times %.3f (eyes %.3f, mouth %.3f, nose %.3f, lips %.3f)", w->scale.scale,
              w->scale.eyes, w->scale.mouth, w->scale.nose, w->scale.lips);
}

void fit_report_json(const fit_work *w)
{
    const fap_registration_report *r = fap_registration_report_get(w->registration);
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_string(&j, "scan", w->opt->scan);
    json_string(&j, "format", w->scan->format);
    json_integer(&j, "vertices", w->scan->vertex_count);
    json_integer(&j, "triangles", w->scan->triangle_count);
    json_string(&j, "generic", fap_bank_name(w->bank));
    json_string(&j, "method", fap_registration_name(w->opt->fit.method));
    json_number(&j, "seconds", w->seconds);
    json_number(&j, "mm_per_unit", r->mm_per_unit);
    json_bool(&j, "unit_known", r->unit_known);
    json_number(&j, "turned_deg", r->turned_deg);
    json_number(&j, "size", r->scale);
    json_integer(&j, "landmarks", r->pins);
    json_integer(&j, "landmarks_followed", w->followed);
    json_integer(&j, "landmarks_left_out", r->pins_out);
    json_number(&j, "landmark_rms_mm", r->pin_rms_mm);
    json_number(&j, "surface_rms_mm", r->surface_rms_mm);
    json_number(&j, "surface_max_mm", r->surface_max_mm);
    json_integer(&j, "skin_vertices", r->skin);
    json_integer(&j, "seen_vertices", r->seen);
    json_integer(&j, "folded_edges", r->folded);
    json_number(&j, "motion_scale", w->scale.scale);
    json_open(&j, "notes", '[');
    for (uint32_t i = 0; i < w->scan->note_count; i++)
        json_string(&j, NULL, w->scan->note[i]);
    for (uint32_t i = 0; i < r->note_count; i++)
        json_string(&j, NULL, r->note[i]);
    json_close(&j, ']');
    json_close(&j, '}');
    fputc('\n', stdout);
}
