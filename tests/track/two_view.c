/* SPDX-License-Identifier: BSD-2-Clause */
/* See two_view.h. */
#include <math.h>
#include <string.h>

#include "two_view.h"
#include "track/vector.h"

enum { N = 9 };

/* --- eigenvectors (Jacobi 1846) --- */

/* Turns axes p and q of a symmetric matrix so that a[p][q] becomes 0; @v keeps the turned axes as columns. */
static void turn_axes(double a[N][N], double v[N][N], int n, int p, int q)
{
    const double half = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = (half < 0 ? -1 : 1) / (fabs(half) + sqrt(half * half + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;

    for (int k = 0; k < n; k++) {
        const double kp = a[k][p], kq = a[k][q], vp = v[k][p], vq = v[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
        v[k][p] = c * vp - s * vq;
        v[k][q] = s * vp + c * vq;
    }
    for (int k = 0; k < n; k++) {
        const double pk = a[p][k], qk = a[q][k];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
    }
}

/* @a becomes diagonal, the eigenvalues; the columns of @v are the eigenvectors. */
static void eigen(double a[N][N], double v[N][N], int n)
{
    enum { SWEEPS = 30 };

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            v[i][j] = i == j;
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++)
                if (fabs(a[p][q]) > 1e-300)
                    turn_axes(a, v, n, p, q);
}

/* The column of the smallest eigenvalue, or of the largest. */
static int extreme(double a[N][N], int n, int largest)
{
    int best = 0;

    for (int i = 1; i < n; i++)
        if (largest ? a[i][i] > a[best][best] : a[i][i] < a[best][best])
            best = i;
    return best;
}

/* --- eight points --- */

/* x -> scale * (x - middle): about 0, root two away on average. */
typedef struct normaliser {
    double middle[2], scale;
} normaliser;

static void second(const fap_mirror_pair *pair, double ray[2])
{
    ray[0] = -pair->mirrored[0];
    ray[1] = pair->mirrored[1];
}

static void ray_in(const fap_mirror_pair *pair, int view, double ray[2])
{
    if (view)
        second(pair, ray);
    else
        memcpy(ray, pair->direct, sizeof pair->direct);
}

static normaliser normalise(const fap_mirror_pair *pair, int count, int view)
{
    normaliser n = { { 0, 0 }, 0 };
    double sum = 0, ray[2];

    for (int i = 0; i < count; i++) {
        ray_in(&pair[i], view, ray);
        n.middle[0] += ray[0] / count;
        n.middle[1] += ray[1] / count;
    }
    for (int i = 0; i < count; i++) {
        ray_in(&pair[i], view, ray);
        sum += hypot(ray[0] - n.middle[0], ray[1] - n.middle[1]) / count;
    }
    n.scale = sqrt(2) / fmax(sum, 1e-300);
    return n;
}

static void apply(const normaliser *n, const double ray[2], double out[3])
{
    out[0] = n->scale * (ray[0] - n->middle[0]);
    out[1] = n->scale * (ray[1] - n->middle[1]);
    out[2] = 1;
}

/* f becomes b^T f a for the matrices a and b of the normalisers: for rays as they were. */
static void undo(const normaliser *a, const normaliser *b, double f[3][3])
{
    for (int i = 0; i < 3; i++) {
        f[i][2] -= a->scale * (f[i][0] * a->middle[0] + f[i][1] * a->middle[1]);
        f[i][0] *= a->scale;
        f[i][1] *= a->scale;
    }
    for (int j = 0; j < 3; j++) {
        f[2][j] -= b->scale * (f[0][j] * b->middle[0] + f[1][j] * b->middle[1]);
        f[0][j] *= b->scale;
        f[1][j] *= b->scale;
    }
}

/* q^T f p = 0 for all pairs, as nearly as can be. */
static void eight_points(const fap_mirror_pair *pair, int count, double f[3][3])
{
    const normaliser a = normalise(pair, count, 0), b = normalise(pair, count, 1);
    double m[N][N] = { { 0 } }, v[N][N];

    for (int i = 0; i < count; i++) {
        double p[3], q[3], ray[2], row[N];
        second(&pair[i], ray);
        apply(&a, pair[i].direct, p);
        apply(&b, ray, q);
        for (int k = 0; k < N; k++)
            row[k] = q[k / 3] * p[k % 3];
        for (int j = 0; j < N; j++)
            for (int k = 0; k < N; k++)
                m[j][k] += row[j] * row[k];
    }
    eigen(m, v, N);
    const int least = extreme(m, N, 0);
    for (int k = 0; k < N; k++)
        f[k / 3][k % 3] = v[k][least];
    undo(&a, &b, f);
}

/* --- a camera from the matrix --- */

static void times(const double m[3][3], const double x[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = dot3(m[i], x);
}

/* e = u1 v1^T s1 + u2 v2^T s2 + ...: both triples right-handed; the third, nearly empty one as the others leave it. */
static int take_apart(const double e[3][3], double u[3][3], double v[3][3])
{
    double square[N][N] = { { 0 } }, axes[N][N];

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                square[i][j] += e[k][i] * e[k][j];
    eigen(square, axes, 3);
    const int first = extreme(square, 3, 1), last = extreme(square, 3, 0), mid = 3 - first - last;
    if (first == last)
        return 0;
    for (int k = 0; k < 3; k++) {
        v[0][k] = axes[k][first];
        v[1][k] = axes[k][mid];
    }
    cross3(v[0], v[1], v[2]);
    for (int i = 0; i < 2; i++) {
        times(e, v[i], u[i]);
        if (!unit3(u[i]))
            return 0;
    }
    add_scaled3(u[1], u[0], -dot3(u[0], u[1]));
    if (!unit3(u[1]))
        return 0;
    cross3(u[0], u[1], u[2]);
    return 1;
}

/* One of the four cameras: turn = u w v^T with w a quarter turn one way or the other, shift = u3 or -u3. */
static void candidate(const double u[3][3], const double v[3][3], int which, two_view *out)
{
    const double way = which & 1 ? -1 : 1, sign = which & 2 ? -1 : 1;

    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            out->turn[i][j] = way * (u[1][i] * v[0][j] - u[0][i] * v[1][j]) + u[2][i] * v[2][j];
        out->shift[i] = sign * u[2][i];
    }
}

static int before_both(const two_view *v, const fap_mirror_pair *pair, int count)
{
    int before = 0;
    double place[3];

    for (int i = 0; i < count; i++)
        before += two_view_place(v, &pair[i], place);
    return before;
}

int two_view_find(two_view *best, const fap_mirror_pair *pair, int count)
{
    double e[3][3], u[3][3], v[3][3];
    int most = 0;

    if (count < 8)
        return 0;
    eight_points(pair, count, e);
    if (!take_apart((const double(*)[3])e, u, v))
        return 0;
    for (int i = 0; i < 4; i++) {
        two_view one;
        candidate((const double(*)[3])u, (const double(*)[3])v, i, &one);
        const int before = before_both(&one, pair, count);
        if (before <= most)
            continue;
        most = before;
        *best = one;
    }
    return most > 0;
}

/* s (turn p) + shift is to be t q: the two points nearest to each other, and what is midway. */
int two_view_place(const two_view *v, const fap_mirror_pair *pair, double place[3])
{
    const double p[3] = { pair->direct[0], pair->direct[1], 1 };
    double a[3], ray[2];

    second(pair, ray);
    const double q[3] = { ray[0], ray[1], 1 };
    times((const double(*)[3])v->turn, p, a);
    const double aa = dot3(a, a), aq = dot3(a, q), qq = dot3(q, q), det = aa * qq - aq * aq;
    const double as = dot3(a, v->shift), qs = dot3(q, v->shift);
    if (!(det > 1e-12 * aa * qq))
        return 0;
    const double s = (aq * qs - qq * as) / det, t = (aa * qs - aq * as) / det;
    double other[3];
    for (int k = 0; k < 3; k++)
        other[k] = t * q[k] - v->shift[k];
    for (int k = 0; k < 3; k++) /* turned back: the turn's columns */
        place[k] =
            (s * p[k] + v->turn[0][k] * other[0] + v->turn[1][k] * other[1] + v->turn[2][k] * other[2]) / 2;
    return s > 0 && t > 0;
}
