/* SPDX-License-Identifier: BSD-2-Clause */
/* What is inside a FAP stream, for people: what it is, where its bits go, what each FAP does. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include <fap/tables.h>

#include "encoder/report_inspect.h"

int stream_coded_faps(const stream_summary *s)
{
    int n = 0;

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        n += s->fap[fap].coded > 0;
    return n;
}

double stream_length_s(const stream_summary *s)
{
    return (double)s->end_us * 1e-6;
}

double stream_kbit_s(const stream_summary *s)
{
    return s->end_us ? (double)s->size * 8 / 1000 / stream_length_s(s) : 0;
}

const char *group_name(int group)
{
    static const char *const names[FAP_GROUPS + 1] = {
        "",
        "viseme, expression",
        "jaw, inner lips",
        "eyes",
        "brows",
        "cheeks",
        "tongue",
        "head",
        "outer lips",
        "nose",
        "ears",
    };

    return group >= 1 && group <= FAP_GROUPS ? names[group] : "";
}

/* --- the stream --- */

static const char *plural(uint64_t n)
{
    return n == 1 ? "" : "s";
}

static void say_facts(const options *opt, const stream_summary *s)
{
    printf("%s: %s%s%s%s%s\n", opt->input, strcmp(s->format, "fba") ? "FAP file" : "FBA stream",
           *s->header.version ? ", version " : "", s->header.version, *s->header.name ? ", name " : "",
           s->header.name);
    printf("%" PRIu64 " frames at %g Hz, %.2f s, %d FAPs, %" PRIu64 " bytes, %.2f kbit/s", s->frames,
           s->header.rate_hz, stream_length_s(s), stream_coded_faps(s), s->size, stream_kbit_s(s));
}

static void say_bits_facts(const stream_summary *s, const inspection *in)
{
    printf(" (%.2f in the fullest 2 s)\n", (double)in->largest_window_bits / 2000);
    printf("%" PRIu64 " I plane%s, %" PRIu64 " P plane%s, %" PRIu64 " frame%s skipped; gender: %s",
           in->kind[1].planes, plural(in->kind[1].planes), in->kind[0].planes, plural(in->kind[0].planes),
           s->skipped, plural(s->skipped),
           in->male && in->female ? "both"
           : in->male             ? "male"
                                  : "female");
    if (in->with_body)
        printf("; %" PRIu64 " planes with body data", in->with_body);
    if (s->rate_changes)
        printf("; the rate changes %" PRIu64 " time%s", s->rate_changes, plural(s->rate_changes));
    putchar('\n');
}

/* --- planes --- */

static void say_kind(const char *name, const plane_kind *k)
{
    printf("%-6s %6" PRIu64 " %6" PRIu64 " %9" PRIu64 " %7.1f %7" PRIu64 " %8" PRIu64 " %7" PRIu64
           " %7" PRIu64 " %9" PRIu64 " %8" PRIu64 " %7" PRIu64 "\n",
           name, k->planes, k->start_codes, k->bits, k->planes ? (double)k->bits / (double)k->planes : 0.0,
           k->largest, k->header, k->setup, k->ranges, k->faps, k->runs, k->body);
}

static double percent(uint64_t part, uint64_t whole)
{
    return whole ? 100.0 * (double)part / (double)whole : 0;
}

static void say_shares(const plane_kind *i, const plane_kind *p)
{
    const uint64_t all = i->bits + p->bits;

    printf("%-6s %6s %6s %9s %7s %7s %7.1f%% %6.1f%% %6.1f%% %8.1f%% %7.1f%% %6.1f%%\n", "share", "", "", "",
           "", "", percent(i->header + p->header, all), percent(i->setup + p->setup, all),
           percent(i->ranges + p->ranges, all), percent(i->faps + p->faps, all),
           percent(i->runs + p->runs, all), percent(i->body + p->body, all));
}

static void say_kinds(const inspection *in)
{
    printf("\n%-6s %6s %6s %9s %7s %7s %8s %7s %7s %9s %8s %7s\n", "planes", "count", "codes", "bits", "mean",
           "largest", "header", "setup", "ranges", "FAPs", "run ends", "body");
    say_kind("I", &in->kind[1]);
    say_kind("P", &in->kind[0]);
    say_shares(&in->kind[1], &in->kind[0]);
}

static void say_quantisers(const inspection *in)
{
    printf("\nfap_quant ");
    for (int q = 0; q < INSPECT_QUANTS; q++)
        if (in->quant_all[q])
            printf(" %d (%" PRIu64 " I, %" PRIu64 " P)", q, in->quant_i[q],
                   in->quant_all[q] - in->quant_i[q]);
    putchar('\n');
}

/* --- masks --- */

static void say_mask(const mask_change *m, int count)
{
    static const char *const rest[INSPECT_MASK_TYPES] = { "", ", rest held", ", rest derived", "" };

    if (m->coded == 0 && m->type == 0)
        printf("none");
    else if (m->coded == count)
        printf("all %d", count);
    else
        printf("%d of %d%s", m->coded, count, rest[m->type]);
}

/* The first mask and the next, and how often it changes. */
static void say_group(const inspection *in, int group)
{
    const group_masks *g = &in->group[group];
    const int first = fap_group_first(group), count = fap_group_count(group);

    printf("%5d %-19s %2d-%-3d ", group, group_name(group), first, first + count - 1);
    if (g->kept)
        say_mask(&g->change[0], count);
    if (g->kept > 1) {
        printf("; frame %" PRId64 ": ", g->change[1].frame);
        say_mask(&g->change[1], count);
    }
    if (g->changes > 1)
        printf("; %" PRIu64 " changes", g->changes);
    putchar('\n');
}

static void say_groups(const inspection *in)
{
    printf("\ngroup %-19s FAPs   sent\n", "");
    for (int group = 1; group <= FAP_GROUPS; group++)
        say_group(in, group);
}

/* --- FAPs --- */

enum { BAR = 6 };

/* A bar of the largest FAP's length is full. */
static void make_bar(char *bar, uint64_t bits, uint64_t most)
{
    const uint64_t filled = most ? (bits * BAR + most / 2) / most : 0;

    memset(bar, ' ', BAR);
    memset(bar, '#', (size_t)filled);
    bar[BAR] = '\0';
}

/* "-60..60"; with ~ in front where it is not the same in all I planes. */
static void make_span(char *text, size_t room, int vary, int low, int high)
{
    snprintf(text, room, "%s%d..%d", vary ? "~" : "", low, high);
}

static void say_levels(const fap_ranges *r)
{
    char span[32];

    if (!r->known)
        return;
    make_span(span, sizeof span, r->vary, r->i_min, r->i_max);
    printf(" %12s", span);
    make_span(span, sizeof span, r->vary, r->p_min, r->p_max);
    printf(" %11s", span);
}

static void say_values(const stream_fap *f, int fap)
{
    char span[32] = "";

    if (fap > 2 && f->coded)
        make_span(span, sizeof span, 0, f->min, f->max);
    printf("%3d %-21s %13s %7" PRIu64, fap, fap_info_get(fap)->name, span, f->coded);
}

static void say_fap_bits(const stream_summary *s, const inspection *in, int fap, uint64_t most)
{
    const stream_fap *f = &s->fap[fap];
    char bar[BAR + 1];

    if (!f->coded) {
        printf(" derived by the decoder in %" PRIu64 " frames", in->derived[fap]);
        return;
    }
    make_bar(bar, f->bits, most);
    printf(" %7" PRIu64 " %6.2f %s %4.1f%%", f->bits, (double)f->bits / (double)s->frames, bar,
           percent(f->bits, s->size * 8));
    say_levels(&in->ranges[fap]);
}

static void say_faps_with_bits(const stream_summary *s, const inspection *in)
{
    uint64_t most = 0;

    if (!stream_coded_faps(s))
        return;
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        most = s->fap[fap].bits > most ? s->fap[fap].bits : most;
    printf("\nFAP %-21s %13s %7s %7s %6s %-12s %12s %11s\n", "", "values", "frames", "bits", "/frame",
           "share", "I levels", "P levels");
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        if (!s->fap[fap].coded && !in->derived[fap])
            continue;
        say_values(&s->fap[fap], fap);
        say_fap_bits(s, in, fap, most);
        putchar('\n');
    }
}

static void say_faps(const stream_summary *s)
{
    if (!stream_coded_faps(s))
        return;
    printf("\nFAP %-21s %13s %7s %9s\n", "", "values", "frames", "mean");
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        const stream_fap *f = &s->fap[fap];
        if (!f->coded)
            continue;
        say_values(f, fap);
        if (fap > 2)
            printf(" %9.1f", f->sum / (double)f->coded);
        putchar('\n');
    }
}

/* --- what is wrong with it --- */

static void say_notices(const stream_summary *s, const char *place)
{
    if (s->notice_count)
        printf("\ndeviations, each told once\n");
    for (int i = 0; i < s->notice_count; i++)
        printf("  %s %" PRId64 ": %s\n", place, s->notice[i].where, s->notice[i].text);
}

static void say_broken(const stream_summary *s, const inspection *in)
{
    if (!s->broken_planes)
        return;
    printf("\n%" PRIu64 " plane%s broken and passed over; %" PRIu64 " frame%s had to be predicted\n",
           s->broken_planes, s->broken_planes == 1 ? " is" : "s are", s->concealed, plural(s->concealed));
    for (int i = 0; i < in->broken_kept; i++)
        printf("  %s\n", in->broken[i].why);
    if (s->broken_planes > (uint64_t)in->broken_kept)
        printf("  ...\n");
}

/* --- --planes --- */

static void say_planes(const inspection *in)
{
    printf("\n%7s %8s %9s  type   quant %5s %5s %7s %6s %6s %6s %6s %5s %5s\n", "frame", "time, s", "bit",
           "skip", "FAPs", "bits", "header", "setup", "ranges", "FAPs", "runs", "body");
    for (size_t i = 0; i < in->plane_count; i++) {
        const plane_record *r = &in->plane[i];
        const fap_plane_info *p = &r->info;
        printf("%7" PRId64 " %8.3f %9" PRId64 "  %c %s %5d %5u %5d %7u %6u %6u %6u %6u %5u %5u\n", r->frame,
               (double)r->pts_us * 1e-6, p->bit_position, p->intra ? 'I' : 'P',
               p->start_code ? "code" : "    ", p->quant, (unsigned)p->skipped, r->coded,
               (unsigned)p->bit_count, (unsigned)p->header_bits, (unsigned)p->setup_bits,
               (unsigned)p->range_bits, (unsigned)r->fap_bits, (unsigned)p->run_bits, (unsigned)p->body_bits);
    }
}

/* --- all of it --- */

void inspect_say(const options *opt, const run_report *rep)
{
    const stream_summary *s = &rep->stream;
    const inspection *in = rep->inspection;

    say_facts(opt, s);
    if (in) {
        say_bits_facts(s, in);
        if (rep->fit)
            printf("interpolates by %s\n", opt->fit_path ? opt->fit_path : rep->fit_found);
        say_kinds(in);
        say_quantisers(in);
        say_groups(in);
        say_faps_with_bits(s, in);
        say_broken(s, in);
        say_notices(s, "bit");
    } else {
        putchar('\n');
        say_faps(s);
        say_notices(s, "line");
    }
    if (in && in->keep_planes)
        say_planes(in);
}
