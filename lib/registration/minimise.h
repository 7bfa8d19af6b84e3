/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Two ways to the lowest place of a function: the downhill simplex, which asks for values alone (Nelder, Mead 1965), and
 * L-BFGS, which asks for gradients too and learns the curvature on the way (Nocedal 1980). Both only ever go down, take no step
 * longer than allowed, and give the same answer each time.
 */
#ifndef LIB_REGISTRATION_MINIMISE_H
#define LIB_REGISTRATION_MINIMISE_H

#include <stddef.h>

#include <fap/alloc.h>
#include <fap/error.h>

/* Value at @p x; @p gradient may be NULL. INFINITY: nobody may be there. */
typedef double (*minimise_value)(void *user, const double *x, double *gradient);

/* --- L-BFGS --- */

typedef struct lbfgs lbfgs;

fap_err lbfgs_open(lbfgs **out, size_t size, const fap_allocator *alloc);
void lbfgs_close(lbfgs **l);

typedef struct lbfgs_task {
    minimise_value value;
    void *user;
    int iterations;   /* at most */
    double most_step; /* of any unknown at once */
    double enough;    /* ends when a step gains less than this share of the value */
} lbfgs_task;
/* @p x: in, where to begin; out, the answer. What was learned is kept for the next run. Returns the value. */
double lbfgs_run(lbfgs *l, const lbfgs_task *task, double *x);

/* --- downhill simplex --- */

enum { SIMPLEX_MAX = 16 };

typedef struct simplex_task {
    minimise_value value; /* its gradient is NULL */
    void *user;
    int size;      /* unknowns, at most SIMPLEX_MAX */
    double edge;   /* of the first simplex */
    double enough; /* ends when all corners are this near the best */
    int values;    /* at most */
} simplex_task;
/* The same. */
double simplex_run(const simplex_task *task, double *x);

#endif
