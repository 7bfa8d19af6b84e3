/* SPDX-License-Identifier: BSD-2-Clause */
/* What is inside a FAP stream, as JSON. Names are stable; docs/man/fapenc.1 lists them. */
#include <stdio.h>

#include <fap/tables.h>

#include "common/json.h"
#include "encoder/report_inspect.h"
#include "encoder/report_written.h"

static void put_facts(json *j, const options *opt, const stream_summary *s)
{
    json_string(j, "path", opt->input);
    json_string(j, "format", s->format);
    json_string(j, "version", s->header.version);
    json_string(j, "name", s->header.name);
    json_number(j, "rate_hz", s->header.rate_hz);
    json_integer(j, "frames", (int64_t)s->frames);
    json_number(j, "length_s", stream_length_s(s));
    json_integer(j, "coded_faps", stream_coded_faps(s));
    json_integer(j, "bytes", (int64_t)s->size);
    json_number(j, "kbit_s", stream_kbit_s(s));
}

static void put_bits_facts(json *j, const stream_summary *s, const inspection *in)
{
    json_integer(j, "largest_2s_bits", (int64_t)in->largest_window_bits);
    json_number(j, "largest_2s_kbit_s", (double)in->largest_window_bits / 2000);
    json_integer(j, "intra_frames", (int64_t)s->intra_frames);
    json_integer(j, "skipped_frames", (int64_t)s->skipped);
    json_integer(j, "predicted_frames", (int64_t)s->concealed);
    json_integer(j, "broken_planes", (int64_t)s->broken_planes);
    json_integer(j, "rate_changes", (int64_t)s->rate_changes);
    json_integer(j, "planes_with_body", (int64_t)in->with_body);
    json_string(j, "gender", in->male && in->female ? "both" : in->male ? "male" : "female");
}

static void put_kind(json *j, const char *key, const plane_kind *k)
{
    json_open(j, key, '{');
    json_integer(j, "planes", (int64_t)k->planes);
    json_integer(j, "start_codes", (int64_t)k->start_codes);
    json_integer(j, "bits", (int64_t)k->bits);
    json_number(j, "mean_bits", k->planes ? (double)k->bits / (double)k->planes : 0);
    json_integer(j, "max_bits", (int64_t)k->largest);
    json_integer(j, "header_bits", (int64_t)k->header);
    json_integer(j, "setup_bits", (int64_t)k->setup);
    json_integer(j, "range_bits", (int64_t)k->ranges);
    json_integer(j, "fap_bits", (int64_t)k->faps);
    json_integer(j, "run_bits", (int64_t)k->runs);
    json_integer(j, "body_bits", (int64_t)k->body);
    json_close(j, '}');
}

static void put_kinds(json *j, const inspection *in)
{
    json_open(j, "planes", '{');
    put_kind(j, "i", &in->kind[1]);
    put_kind(j, "p", &in->kind[0]);
    json_close(j, '}');
}

static void put_quantisers(json *j, const inspection *in)
{
    json_open(j, "quantisers", '[');
    for (int q = 0; q < INSPECT_QUANTS; q++) {
        if (!in->quant_all[q])
            continue;
        json_open(j, NULL, '{');
        json_integer(j, "quant", q);
        json_integer(j, "i_planes", (int64_t)in->quant_i[q]);
        json_integer(j, "planes", (int64_t)in->quant_all[q]);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_masks(json *j, const group_masks *g)
{
    json_open(j, "masks", '[');
    for (int i = 0; i < g->kept; i++) {
        json_open(j, NULL, '{');
        json_integer(j, "plane", g->change[i].plane);
        json_integer(j, "frame", g->change[i].frame);
        json_integer(j, "type", g->change[i].type);
        json_integer(j, "faps", g->change[i].coded);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_groups(json *j, const inspection *in)
{
    json_open(j, "groups", '[');
    for (int group = 1; group <= FAP_GROUPS; group++) {
        const group_masks *g = &in->group[group];
        json_open(j, NULL, '{');
        json_integer(j, "group", group);
        json_string(j, "name", group_name(group));
        json_integer(j, "first_fap", fap_group_first(group));
        json_integer(j, "fap_count", fap_group_count(group));
        json_open(j, "i_planes_of_type", '[');
        for (int type = 0; type < INSPECT_MASK_TYPES; type++)
            json_integer(j, NULL, (int64_t)g->of_type[type]);
        json_close(j, ']');
        json_integer(j, "changes", (int64_t)g->changes);
        put_masks(j, g);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_ranges(json *j, const fap_ranges *r)
{
    json_open(j, "levels", '{');
    json_integer(j, "i_min", r->i_min);
    json_integer(j, "i_max", r->i_max);
    json_integer(j, "p_min", r->p_min);
    json_integer(j, "p_max", r->p_max);
    json_bool(j, "vary", r->vary);
    json_close(j, '}');
}

static void put_fap_bits(json *j, const stream_summary *s, const inspection *in, int fap)
{
    const uint64_t bits = s->fap[fap].bits;

    json_integer(j, "derived_frames", (int64_t)in->derived[fap]);
    json_integer(j, "bits", (int64_t)bits);
    json_integer(j, "i_bits", (int64_t)in->fap_bits[1][fap]);
    json_integer(j, "p_bits", (int64_t)in->fap_bits[0][fap]);
    json_number(j, "bits_per_frame", (double)bits / (double)s->frames);
    json_number(j, "share", (double)bits / (double)(s->size * 8));
    if (in->ranges[fap].known)
        put_ranges(j, &in->ranges[fap]);
}

static void put_fap(json *j, const stream_summary *s, const inspection *in, int fap)
{
    const stream_fap *f = &s->fap[fap];

    json_open(j, NULL, '{');
    json_integer(j, "fap", fap);
    json_string(j, "name", fap_info_get(fap)->name);
    json_integer(j, "frames", (int64_t)f->coded);
    if (f->coded) {
        json_integer(j, "min", f->min);
        json_integer(j, "max", f->max);
        json_number(j, "mean", f->sum / (double)f->coded);
    }
    if (in)
        put_fap_bits(j, s, in, fap);
    json_close(j, '}');
}

static void put_faps(json *j, const stream_summary *s, const inspection *in)
{
    json_open(j, "faps", '[');
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (s->fap[fap].coded || (in && in->derived[fap]))
            put_fap(j, s, in, fap);
    json_close(j, ']');
}

static void put_notices(json *j, const stream_summary *s, const inspection *in)
{
    json_open(j, "notices", '[');
    for (int i = 0; i < s->notice_count; i++) {
        json_open(j, NULL, '{');
        json_integer(j, in ? "bit" : "line", s->notice[i].where);
        json_string(j, "text", s->notice[i].text);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_broken(json *j, const inspection *in)
{
    json_open(j, "broken", '[');
    for (int i = 0; i < in->broken_kept; i++)
        json_string(j, NULL, in->broken[i].why);
    json_close(j, ']');
}

static void put_plane(json *j, const plane_record *p)
{
    json_open(j, NULL, '{');
    json_integer(j, "frame", p->frame);
    json_number(j, "time_s", (double)p->pts_us * 1e-6);
    json_string(j, "type", p->info.intra ? "I" : "P");
    json_integer(j, "bit", p->info.bit_position);
    json_integer(j, "bits", p->info.bit_count);
    json_bool(j, "start_code", p->info.start_code);
    json_integer(j, "quant", p->info.quant);
    json_integer(j, "skipped", p->info.skipped);
    json_integer(j, "faps", p->coded);
    json_integer(j, "header_bits", p->info.header_bits);
    json_integer(j, "setup_bits", p->info.setup_bits);
    json_integer(j, "range_bits", p->info.range_bits);
    json_integer(j, "fap_bits", p->fap_bits);
    json_integer(j, "run_bits", p->info.run_bits);
    json_integer(j, "body_bits", p->info.body_bits);
    json_close(j, '}');
}

static void put_planes(json *j, const inspection *in)
{
    json_open(j, "plane_list", '[');
    for (size_t i = 0; i < in->plane_count; i++)
        put_plane(j, &in->plane[i]);
    json_close(j, ']');
}

void inspect_json(const options *opt, const run_report *rep)
{
    const stream_summary *s = &rep->stream;
    const inspection *in = rep->inspection;
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    put_facts(&j, opt, s);
    if (in) {
        put_bits_facts(&j, s, in);
        if (rep->fit)
            json_string(&j, "fit", opt->fit_path ? opt->fit_path : rep->fit_found);
        put_kinds(&j, in);
        put_quantisers(&j, in);
        put_groups(&j, in);
    }
    put_faps(&j, s, in);
    put_notices(&j, s, in);
    if (in)
        put_broken(&j, in);
    if (in && in->keep_planes)
        put_planes(&j, in);
    report_written_json(&j, opt, &rep->written);
    json_close(&j, '}');
}
