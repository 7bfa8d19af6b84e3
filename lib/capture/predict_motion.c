/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How the hidden point moves with its neighbours, learnt from the rest of the take: ridge regression of its place on the
 * places of the witnesses. Source: A. E. Hoerl, R. W. Kennard, Ridge regression, 1970; the idea of filling gaps with the
 * take's own correlations is P. Federolf's, 2013.
 */
#include <math.h>
#include <string.h>

#include "capture/predict.h"

enum { TERMS = 3 * MAX_WITNESSES, LEAST_FRAMES = 16, MOST_FRAMES = 1000 };

typedef struct motion_state {
    int terms;
    double mean[TERMS + 3]; /* of the witnesses, then of the point */
    double weight[TERMS][3];
    double gram[TERMS][TERMS + 3]; /* work */
} motion_state;

/* Places of all witnesses in a frame; 0: one is hidden. */
static int terms_of(const gap *g, uint32_t frame, double *out)
{
    for (uint32_t i = 0; i < g->count; i++)
        if (!scene_still(g->scene, frame, g->witness[i], out + 3 * i))
            return 0;
    return 1;
}

static int example(const gap *g, uint32_t frame, double v[TERMS + 3])
{
    return gap_teaches(g, frame, v + 3 * g->count) && terms_of(g, frame, v);
}

static uint32_t find_mean(motion_state *s, const gap *g)
{
    double v[TERMS + 3];
    uint32_t n = 0;

    memset(s->mean, 0, sizeof s->mean);
    for (uint32_t f = 0; f < g->scene->take->frame_count; f += gap_step(g, MOST_FRAMES)) {
        if (!example(g, f, v))
            continue;
        for (int i = 0; i < s->terms + 3; i++)
            s->mean[i] += v[i];
        n++;
    }
    for (int i = 0; i < s->terms + 3 && n; i++)
        s->mean[i] /= n;
    return n;
}

static void accumulate(motion_state *s, const gap *g)
{
    double v[TERMS + 3];

    memset(s->gram, 0, sizeof s->gram);
    for (uint32_t f = 0; f < g->scene->take->frame_count; f += gap_step(g, MOST_FRAMES)) {
        if (!example(g, f, v))
            continue;
        for (int i = 0; i < s->terms + 3; i++)
            v[i] -= s->mean[i];
        for (int i = 0; i < s->terms; i++)
            for (int k = i; k < s->terms + 3; k++)
                s->gram[i][k] += v[i] * v[k];
    }
}

/* Symmetric elimination on the upper triangle: the ridge makes it definite. */
static void solve(motion_state *s)
{
    for (int c = 0; c < s->terms; c++)
        for (int r = c + 1; r < s->terms; r++) {
            const double f = s->gram[c][r] / s->gram[c][c];
            for (int k = r; k < s->terms + 3; k++)
                s->gram[r][k] -= f * s->gram[c][k];
        }
    for (int r = s->terms - 1; r >= 0; r--)
        for (int axis = 0; axis < 3; axis++) {
            double sum = s->gram[r][s->terms + axis];
            for (int k = r + 1; k < s->terms; k++)
                sum -= s->gram[r][k] * s->weight[k][axis];
            s->weight[r][axis] = sum / s->gram[r][r];
        }
}

static int learn(void *state, const gap *g)
{
    static const double ridge_mm2 = 0.06; /* measured on real takes: 0.03 to 0.1 make no difference */
    motion_state *s = state;

    s->terms = (int)(3 * g->count);
    const uint32_t n = find_mean(s, g);
    if (n < LEAST_FRAMES || !s->terms)
        return 0;
    accumulate(s, g);
    for (int i = 0; i < s->terms; i++)
        s->gram[i][i] += ridge_mm2 * n;
    solve(s);
    return 1;
}

static int at(const void *state, const gap *g, uint32_t frame, double out[3])
{
    const motion_state *s = state;
    double v[TERMS];

    if (!terms_of(g, frame, v))
        return 0;
    for (int axis = 0; axis < 3; axis++) {
        out[axis] = s->mean[s->terms + axis];
        for (int i = 0; i < s->terms; i++)
            out[axis] += s->weight[i][axis] * (v[i] - s->mean[i]);
    }
    return 1;
}

const predictor predictor_motion = { FAP_SAMPLE_MOTION, sizeof(motion_state), NULL, learn, at };
