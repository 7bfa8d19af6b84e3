/* SPDX-License-Identifier: BSD-2-Clause */
/* Gauss with partial pivoting: n is a few dozen, and rows that are left over do no harm. */
#include <math.h>

#include "bank/gauss.h"

enum { BLOCK = 4 };

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

/* row -= f * pivot, from @p first to @p last; blocks, which compilers turn into vectors, and what is left over. */
static void subtract(double *restrict row, const double *restrict pivot, double f, int first, int last)
{
    int k = first;

    for (; k + BLOCK <= last + 1; k += BLOCK)
        for (int i = 0; i < BLOCK; i++)
            row[k + i] -= f * pivot[k + i];
    for (; k <= last; k++)
        row[k] -= f * pivot[k];
}

static void clear_below(double *a, size_t stride, int n, int column, int pivot)
{
    const double *p = a + (size_t)pivot * stride, inverse = 1 / p[column];

    for (int i = pivot + 1; i < n; i++) {
        double *row = a + (size_t)i * stride;
        if (row[column] != 0)
            subtract(row, p, row[column] * inverse, column, n);
    }
}

/* Unknowns without a pivot are 0 and drop out of the rows above. */
static double solve_row(const double *row, int column, int n, const double *x)
{
    double sum = row[n];

    for (int c = column + 1; c < n; c++)
        sum -= row[c] * x[c];
    return sum / row[column];
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
        clear_below(a, stride, n, c, used);
        pivot_row[c] = used++;
    }
    for (int c = n; c-- > 0;)
        x[c] = pivot_row[c] < 0 ? 0 : solve_row(a + (size_t)pivot_row[c] * stride, c, n, x);
}
