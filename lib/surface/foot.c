/* SPDX-License-Identifier: BSD-2-Clause */
/* See foot.h. Which of the seven Voronoi regions (three corners, three edges, the inside) the place is in decides. Source:
 * C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5. */
#include "surface/foot.h"

static double dot(const double u[3], const double v[3])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

static void give(float share[3], double b, double c)
{
    share[0] = (float)(1 - b - c);
    share[1] = (float)b;
    share[2] = (float)c;
}

/* Shares of b and c. */
static void find(const double ab[3], const double ac[3], const double ap[3], float share[3])
{
    double bp[3], cp[3];

    for (int i = 0; i < 3; i++) {
        bp[i] = ap[i] - ab[i];
        cp[i] = ap[i] - ac[i];
    }
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;

    if (d1 <= 0 && d2 <= 0)
        give(share, 0, 0);
    else if (d3 >= 0 && d4 <= d3)
        give(share, 1, 0);
    else if (d6 >= 0 && d5 <= d6)
        give(share, 0, 1);
    else if (vc <= 0 && d1 >= 0 && d3 <= 0)
        give(share, d1 / (d1 - d3), 0);
    else if (vb <= 0 && d2 >= 0 && d6 <= 0)
        give(share, 0, d2 / (d2 - d6));
    else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        give(share, 1 - w, w);
    } else
        give(share, vb / (va + vb + vc), vc / (va + vb + vc));
}

void surface_foot(const float a[3], const float b[3], const float c[3], const float at[3], float share[3],
                  float foot[3])
{
    double ab[3], ac[3], ap[3];

    for (int i = 0; i < 3; i++) {
        ab[i] = (double)b[i] - (double)a[i];
        ac[i] = (double)c[i] - (double)a[i];
        ap[i] = (double)at[i] - (double)a[i];
    }
    find(ab, ac, ap, share);
    for (int i = 0; i < 3; i++)
        foot[i] = (float)((double)a[i] + (double)share[1] * ab[i] + (double)share[2] * ac[i]);
}
