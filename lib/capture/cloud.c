/* SPDX-License-Identifier: BSD-2-Clause */
/* See cloud.h. */
#include <math.h>
#include <string.h>

#include "bank/gauss.h"
#include "base/mem.h"
#include "capture/cloud.h"

enum { LEAST_POINTS = 8, STARTS = 96, FINALISTS = 8, FIRST_STEPS = 15, LAST_STEPS = 30, BEND_STEPS = 40 };

/* Millimetres of a face of average size. */
static const double start_mm = 20, least_mm = 3, judge_mm = 6;
/* How many of the points are on the face's features at all. */
static const double off_share = 0.25;
/* The face in one of these sizes against what the points' spread suggests: a set may leave out chin or brows. */
static const double size_start[2] = { 0.8, 1.1 };
static const double size_least = 0.55, size_most = 1.7;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double square_between(const double a[3], const double b[3])
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

/* --- the points --- */

typedef struct points {
    uint32_t count;
    double at[CLOUD_MOST][3];
    double size; /* millimetres of the points in one of the face's, by spread */
    double volume;
} points;

/* Each next one is the farthest from those taken: thin where the points are dense. */
static void thin(points *p, const double (*at)[3], uint32_t count)
{
    p->count = 0;
    for (uint32_t next = 0; p->count < CLOUD_MOST && p->count < count; next = 0) {
        double most = -1;
        for (uint32_t i = 0; i < count && p->count; i++) {
            double least = INFINITY;
            for (uint32_t k = 0; k < p->count && least > most; k++)
                least = fmin(least, square_between(at[i], p->at[k]));
            if (least > most) {
                most = least;
                next = i;
            }
        }
        memcpy(p->at[p->count++], at[next], sizeof *at);
    }
}

static void take_points(points *p, const double (*at)[3], uint32_t count)
{
    if (count > CLOUD_MOST) {
        thin(p, at, count);
        return;
    }
    memcpy(p->at, at, count * sizeof *at);
    p->count = count;
}

static double spread(const double (*at)[3], const double *share, int count)
{
    double mean[3] = { 0 }, total = 0, sum = 0;

    for (int i = 0; i < count; i++) {
        const double w = share ? share[i] : 1;
        total += w;
        for (int axis = 0; axis < 3; axis++)
            mean[axis] += w * at[i][axis];
    }
    for (int axis = 0; axis < 3; axis++)
        mean[axis] /= total;
    for (int i = 0; i < count; i++)
        sum += (share ? share[i] : 1) * square_between(at[i], mean);
    return sqrt(sum / total);
}

static int open_points(points *p, const cloud_model *model, const double (*at)[3], uint32_t count)
{
    if (count < LEAST_POINTS || model->count < LEAST_POINTS)
        return 0;
    take_points(p, at, count);
    const double size = spread((const double(*)[3])p->at, NULL, (int)p->count);
    if (!(size > 1e-3) || !isfinite(size))
        return 0;
    p->size = size / spread(model->at, model->share, model->count);
    p->volume = pow(2.5 * size, 3);
    return 1;
}

/* --- one step --- */

/* A feature's share of the points, and their mean. */
typedef struct pull {
    double weight[FAP_POINT_COUNT], mean[FAP_POINT_COUNT][3];
    double total, square; /* of distances, weighted */
    double likelihood;
} pull;

static void pull_by_points(const cloud_model *model, const double (*feature)[3], const double (*at)[3],
                           uint32_t count, double variance, double volume, pull *out)
{
    static const double pi = 3.14159265358979323846;
    const double norm = pow(2 * pi * variance, -1.5), off = off_share / volume;
    double all = 0;

    memset(out, 0, sizeof *out);
    for (int m = 0; m < model->count; m++)
        all += model->share[m];
    for (uint32_t i = 0; i < count; i++) {
        double p[FAP_POINT_COUNT], square[FAP_POINT_COUNT], sum = off;
        for (int m = 0; m < model->count; m++) {
            square[m] = square_between(feature[m], at[i]);
            p[m] = (1 - off_share) * model->share[m] / all * norm * exp(-square[m] / (2 * variance));
            sum += p[m];
        }
        out->likelihood += log(sum) / count;
        for (int m = 0; m < model->count; m++) {
            const double w = p[m] / sum;
            out->weight[m] += w;
            out->total += w;
            out->square += w * square[m];
            for (int axis = 0; axis < 3; axis++)
                out->mean[m][axis] += w * at[i][axis];
        }
    }
    for (int m = 0; m < model->count; m++)
        for (int axis = 0; axis < 3 && out->weight[m] > 1e-12; axis++)
            out->mean[m][axis] /= out->weight[m];
}

static void place_features(const cloud_model *model, const cloud_fit *fit, double (*out)[3])
{
    for (int m = 0; m < model->count; m++) {
        const double scaled[3] = { fit->scale * model->at[m][0], fit->scale * model->at[m][1],
                                   fit->scale * model->at[m][2] };
        rigid_apply(&fit->pose, scaled, out[m]);
    }
}

/* The scale that fits best once the turning is known. */
static double best_scale(const cloud_model *model, const pull *p, const rigid_pose *pose)
{
    double from[3] = { 0 }, to[3] = { 0 }, along = 0, square = 0;

    for (int m = 0; m < model->count; m++)
        for (int axis = 0; axis < 3; axis++) {
            from[axis] += p->weight[m] * model->at[m][axis] / p->total;
            to[axis] += p->weight[m] * p->mean[m][axis] / p->total;
        }
    for (int m = 0; m < model->count; m++) {
        double a[3], b[3];
        for (int axis = 0; axis < 3; axis++) {
            a[axis] = model->at[m][axis] - from[axis];
            b[axis] = p->mean[m][axis] - to[axis];
        }
        for (int row = 0; row < 3; row++)
            along += p->weight[m] * dot(pose->r[row], a) * b[row];
        square += p->weight[m] * dot(a, a);
    }
    return square > 0 ? along / square : 0;
}

static void pose_by_pull(const cloud_model *model, const points *pts, const pull *p, cloud_fit *fit)
{
    double scaled[FAP_POINT_COUNT][3];
    rigid_pose pose;

    if (!rigid_fit(model->at, (const double(*)[3])p->mean, p->weight, (uint32_t)model->count, &pose))
        return;
    const double scale = best_scale(model, p, &pose);
    fit->scale = fmax(size_least * pts->size, fmin(size_most * pts->size, scale));
    for (int m = 0; m < model->count; m++)
        for (int axis = 0; axis < 3; axis++)
            scaled[m][axis] = fit->scale * model->at[m][axis];
    if (!rigid_fit((const double(*)[3])scaled, (const double(*)[3])p->mean, p->weight, (uint32_t)model->count,
                   &fit->pose))
        fit->pose = pose;
}

static void drift(const cloud_model *model, const points *pts, int steps, double first_mm, cloud_fit *fit)
{
    double feature[FAP_POINT_COUNT][3], variance = pow(first_mm * pts->size, 2);
    pull p;

    for (int step = 0; step < steps; step++) {
        place_features(model, fit, feature);
        pull_by_points(model, (const double(*)[3])feature, pts->at, pts->count, variance, pts->volume, &p);
        pose_by_pull(model, pts, &p, fit);
        variance = fmax(pow(least_mm * pts->size, 2), p.square / (3 * p.total + 1e-9));
    }
    place_features(model, fit, feature);
    pull_by_points(model, (const double(*)[3])feature, pts->at, pts->count, pow(judge_mm * pts->size, 2),
                   pts->volume, &p);
    fit->likelihood = p.likelihood;
}

/* --- from everywhere --- */

static double halton(int i, int base)
{
    double value = 0, part = 1;

    for (; i; i /= base)
        value += (part /= base) * (i % base);
    return value;
}

static void quaternion_rotation(const double q[4], double r[3][3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = { { 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y) },
                             { 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x) },
                             { 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y) } };
    memcpy(r, m, sizeof m);
}

/* The 24 ways in which a take's axes can be a head's come first, then turns spread evenly. Source of these: K. Shoemake 1992,
 * Uniform random rotations. */
static void start_rotation(int i, double r[3][3])
{
    enum { STRAIGHT = 24 };
    static const double pi = 3.14159265358979323846;

    if (i >= STRAIGHT) {
        const double u = halton(i, 2), v = 2 * pi * halton(i, 3), w = 2 * pi * halton(i, 5);
        quaternion_rotation((const double[4]){ sqrt(1 - u) * sin(v), sqrt(1 - u) * cos(v), sqrt(u) * sin(w),
                                               sqrt(u) * cos(w) },
                            r);
        return;
    }
    const int first = i % 3, second = (first + 1 + i / 3 % 2) % 3, third = 3 - first - second;
    const double a = i / 6 % 2 ? -1 : 1, b = i / 12 ? -1 : 1, c = second == (first + 1) % 3 ? a * b : -a * b;
    memset(r, 0, 9 * sizeof(double));
    r[0][first] = a;
    r[1][second] = b;
    r[2][third] = c;
}

static void mean_of(const double (*at)[3], const double *share, int count, double out[3])
{
    double total = 0;

    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < count; i++) {
        const double w = share ? share[i] : 1;
        total += w;
        for (int axis = 0; axis < 3; axis++)
            out[axis] += w * at[i][axis];
    }
    for (int axis = 0; axis < 3; axis++)
        out[axis] /= total;
}

static void start(const cloud_model *model, const points *pts, int i, double size, cloud_fit *fit)
{
    double from[3], to[3], moved[3];

    *fit = (cloud_fit){ .scale = size * pts->size };
    start_rotation(i, fit->pose.r);
    mean_of(model->at, model->share, model->count, from);
    mean_of((const double(*)[3])pts->at, NULL, (int)pts->count, to);
    for (int axis = 0; axis < 3; axis++)
        from[axis] *= fit->scale;
    rigid_apply(&fit->pose, from, moved);
    for (int axis = 0; axis < 3; axis++)
        fit->pose.t[axis] = to[axis] - moved[axis];
}

/* Best first. */
static void enter(cloud_fit best[FINALISTS], int *count, const cloud_fit *fit)
{
    int at = *count < FINALISTS ? (*count)++ : FINALISTS - 1;

    if (at == FINALISTS - 1 && best[at].likelihood >= fit->likelihood && *count == FINALISTS)
        return;
    for (; at > 0 && best[at - 1].likelihood < fit->likelihood; at--)
        best[at] = best[at - 1];
    best[at] = *fit;
}

/* Another pose, and not the same one found twice. */
static int differs(const cloud_fit *a, const cloud_fit *b, double size)
{
    static const double turned = 0.77, away_mm = 25; /* 40 degrees */
    double trace = 0;

    for (int row = 0; row < 3; row++)
        trace += dot(a->pose.r[row], b->pose.r[row]);
    return (trace - 1) / 2 < turned || square_between(a->pose.t, b->pose.t) > pow(away_mm * size, 2);
}

static int is_new(const cloud_fit *best, int count, const cloud_fit *fit, double size)
{
    for (int i = 0; i < count; i++)
        if (!differs(&best[i], fit, size) && best[i].likelihood >= fit->likelihood)
            return 0;
    return 1;
}

int cloud_align(const cloud_model *model, const double (*at)[3], uint32_t count, cloud_fit *out)
{
    cloud_fit best[FINALISTS] = { { 0 } }, fit;
    int found = 0;
    points pts;

    if (!open_points(&pts, model, at, count))
        return 0;
    for (int i = 0; i < 2 * STARTS; i++) {
        start(model, &pts, i / 2, size_start[i % 2], &fit);
        drift(model, &pts, FIRST_STEPS, start_mm, &fit);
        if (is_new(best, found, &fit, pts.size))
            enter(best, &found, &fit);
    }
    int winner = 0;
    for (int i = 0; i < found; i++) {
        drift(model, &pts, LAST_STEPS, judge_mm, &best[i]);
        winner = best[i].likelihood > best[winner].likelihood ? i : winner;
    }
    *out = best[winner];
    out->rival = -INFINITY;
    for (int i = 0; i < found; i++)
        if (differs(&best[i], out, pts.size))
            out->rival = fmax(out->rival, best[i].likelihood);
    return 1;
}

void cloud_refine(const cloud_model *model, const double (*at)[3], uint32_t count, cloud_fit *fit)
{
    points pts;

    if (open_points(&pts, model, at, count))
        drift(model, &pts, LAST_STEPS, judge_mm, fit);
}

void cloud_to_face(const cloud_fit *fit, const double at[3], double face[3])
{
    rigid_undo(&fit->pose, at, face);
    for (int axis = 0; axis < 3; axis++)
        face[axis] /= fit->scale;
}

/* --- the features --- */

/* Neighbours move alike within about this; and what a bend costs. */
static const double bend_reach_mm = 25, bend_price = 0.3;
/* How near counts, at first and in the end. */
static const double bend_first_mm = 10, bend_last_mm = 2;

/* Coefficients of the kernels for one axis. */
static void solve_axis(const cloud_model *model, const double (*rest)[3], const pull *p, double variance,
                       int axis, double *out)
{
    double a[FAP_POINT_COUNT][FAP_POINT_COUNT + 1];
    const int n = model->count;

    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++)
            a[i][k] =
                p->weight[i] * exp(-square_between(rest[i], rest[k]) / (2 * bend_reach_mm * bend_reach_mm));
        a[i][i] += bend_price * variance;
        a[i][n] = p->weight[i] * (p->mean[i][axis] - rest[i][axis]);
    }
    fap_gauss_solve(a[0], FAP_POINT_COUNT + 1, n, 1e-9, out);
}

static void bend_once(cloud_model *model, const double (*rest)[3], const pull *p, double variance)
{
    double by[3][FAP_POINT_COUNT];

    for (int axis = 0; axis < 3; axis++)
        solve_axis(model, rest, p, variance, axis, by[axis]);
    for (int i = 0; i < model->count; i++)
        for (int axis = 0; axis < 3; axis++) {
            model->at[i][axis] = rest[i][axis];
            for (int k = 0; k < model->count; k++)
                model->at[i][axis] += by[axis][k] * exp(-square_between(rest[i], rest[k]) /
                                                        (2 * bend_reach_mm * bend_reach_mm));
        }
}

void cloud_bend(cloud_model *model, const double (*face)[3], uint32_t count)
{
    double rest[FAP_POINT_COUNT][3], near_mm = bend_first_mm;
    cloud_model even = *model;
    points pts;
    pull p;

    if (!open_points(&pts, model, face, count))
        return;
    memcpy(rest, model->at, sizeof rest);
    for (int m = 0; m < even.count; m++) /* the pose is known: what is rare may pull now */
        even.share[m] = sqrt(even.share[m]);
    for (int step = 0; step < BEND_STEPS; step++) {
        pull_by_points(&even, (const double(*)[3])model->at, (const double(*)[3])pts.at, pts.count,
                       near_mm * near_mm, pts.volume, &p);
        bend_once(model, (const double(*)[3])rest, &p, near_mm * near_mm);
        near_mm *= pow(bend_last_mm / bend_first_mm, 1.0 / BEND_STEPS);
    }
}

/* --- which is which --- */

/* Rows are features; columns the points, then for each row a place of its own that is nobody. */
typedef struct matching {
    const double *cost;
    uint32_t rows, columns;
    double *u, *v, *least;
    uint32_t *row_of, *way; /* of columns, counted from 1; 0: free */
    uint8_t *used;
} matching;

/* Shortest augmenting path for one row. Source: R. Jonker, A. Volgenant 1987. */
static void add_row(matching *m, uint32_t row)
{
    uint32_t column = 0;

    m->row_of[0] = row;
    for (uint32_t j = 0; j <= m->columns; j++) {
        m->least[j] = INFINITY;
        m->used[j] = 0;
    }
    do {
        const uint32_t i = m->row_of[column];
        uint32_t next = 0;
        double step = INFINITY;
        m->used[column] = 1;
        for (uint32_t j = 1; j <= m->columns; j++) {
            if (m->used[j])
                continue;
            const double c = m->cost[(size_t)(i - 1) * m->columns + j - 1] - m->u[i] - m->v[j];
            if (c < m->least[j]) {
                m->least[j] = c;
                m->way[j] = column;
            }
            if (m->least[j] < step) {
                step = m->least[j];
                next = j;
            }
        }
        for (uint32_t j = 0; j <= m->columns; j++)
            if (m->used[j]) {
                m->u[m->row_of[j]] += step;
                m->v[j] -= step;
            } else {
                m->least[j] -= step;
            }
        column = next;
    } while (m->row_of[column]);
    while (column) {
        const uint32_t before = m->way[column];
        m->row_of[column] = m->row_of[before];
        column = before;
    }
}

static void fill_costs(const cloud_model *model, const double (*face)[3], uint32_t count,
                       const double *gate_mm, double *cost)
{
    static const double never = 1e9;
    const uint32_t columns = count + (uint32_t)model->count;

    for (int m = 0; m < model->count; m++)
        for (uint32_t j = 0; j < columns; j++) {
            const double gate = gate_mm[m] * gate_mm[m];
            double c = j == count + (uint32_t)m ? gate : never;
            if (j < count)
                c = square_between(model->at[m], face[j]);
            cost[(size_t)m * columns + j] = j < count && c > gate ? never : c;
        }
}

int cloud_assign(const cloud_model *model, const double (*face)[3], uint32_t count, const double *gate_mm,
                 int *index, const fap_allocator *a)
{
    const uint32_t rows = (uint32_t)model->count, columns = count + rows;
    double *cost = fap_mem_calloc(a, (size_t)rows * columns + rows + 1 + 2 * (columns + 1), sizeof *cost);
    uint32_t *tree = fap_mem_calloc(a, 2 * ((size_t)columns + 1), sizeof *tree);
    uint8_t *used = fap_mem_calloc(a, (size_t)columns + 1, 1);

    if (cost && tree && used) {
        matching m = { cost, rows, columns, cost + (size_t)rows * columns, NULL, NULL, tree, NULL, used };
        m.v = m.u + rows + 1;
        m.least = m.v + columns + 1;
        m.way = tree + columns + 1;
        fill_costs(model, face, count, gate_mm, cost);
        for (uint32_t row = 1; row <= rows; row++)
            add_row(&m, row);
        for (int i = 0; i < model->count; i++)
            index[i] = -1;
        for (uint32_t j = 1; j <= count; j++)
            if (m.row_of[j])
                index[m.row_of[j] - 1] = (int)j - 1;
    }
    const int ok = cost && tree && used;
    fap_mem_free(a, cost);
    fap_mem_free(a, tree);
    fap_mem_free(a, used);
    return ok;
}
