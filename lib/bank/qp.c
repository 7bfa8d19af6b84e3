/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Coordinate descent finds which bounds hold in a few cheap sweeps; a primal active set method, one Cholesky
 * factor a step, then makes the answer exact. Both are bounded in steps. Source: Nocedal & Wright, Numerical
 * Optimization, section 16.5 (active set methods for convex quadratic programs).
 */
#include <math.h>
#include <string.h>

#include "base/lanes.h"
#include "base/mem.h"
#include "bank/qp.h"

enum { SWEEPS = 12, STEPS_PER_VARIABLE = 3 };
static const double tolerance = 1e-10;

int fap_qp_open(fap_qp *qp, int capacity, const fap_allocator *alloc)
{
    const size_t n = (size_t)fap_lanes_padded(capacity), doubles = 2 * n * n + 6 * n;

    memset(qp, 0, sizeof *qp);
    qp->block = fap_mem_calloc(alloc, doubles * sizeof(double) + n * (sizeof(int) + 1), 1);
    if (!qp->block)
        return 1;
    double *p = qp->block;
    qp->capacity = (int)n;
    qp->gram = p;
    qp->factor = p + n * n;
    p += 2 * n * n;
    qp->linear = p;
    qp->lo = p + n;
    qp->hi = p + 2 * n;
    qp->x = p + 3 * n;
    qp->slope = p + 4 * n;
    qp->step = p + 5 * n;
    qp->free_index = (int *)(p + 6 * n);
    qp->bound = (signed char *)(qp->free_index + n);
    return 0;
}

void fap_qp_close(fap_qp *qp, const fap_allocator *alloc)
{
    fap_mem_free(alloc, qp->block);
    memset(qp, 0, sizeof *qp);
}

void fap_qp_clear(fap_qp *qp, int n)
{
    qp->n = n;
    memset(qp->gram, 0, sizeof *qp->gram * (size_t)n * (size_t)qp->capacity);
    memset(qp->linear, 0, sizeof *qp->linear * (size_t)n);
    memset(qp->lo, 0, sizeof *qp->lo * (size_t)n);
    memset(qp->hi, 0, sizeof *qp->hi * (size_t)n);
}

static double clamp(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

static const double *row(const fap_qp *qp, int i)
{
    return qp->gram + (size_t)i * (size_t)qp->capacity;
}

/* slope += by * the i-th row of G, which past n is 0. */
static void tilt(fap_qp *qp, int i, double by)
{
    const double *restrict g = row(qp, i);
    double *restrict slope = qp->slope;

    for (int j = 0; j < qp->n; j += FAP_LANES)
        for (int k = 0; k < FAP_LANES; k++)
            slope[j + k] += by * g[j + k];
}

static void move(fap_qp *qp, int i, double by)
{
    qp->x[i] += by;
    tilt(qp, i, by);
}

static void start(fap_qp *qp)
{
    memset(qp->slope, 0, sizeof *qp->slope * (size_t)qp->capacity);
    for (int i = 0; i < qp->n; i++) {
        qp->slope[i] -= qp->linear[i];
        qp->x[i] = clamp(0, qp->lo[i], qp->hi[i]);
    }
    for (int i = 0; i < qp->n; i++)
        if (qp->x[i] != 0)
            tilt(qp, i, qp->x[i]);
}

/* One pass over the variables; returns the largest move. */
static double sweep(fap_qp *qp)
{
    double largest = 0;

    for (int i = 0; i < qp->n; i++) {
        const double to = clamp(qp->x[i] - qp->slope[i] / row(qp, i)[i], qp->lo[i], qp->hi[i]);
        const double by = to - qp->x[i];
        if (by == 0)
            continue;
        move(qp, i, by);
        largest = fmax(largest, fabs(by));
    }
    return largest;
}

static void note_bounds(fap_qp *qp)
{
    for (int i = 0; i < qp->n; i++) {
        const int low = qp->x[i] <= qp->lo[i] && qp->slope[i] >= 0;
        const int high = qp->x[i] >= qp->hi[i] && qp->slope[i] <= 0;
        qp->bound[i] = (signed char)(low ? -1 : high);
    }
}

static int list_free(fap_qp *qp)
{
    int count = 0;

    for (int i = 0; i < qp->n; i++)
        if (!qp->bound[i])
            qp->free_index[count++] = i;
    return count;
}

/* Lower Cholesky factor of the free rows and columns of G. 0: G is not positive definite there. */
static int factorise(fap_qp *qp, int m)
{
    for (int i = 0; i < m; i++) {
        const double *g = row(qp, qp->free_index[i]);
        double *li = qp->factor + (size_t)i * (size_t)m;
        for (int j = 0; j <= i; j++) {
            const double *lj = qp->factor + (size_t)j * (size_t)m;
            double sum = g[qp->free_index[j]];
            for (int k = 0; k < j; k++)
                sum -= li[k] * lj[k];
            if (i == j && !(sum > 0))
                return 0;
            li[j] = i == j ? sqrt(sum) : sum / lj[j];
        }
    }
    return 1;
}

/* step = -(free G)^-1 * free slope */
static void back_substitute(fap_qp *qp, int m)
{
    double *s = qp->step;

    for (int i = 0; i < m; i++) {
        const double *l = qp->factor + (size_t)i * (size_t)m;
        s[i] = -qp->slope[qp->free_index[i]];
        for (int k = 0; k < i; k++)
            s[i] -= l[k] * s[k];
        s[i] /= l[i];
    }
    for (int i = m - 1; i >= 0; i--) {
        for (int k = i + 1; k < m; k++)
            s[i] -= qp->factor[(size_t)k * (size_t)m + (size_t)i] * s[k];
        s[i] /= qp->factor[(size_t)i * (size_t)m + (size_t)i];
    }
}

/* How much of the step fits into the box, and which free variable stops it; -1: none. */
static double room(const fap_qp *qp, int m, int *stops)
{
    double share = 1;

    *stops = -1;
    for (int f = 0; f < m; f++) {
        const int i = qp->free_index[f];
        const double to = qp->x[i] + qp->step[f], limit = clamp(to, qp->lo[i], qp->hi[i]);
        if (limit == to)
            continue;
        const double fits = (limit - qp->x[i]) / qp->step[f];
        if (fits < share || *stops < 0) {
            share = fits < share ? fits : share;
            *stops = f;
        }
    }
    return share;
}

/* Go to the minimum over the free variables, or as far as the box allows. 1: arrived. */
static int advance(fap_qp *qp)
{
    const int m = list_free(qp);
    if (!m || !factorise(qp, m))
        return 1;
    back_substitute(qp, m);
    int stops;
    const double share = room(qp, m, &stops);
    for (int f = 0; f < m; f++)
        move(qp, qp->free_index[f], share * qp->step[f]);
    if (stops < 0)
        return 1;
    const int i = qp->free_index[stops];
    const int high = qp->step[stops] > 0;
    qp->bound[i] = high ? 1 : -1;
    qp->x[i] = high ? qp->hi[i] : qp->lo[i];
    return 0;
}

/* Free the variable that most wants to leave its bound. 0: none does, the answer is exact. */
static int release(fap_qp *qp)
{
    double worst = tolerance;
    int which = -1;

    for (int i = 0; i < qp->n; i++) {
        if (!qp->bound[i] || qp->lo[i] >= qp->hi[i])
            continue;
        const double pull = (qp->slope[i] * qp->bound[i]) / sqrt(row(qp, i)[i]);
        if (pull > worst) {
            worst = pull;
            which = i;
        }
    }
    if (which >= 0)
        qp->bound[which] = 0;
    return which >= 0;
}

void fap_qp_solve(fap_qp *qp)
{
    start(qp);
    for (int i = 0; i < SWEEPS && sweep(qp) > tolerance; i++)
        ;
    note_bounds(qp);
    for (int left = STEPS_PER_VARIABLE * qp->n + 10; left > 0; left--)
        if (advance(qp) && !release(qp))
            break;
    for (int i = 0; i < qp->n; i++)
        qp->x[i] = clamp(qp->x[i], qp->lo[i], qp->hi[i]);
}
