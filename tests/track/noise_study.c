/* SPDX-License-Identifier: BSD-2-Clause */
/* See noise_study.h. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "noise_study.h"
#include "track/vector.h"
#include "two_view.h"

enum { TESTED = 50, MAX_POINTS = 400 };

static const double focal_px = 960, away_mm = 400;

const char *study_method_name(int method)
{
    static const char *const name[STUDY_METHODS] = { "fundamental matrix", "mirror plane",
                                                     "refined mirror plane" };

    return name[method];
}

/* --- numbers --- */

typedef struct rng {
    uint64_t state;
} rng;

/* Vigna 2015, splitmix64. */
static double evenly(rng *r)
{
    uint64_t z = r->state += 0x9e3779b97f4a7c15U;

    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
    z = (z ^ z >> 27) * 0x94d049bb133111ebU;
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

/* Box and Muller 1958. */
static double normal(rng *r)
{
    const double u = evenly(r), v = evenly(r);

    return sqrt(-2 * log(1 - u)) * cos(6.283185307179586 * v);
}

/* --- a trial --- */

typedef struct trial {
    fap_mirror_plane truth;
    int count; /* points to find the mirror from; those to be tested are behind them */
    double place[MAX_POINTS + TESTED][3];
    fap_mirror_pair pair[MAX_POINTS + TESTED];
} trial;

static void picture(const double place[3], double noise_px, rng *r, double ray[2])
{
    for (int k = 0; k < 2; k++)
        ray[k] = place[k] / place[2] + noise_px * normal(r) / focal_px;
}

static void make_trial(trial *t, const study_setting *s, rng *r)
{
    const double noise_px = sqrt(s->variance_px2);
    double image[3];

    t->truth = (fap_mirror_plane){ { 0.88, 0.02, -0.475 }, -265 };
    unit3(t->truth.normal);
    t->count = s->points;
    for (int i = 0; i < s->points + TESTED; i++) {
        double *p = t->place[i];
        p[0] = 100 * (evenly(r) - 0.5);
        p[1] = 200 * (evenly(r) - 0.5);
        p[2] = away_mm + 100 * (evenly(r) - 0.5);
        fap_mirror_reflect(&t->truth, p, image);
        picture(p, noise_px, r, t->pair[i].direct);
        picture(image, noise_px, r, t->pair[i].mirrored);
    }
}

/* RMS of the tested points, with the one scale that suits them best: a ruler's errors would be the same for all methods. */
static double error_of(const trial *t, double got[TESTED][3])
{
    double gg = 0, gt = 0, sum = 0;

    for (int i = 0; i < TESTED; i++) {
        gg += dot3(got[i], got[i]);
        gt += dot3(got[i], t->place[t->count + i]);
    }
    for (int i = 0; i < TESTED; i++) {
        double off[3] = { 0 };
        add_scaled3(off, got[i], gt / gg);
        add_scaled3(off, t->place[t->count + i], -1);
        sum += dot3(off, off);
    }
    return sqrt(sum / TESTED);
}

static double by_two_views(const trial *t)
{
    double got[TESTED][3];
    two_view v;

    if (!two_view_find(&v, t->pair, t->count))
        return INFINITY;
    for (int i = 0; i < TESTED; i++)
        if (!two_view_place(&v, &t->pair[t->count + i], got[i]))
            return INFINITY;
    return error_of(t, got);
}

static void views_of(const fap_mirror_pair *pair, fap_mirror_views *v)
{
    *v = (fap_mirror_views){ .seen = { 1, 1, 0 } };
    memcpy(v->ray[0], pair->direct, sizeof pair->direct);
    memcpy(v->ray[1], pair->mirrored, sizeof pair->mirrored);
}

static void refine(const trial *t, fap_mirror_plane *mirror, double tolerance)
{
    fap_mirror_views v[MAX_POINTS];

    for (int i = 0; i < t->count; i++)
        views_of(&t->pair[i], &v[i]);
    fap_mirror_refine(mirror, 1, v, t->count, tolerance);
}

static int place_of(const fap_mirror_plane *mirror, const fap_mirror_pair *pair, int best, double place[3])
{
    fap_mirror_views v;

    if (!best)
        return fap_mirror_place(mirror, pair, place);
    views_of(pair, &v);
    return fap_mirror_locate(mirror, 1, &v, place, NULL);
}

static double by_mirror(const trial *t, double noise_px, int refined)
{
    const double tolerance = fmax(2, 4 * noise_px) / focal_px;
    double got[TESTED][3];
    fap_mirror_plane mirror;
    fap_mirror_fit fit;

    if (fap_mirror_find(&mirror, t->pair, t->count, tolerance, &fit, NULL) != FAP_OK)
        return INFINITY;
    if (refined)
        refine(t, &mirror, tolerance);
    for (int i = 0; i < TESTED; i++)
        if (!place_of(&mirror, &t->pair[t->count + i], refined, got[i]))
            return INFINITY;
    return error_of(t, got);
}

/* --- many --- */

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static study_result summarise(double *error, int count)
{
    study_result r = { 0, 0, 0 };

    qsort(error, (size_t)count, sizeof *error, ascending);
    r.median_mm = error[count / 2];
    r.tenth_mm = error[count * 9 / 10];
    for (int i = 0; i < count; i++)
        r.failed += !isfinite(error[i]);
    return r;
}

int study_run(const study_setting *s, study_result result[STUDY_METHODS])
{
    const double noise_px = sqrt(s->variance_px2);
    double *error = malloc(STUDY_METHODS * (size_t)s->trials * sizeof *error);
    trial *t = malloc(sizeof *t);
    rng r = { 1 };

    for (int i = 0; error && t && i < s->trials; i++) {
        make_trial(t, s, &r);
        error[i] = by_two_views(t);
        error[s->trials + i] = by_mirror(t, noise_px, 0);
        error[2 * s->trials + i] = by_mirror(t, noise_px, 1);
    }
    for (int m = 0; error && t && m < STUDY_METHODS; m++)
        result[m] = summarise(&error[m * s->trials], s->trials);
    const int done = error && t;
    free(t);
    free(error);
    return done;
}
