/* SPDX-License-Identifier: BSD-2-Clause */
/* See compare.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture/rigid.h"
#include "compare.h"

/* What both takes have: the same point at the same time. */
typedef struct pairs {
    uint32_t count, room;
    double (*truth)[3], (*got)[3], *weight, *error;
    uint32_t *point; /* of @got */
    double *at_s;
} pairs;

static int make(pairs *p, size_t room)
{
    *p = (pairs){ .room = (uint32_t)room };
    p->truth = malloc(room * sizeof *p->truth);
    p->got = malloc(room * sizeof *p->got);
    p->weight = malloc(room * sizeof *p->weight);
    p->error = malloc(room * sizeof *p->error);
    p->point = malloc(room * sizeof *p->point);
    p->at_s = malloc(room * sizeof *p->at_s);
    return p->truth && p->got && p->weight && p->error && p->point && p->at_s;
}

static void drop(pairs *p)
{
    free(p->truth);
    free(p->got);
    free(p->weight);
    free(p->error);
    free(p->point);
    free(p->at_s);
}

static void add(pairs *p, const float truth[3], const float got[3], uint32_t point, double at_s)
{
    for (int k = 0; k < 3; k++) {
        p->truth[p->count][k] = (double)truth[k];
        p->got[p->count][k] = (double)got[k];
    }
    p->weight[p->count] = 1;
    p->point[p->count] = point;
    p->at_s[p->count++] = at_s;
}

/* The frame of the truth at that time; -1: there is none just then. */
static long frame_at(const fap_take *truth, double at_s)
{
    const double frame = at_s * truth->rate_hz;
    const long near = lrint(frame);

    return fabs(frame - (double)near) < 0.01 && near >= 0 && near < (long)truth->frame_count ? near : -1;
}

static void pair_point(const fap_take *truth, const fap_take *got, uint32_t point, pairs *p,
                       take_difference *d)
{
    const int same = strncmp(got->name[point], "ruler", 5) ? fap_take_find(truth, got->name[point]) : -1;

    d->points += same >= 0;
    for (uint32_t f = 0; same >= 0 && f < got->frame_count; f++) {
        const double at_s = f / got->rate_hz;
        const long then = frame_at(truth, at_s);
        const float *want = then < 0 ? NULL : fap_take_sample(truth, (uint32_t)then, (uint32_t)same);
        const float *is = fap_take_sample(got, f, point);
        if (want && is)
            add(p, want, is, point, at_s);
        else if (want)
            d->missing++;
    }
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static void measure(const fap_take *got, pairs *p, const rigid_pose *pose, take_difference *d)
{
    double sum = 0;

    for (uint32_t i = 0; i < p->count; i++) {
        double at[3], off = 0;
        rigid_apply(pose, p->got[i], at);
        for (int k = 0; k < 3; k++)
            off += (at[k] - p->truth[i][k]) * (at[k] - p->truth[i][k]);
        sum += off;
        p->error[i] = sqrt(off);
        if (p->error[i] <= d->max_mm)
            continue;
        d->max_mm = p->error[i];
        d->worst_s = p->at_s[i];
        snprintf(d->worst, sizeof d->worst, "%s", got->name[p->point[i]]);
    }
    qsort(p->error, p->count, sizeof *p->error, ascending);
    d->samples = p->count;
    d->rms_mm = sqrt(sum / p->count);
    d->p95_mm = p->error[p->count * 95 / 100];
}

int take_compare(const fap_take *truth, const fap_take *got, take_difference *d)
{
    rigid_pose pose;
    pairs p;

    *d = (take_difference){ 0 };
    if (!(truth->rate_hz > 0) || !(got->rate_hz > 0))
        return 0;
    int compared = make(&p, (size_t)got->frame_count * got->point_count);
    for (uint32_t i = 0; compared && i < got->point_count; i++)
        pair_point(truth, got, i, &p, d);
    compared = compared && p.count &&
               rigid_fit((const double(*)[3])p.got, (const double(*)[3])p.truth, p.weight, p.count, &pose);
    if (compared)
        measure(got, &p, &pose, d);
    drop(&p);
    return compared;
}
