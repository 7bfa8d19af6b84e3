/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The filter of one dot: position and velocity in x and y, eq. 1 and 2 of Lin, Yeh, Ouhyoung 2001. Both axes have the same noise,
 * so one covariance serves them.
 */
#ifndef LIB_TRACK_KALMAN_H
#define LIB_TRACK_KALMAN_H

typedef struct kalman {
    double p[2], v[2]; /* pixels, pixels a frame */
    double pp, pv, vv; /* covariance of position and velocity */
} kalman;

void kalman_start(kalman *k, const double at[2], double variance);
/* s(t | t - 1): @frames on, the velocity having changed by @velocity_variance a frame. */
void kalman_predict(kalman *k, double frames, double velocity_variance);
/* h(t), of that variance. */
void kalman_measure(kalman *k, const double at[2], double variance);

#endif
