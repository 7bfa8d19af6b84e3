/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Exact box-bounded least squares: minimise x'Gx/2 - g'x for lo <= x <= hi, G symmetric positive definite.
 * The minimum is unique and moves continuously with g, so neighbouring frames get neighbouring weights
 * without any memory of each other.
 */
#ifndef LIB_BANK_QP_H
#define LIB_BANK_QP_H

#include <fap/alloc.h>

typedef struct fap_qp {
    int n;                    /* variables of this problem, at most capacity */
    int capacity;             /* a multiple of FAP_LANES */
    double *gram;             /* [n][capacity], both triangles */
    double *linear, *lo, *hi; /* [n] */
    double *x;                /* [n], the answer */
    double *slope, *step;     /* work: the gradient at x; the way to the free minimum */
    double *factor;           /* work: Cholesky factor of the free part */
    int *free_index;          /* work: which variables are free */
    signed char *bound;       /* -1 at lo, 1 at hi, 0 free */
    void *block;
} fap_qp;

/* Non-zero: no memory. @p capacity is rounded up. */
int fap_qp_open(fap_qp *qp, int capacity, const fap_allocator *alloc);
void fap_qp_close(fap_qp *qp, const fap_allocator *alloc);
/* An empty problem of @p n variables: G, g and bounds zero. */
void fap_qp_clear(fap_qp *qp, int n);
void fap_qp_solve(fap_qp *qp);

#endif
