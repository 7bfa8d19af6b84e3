/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Spikes, and the account of cleaning. A spike stands out of the median of its neighbours by more than they themselves
 * scatter; it becomes a gap, which fill.c closes. Source: F. R. Hampel, The influence curve and its role in robust
 * estimation, 1974.
 */
#include <math.h>
#include <string.h>

#include <fap/studio/clean.h>

#include "base/mem.h"
#include "capture/fill.h"

enum { HALF_WINDOW = 4 };

void fap_clean_config_init(fap_clean_config *cfg)
{
    *cfg = (fap_clean_config){
        .struct_size = sizeof *cfg, .spike_mm = 3, .gap_s = 0.2, .methods = FAP_CLEAN_TAKE
    };
}

const char *fap_sample_name(fap_sample sample)
{
    static const char *const names[FAP_SAMPLE_KINDS] = { "missing", "measured", "spline", "rigid",
                                                         "surface", "motion",   "bank",   "eased" };
    return (unsigned)sample < FAP_SAMPLE_KINDS ? names[sample] : "unknown";
}

static size_t at(const fap_take *take, uint32_t frame, uint32_t point)
{
    return (size_t)frame * take->point_count + point;
}

/* --- spikes --- */

static void sort(float *v, int n)
{
    for (int i = 1; i < n; i++) {
        const float x = v[i];
        int j = i;
        for (; j > 0 && v[j - 1] > x; j--)
            v[j] = v[j - 1];
        v[j] = x;
    }
}

static float median(float *v, int n)
{
    sort(v, n);
    return n % 2 ? v[n / 2] : 0.5f * (v[n / 2 - 1] + v[n / 2]);
}

static const float *valid_sample(const fap_take *take, int64_t frame, uint32_t point)
{
    return frame >= 0 && frame < take->frame_count ? fap_take_sample(take, (uint32_t)frame, point) : NULL;
}

/* Where the frames before and after say that a point should be: a pair at equal distance sees any steady
 * motion. */
static int predictions(const fap_take *take, uint32_t frame, uint32_t point, int axis, float *v)
{
    int n = 0;

    for (int k = 1; k <= HALF_WINDOW; k++) {
        const float *a = valid_sample(take, (int64_t)frame - k, point),
                    *b = valid_sample(take, (int64_t)frame + k, point);
        if (a && b)
            v[n++] = 0.5f * (a[axis] + b[axis]);
    }
    return n;
}

/* How far the sample is from the middle of those on one side. */
static float off_side(const fap_take *take, uint32_t frame, uint32_t point, int axis, int direction)
{
    float v[HALF_WINDOW];
    int n = 0;

    for (int k = 1; k <= HALF_WINDOW; k++) {
        const float *x = valid_sample(take, (int64_t)frame + direction * k, point);
        if (x)
            v[n++] = x[axis];
    }
    return n ? fabsf(take->xyz[at(take, frame, point)][axis] - median(v, n)) : 0;
}

/*
 * Off the predictions by more than they differ among themselves: times 1.4826 a median deviation is a
 * standard deviation, and five of those never happen. Off both sides as well: a step belongs to one of them.
 */
static int stands_out(const fap_take *take, uint32_t frame, uint32_t point, int axis, float least_mm)
{
    const float x = take->xyz[at(take, frame, point)][axis];
    float v[HALF_WINDOW], deviation[HALF_WINDOW];
    const int n = predictions(take, frame, point, axis, v);

    if (n < 2)
        return 0;
    const float middle = median(v, n);
    if (fabsf(x - middle) <= least_mm)
        return 0;
    for (int i = 0; i < n; i++)
        deviation[i] = fabsf(v[i] - middle);
    return fabsf(x - middle) > least_mm + 5 * 1.4826f * median(deviation, n) &&
           off_side(take, frame, point, axis, -1) > least_mm &&
           off_side(take, frame, point, axis, 1) > least_mm;
}

/* Judged on what was measured: the medians still see the spikes that were marked, and survive them. */
static uint32_t drop_spikes(fap_take *take, uint32_t point, float least_mm)
{
    uint32_t spikes = 0, pending[HALF_WINDOW + 1];

    memset(pending, 0xff, sizeof pending);
    for (uint32_t f = 0; f < take->frame_count + HALF_WINDOW + 1; f++) {
        uint32_t *slot = &pending[f % (HALF_WINDOW + 1)];
        if (*slot != UINT32_MAX)
            take->valid[at(take, *slot, point)] = 0;
        *slot = UINT32_MAX;
        if (f >= take->frame_count || !take->valid[at(take, f, point)])
            continue;
        for (int axis = 0; axis < 3 && *slot == UINT32_MAX; axis++)
            if (stands_out(take, f, point, axis, least_mm))
                *slot = f;
        spikes += *slot != UINT32_MAX;
    }
    return spikes;
}

/* --- the thesis's way --- */

/* The mean of the frame and those beside it, where they are there: a spike is spread, not removed. */
static void average(fap_take *take, uint32_t point)
{
    float before[3] = { 0 };
    int had = 0;

    for (uint32_t f = 0; f < take->frame_count; f++) {
        float *v = take->xyz[at(take, f, point)];
        const float here[3] = { v[0], v[1], v[2] };
        const float *after = valid_sample(take, (int64_t)f + 1, point);
        const int has = take->valid[at(take, f, point)] != FAP_SAMPLE_MISSING;
        for (int axis = 0; axis < 3 && has; axis++)
            v[axis] = (here[axis] + (had ? before[axis] : 0) + (after ? after[axis] : 0)) /
                      (float)(1 + had + (after != NULL));
        memcpy(before, here, sizeof before);
        had = has;
    }
}

/* --- the account --- */

/* Counts the gaps of a point that are there now. */
static void count_gaps(const fap_take *take, uint32_t point, fap_clean_point *out)
{
    uint32_t run = 0;

    for (uint32_t f = 0; f <= take->frame_count; f++) {
        if (f < take->frame_count && !take->valid[at(take, f, point)]) {
            run++;
            continue;
        }
        out->gaps += run > 0;
        out->longest_gap = run > out->longest_gap ? run : out->longest_gap;
        run = 0;
    }
}

static void sum_up(const fap_take *take, fap_clean_point *points, fap_clean_report *report)
{
    for (uint32_t p = 0; p < take->point_count; p++) {
        fap_clean_point *c = &points[p];
        uint32_t closed = 0;
        for (int kind = 0; kind < FAP_SAMPLE_KINDS; kind++) {
            closed += c->gaps_by[kind];
            report->samples_filled += c->filled[kind];
        }
        for (uint32_t f = 0; f < take->frame_count; f++)
            c->unfilled += !take->valid[at(take, f, p)];
        report->spikes += c->spikes;
        report->gaps_closed += closed;
        report->gaps_left += c->gaps - closed;
    }
}

fap_err fap_take_clean(fap_take *take, const fap_clean_config *cfg, fap_clean_report *report,
                       fap_clean_point *points)
{
    fap_clean_config defaults;

    fap_clean_config_init(&defaults);
    if (!cfg)
        cfg = &defaults;
    *report = (fap_clean_report){ 0 };
    fap_clean_point *own = points ? NULL : fap_mem_calloc(&take->alloc, take->point_count, sizeof *own);
    if (!points && !own)
        return FAP_E_NOMEM;
    points = points ? points : own;
    memset(points, 0, take->point_count * sizeof *points);
    for (uint32_t p = 0; p < take->point_count; p++) {
        if (cfg->average)
            average(take, p);
        else if (cfg->spike_mm > 0)
            points[p].spikes = drop_spikes(take, p, (float)cfg->spike_mm);
        count_gaps(take, p, &points[p]);
    }
    const fap_err err = fill_gaps(take, cfg, points);
    sum_up(take, points, report);
    fap_mem_free(&take->alloc, own);
    return err;
}
