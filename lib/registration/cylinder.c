/* SPDX-License-Identifier: BSD-2-Clause */
/* See cylinder.h. */
#include <math.h>

#include "registration/cylinder.h"

cylinder cylinder_around(const float (*at)[3], uint32_t count)
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };

    for (uint32_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++) {
            low[a] = fmin(low[a], (double)at[i][a]);
            high[a] = fmax(high[a], (double)at[i][a]);
        }
    return (cylinder){ (low[0] + high[0]) / 2, (low[2] + high[2]) / 2, low[1], high[1] };
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
