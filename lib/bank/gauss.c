/* SPDX-License-Identifier: BSD-2-Clause */
/* Gauss and Jordan with partial pivoting: n is a few dozen, and rows that are left over do no harm. */
#include <math.h>

#include "bank/gauss.h"

static void swap_rows(double *a, double *b, int n)
{
    for (int i = 0; i <= n; i++) {
        const double t = a[i];
        a[i] = b[i];
        b[i] = t;
    }
}

static int largest_in_column(const double *a, size_t stride, int column, int from, int n)
{
    int best = from;

    for (int i = from + 1; i < n; i++)
        if (fabs(a[(size_t)i * stride + (size_t)column]) > fabs(a[(size_t)best * stride + (size_t)column]))
            best = i;
    return best;
}

/* Subtracts the pivot's row from all others. */
static void clear_column(double *a, size_t stride, int n, int column, int pivot)
{
    const double *p = a + (size_t)pivot * stride;

    for (int i = 0; i < n; i++) {
        double *row = a + (size_t)i * stride;
        const double f = i == pivot ? 0 : row[column] / p[column];
        for (int k = column; k <= n && f != 0; k++)
            row[k] -= f * p[k];
    }
}

void fap_gauss_solve(double *a, size_t stride, int n, double least, double *x)
{
    int pivot_row[FAP_GAUSS_MAX], used = 0;

    for (int c = 0; c < n; c++) {
        pivot_row[c] = -1;
        if (used >= n)
            continue;
        const int best = largest_in_column(a, stride, c, used, n);
        if (fabs(a[(size_t)best * stride + (size_t)c]) < least)
            continue;
        swap_rows(a + (size_t)used * stride, a + (size_t)best * stride, n);
        clear_column(a, stride, n, c, used);
        pivot_row[c] = used++;
    }
    for (int c = 0; c < n; c++) {
        const double *row = pivot_row[c] < 0 ? NULL : a + (size_t)pivot_row[c] * stride;
        x[c] = row ? row[n] / row[c] : 0;
    }
}
