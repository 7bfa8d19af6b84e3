/* SPDX-License-Identifier: BSD-2-Clause */
/* See rigid.h. */
#include <math.h>
#include <string.h>

#include "capture/rigid.h"

enum { MAX_EIGEN = 4, MAX_SWEEPS = 32, FRAMES_LOOKED_AT = 200 };

/* --- eigenvectors of small symmetric matrices: cyclic Jacobi --- */

static void rotate(double a[MAX_EIGEN][MAX_EIGEN], double v[MAX_EIGEN][MAX_EIGEN], int n, int p, int q)
{
    if (fabs(a[p][q]) < 1e-300)
        return;
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;

    for (int i = 0; i < n; i++) {
        const double x = a[i][p], y = a[i][q];
        a[i][p] = c * x - s * y;
        a[i][q] = s * x + c * y;
    }
    for (int i = 0; i < n; i++) {
        const double x = a[p][i], y = a[q][i], vx = v[i][p], vy = v[i][q];
        a[p][i] = c * x - s * y;
        a[q][i] = s * x + c * y;
        v[i][p] = c * vx - s * vy;
        v[i][q] = s * vx + c * vy;
    }
}

static double off_diagonal(double a[MAX_EIGEN][MAX_EIGEN], int n)
{
    double sum = 0;

    for (int p = 0; p < n; p++)
        for (int q = p + 1; q < n; q++)
            sum += fabs(a[p][q]);
    return sum;
}

/* @p a becomes diagonal, the columns of @p v its eigenvectors. */
static void diagonalise(double a[MAX_EIGEN][MAX_EIGEN], double v[MAX_EIGEN][MAX_EIGEN], int n)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            v[i][j] = i == j;
    const double enough = 1e-15 * (fabs(a[0][0]) + off_diagonal(a, n) + fabs(a[n - 1][n - 1]));
    for (int sweep = 0; sweep < MAX_SWEEPS && off_diagonal(a, n) > enough; sweep++)
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++)
                rotate(a, v, n, p, q);
}

/* --- the fit --- */

static void centroid(const double (*p)[3], const double *weight, uint32_t n, double out[3])
{
    double sum = 0;

    out[0] = out[1] = out[2] = 0;
    for (uint32_t i = 0; i < n; i++) {
        sum += weight[i];
        for (int axis = 0; axis < 3; axis++)
            out[axis] += weight[i] * p[i][axis];
    }
    for (int axis = 0; axis < 3; axis++)
        out[axis] /= sum;
}

/* sum of w (a - ca)(b - cb)^T */
static void correlate(const double (*a)[3], const double ca[3], const double (*b)[3], const double cb[3],
                      const double *weight, uint32_t n, double out[3][3])
{
    memset(out, 0, 9 * sizeof(double));
    for (uint32_t i = 0; i < n; i++)
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 3; column++)
                out[row][column] += weight[i] * (a[i][row] - ca[row]) * (b[i][column] - cb[column]);
}

/* Three points make a triangle when the second largest spread is not nothing. */
static int is_triangle(const double (*p)[3], const double c[3], const double *weight, uint32_t n)
{
    double s[3][3], a[MAX_EIGEN][MAX_EIGEN] = { { 0 } }, v[MAX_EIGEN][MAX_EIGEN], sum = 0;

    correlate(p, c, p, c, weight, n, s);
    for (uint32_t i = 0; i < n; i++)
        sum += weight[i];
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            a[row][column] = s[row][column] / sum;
    diagonalise(a, v, 3);
    const double low = fmin(a[0][0], fmin(a[1][1], a[2][2])), high = fmax(a[0][0], fmax(a[1][1], a[2][2]));
    const double middle = a[0][0] + a[1][1] + a[2][2] - low - high;
    return middle > 4 && middle > 0.003 * high; /* mm^2: 2 mm off the line */
}

/* Horn's 4x4 matrix; its largest eigenvector is the rotation as a quaternion. */
static void quaternion_of(const double s[3][3], double q[4])
{
    double a[MAX_EIGEN][MAX_EIGEN] = {
        { s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0] },
        { 0, s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2] },
        { 0, 0, s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1] },
        { 0, 0, 0, s[2][2] - s[0][0] - s[1][1] },
    };
    double v[MAX_EIGEN][MAX_EIGEN];
    int best = 0;

    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++)
            a[i][j] = a[j][i];
    diagonalise(a, v, 4);
    for (int i = 1; i < 4; i++)
        if (a[i][i] > a[best][best])
            best = i;
    for (int i = 0; i < 4; i++)
        q[i] = v[i][best];
}

static void matrix_of(const double q[4], double r[3][3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];

    r[0][0] = w * w + x * x - y * y - z * z;
    r[0][1] = 2 * (x * y - w * z);
    r[0][2] = 2 * (x * z + w * y);
    r[1][0] = 2 * (x * y + w * z);
    r[1][1] = w * w - x * x + y * y - z * z;
    r[1][2] = 2 * (y * z - w * x);
    r[2][0] = 2 * (x * z - w * y);
    r[2][1] = 2 * (y * z + w * x);
    r[2][2] = w * w - x * x - y * y + z * z;
}

int rigid_fit(const double (*model)[3], const double (*seen)[3], const double *weight, uint32_t n,
              rigid_pose *pose)
{
    double cm[3], cs[3], s[3][3], q[4];

    if (n < 3)
        return 0;
    centroid(model, weight, n, cm);
    centroid(seen, weight, n, cs);
    if (!is_triangle(model, cm, weight, n))
        return 0;
    correlate(model, cm, seen, cs, weight, n, s);
    quaternion_of((const double(*)[3])s, q);
    matrix_of(q, pose->r);
    for (int i = 0; i < 3; i++)
        pose->t[i] = cs[i] - (pose->r[i][0] * cm[0] + pose->r[i][1] * cm[1] + pose->r[i][2] * cm[2]);
    return 1;
}

void rigid_apply(const rigid_pose *pose, const double model[3], double seen[3])
{
    for (int i = 0; i < 3; i++)
        seen[i] = pose->r[i][0] * model[0] + pose->r[i][1] * model[1] + pose->r[i][2] * model[2] + pose->t[i];
}

void rigid_undo(const rigid_pose *pose, const double seen[3], double model[3])
{
    const double d[3] = { seen[0] - pose->t[0], seen[1] - pose->t[1], seen[2] - pose->t[2] };

    for (int i = 0; i < 3; i++)
        model[i] = pose->r[0][i] * d[0] + pose->r[1][i] * d[1] + pose->r[2][i] * d[2];
}

/* --- the body --- */

static void to_double(const float v[3], double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = v[axis];
}

int rigid_body_pose(const rigid_body *body, const fap_take *take, uint32_t frame, rigid_pose *pose)
{
    double model[RIGID_MAX_POINTS][3], seen[RIGID_MAX_POINTS][3], weight[RIGID_MAX_POINTS];
    uint32_t n = 0;

    for (uint32_t i = 0; i < body->count; i++) {
        const float *v = fap_take_sample(take, frame, body->point[i]);
        if (!v)
            continue;
        to_double(v, seen[n]);
        memcpy(model[n], body->model[i], sizeof model[n]);
        weight[n++] = body->weight[i];
    }
    return rigid_fit((const double(*)[3])model, (const double(*)[3])seen, weight, n, pose);
}

static uint32_t step_over(const fap_take *take)
{
    return 1 + take->frame_count / FRAMES_LOOKED_AT;
}

static uint32_t count_seen(const rigid_body *body, const fap_take *take, uint32_t frame)
{
    uint32_t n = 0;

    for (uint32_t i = 0; i < body->count; i++)
        n += fap_take_sample(take, frame, body->point[i]) != NULL;
    return n;
}

/* Points that the first frame does not show get their place when a later one does. */
static void start_shape(rigid_body *body, const fap_take *take)
{
    uint32_t best = 0, most = 0, kept = 0;

    for (uint32_t f = 0; f < take->frame_count; f++) {
        const uint32_t n = count_seen(body, take, f);
        if (n > most) {
            most = n;
            best = f;
        }
    }
    for (uint32_t i = 0; i < body->count; i++) {
        const float *v = fap_take_sample(take, best, body->point[i]);
        if (!v)
            continue;
        to_double(v, body->model[kept]);
        body->weight[kept] = 1;
        body->point[kept++] = body->point[i];
    }
    body->count = kept;
}

/* Mean place of each point in body coordinates, and how far it strays from there (rms). */
static uint32_t measure_shape(const rigid_body *body, const fap_take *take, const uint16_t *point,
                              uint32_t count, double (*mean)[3], double *stray)
{
    double sum[RIGID_MAX_POINTS][3] = { { 0 } }, square[RIGID_MAX_POINTS] = { 0 };
    uint32_t seen[RIGID_MAX_POINTS] = { 0 }, frames = 0;
    rigid_pose pose;

    for (uint32_t f = 0; f < take->frame_count; f += step_over(take)) {
        if (!rigid_body_pose(body, take, f, &pose))
            continue;
        frames++;
        for (uint32_t i = 0; i < count; i++) {
            const float *v = fap_take_sample(take, f, point[i]);
            double p[3], m[3];
            if (!v)
                continue;
            to_double(v, p);
            rigid_undo(&pose, p, m);
            seen[i]++;
            for (int axis = 0; axis < 3; axis++) {
                sum[i][axis] += m[axis];
                square[i] += m[axis] * m[axis];
            }
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        double length2 = 0;
        for (int axis = 0; axis < 3; axis++) {
            mean[i][axis] = seen[i] ? sum[i][axis] / seen[i] : 0;
            length2 += mean[i][axis] * mean[i][axis];
        }
        stray[i] = seen[i] * 2 > frames ? sqrt(fmax(0, square[i] / seen[i] - length2)) : INFINITY;
    }
    return frames;
}

/*
 * Weights fall with the square of the straying; a fifth of a millimetre is as good as it gets. (At half of one, a head made
 * up with a cap and a nose that talks along was 0.34 mm off the truth instead of 0.25: make bench, head_residual_mm.)
 */
static const double floor_mm = 0.2;

static double weight_of(double stray_mm)
{
    return 1 / (stray_mm * stray_mm + floor_mm * floor_mm);
}

double rigid_body_stray(const rigid_body *body, uint32_t i)
{
    return sqrt(fmax(0, 1 / body->weight[i] - floor_mm * floor_mm));
}

static int relearn(rigid_body *body, const fap_take *take)
{
    double mean[RIGID_MAX_POINTS][3], stray[RIGID_MAX_POINTS], sum = 0, weights = 0;

    if (!measure_shape(body, take, body->point, body->count, mean, stray))
        return 0;
    for (uint32_t i = 0; i < body->count; i++) {
        if (!isfinite(stray[i]))
            continue;
        memcpy(body->model[i], mean[i], sizeof mean[i]);
        body->weight[i] = weight_of(stray[i]);
        sum += body->weight[i] * stray[i] * stray[i];
        weights += body->weight[i];
    }
    body->rms_mm = weights > 0 ? sqrt(sum / weights) : 0;
    return 1;
}

int rigid_body_learn(rigid_body *body, const fap_take *take)
{
    enum { ROUNDS = 4 };

    start_shape(body, take);
    for (int round = 0; round < ROUNDS; round++)
        if (!relearn(body, take))
            return 0;
    return 1;
}

void rigid_body_extend(rigid_body *body, const fap_take *take, const uint16_t *candidate, uint32_t count,
                       double limit_mm)
{
    double mean[RIGID_MAX_POINTS][3], stray[RIGID_MAX_POINTS];
    int added = 0;

    count = count < RIGID_MAX_POINTS ? count : RIGID_MAX_POINTS;
    measure_shape(body, take, candidate, count, mean, stray);
    for (uint32_t i = 0; i < count && body->count < RIGID_MAX_POINTS; i++) {
        int known = 0;
        for (uint32_t k = 0; k < body->count; k++)
            known |= body->point[k] == candidate[i];
        if (known || !(stray[i] < limit_mm))
            continue;
        memcpy(body->model[body->count], mean[i], sizeof mean[i]);
        body->weight[body->count] = weight_of(stray[i]);
        body->point[body->count++] = candidate[i];
        added = 1;
    }
    for (int round = 0; round < 3 && added; round++)
        added = relearn(body, take);
}

/* --- finding --- */

/* How much the distance of two points varies; INFINITY where they are rarely seen together or too close to
 * matter. */
static double distance_change(const fap_take *take, uint16_t a, uint16_t b)
{
    static const double least_mm = 15;
    double sum = 0, square = 0;
    uint32_t n = 0, frames = 0;

    for (uint32_t f = 0; f < take->frame_count; f += step_over(take)) {
        const float *p = fap_take_sample(take, f, a), *q = fap_take_sample(take, f, b);
        frames++;
        if (!p || !q)
            continue;
        const double d = sqrt(pow(p[0] - q[0], 2) + pow(p[1] - q[1], 2) + pow(p[2] - q[2], 2));
        sum += d;
        square += d * d;
        n++;
    }
    if (n < 3 || n * 3 < frames || sum / n < least_mm)
        return INFINITY;
    return sqrt(fmax(0, square / n - sum / n * (sum / n)));
}

typedef struct change_table {
    double change[RIGID_MAX_POINTS][RIGID_MAX_POINTS];
    uint32_t count;
} change_table;

/* Grows a group from a pair, always by the candidate that fits best. Returns its size; @p worst: its largest
 * change. */
static uint32_t grow(const change_table *t, uint32_t a, uint32_t b, double limit_mm, uint8_t *member,
                     double *worst)
{
    uint32_t size = 2;

    memset(member, 0, RIGID_MAX_POINTS);
    member[a] = member[b] = 1;
    *worst = t->change[a][b];
    for (;;) {
        uint32_t best = 0;
        double least = INFINITY;
        for (uint32_t i = 0; i < t->count; i++) {
            double change = member[i] ? INFINITY : 0;
            for (uint32_t k = 0; k < t->count; k++)
                if (member[k] && k != i)
                    change = fmax(change, t->change[i][k]);
            if (change < least) {
                least = change;
                best = i;
            }
        }
        if (!(least <= limit_mm))
            return size;
        member[best] = 1;
        *worst = fmax(*worst, least);
        size++;
    }
}

int rigid_body_find(rigid_body *body, const fap_take *take, const uint16_t *candidate, uint32_t count)
{
    static const double limit_mm = 1.0;
    change_table t = { .count = count < RIGID_MAX_POINTS ? count : RIGID_MAX_POINTS };
    uint8_t member[RIGID_MAX_POINTS], best[RIGID_MAX_POINTS] = { 0 };
    double worst, best_worst = INFINITY;
    uint32_t most = 2;

    for (uint32_t i = 0; i < t.count; i++)
        for (uint32_t k = i; k < t.count; k++)
            t.change[i][k] = t.change[k][i] = i == k ? 0 : distance_change(take, candidate[i], candidate[k]);
    for (uint32_t i = 0; i < t.count; i++)
        for (uint32_t k = i + 1; k < t.count; k++) {
            if (!(t.change[i][k] <= limit_mm))
                continue;
            const uint32_t size = grow(&t, i, k, limit_mm, member, &worst);
            if (size > most || (size == most && size > 2 && worst < best_worst)) {
                most = size;
                best_worst = worst;
                memcpy(best, member, sizeof best);
            }
        }
    body->count = 0;
    for (uint32_t i = 0; i < t.count && most > 2; i++)
        if (best[i])
            body->point[body->count++] = candidate[i];
    return body->count >= 3 && rigid_body_learn(body, take);
}
