/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How well gaps are closed: stretches of real takes without gaps are taken out, a marker at a time, filled, and compared
 * with what was there.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/clean.h>

#include "bench.h"
#include "common/file.h"

static const char *const takes[] = { "../shared/data/takes/optical_animface/jaw_60hz.c3d",
                                     "../shared/data/takes/optical_animface/eyebrows_60hz_int16.c3d" };

enum { TAKES = 2, ROUNDS = 4, MARGIN = 30, NEIGHBOURS = 3 };

typedef struct errors {
    double sum, worst;
    uint32_t samples, gaps_of[FAP_SAMPLE_KINDS];
} errors;

/* What may close the gaps; nothing: the last place is held. */
typedef struct trial {
    uint32_t methods, length;
    int with_neighbours; /* the nearest markers are hidden as well */
} trial;

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static fap_take *copy_of(const fap_take *take)
{
    fap_take *out;
    const size_t samples = (size_t)take->frame_count * take->point_count;

    if (fap_take_create(&out, take->point_count, take->frame_count, NULL) != FAP_OK)
        return NULL;
    memcpy(out->xyz, take->xyz, samples * sizeof *take->xyz);
    memcpy(out->valid, take->valid, samples);
    out->rate_hz = take->rate_hz;
    return out;
}

static void hide(fap_take *take, uint32_t point, uint32_t first, uint32_t length)
{
    for (uint32_t f = first; f < first + length; f++)
        take->valid[(size_t)f * take->point_count + point] = 0;
}

static double distance(const float a[3], const float b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* The nearest markers go, too. */
static void hide_neighbours(fap_take *take, const fap_take *whole, uint32_t point, uint32_t first,
                            uint32_t length)
{
    double beyond = 0;

    for (int k = 0; k < NEIGHBOURS; k++) {
        uint32_t best = point;
        double least = INFINITY;
        for (uint32_t i = 0; i < whole->point_count; i++) {
            const double d = distance(whole->xyz[point], whole->xyz[i]);
            if (i != point && d > beyond && d < least) {
                least = d;
                best = i;
            }
        }
        beyond = least;
        hide(take, best, first, length);
    }
}

static void compare(const fap_take *take, const fap_take *whole, uint32_t point, uint32_t first,
                    uint32_t length, errors *e)
{
    for (uint32_t f = first; f < first + length; f++) {
        const size_t i = (size_t)f * take->point_count + point,
                     before = (size_t)(first - 1) * take->point_count + point;
        const double d = distance(take->valid[i] ? take->xyz[i] : take->xyz[before], whole->xyz[i]);
        e->sum += d;
        e->worst = fmax(e->worst, d);
        e->samples++;
        e->gaps_of[take->valid[i]] += f == first;
    }
}

/* One gap in each slot of time, each of another marker; the next call goes on with the next markers. */
static int fill_slots(const fap_take *whole, const trial *t, uint32_t *next, uint32_t *seed, errors *e)
{
    enum { MAX_SLOTS = 64 };
    const uint32_t room = t->length + MARGIN, slots = (whole->frame_count - 2 * MARGIN) / room;
    uint32_t first[MAX_SLOTS], point[MAX_SLOTS], used = 0;
    fap_clean_config cfg;
    fap_clean_report report;
    fap_take *take = copy_of(whole);

    if (!take)
        return 0;
    for (; used < slots && used < MAX_SLOTS && *next < ROUNDS * whole->point_count; used++) {
        point[used] = (*next)++ % whole->point_count;
        first[used] = MARGIN + used * room + next_random(seed) % MARGIN;
        hide(take, point[used], first[used], t->length);
        if (t->with_neighbours)
            hide_neighbours(take, whole, point[used], first[used], t->length);
    }
    fap_clean_config_init(&cfg);
    cfg.spike_mm = 0;
    cfg.methods = t->methods;
    cfg.gap_s = t->methods == FAP_CLEAN_SPLINE ? 1e3 : cfg.gap_s;
    const int ok = fap_take_clean(take, &cfg, &report, NULL) == FAP_OK;
    for (uint32_t i = 0; i < used; i++)
        compare(take, whole, point[i], first[i], t->length, e);
    fap_take_close(&take);
    return ok && used;
}

static int measure_take(const char *path, const trial *t, errors *e)
{
    uint8_t *data = NULL;
    fap_take *take = NULL;
    uint32_t next = 0, seed = 1;
    size_t size;
    int ok = file_read(path, 1 << 26, &data, &size) == FAP_OK &&
             fap_take_read(&take, data, size, NULL, NULL) == FAP_OK;

    while (ok && next < ROUNDS * take->point_count)
        ok = fill_slots(take, t, &next, &seed, e);
    fap_take_close(&take);
    free(data);
    return ok;
}

/* Mean over all samples; negative: no takes. */
static double measure(const trial *t, errors *e)
{
    *e = (errors){ 0 };
    for (int i = 0; i < TAKES; i++)
        if (!measure_take(takes[i], t, e))
            return -1;
    return e->sum / e->samples;
}

static void note_other(const char *name, const trial *t)
{
    errors e;
    char worst[64];
    const double mean = measure(t, &e);

    snprintf(worst, sizeof worst, "%s, worst", name);
    bench_note(name, mean, "mm");
    bench_note(worst, e.worst, "mm");
}

static double gap_fill(uint32_t length)
{
    const trial all = { FAP_CLEAN_TAKE, length, 0 };
    errors e;
    const double mean = measure(&all, &e);

    if (mean < 0)
        return mean;
    bench_note("worst", e.worst, "mm");
    for (int kind = 0; kind < FAP_SAMPLE_KINDS; kind++)
        if (e.gaps_of[kind])
            bench_note(fap_sample_name((fap_sample)kind), e.gaps_of[kind], "gaps");
    note_other("held", &(trial){ 0, length, 0 });
    note_other("spline only", &(trial){ FAP_CLEAN_SPLINE, length, 0 });
    note_other("rigid only", &(trial){ 1u << FAP_SAMPLE_RIGID, length, 0 });
    note_other("surface only", &(trial){ 1u << FAP_SAMPLE_SURFACE, length, 0 });
    note_other("motion only", &(trial){ 1u << FAP_SAMPLE_MOTION, length, 0 });
    note_other("with the 3 nearest hidden", &(trial){ FAP_CLEAN_TAKE, length, 1 });
    return mean;
}

double bench_gap_fill_error_mm_5(void)
{
    return gap_fill(5);
}

double bench_gap_fill_error_mm_30(void)
{
    return gap_fill(30);
}

double bench_gap_fill_error_mm_120(void)
{
    return gap_fill(120);
}
