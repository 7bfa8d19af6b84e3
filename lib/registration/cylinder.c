/* SPDX-License-Identifier: BSD-2-Clause */
/* See cylinder.h. */
#include <math.h>

#include "registration/cylinder.h"

/* A face that ends at the ears: its axis is where the head's would be, this share of its width behind the tip of the nose. */
static const double half_depth = 0.62;

cylinder cylinder_around(const float (*at)[3], uint32_t count)
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };

    for (uint32_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++) {
            low[a] = fmin(low[a], (double)at[i][a]);
            high[a] = fmax(high[a], (double)at[i][a]);
        }
    const double deep = fmax((high[2] - low[2]) / 2, (high[0] - low[0]) * half_depth);
    return (cylinder){ (low[0] + high[0]) / 2, high[2] - deep, low[1], high[1] };
}

void cylinder_outwards(const cylinder *c, const float at[3], float out[3])
{
    const double x = (double)at[0] - c->x, z = (double)at[2] - c->z;
    const double length = fmax(1e-9, sqrt(x * x + z * z));

    out[0] = (float)(x / length);
    out[1] = 0;
    out[2] = (float)(z / length);
}

void cylinder_unroll(const cylinder *c, const float at[3], double out[3])
{
    const double x = (double)at[0] - c->x, z = (double)at[2] - c->z;

    out[0] = atan2(x, z);
    out[1] = (double)at[1];
    out[2] = sqrt(x * x + z * z);
}

/* Ears begin this far to either side of straight ahead, and the hair at this share of the head's height above its middle. */
static const double face_degrees = 80, face_top = 0.62;

int cylinder_is_face(const cylinder *c, const float at[3])
{
    const double middle = (c->low + c->high) / 2, degrees = 57.29577951308232;
    double unrolled[3];

    cylinder_unroll(c, at, unrolled);
    return fabs(unrolled[0]) * degrees < face_degrees && unrolled[1] < middle + face_top * (c->high - middle);
}
