/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Phonemes to FAPs by dominance: every sound pulls lips, jaw and tongue towards its viseme, from a little before it is heard
 * to a little after, and where several pull, the mean goes where the strong ones want. Their way is kept to but for two
 * things: a sound rules undiminished in its middle, so that a long one does not sag at its ends; and a rate is 1/s whatever
 * the exponent. Source: Cohen and Massaro 1993; fap_tables/dominance.csv.
 */
#include <math.h>
#include <string.h>

#include <fap/facs.h>
#include <fap/studio/speech.h>

#include "base/mem.h"
#include "gen/dominance.h"
#include "speech/phonemes.h"
#include "speech/two_visemes.h"

enum { VISEMES = FAP_VISEME_COUNT + 1 };

/* A sound grows and fades within this of its ends; what is left between is its middle. */
static const double edge_s = 0.04;
/* A pause as short as this is half a pause: there is no time to come to rest. */
static const double breath_s = 0.15;
/* The first part of a diphthong is the longer one. */
static const double diphthong_first = 0.55;
/* Farther away nothing is left of any dominance. */
static const double reach_s = 0.8;
/* Silence around all sounds. */
static const double ever_s = 1e7;
/* What two sounds of an aligner may be apart without a pause between them. */
static const double seam_s = 0.002;

static const struct dominance {
    double magnitude, before, after, exponent;
} dominances[VISEMES][FAP_ARTICULATOR_COUNT] = {
#define X(viseme, part, magnitude, before, after, exponent)                                                  \
    [viseme][FAP_##part] = { magnitude / 100.0, before, after, exponent / 100.0 },
    DOMINANCE_ROWS(X)
#undef X
};

typedef struct segment {
    double start_s, end_s;
    double weight; /* of its magnitude */
    int viseme;
} segment;

struct fap_mouth {
    fap_allocator alloc;
    fap_mouth_way way;
    fap_mouth_report report;
    uint32_t count;
    segment *segment; /* ascending, disjoint */
    double target[VISEMES][FAP_COUNT + 1];
    int8_t part[FAP_COUNT + 1]; /* a fap_articulator; -1: speech leaves it alone */
};

void fap_mouth_config_init(fap_mouth_config *cfg)
{
    *cfg = (fap_mouth_config){ .struct_size = sizeof *cfg };
}

/* --- what sounds want --- */

/* Of jaw and chin, lips, tongue. */
static int part_of(int fap)
{
    switch (fap_info_get(fap)->group) {
    case 2: return fap == 3 || fap == 14 || fap == 15 || fap == 18 ? FAP_JAW : FAP_LIPS;
    case 6: return FAP_TONGUE;
    case 8: return FAP_LIPS;
    default: return -1;
    }
}

static void read_targets(fap_mouth *m)
{
    memset(m->part, -1, sizeof m->part);
    for (int v = 1; v < VISEMES; v++) {
        fap_arkit shapes = { .has_head = 0 };
        fap_frame frame = { .number = 0 };
        fap_viseme_to_arkit(v, &shapes);
        fap_arkit_to_faps(&shapes, &frame);
        for (int fap = 3; fap <= FAP_COUNT; fap++) {
            m->target[v][fap] = frame.value[fap];
            if (frame.value[fap] && part_of(fap) >= 0)
                m->part[fap] = (int8_t)part_of(fap);
        }
    }
}

/* --- segments --- */

static void add(fap_mouth *m, int viseme, double start, double end, double weight)
{
    m->segment[m->count++] = (segment){ start, end, weight, viseme };
}

static void add_pause(fap_mouth *m, double start, double end)
{
    m->report.silences++;
    add(m, 0, start, end, (end - start) / (end - start + breath_s));
}

static void note_unknown(fap_mouth_report *r, const char *name)
{
    r->unknown++;
    for (uint32_t i = 0; i < r->unknown_names; i++)
        if (!strcmp(r->unknown_name[i], name))
            return;
    if (r->unknown_names < FAP_MOUTH_MAX_UNKNOWN)
        memcpy(r->unknown_name[r->unknown_names++], name, FAP_PHONEME_NAME_SIZE);
}

static void add_phoneme(fap_mouth *m, fap_alphabet alphabet, const fap_phoneme *p)
{
    int second;
    const int first = fap_phoneme_visemes(alphabet, p->name, &second);
    const double middle = second ? p->start_s + diphthong_first * (p->end_s - p->start_s) : p->end_s;

    if (phonemes_is_silence(alphabet, p->name)) {
        add_pause(m, p->start_s, p->end_s);
        return;
    }
    m->report.sounds++;
    if (first < 0)
        note_unknown(&m->report, p->name);
    if (first > 0)
        add(m, first, p->start_s, middle, 1);
    if (second > 0)
        add(m, second, middle, p->end_s, 1);
}

/* Room for each phoneme twice, a pause in front of each, and one behind all. */
static fap_err add_all(fap_mouth *m, const fap_speech *s)
{
    double at = -ever_s;

    m->segment = fap_mem_calloc(&m->alloc, 3 * (size_t)s->count + 1, sizeof *m->segment);
    if (!m->segment)
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < s->count; i++) {
        const fap_phoneme *p = &s->phoneme[i];
        if (p->start_s - at > seam_s)
            add_pause(m, at, p->start_s);
        add_phoneme(m, s->alphabet, p);
        at = p->end_s;
    }
    add_pause(m, at, at + ever_s);
    return FAP_OK;
}

fap_err fap_mouth_open(fap_mouth **mouth, const fap_speech *speech, const fap_mouth_config *cfg)
{
    const fap_allocator alloc = fap_mem_allocator(cfg ? &cfg->alloc : NULL);
    fap_mouth *m = fap_mem_calloc(&alloc, 1, sizeof *m);

    *mouth = NULL;
    if (!m)
        return FAP_E_NOMEM;
    m->alloc = alloc;
    m->way = cfg ? cfg->way : FAP_MOUTH_VISEMES;
    const fap_err err = add_all(m, speech);
    if (err != FAP_OK) {
        fap_mouth_close(&m);
        return err;
    }
    read_targets(m);
    *mouth = m;
    return FAP_OK;
}

void fap_mouth_close(fap_mouth **mouth)
{
    fap_mouth *m = mouth ? *mouth : NULL;

    if (!m)
        return;
    const fap_allocator alloc = m->alloc;
    fap_mem_free(&alloc, m->segment);
    fap_mem_free(&alloc, m);
    *mouth = NULL;
}

const fap_mouth_report *fap_mouth_report_get(const fap_mouth *mouth)
{
    return &mouth->report;
}

/* --- dominance --- */

static double dominance(const segment *s, fap_articulator part, double t)
{
    const struct dominance *d = &dominances[s->viseme][part];
    const double edge = fmin(edge_s, 0.5 * (s->end_s - s->start_s));
    const double before = s->start_s + edge - t, after = t - (s->end_s - edge);
    const double far = fmax(0, fmax(d->before * before, d->after * after));

    return s->weight * d->magnitude * exp(-pow(far, d->exponent));
}

/* The first segment that ends behind @p t. */
static uint32_t first_behind(const fap_mouth *m, double t)
{
    uint32_t low = 0, high = m->count;

    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (m->segment[middle].end_s > t)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* Dominance of each viseme; their sum, or 1 for rest where nothing is left of any. */
static double sum_up(const fap_mouth *m, fap_articulator part, double t, double all[VISEMES])
{
    double sum = 0;

    memset(all, 0, VISEMES * sizeof *all);
    for (uint32_t i = first_behind(m, t - reach_s); i < m->count && m->segment[i].start_s < t + reach_s;
         i++) {
        const double d = dominance(&m->segment[i], part, t);
        all[m->segment[i].viseme] += d;
        sum += d;
    }
    if (!(sum > 0))
        all[0] = sum = 1;
    return sum;
}

void fap_mouth_shares(const fap_mouth *m, fap_articulator part, double t_s, double share[VISEMES])
{
    const double sum = sum_up(m, part, t_s, share);

    for (int v = 0; v < VISEMES; v++)
        share[v] /= sum;
}

/* --- FAP 1 --- */

/*
 * There is one blend for the whole mouth, and lips are what is seen of it. Dominances are summed, not shares: lips that must
 * close do so, whatever the tongue does meanwhile.
 */
static void whole_mouth(const fap_mouth *m, double t, double all[VISEMES])
{
    static const double seen[FAP_ARTICULATOR_COUNT] = { 1, 0.25, 0.25 };
    double part[VISEMES];

    memset(all, 0, VISEMES * sizeof *all);
    for (int p = 0; p < FAP_ARTICULATOR_COUNT; p++) {
        sum_up(m, (fap_articulator)p, t, part);
        for (int v = 0; v < VISEMES; v++)
            all[v] += seen[p] * part[v];
    }
}

/* Two visemes of all that pull. */
static void show_visemes(const fap_mouth *m, double t, fap_frame *frame)
{
    double all[VISEMES];

    whole_mouth(m, t, all);
    frame->state[1] = FAP_CODED;
    two_visemes(all, &frame->viseme);
}

/* --- low-level FAPs --- */

static void show_lips(const fap_mouth *m, double t, fap_frame *frame)
{
    double share[FAP_ARTICULATOR_COUNT][VISEMES];

    for (int p = 0; p < FAP_ARTICULATOR_COUNT; p++)
        fap_mouth_shares(m, (fap_articulator)p, t, share[p]);
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        double value = 0;
        if (m->part[fap] < 0)
            continue;
        for (int v = 1; v < VISEMES; v++)
            value += share[m->part[fap]][v] * m->target[v][fap];
        frame->state[fap] = FAP_CODED;
        frame->value[fap] = (int32_t)lround(value);
    }
}

void fap_mouth_at(const fap_mouth *m, double t_s, fap_frame *frame)
{
    *frame = (fap_frame){ .number = frame->number, .pts_us = frame->pts_us };
    (m->way == FAP_MOUTH_VISEMES ? show_visemes : show_lips)(m, t_s, frame);
}
