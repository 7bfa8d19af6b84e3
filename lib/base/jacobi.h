/* SPDX-License-Identifier: BSD-2-Clause */
/* Eigenvectors of small symmetric matrices. Source: Golub & Van Loan, Matrix Computations, section 8.5. */
#ifndef LIB_BASE_JACOBI_H
#define LIB_BASE_JACOBI_H

#include <stddef.h>

/*
 * Cyclic Jacobi rotations: @p g, n x n, becomes diagonal, its eigenvalues in no order; row i of @p v, zeroed before,
 * the unit eigenvector of g[i][i]. The work grows with the cube of n.
 */
void fap_jacobi(double *g, double *v, size_t n);

#endif
