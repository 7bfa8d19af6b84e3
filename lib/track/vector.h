/* SPDX-License-Identifier: BSD-2-Clause */
/* Arithmetic on three doubles: geometry at millimetres under a thousandth wants more than cglm's floats. */
#ifndef LIB_TRACK_VECTOR_H
#define LIB_TRACK_VECTOR_H

#include <math.h>

static inline double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void add_scaled3(double a[3], const double b[3], double s)
{
    for (int i = 0; i < 3; i++)
        a[i] += s * b[i];
}

/* 0: it has no length, and stays. */
static inline int unit3(double a[3])
{
    const double length = sqrt(dot3(a, a));

    if (!(length > 1e-300))
        return 0;
    for (int i = 0; i < 3; i++)
        a[i] /= length;
    return 1;
}

#endif
