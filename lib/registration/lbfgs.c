/* SPDX-License-Identifier: BSD-2-Clause */
/* See minimise.h. Memory is taken once; a step is shortened until the value falls (Armijo 1966). */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/mem.h"
#include "registration/minimise.h"

enum { PAIRS = 8, SHORTENED_MOST = 12 };

static const double falls = 1e-4; /* of what the slope promises */

struct lbfgs {
    fap_allocator alloc;
    size_t size;
    int count, newest; /* of the pairs */
    double *step[PAIRS], *turn[PAIRS],
        share[PAIRS]; /* x and gradient between two places; 1 / (step . turn) */
    double *gradient, *way, *next, *next_gradient;
};

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void add(double *out, const double *a, double by, size_t n)
{
    for (size_t i = 0; i < n; i++)
        out[i] += by * a[i];
}

fap_err lbfgs_open(lbfgs **out, size_t size, const fap_allocator *alloc)
{
    lbfgs *l = fap_mem_calloc(alloc, 1, sizeof *l);
    double *block = l && size <= SIZE_MAX / (2 * PAIRS + 4)
                        ? fap_mem_calloc(alloc, (2 * PAIRS + 4) * size, sizeof *block)
                        : NULL;

    *out = block ? l : NULL;
    if (!block) {
        fap_mem_free(alloc, l);
        return FAP_E_NOMEM;
    }
    *l = (lbfgs){ .alloc = *alloc, .size = size };
    l->gradient = block;
    l->way = block + size;
    l->next = block + 2 * size;
    l->next_gradient = block + 3 * size;
    for (size_t i = 0; i < PAIRS; i++) {
        l->step[i] = block + (4 + 2 * i) * size;
        l->turn[i] = block + (5 + 2 * i) * size;
    }
    return FAP_OK;
}

void lbfgs_close(lbfgs **l)
{
    if (!*l)
        return;
    const fap_allocator alloc = (*l)->alloc;
    fap_mem_free(&alloc, (*l)->gradient);
    fap_mem_free(&alloc, *l);
    *l = NULL;
}

static int pair_before(const lbfgs *l, int back)
{
    return (l->newest - back + PAIRS) % PAIRS;
}

/* way = -(inverse Hessian as the pairs know it) gradient, by the two loops of Nocedal. */
static void find_way(lbfgs *l)
{
    double part[PAIRS];

    for (size_t i = 0; i < l->size; i++)
        l->way[i] = -l->gradient[i];
    for (int back = 0; back < l->count; back++) {
        const int k = pair_before(l, back);
        part[k] = l->share[k] * dot(l->step[k], l->way, l->size);
        add(l->way, l->turn[k], -part[k], l->size);
    }
    if (l->count) {
        const double *turn = l->turn[l->newest];
        const double scale = 1 / (l->share[l->newest] * dot(turn, turn, l->size));
        for (size_t i = 0; i < l->size; i++)
            l->way[i] *= scale;
    }
    for (int back = l->count - 1; back >= 0; back--) {
        const int k = pair_before(l, back);
        add(l->way, l->step[k], part[k] - l->share[k] * dot(l->turn[k], l->way, l->size), l->size);
    }
}

/* Nothing known: the first step is as long as allowed; later ones are shortened to that. */
static void bound_way(lbfgs *l, double most)
{
    double longest = 0;

    for (size_t i = 0; i < l->size; i++)
        longest = fmax(longest, fabs(l->way[i]));
    const double by = longest > 0 && (longest > most || !l->count) ? most / longest : 1;
    for (size_t i = 0; i < l->size; i++)
        l->way[i] *= by;
}

static void learn(lbfgs *l, const double *x)
{
    const int k = (l->newest + 1) % PAIRS;

    for (size_t i = 0; i < l->size; i++) {
        l->step[k][i] = l->next[i] - x[i];
        l->turn[k][i] = l->next_gradient[i] - l->gradient[i];
    }
    const double curve = dot(l->step[k], l->turn[k], l->size);
    if (!(curve > 1e-12 * dot(l->turn[k], l->turn[k], l->size)))
        return; /* bent the other way: nothing to learn */
    l->share[k] = 1 / curve;
    l->newest = k;
    l->count += l->count < PAIRS;
}

/* One step down from @p value; returns the new value, or the old one where no step is low enough. */
static double go_down(lbfgs *l, const lbfgs_task *task, double *x, double value)
{
    double slope, length = 1;

    find_way(l);
    slope = dot(l->way, l->gradient, l->size);
    if (!(slope < 0)) { /* what was learned misleads */
        l->count = 0;
        find_way(l);
    }
    bound_way(l, task->most_step);
    slope = dot(l->way, l->gradient, l->size);
    for (int i = 0; i < SHORTENED_MOST; i++, length /= 2) {
        memcpy(l->next, x, l->size * sizeof *x);
        add(l->next, l->way, length, l->size);
        const double next = task->value(task->user, l->next, l->next_gradient);
        if (!(next <= value + falls * length * slope))
            continue;
        learn(l, x);
        memcpy(x, l->next, l->size * sizeof *x);
        memcpy(l->gradient, l->next_gradient, l->size * sizeof *x);
        return next;
    }
    return value;
}

double lbfgs_run(lbfgs *l, const lbfgs_task *task, double *x)
{
    double value = task->value(task->user, x, l->gradient);

    for (int i = 0; i < task->iterations && isfinite(value); i++) {
        const double next = go_down(l, task, x, value);
        const double gain = value - next;
        value = next;
        if (gain > task->enough * fabs(value))
            continue;
        if (gain > 0 || !l->count)
            break;
        l->count = 0; /* once more, with nothing learned */
    }
    return value;
}
