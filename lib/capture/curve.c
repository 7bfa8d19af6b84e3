/* SPDX-License-Identifier: BSD-2-Clause */
/* See curve.h. */
#include <math.h>
#include <string.h>

#include "capture/curve.h"

/* What a sample is trusted to, as a share of the signal's variance: keeps near samples from fighting. */
static const double noise = 1e-4;

static int trend_terms(const curve *c)
{
    return c->kind == CURVE_REMAINDER ? 0 : c->count > 1 ? 2 : 1;
}

static double covariance(const curve *c, double distance)
{
    const double d = fabs(distance) / c->reach, a = sqrt(3) * d, b = sqrt(5) * d;
    return c->kind == CURVE_REMAINDER ? (1 + a) * exp(-a) : (1 + b + b * b / 3) * exp(-b);
}

static double trend(const curve *c, int term, double t)
{
    return term ? (t - c->middle) / c->reach : 1;
}

typedef struct linear_system {
    int size;
    double row[CURVE_TERMS][CURVE_TERMS + 3];
} linear_system;

static void set_up(const curve *c, const double (*v)[3], linear_system *s)
{
    memset(s, 0, sizeof *s);
    s->size = c->count + trend_terms(c);
    for (int i = 0; i < c->count; i++) {
        for (int k = 0; k < c->count; k++)
            s->row[i][k] = covariance(c, c->at[i] - c->at[k]) + (i == k ? noise : 0);
        for (int k = c->count; k < s->size; k++)
            s->row[i][k] = s->row[k][i] = trend(c, k - c->count, c->at[i]);
        for (int axis = 0; axis < 3; axis++)
            s->row[i][s->size + axis] = v[i][axis];
    }
}

static void swap_rows(linear_system *s, int a, int b)
{
    double kept[CURVE_TERMS + 3];

    memcpy(kept, s->row[a], sizeof kept);
    memcpy(s->row[a], s->row[b], sizeof kept);
    memcpy(s->row[b], kept, sizeof kept);
}

/* Gauss and Jordan with row pivots: with a trend the matrix is not definite. */
static int solve(linear_system *s)
{
    for (int c = 0; c < s->size; c++) {
        int pivot = c;
        for (int r = c + 1; r < s->size; r++)
            if (fabs(s->row[r][c]) > fabs(s->row[pivot][c]))
                pivot = r;
        if (!(fabs(s->row[pivot][c]) > 1e-12))
            return 0;
        swap_rows(s, c, pivot);
        for (int r = 0; r < s->size; r++) {
            const double f = r == c ? 0 : s->row[r][c] / s->row[c][c];
            for (int k = c; f != 0 && k < s->size + 3; k++)
                s->row[r][k] -= f * s->row[c][k];
        }
    }
    return 1;
}

int curve_fit(curve *c, curve_kind kind, double reach, const double *t, const double (*v)[3], int count)
{
    linear_system s;

    *c = (curve){ .kind = kind, .count = count, .reach = reach };
    if (count < 1)
        return 0;
    memcpy(c->at, t, (size_t)count * sizeof *t);
    c->middle = 0.5 * (t[0] + t[count - 1]);
    set_up(c, v, &s);
    if (!solve(&s))
        return 0;
    for (int i = 0; i < s.size; i++)
        for (int axis = 0; axis < 3; axis++)
            c->weight[i][axis] = s.row[i][s.size + axis] / s.row[i][i];
    return 1;
}

void curve_value(const curve *c, double t, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < c->count + trend_terms(c); i++) {
        const double w = i < c->count ? covariance(c, t - c->at[i]) : trend(c, i - c->count, t);
        for (int axis = 0; axis < 3; axis++)
            out[axis] += w * c->weight[i][axis];
    }
}
