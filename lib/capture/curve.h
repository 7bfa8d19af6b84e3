/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The smoothest curve through samples beside a gap, in the sense of a Gaussian process: between them it continues both
 * sides, far from them it forgets them. Source: G. Matheron, The intrinsic random functions, 1973 (kriging with a trend);
 * covariances after B. Matern, Spatial Variation, 1960.
 */
#ifndef LIB_CAPTURE_CURVE_H
#define LIB_CAPTURE_CURVE_H

enum { CURVE_SIDE = 8, CURVE_SAMPLES = 2 * CURVE_SIDE, CURVE_TERMS = CURVE_SAMPLES + 2 };

typedef enum curve_kind {
    CURVE_SPLINE,   /* twice differentiable, with a straight line as its trend: for what moves by itself */
    CURVE_REMAINDER /* once differentiable, back to 0 away from the samples: for what a prediction leaves */
} curve_kind;

typedef struct curve {
    curve_kind kind;
    int count;
    double reach, middle; /* how far a sample is felt; the trend's zero */
    double at[CURVE_SAMPLES], weight[CURVE_TERMS][3];
} curve;

/* @p t and @p v: @p count samples, at most CURVE_SAMPLES; @p reach in the unit of @p t. 0: no curve. */
int curve_fit(curve *c, curve_kind kind, double reach, const double *t, const double (*v)[3], int count);
void curve_value(const curve *c, double t, double out[3]);

#endif
