/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Places and mirrors that fit all views best. The paper's depths are the start; from there the errors in the pictures are made
 * least, first of a place given the mirrors, then of the mirrors given that every place is the best there is (Levenberg 1944,
 * Marquardt 1963; places leave the problem as in Golub and Pereyra 1973). Source of the start: Lin, Yeh, Ouhyoung 2001, section 4.1.
 */
#include <math.h>
#include <string.h>

#include <fap/studio/mirror.h>

#include "bank/gauss.h"
#include "track/vector.h"

/* Two for each view. */
enum { ROWS = 2 * (1 + FAP_MIRROR_MAX) };

/* --- a place in a view --- */

/* Where @p place appears, directly or in a mirror. 0: behind the lens. */
static int appears(const fap_mirror_plane *mirror, int view, const double place[3], double ray[2])
{
    double at[3] = { place[0], place[1], place[2] };

    if (view)
        fap_mirror_reflect(&mirror[view - 1], place, at);
    if (!(at[2] > 0))
        return 0;
    ray[0] = at[0] / at[2];
    ray[1] = at[1] / at[2];
    return 1;
}

/* Errors of all views, 0 for those that were not seen. 0: behind the lens in one. */
static int errors_at(const fap_mirror_plane *mirror, int mirrors, const fap_mirror_views *v,
                     const double place[3], double error[ROWS])
{
    for (int view = 0; view <= mirrors; view++) {
        double ray[2];
        error[2 * view] = error[2 * view + 1] = 0;
        if (!v->seen[view])
            continue;
        if (!appears(mirror, view, place, ray))
            return 0;
        error[2 * view] = ray[0] - v->ray[view][0];
        error[2 * view + 1] = ray[1] - v->ray[view][1];
    }
    return 1;
}

static double squares(const double *e, int count)
{
    double sum = 0;

    for (int i = 0; i < count; i++)
        sum += e[i] * e[i];
    return sum;
}

static int views_of(const fap_mirror_views *v, int mirrors)
{
    int count = 0;

    for (int view = 0; view <= mirrors; view++)
        count += v->seen[view] != 0;
    return count;
}

/* --- a first place --- */

/* Mirrors see each other's points when the direct view is blocked: the point nearest to both rays, in front of the lens. */
static int between_mirrors(const fap_mirror_plane *mirror, const fap_mirror_views *v, double place[3])
{
    double from[2][3], along[2][3], gap[3];

    for (int i = 0; i < 2; i++) {
        const double lens[3] = { 0, 0, 0 }, far[3] = { v->ray[1 + i][0], v->ray[1 + i][1], 1 };
        double tip[3];
        fap_mirror_reflect(&mirror[i], lens, from[i]);
        fap_mirror_reflect(&mirror[i], far, tip);
        for (int k = 0; k < 3; k++)
            along[i][k] = tip[k] - from[i][k];
    }
    for (int k = 0; k < 3; k++)
        gap[k] = from[1][k] - from[0][k];
    const double aa = dot3(along[0], along[0]), ab = dot3(along[0], along[1]), bb = dot3(along[1], along[1]);
    const double det = aa * bb - ab * ab, ga = dot3(gap, along[0]), gb = dot3(gap, along[1]);
    if (!(det > 1e-12 * aa * bb))
        return 0;
    const double s = (ga * bb - gb * ab) / det, t = (ga * ab - gb * aa) / det;
    for (int k = 0; k < 3; k++)
        place[k] = (from[0][k] + s * along[0][k] + from[1][k] + t * along[1][k]) / 2;
    return place[2] > 0;
}

static int first_place(const fap_mirror_plane *mirror, int mirrors, const fap_mirror_views *v,
                       double place[3])
{
    fap_mirror_pair pair;
    double sum[3] = { 0 };
    int count = 0;

    if (!v->seen[0])
        return mirrors == 2 && v->seen[1] && v->seen[2] && between_mirrors(mirror, v, place);
    memcpy(pair.direct, v->ray[0], sizeof pair.direct);
    for (int i = 0; i < mirrors; i++) {
        double one[3];
        if (!v->seen[1 + i])
            continue;
        memcpy(pair.mirrored, v->ray[1 + i], sizeof pair.mirrored);
        if (!fap_mirror_place(&mirror[i], &pair, one))
            continue;
        add_scaled3(sum, one, 1);
        count++;
    }
    for (int k = 0; count && k < 3; k++)
        place[k] = sum[k] / count;
    return count > 0;
}

/* --- the best place --- */

/* A step of Gauss and Newton, derivatives by differences. */
static int step(const fap_mirror_plane *mirror, int mirrors, const fap_mirror_views *v, const double place[3],
                const double error[ROWS], double damping, double move[3])
{
    const double h = 1e-6 * place[2];
    double slope[3][ROWS], a[3][4], at[3], moved[ROWS];

    for (int k = 0; k < 3; k++) {
        memcpy(at, place, sizeof at);
        at[k] += h;
        if (!errors_at(mirror, mirrors, v, at, moved))
            return 0;
        for (int r = 0; r < 2 * (1 + mirrors); r++)
            slope[k][r] = (moved[r] - error[r]) / h;
    }
    for (int i = 0; i < 3; i++) {
        a[i][3] = 0;
        for (int j = 0; j < 3; j++)
            a[i][j] = 0;
        for (int r = 0; r < 2 * (1 + mirrors); r++) {
            a[i][3] -= slope[i][r] * error[r];
            for (int j = 0; j < 3; j++)
                a[i][j] += slope[i][r] * slope[j][r];
        }
    }
    for (int i = 0; i < 3; i++)
        a[i][i] *= 1 + damping;
    fap_gauss_solve(&a[0][0], 4, 3, 1e-300, move);
    return 1;
}

static double settle(const fap_mirror_plane *mirror, int mirrors, const fap_mirror_views *v, double place[3])
{
    enum { STEPS = 15 };
    double error[ROWS], damping = 1e-6;

    if (!errors_at(mirror, mirrors, v, place, error))
        return -1;
    double now = squares(error, 2 * (1 + mirrors));
    for (int i = 0; i < STEPS; i++) {
        double move[3], there[3] = { place[0], place[1], place[2] }, then[ROWS];
        if (!step(mirror, mirrors, v, place, error, damping, move))
            break;
        add_scaled3(there, move, 1);
        const int fits = errors_at(mirror, mirrors, v, there, then);
        const double next = fits ? squares(then, 2 * (1 + mirrors)) : INFINITY;
        if (!(next < now)) {
            damping = fmax(damping, 1e-6) * 100;
            if (damping > 1e6)
                break;
            continue;
        }
        memcpy(place, there, sizeof there);
        memcpy(error, then, sizeof then);
        const double gain = now - next;
        now = next;
        damping *= 0.1;
        if (gain < 1e-9 * now)
            break;
    }
    return now;
}

int fap_mirror_locate(const fap_mirror_plane *mirror, int mirrors, const fap_mirror_views *v, double place[3],
                      double *residual)
{
    const int views = views_of(v, mirrors);

    if (views < 2 || !first_place(mirror, mirrors, v, place))
        return 0;
    const double sum = settle(mirror, mirrors, v, place);
    if (sum < 0)
        return 0;
    if (residual)
        *residual = sqrt(sum / views);
    return 1;
}

/* --- the best mirrors --- */

/* A mirror's direction moves in the plane at right angles to it; the second one's distance by a factor. */
enum { MAX_UNKNOWNS = 2 * FAP_MIRROR_MAX + 1 };

static void across(const double n[3], double a[3], double b[3])
{
    const double up[3] = { 0, 1, 0 }, aside[3] = { 1, 0, 0 };

    cross3(n, fabs(n[1]) < 0.9 ? up : aside, a);
    unit3(a);
    cross3(n, a, b);
}

static void moved_by(const fap_mirror_plane *mirror, int mirrors, const double *x, fap_mirror_plane *out)
{
    for (int i = 0; i < mirrors; i++) {
        double a[3], b[3];
        out[i] = mirror[i];
        across(mirror[i].normal, a, b);
        add_scaled3(out[i].normal, a, x[2 * i]);
        add_scaled3(out[i].normal, b, x[2 * i + 1]);
        unit3(out[i].normal);
    }
    if (mirrors == 2)
        out[1].distance *= exp(x[4]);
}

/* Looked at often: of many points as many as tell enough. */
typedef struct refining {
    int mirrors, unknowns, count, step;
    const fap_mirror_views *v;
    double tolerance;
} refining;

/* The errors that the best place of a point leaves; from the tolerance on they grow with their root (Huber 1964). */
static void weighted_errors(const refining *w, const fap_mirror_plane *mirror, const fap_mirror_views *v,
                            double e[ROWS])
{
    double place[3];

    memset(e, 0, ROWS * sizeof *e);
    if (!fap_mirror_locate(mirror, w->mirrors, v, place, NULL) ||
        !errors_at(mirror, w->mirrors, v, place, e)) {
        e[0] = 2 * w->tolerance; /* mirrors that cannot be are no better than wrong pairs */
        return;
    }
    const double length = sqrt(squares(e, ROWS)), t = w->tolerance;
    for (int r = 0; length > t && r < ROWS; r++)
        e[r] *= sqrt(2 * t * length - t * t) / length;
}

static double cost_of(const refining *w, const fap_mirror_plane *mirror)
{
    double sum = 0, e[ROWS];

    for (int i = 0; i < w->count; i += w->step) {
        weighted_errors(w, mirror, &w->v[i], e);
        sum += squares(e, ROWS);
    }
    return sum;
}

typedef double normal_equations[MAX_UNKNOWNS][MAX_UNKNOWNS + 1];

static void add_point(const refining *w, const fap_mirror_plane *mirror, const fap_mirror_plane *beside,
                      const fap_mirror_views *v, normal_equations a)
{
    const double h = 1e-6;
    double e[ROWS], slope[MAX_UNKNOWNS][ROWS];

    weighted_errors(w, mirror, v, e);
    for (int k = 0; k < w->unknowns; k++) {
        weighted_errors(w, beside + FAP_MIRROR_MAX * k, v, slope[k]);
        for (int r = 0; r < ROWS; r++)
            slope[k][r] = (slope[k][r] - e[r]) / h;
    }
    for (int k = 0; k < w->unknowns; k++)
        for (int r = 0; r < ROWS; r++) {
            a[k][w->unknowns] -= slope[k][r] * e[r];
            for (int l = 0; l < w->unknowns; l++)
                a[k][l] += slope[k][r] * slope[l][r];
        }
}

/* @p a: the normal equations of a step from @p mirror. */
static void linearise(const refining *w, const fap_mirror_plane *mirror, normal_equations a)
{
    fap_mirror_plane beside[MAX_UNKNOWNS][FAP_MIRROR_MAX] = { 0 };

    memset(a, 0, sizeof(normal_equations));
    for (int k = 0; k < w->unknowns; k++) {
        double x[MAX_UNKNOWNS] = { 0 };
        x[k] = 1e-6;
        moved_by(mirror, w->mirrors, x, beside[k]);
    }
    for (int i = 0; i < w->count; i += w->step)
        add_point(w, mirror, beside[0], &w->v[i], a);
}

static void solve(const refining *w, normal_equations equations, double damping, double *x)
{
    normal_equations a;

    memcpy(a, equations, sizeof a);
    for (int k = 0; k < w->unknowns; k++)
        a[k][k] *= 1 + damping;
    fap_gauss_solve(&a[0][0], MAX_UNKNOWNS + 1, w->unknowns, 1e-300, x);
}

double fap_mirror_refine(fap_mirror_plane *mirror, int mirrors, const fap_mirror_views *v, int count,
                         double tolerance)
{
    enum { STEPS = 20, ENOUGH = 2000 };
    const refining w = { mirrors,  mirrors == 2 ? 5 : 2, count, count > ENOUGH ? count / ENOUGH : 1, v,
                         tolerance };
    normal_equations equations;
    double damping = 1e-4, now = cost_of(&w, mirror), x[MAX_UNKNOWNS];
    int stale = 1;

    for (int i = 0; i < STEPS && damping < 1e6; i++) {
        fap_mirror_plane there[FAP_MIRROR_MAX];
        if (stale)
            linearise(&w, mirror, equations);
        solve(&w, equations, damping, x);
        moved_by(mirror, mirrors, x, there);
        const double next = cost_of(&w, there);
        stale = next < now;
        damping *= stale ? 0.1 : 100;
        if (!stale)
            continue;
        memcpy(mirror, there, (size_t)mirrors * sizeof *mirror);
        const double gain = now - next;
        now = next;
        if (gain < 1e-9 * now)
            break;
    }
    const int looked_at = count > 0 ? (count - 1) / w.step + 1 : 1;
    return sqrt(now / (looked_at * (1 + mirrors)));
}

/* --- sizes --- */

static void sort_up(double *value, int count)
{
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && value[k] < value[k - 1]; k--) {
            const double t = value[k];
            value[k] = value[k - 1];
            value[k - 1] = t;
        }
}

/* A depth grows with its mirror's distance: both mirrors must give the same. */
int fap_mirror_join(fap_mirror_plane mirror[FAP_MIRROR_MAX], const fap_mirror_views *v, int count)
{
    enum { ENOUGH = 500 };
    double ratio[ENOUGH];
    int found = 0;

    for (int i = 0; i < count && found < ENOUGH; i++) {
        double place[2][3];
        int both = v[i].seen[0];
        for (int m = 0; m < 2 && both; m++) {
            fap_mirror_pair pair;
            memcpy(pair.direct, v[i].ray[0], sizeof pair.direct);
            memcpy(pair.mirrored, v[i].ray[1 + m], sizeof pair.mirrored);
            both = v[i].seen[1 + m] && fap_mirror_place(&mirror[m], &pair, place[m]);
        }
        if (both)
            ratio[found++] = place[0][2] / place[1][2];
    }
    sort_up(ratio, found);
    if (found)
        mirror[1].distance *= ratio[found / 2];
    return found;
}

void fap_mirror_scale(fap_mirror_plane *mirror, int mirrors, double factor)
{
    for (int i = 0; i < mirrors; i++)
        mirror[i].distance *= factor;
}
