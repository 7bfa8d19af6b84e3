/* SPDX-License-Identifier: BSD-2-Clause */
/* Eigenvectors are what they should be: G v = lambda v, at right angles, of length 1. */
#include "tests/test.h"

#include <math.h>
#include <string.h>

#include "base/jacobi.h"

enum { N = 7 };

static void make_symmetric(double g[N][N])
{
    for (int i = 0; i < N; i++)
        for (int k = 0; k <= i; k++)
            g[i][k] = g[k][i] = sin(3.7 * i + 1.3 * k) + (i == k ? i : 0);
}

TEST(jacobi, every_row_is_an_eigenvector)
{
    double g[N][N], was[N][N], v[N][N] = { { 0 } };

    make_symmetric(g);
    memcpy(was, g, sizeof g);
    fap_jacobi(g[0], v[0], N);
    for (int e = 0; e < N; e++)
        for (int i = 0; i < N; i++) {
            double sum = 0;
            for (int k = 0; k < N; k++)
                sum += was[i][k] * v[e][k];
            assert_true(fabs(sum - g[e][e] * v[e][i]) < 1e-10);
        }
}

TEST(jacobi, rows_are_at_right_angles)
{
    double g[N][N], v[N][N] = { { 0 } };

    make_symmetric(g);
    fap_jacobi(g[0], v[0], N);
    for (int a = 0; a < N; a++)
        for (int b = 0; b < N; b++) {
            double sum = 0;
            for (int i = 0; i < N; i++)
                sum += v[a][i] * v[b][i];
            assert_true(fabs(sum - (a == b)) < 1e-12);
        }
}

TEST(jacobi, nothing_stays_nothing)
{
    double g[4] = { 0 }, v[4] = { 0 };

    fap_jacobi(g, v, 2);
    assert_true(g[0] == 0 && g[3] == 0 && v[0] == 1 && v[3] == 1);
}
