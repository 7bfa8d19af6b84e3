/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See rbf.h. With f(x) = sum a_i phi_i(x) + b p(x) (eq. 13), f(x_j) = d_j (eq. 15) and sum a_i p(x_i) = 0 (eq. 16), the
 * value at x is linear in the d_j: the weights are the solution of the transposed system with phi and p at x on its right.
 */
#include <math.h>
#include <string.h>

#include "bank/gauss.h"
#include "bank/mask.h"
#include "capture/rbf.h"

enum { AFFINE = 4, ROOM = RBF_MOST + AFFINE };

/* Markers on a cheek lie nearly in a plane: the slope across it is anybody's guess, and this keeps it small. */
static const double slope_price = 0.1, least_pivot = 1e-9;
/* More than that, and the mix invents what no marker did. */
static const double most_gain = 2.2;
static const double least_radius_mm = 2, most_radius_mm = 40;

static double distance(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* --- which centres --- */

static int is_across(uint8_t a, uint8_t b)
{
    return a && b && (fap_mask_across(a) & b);
}

static void insert(rbf_mix *m, uint16_t centre, double far)
{
    uint32_t i = m->count < RBF_MOST ? m->count++ : RBF_MOST - 1;

    for (; i && m->distance[i - 1] > far; i--) {
        m->distance[i] = m->distance[i - 1];
        m->centre[i] = m->centre[i - 1];
    }
    m->distance[i] = far;
    m->centre[i] = centre;
}

static void choose(rbf_mix *m, const rbf_centre *centre, uint32_t count, const double at[3], uint8_t side)
{
    m->count = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!centre[i].use || is_across(centre[i].side, side))
            continue;
        const double far = distance(centre[i].at, at);
        if (m->count < RBF_MOST || far < m->distance[RBF_MOST - 1])
            insert(m, (uint16_t)i, far);
    }
}

/* --- the equations --- */

/* Eq. 14: own radius, the distance to the nearest other centre. */
static double radius(const rbf_mix *m, const rbf_centre *centre, uint32_t i)
{
    double least = most_radius_mm;

    for (uint32_t j = 0; j < m->count; j++)
        if (j != i)
            least = fmin(least, distance(centre[m->centre[i]].at, centre[m->centre[j]].at));
    return fmax(least, least_radius_mm);
}

static double inverse_multiquadric(double far, double radius_mm)
{
    return radius_mm / sqrt(far * far + radius_mm * radius_mm);
}

/* The centre as the affine part sees it: from the place asked for, in units of the group's size. */
static void affine(const rbf_centre *c, const double at[3], double size, double out[AFFINE])
{
    out[0] = 1;
    for (int axis = 0; axis < 3; axis++)
        out[1 + axis] = (c->at[axis] - at[axis]) / size;
}

/* @p terms: 1, the mean is kept; 4, slopes too. */
static void solve(rbf_mix *m, const rbf_centre *centre, const double at[3], uint32_t terms)
{
    double a[ROOM][ROOM + 1] = { { 0 } }, x[ROOM], p[AFFINE];
    const uint32_t n = m->count, size = n + terms;

    for (uint32_t i = 0; i < n; i++) {
        const double r = radius(m, centre, i);
        for (uint32_t j = 0; j < n; j++)
            a[i][j] = inverse_multiquadric(distance(centre[m->centre[i]].at, centre[m->centre[j]].at), r);
        a[i][size] = inverse_multiquadric(m->distance[i], r);
        affine(&centre[m->centre[i]], at, fmax(m->distance[n - 1], 1), p);
        for (uint32_t k = 0; k < terms; k++)
            a[i][n + k] = a[n + k][i] = p[k];
    }
    a[n][size] = 1;
    for (uint32_t k = 1; k < terms; k++)
        a[n + k][n + k] = -slope_price;
    fap_gauss_solve(&a[0][0], ROOM + 1, (int)size, least_pivot, x);
    memcpy(m->weight, x, n * sizeof *x);
}

static int is_sane(const rbf_mix *m)
{
    double sum = 0, gain = 0;

    for (uint32_t i = 0; i < m->count; i++) {
        sum += m->weight[i];
        gain += fabs(m->weight[i]);
    }
    return fabs(sum - 1) < 1e-6 && gain <= most_gain;
}

/* Two centres in one place have no solution: nearness decides. */
static void by_nearness(rbf_mix *m)
{
    double sum = 0;

    for (uint32_t i = 0; i < m->count; i++)
        sum += m->weight[i] = 1 / (m->distance[i] * m->distance[i] + 1);
    for (uint32_t i = 0; i < m->count; i++)
        m->weight[i] /= sum;
}

void rbf_mix_at(rbf_mix *out, const rbf_centre *centre, uint32_t count, const double at[3], uint8_t side)
{
    choose(out, centre, count, at, side);
    if (!out->count)
        return;
    if (out->count > AFFINE)
        solve(out, centre, at, AFFINE);
    if (out->count <= AFFINE || !is_sane(out))
        solve(out, centre, at, 1);
    if (!is_sane(out))
        by_nearness(out);
}
