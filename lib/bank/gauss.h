/* SPDX-License-Identifier: BSD-2-Clause */
/* Small dense systems of linear equations, some of which may be the same equation twice. */
#ifndef LIB_BANK_GAUSS_H
#define LIB_BANK_GAUSS_H

#include <stddef.h>

enum { FAP_GAUSS_MAX = 128 };

/*
 * Solves a x = b; row i of @p a has n numbers and b[i] behind them. An unknown that finds no pivot of at least
 * @p least is 0. @p a is destroyed. @p n up to FAP_GAUSS_MAX.
 */
void fap_gauss_solve(double *a, size_t stride, int n, double least, double *x);

#endif
