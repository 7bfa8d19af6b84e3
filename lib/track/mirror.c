/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A mirror from pairs of points. A point m, its image m' and the normal u lie in a plane with the lens: p'^T U p = 0 (eq. 8), which
 * says that u is at right angles to p x p'. Rows of M are these products; each is as uncertain as its length and direction make it,
 * so rows are divided by that (Sampson 1982), and pairs that disagree with the best of many pairs of pairs are left out (Fischler
 * and Bolles 1981). Source: Lin, Yeh, Ouhyoung 2001, section 4.1.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <fap/studio/mirror.h>

#include "base/jacobi.h"
#include "track/vector.h"

/* --- one pair and one direction --- */

static void ray3(const double ray[2], double out[3])
{
    out[0] = ray[0];
    out[1] = ray[1];
    out[2] = 1;
}

static void row_of(const fap_mirror_pair *pair, double row[3])
{
    double p[3], q[3];

    ray3(pair->direct, p);
    ray3(pair->mirrored, q);
    cross3(p, q, row);
}

/* How far u . (p x q) moves when p and q do: the length of its gradient by their four coordinates. */
static double uncertainty(const fap_mirror_pair *pair, const double u[3])
{
    double p[3], q[3], by_p[3], by_q[3];

    ray3(pair->direct, p);
    ray3(pair->mirrored, q);
    cross3(q, u, by_p);
    cross3(u, p, by_q);
    return sqrt(by_p[0] * by_p[0] + by_p[1] * by_p[1] + by_q[0] * by_q[0] + by_q[1] * by_q[1]);
}

/* How far the pair would have to move to agree with u, as a ray's error. */
static double error_of(const fap_mirror_pair *pair, const double u[3])
{
    double row[3];

    row_of(pair, row);
    return fabs(dot3(u, row)) / fmax(uncertainty(pair, u), 1e-12);
}

/* --- the direction from many --- */

/* @p value: the eigenvalues, smallest first. */
static void smallest_eigenvector(double m[9], double u[3], double value[3])
{
    double v[9] = { 0 };
    int at = 0;

    fap_jacobi(m, v, 3);
    for (int i = 0; i < 3; i++)
        if (m[4 * i] < m[4 * at])
            at = i;
    memcpy(u, v + 3 * at, 3 * sizeof *u);
    value[0] = m[4 * at];
    value[1] = INFINITY;
    value[2] = 0;
    for (int i = 0; i < 3; i++)
        if (i != at) {
            value[1] = fmin(value[1], m[4 * i]);
            value[2] = fmax(value[2], m[4 * i]);
        }
}

/* Over the pairs nearer than @p limit to @p u, weighted by it. Returns how many. */
static int improve(const fap_mirror_pair *pair, int count, double limit, double u[3], double value[3])
{
    double m[9] = { 0 };
    int used = 0;

    for (int i = 0; i < count; i++) {
        double row[3];
        if (error_of(&pair[i], u) > limit)
            continue;
        row_of(&pair[i], row);
        const double weight = 1 / fmax(uncertainty(&pair[i], u), 1e-12);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                m[3 * r + c] += weight * weight * row[r] * row[c];
        used++;
    }
    if (used >= 2)
        smallest_eigenvector(m, u, value);
    return used;
}

/* --- the best of many guesses --- */

/* A number a step, the same ones each time (xorshift, Marsaglia 2003). */
static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

/* Two pairs make a normal. */
static int guess(const fap_mirror_pair *a, const fap_mirror_pair *b, double u[3])
{
    double ra[3], rb[3];

    row_of(a, ra);
    row_of(b, rb);
    if (!unit3(ra) || !unit3(rb))
        return 0;
    cross3(ra, rb, u);
    /* Of nearly one row nothing can be told. */
    return sqrt(dot3(u, u)) > 1e-6 && unit3(u);
}

/* Small is good: squares that stop growing where a pair is plainly wrong. */
static double badness(const fap_mirror_pair *pair, int count, const double u[3], double tolerance)
{
    double sum = 0;

    for (int i = 0; i < count; i++) {
        const double e = fmin(error_of(&pair[i], u), 2 * tolerance);
        sum += e * e;
    }
    return sum;
}

static int best_guess(const fap_mirror_pair *pair, int count, double tolerance, double best[3])
{
    enum { TRIES = 500 };
    uint32_t state = 2463534242U;
    double least = INFINITY;

    for (int i = 0; i < TRIES; i++) {
        double u[3];
        const uint32_t a = next_random(&state) % (uint32_t)count, b = next_random(&state) % (uint32_t)count;
        if (a == b || !guess(&pair[a], &pair[b], u))
            continue;
        const double bad = badness(pair, count, u, tolerance);
        if (bad >= least)
            continue;
        least = bad;
        memcpy(best, u, 3 * sizeof *u);
    }
    return least < INFINITY;
}

/* --- the whole --- */

/* Eq. 4: of the two directions the one with c < 0. */
static void look_at_camera(double u[3])
{
    if (u[2] <= 0)
        return;
    for (int i = 0; i < 3; i++)
        u[i] = -u[i];
}

static void judge(const fap_mirror_pair *pair, int count, double limit, const double u[3],
                  const double value[3], fap_mirror_fit *fit)
{
    double sum = 0;

    *fit = (fap_mirror_fit){ .pairs = count };
    for (int i = 0; i < count; i++) {
        const double e = error_of(&pair[i], u);
        if (e > limit)
            continue;
        fit->fitting++;
        sum += e * e;
    }
    fit->residual = fit->fitting ? sqrt(sum / fit->fitting) : 0;
    fit->sure = sqrt(value[1] / fmax(value[0], value[2] * 1e-18));
}

static fap_err undetermined(char *where, const char *why)
{
    if (where)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", why);
    return FAP_E_DATA;
}

fap_err fap_mirror_find(fap_mirror_plane *mirror, const fap_mirror_pair *pair, int count, double tolerance,
                        fap_mirror_fit *fit, char *where)
{
    enum { ROUNDS = 12 };
    double u[3], value[3] = { 0 };
    const double limit = 2 * tolerance;

    *fit = (fap_mirror_fit){ .pairs = count > 0 ? count : 0 };
    *mirror = (fap_mirror_plane){ { 0, 0, -1 }, -1 };
    if (count < 2)
        return undetermined(where, "a mirror needs two points at least that are seen in it and directly");
    if (!best_guess(pair, count, tolerance, u))
        return undetermined(where,
                            "the points are where their reflections are, or all on one line with them");
    for (int i = 0; i < ROUNDS; i++)
        if (improve(pair, count, limit, u, value) < 2)
            return undetermined(where,
                                "the reflections fit no mirror: are points of the two sides mixed up?");
    /* The second direction is as empty as the first: every row is nearly the same. */
    if (value[1] < value[2] * 1e-10)
        return undetermined(where,
                            "all points and reflections are on one line: spread them over the picture");
    judge(pair, count, limit, u, value, fit);
    if (2 * fit->fitting < count)
        return undetermined(where, "more than half of the reflections fit no mirror: are points mixed up?");
    look_at_camera(u);
    memcpy(mirror->normal, u, sizeof u);
    return FAP_OK;
}

/* --- places --- */

void fap_mirror_reflect(const fap_mirror_plane *mirror, const double place[3], double image[3])
{
    const double behind = dot3(mirror->normal, place) - mirror->distance;

    for (int i = 0; i < 3; i++)
        image[i] = place[i] - 2 * behind * mirror->normal[i];
}

/*
 * z p reflected is z' p' (eq. 12): z H p - z' p' = -2 d n with H = I - 2 n n^T; three equations for two depths.
 */
static int depths(const fap_mirror_plane *mirror, const double p[3], const double q[3], double z[2])
{
    const double *n = mirror->normal;
    double hp[3] = { p[0], p[1], p[2] };

    add_scaled3(hp, n, -2 * dot3(n, p));
    const double aa = dot3(hp, hp), ab = -dot3(hp, q), bb = dot3(q, q), det = aa * bb - ab * ab;
    const double ra = -2 * mirror->distance * dot3(hp, n), rb = 2 * mirror->distance * dot3(q, n);
    if (!(det > 1e-12 * aa * bb))
        return 0;
    z[0] = (ra * bb - rb * ab) / det;
    z[1] = (rb * aa - ra * ab) / det;
    return z[0] > 0 && z[1] > 0;
}

int fap_mirror_place(const fap_mirror_plane *mirror, const fap_mirror_pair *pair, double place[3])
{
    double p[3], q[3], z[2], virtual_place[3], back[3];

    ray3(pair->direct, p);
    ray3(pair->mirrored, q);
    if (!depths(mirror, p, q, z))
        return 0;
    for (int i = 0; i < 3; i++)
        virtual_place[i] = z[1] * q[i];
    fap_mirror_reflect(mirror, virtual_place, back);
    for (int i = 0; i < 3; i++)
        place[i] = (z[0] * p[i] + back[i]) / 2;
    return 1;
}
