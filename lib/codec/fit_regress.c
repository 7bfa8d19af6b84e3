/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fit_regress.h. Forward stepwise regression on the normal equations, L D L^T grown a row at a time, then
 * Lawson's weights towards the smallest largest error. + - * / alone: the same on every machine.
 * Source: C. L. Lawson, Contributions to the theory of linear least maximum approximation, 1961.
 */
#include <string.h>

#include "codec/fit_regress.h"

enum { LAWSON_ROUNDS = 12, MOST_DIGITS = 9 };

static const double dependent = 1e-8; /* of a feature's energy: what is left of it is rounding */
static const double hopeless = 4;     /* times the bound: weights do not bring that down */

static double size_of(double v)
{
    return v < 0 ? -v : v;
}

static double feature_at(const fit_data *d, int feature, size_t row)
{
    if (!feature)
        return 1;
    const double v = d->source[(size_t)((feature - 1) / 2) * d->rows + row];
    return feature % 2 ? v : v * v;
}

/* --- sums --- */

static void add_row(fit_data *d, size_t row, int features)
{
    double x[FIT_FEATURES];

    for (int i = 0; i < features; i++)
        x[i] = feature_at(d, i, row);
    for (int i = 0; i < features; i++)
        for (int j = 0; j <= i; j++)
            d->gram[i][j] += x[i] * x[j];
    for (int c = 0; c < d->columns; c++) {
        const double v = d->value[(size_t)c * d->rows + row];
        d->energy[c] += v * v;
        for (int i = 0; i < features; i++)
            d->cross[c][i] += v * x[i];
    }
}

void fap_fit_sum(fit_data *d)
{
    const int features = 1 + 2 * d->columns;

    for (size_t row = 0; row < d->rows; row++)
        add_row(d, row, features);
    for (int i = 0; i < features; i++)
        for (int j = 0; j < i; j++)
            d->gram[j][i] = d->gram[i][j];
}

/* --- normal equations --- */

/* gram = L D L^T over the features taken so far; part = D^-1 L^-1 cross. */
typedef struct fit_system {
    int count;
    double l[FIT_FORMULA_MAX][FIT_FORMULA_MAX], d[FIT_FORMULA_MAX], part[FIT_FORMULA_MAX];
} fit_system;

/* Adds a feature by its row of the normal equations: products with those before it, with itself, with the target.
 * Gives by how much the squared error falls; 0 where the feature follows from the others. */
static double extend(fit_system *s, const double *products, double own, double cross)
{
    double *const l = s->l[s->count];
    double left = own;

    for (int i = 0; i < s->count; i++) {
        double v = products[i];
        for (int j = 0; j < i; j++)
            v -= l[j] * s->d[j] * s->l[i][j];
        l[i] = v / s->d[i];
        left -= l[i] * l[i] * s->d[i];
        cross -= l[i] * s->d[i] * s->part[i];
    }
    if (!(left > dependent * own))
        return 0;
    s->d[s->count] = left;
    s->part[s->count++] = cross / left;
    return cross * cross / left;
}

static void solve(const fit_system *s, double *coefficient)
{
    for (int i = s->count - 1; i >= 0; i--) {
        coefficient[i] = s->part[i];
        for (int j = i + 1; j < s->count; j++)
            coefficient[i] -= s->l[j][i] * coefficient[j];
    }
}

/* Adds a feature to those in @p taken. */
static double extend_by_feature(const fit_data *d, fit_system *s, int column, const uint8_t *taken,
                                int feature)
{
    double products[FIT_FORMULA_MAX];

    for (int i = 0; i < s->count; i++)
        products[i] = d->gram[feature][taken[i]];
    return extend(s, products, d->gram[feature][feature], d->cross[column][feature]);
}

/* --- errors --- */

static double error_at(const fit_data *d, int column, const fit_formula *f, const double *coefficient,
                       size_t row)
{
    double v = 0;
    for (int i = 0; i < f->terms; i++)
        v += coefficient[i] * feature_at(d, f->feature[i], row);
    return v - d->value[(size_t)column * d->rows + row];
}

/* How many rows miss by more than the bound; early enough when they are too many. */
static int holds(const fit_data *d, int column, const fit_formula *f, const double *coefficient)
{
    size_t misses = 0;

    /* The decoder rounds: half a unit is as good as none. */
    for (size_t row = 0; row < d->rows && misses <= d->exceptions; row++)
        misses += size_of(error_at(d, column, f, coefficient, row)) >= d->bound[column] + 0.5;
    return misses <= d->exceptions;
}

/* Weights grow where it errs most. Gives the largest error, and whether the bound holds. */
static int reweight(fit_data *d, int column, const fit_formula *f, const double *coefficient, double *largest)
{
    size_t misses = 0;
    double sum = 0;

    *largest = 0;
    for (size_t row = 0; row < d->rows; row++) {
        const double e = size_of(error_at(d, column, f, coefficient, row));
        *largest = e > *largest ? e : *largest;
        misses += e >= d->bound[column] + 0.5;
        d->weight[row] *= e;
        sum += d->weight[row];
    }
    for (size_t row = 0; sum > 0 && row < d->rows; row++)
        d->weight[row] *= (double)d->rows / sum;
    return misses <= d->exceptions;
}

/* Least squares again, with the weights. 0: the features depend on each other now. */
static int solve_weighted(const fit_data *d, int column, const fit_formula *f, double *coefficient)
{
    double gram[FIT_FORMULA_MAX][FIT_FORMULA_MAX] = { { 0 } }, cross[FIT_FORMULA_MAX] = { 0 };
    fit_system s = { 0 };

    for (size_t row = 0; row < d->rows; row++) {
        double x[FIT_FORMULA_MAX];
        for (int i = 0; i < f->terms; i++) {
            x[i] = feature_at(d, f->feature[i], row);
            const double weighted = d->weight[row] * x[i];
            for (int j = 0; j <= i; j++)
                gram[i][j] += weighted * x[j];
            cross[i] += weighted * d->value[(size_t)column * d->rows + row];
        }
    }
    for (int i = 0; i < f->terms; i++) {
        extend(&s, gram[i], gram[i][i], cross[i]);
        if (s.count != i + 1)
            return 0;
    }
    solve(&s, coefficient);
    return 1;
}

/* 1: the bound holds, perhaps with other coefficients than those of least squares. */
static int refine(fit_data *d, int column, const fit_formula *f, double *coefficient)
{
    double largest;

    for (size_t row = 0; row < d->rows; row++)
        d->weight[row] = 1;
    for (int round = 0; round < LAWSON_ROUNDS; round++) {
        if (reweight(d, column, f, coefficient, &largest))
            return 1;
        if (largest > hopeless * (d->bound[column] + 0.5) && !d->exceptions)
            return 0;
        if (!solve_weighted(d, column, f, coefficient))
            return 0;
    }
    return holds(d, column, f, coefficient);
}

/* --- digits --- */

static double largest_feature(const fit_data *d, int feature)
{
    double largest = 0;
    for (size_t row = 0; row < d->rows; row++) {
        const double v = size_of(feature_at(d, feature, row));
        largest = v > largest ? v : largest;
    }
    return largest;
}

/* The fewest digits that change no value by more than @p allowed. 0: out of range. */
static int shorten(double coefficient, double largest, double allowed, fit_number *n)
{
    for (int digits = 1; digits <= MOST_DIGITS; digits++) {
        if (!fap_fit_round(coefficient, digits, n))
            continue;
        if (size_of(fap_fit_value(*n) - coefficient) * largest <= allowed)
            return 1;
    }
    return fap_fit_round(coefficient, MOST_DIGITS, n);
}

/* Coefficients in decimal, and checked again as they are now. */
static int write_down(const fit_data *d, int column, fit_formula *f, const double *coefficient,
                      double allowed)
{
    double rounded[FIT_FORMULA_MAX];

    for (int i = 0; i < f->terms; i++) {
        if (!shorten(coefficient[i], largest_feature(d, f->feature[i]), allowed, &f->coefficient[i]))
            return 0;
        rounded[i] = fap_fit_value(f->coefficient[i]);
    }
    return holds(d, column, f, rounded);
}

static int finish(fit_data *d, int column, const fit_system *s, fit_formula *f)
{
    double coefficient[FIT_FORMULA_MAX];

    solve(s, coefficient);
    if (!refine(d, column, f, coefficient))
        return 0;
    for (double share = 0.2; share > 1e-4; share /= 8)
        if (write_down(d, column, f, coefficient, share * (d->bound[column] + 0.5)))
            return 1;
    return 0;
}

/* --- stepwise --- */

static int is_allowed(int feature, const uint8_t *allowed)
{
    return !feature || allowed[(feature - 1) / 2];
}

static int is_taken(const fit_formula *f, int feature)
{
    return memchr(f->feature, feature, (size_t)f->terms) != NULL;
}

/* The feature that helps most; -1: none does. */
static int best_feature(const fit_data *d, fit_system *s, int column, const uint8_t *allowed,
                        const fit_formula *f)
{
    double most = 0;
    int best = -1;

    for (int feature = 0; feature < 1 + 2 * d->columns; feature++) {
        if (!is_allowed(feature, allowed) || is_taken(f, feature))
            continue;
        const double gain = extend_by_feature(d, s, column, f->feature, feature);
        s->count = f->terms; /* only tried */
        if (gain > most) {
            most = gain;
            best = feature;
        }
    }
    return best;
}

/* Rows that may miss say nothing about the mean: it is no reason to stop then. */
static int may_hold(const fit_data *d, double energy, int column)
{
    const double bound = d->bound[column] + 0.5;
    return d->exceptions || energy <= bound * bound * (double)d->rows;
}

int fap_fit_find(fit_data *d, int column, const uint8_t allowed[FIT_MAX_COLUMNS], int terms, fit_formula *out)
{
    fit_system s = { 0 };
    double energy = d->energy[column];

    *out = (fit_formula){ 0 };
    for (;;) {
        if (may_hold(d, energy, column) && finish(d, column, &s, out))
            return 1;
        if (out->terms == terms)
            return 0;
        const int feature = best_feature(d, &s, column, allowed, out);
        if (feature < 0)
            return 0;
        energy -= extend_by_feature(d, &s, column, out->feature, feature);
        out->feature[out->terms++] = (uint8_t)feature;
    }
}
