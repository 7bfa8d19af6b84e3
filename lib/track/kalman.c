/* SPDX-License-Identifier: BSD-2-Clause */
/* See kalman.h. */
#include "track/kalman.h"

void kalman_start(kalman *k, const double at[2], double variance)
{
    /* Nobody knows its speed yet: some pixels a frame either way. */
    *k = (kalman){ { at[0], at[1] }, { 0, 0 }, variance, 0, 4 };
}

/* The velocity changes at the end of each interval, so it moves the position from the next one on: Q has one entry. */
void kalman_predict(kalman *k, double frames, double velocity_variance)
{
    for (int i = 0; i < 2; i++)
        k->p[i] += frames * k->v[i];
    k->pp += frames * (2 * k->pv + frames * k->vv);
    k->pv += frames * k->vv;
    k->vv += frames * velocity_variance;
}

void kalman_measure(kalman *k, const double at[2], double variance)
{
    const double gain_p = k->pp / (k->pp + variance), gain_v = k->pv / (k->pp + variance);

    for (int i = 0; i < 2; i++) {
        const double news = at[i] - k->p[i];
        k->p[i] += gain_p * news;
        k->v[i] += gain_v * news;
    }
    k->vv -= gain_v * k->pv;
    k->pv -= gain_p * k->pv;
    k->pp -= gain_p * k->pp;
}
