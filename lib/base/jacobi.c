/* SPDX-License-Identifier: BSD-2-Clause */
/* See jacobi.h. */
#include <math.h>

#include "base/jacobi.h"

enum { MOST_SWEEPS = 30 };

static void turn(double *a, double *b, double c, double s)
{
    const double t = *a;

    *a = c * t - s * *b;
    *b = s * t + c * *b;
}

/* Makes g[p][q] zero; v collects the rotations as rows. */
static void rotate(double *g, double *v, size_t n, size_t p, size_t q)
{
    if (g[p * n + q] == 0)
        return;
    const double theta = (g[q * n + q] - g[p * n + p]) / (2 * g[p * n + q]);
    const double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;

    for (size_t k = 0; k < n; k++)
        turn(&g[k * n + p], &g[k * n + q], c, s);
    for (size_t k = 0; k < n; k++)
        turn(&g[p * n + k], &g[q * n + k], c, s);
    for (size_t k = 0; k < n; k++)
        turn(&v[p * n + k], &v[q * n + k], c, s);
}

static double off_diagonal(const double *g, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++)
            sum += g[i * n + j] * g[i * n + j];
    return sum;
}

static double trace(const double *g, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += g[i * n + i];
    return sum;
}

void fap_jacobi(double *g, double *v, size_t n)
{
    const double enough = 1e-24 * trace(g, n) * trace(g, n);

    for (size_t i = 0; i < n; i++)
        v[i * n + i] = 1;
    for (int sweep = 0; sweep < MOST_SWEEPS && off_diagonal(g, n) > enough; sweep++)
        for (size_t p = 0; p < n; p++)
            for (size_t q = p + 1; q < n; q++)
                rotate(g, v, n, p, q);
}
