/* SPDX-License-Identifier: BSD-2-Clause */
/* See minimise.h. The step sizes are Nelder's and Mead's: 1 to reflect, 2 to expand, 1/2 to contract and to shrink. */
#include <math.h>
#include <string.h>

#include "registration/minimise.h"

typedef struct simplex {
    const simplex_task *task;
    double corner[SIMPLEX_MAX + 1][SIMPLEX_MAX], value[SIMPLEX_MAX + 1];
    int best, worst, second; /* second: worst but one */
    int left;                /* values that may still be asked for */
} simplex;

static double ask(simplex *s, const double *x)
{
    s->left--;
    return s->task->value(s->task->user, x, NULL);
}

static void start(simplex *s, const double *x)
{
    const int n = s->task->size;

    for (int k = 0; k <= n; k++) {
        memcpy(s->corner[k], x, (size_t)n * sizeof *x);
        if (k)
            s->corner[k][k - 1] += s->task->edge;
        s->value[k] = ask(s, s->corner[k]);
    }
}

static void rank(simplex *s)
{
    s->best = s->worst = 0;
    for (int k = 1; k <= s->task->size; k++) {
        if (s->value[k] < s->value[s->best])
            s->best = k;
        if (s->value[k] > s->value[s->worst])
            s->worst = k;
    }
    s->second = s->best;
    for (int k = 0; k <= s->task->size; k++)
        if (k != s->worst && s->value[k] > s->value[s->second])
            s->second = k;
}

/* The worst corner, @p by times as far on the other side of the others' middle; kept where it is better than it was. */
static double try_worst(simplex *s, double by)
{
    const int n = s->task->size;
    double at[SIMPLEX_MAX];

    for (int i = 0; i < n; i++) {
        double middle = 0;
        for (int k = 0; k <= n; k++)
            middle += k != s->worst ? s->corner[k][i] / n : 0;
        at[i] = middle + by * (middle - s->corner[s->worst][i]);
    }
    const double value = ask(s, at);
    if (value < s->value[s->worst]) {
        s->value[s->worst] = value;
        memcpy(s->corner[s->worst], at, (size_t)n * sizeof *at);
    }
    return value;
}

static void shrink(simplex *s)
{
    for (int k = 0; k <= s->task->size; k++) {
        if (k == s->best)
            continue;
        for (int i = 0; i < s->task->size; i++)
            s->corner[k][i] = (s->corner[k][i] + s->corner[s->best][i]) / 2;
        s->value[k] = ask(s, s->corner[k]);
    }
}

static void step(simplex *s)
{
    const double worst = s->value[s->worst], reflected = try_worst(s, 1);

    if (reflected < s->value[s->best])
        try_worst(s, -2); /* seen from where it was reflected to: twice as far out */
    else if (reflected >= s->value[s->second] && try_worst(s, -0.5) >= fmin(worst, reflected))
        shrink(s);
}

static double width(const simplex *s)
{
    double most = 0;

    for (int k = 0; k <= s->task->size; k++)
        for (int i = 0; i < s->task->size; i++)
            most = fmax(most, fabs(s->corner[k][i] - s->corner[s->best][i]));
    return most;
}

double simplex_run(const simplex_task *task, double *x)
{
    simplex s = { .task = task, .left = task->values };

    start(&s, x);
    for (rank(&s); s.left > 0 && width(&s) > task->enough; rank(&s))
        step(&s);
    memcpy(x, s.corner[s.best], (size_t)task->size * sizeof *x);
    return s.value[s.best];
}
