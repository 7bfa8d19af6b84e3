/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Inner lips, which no marker can sit on: each inner point keeps its place in the local frame of the outer lip, along
 * whose edge the frame turns; where upper and lower would pass each other, they meet. The offset is the bank's face's.
 * Source: Sanchez Lorenzo et al. 2003, section 5.2.
 */
#include <math.h>
#include <string.h>

#include "capture/performance.h"

/*
 * An inner point, the outer one beside it, and the outer one's neighbours along the edge. A corner has none: what lies above
 * and below it tilts whenever one lip is pushed out, and the corner with it by millimetres.
 */
static const struct lip {
    const char *inner, *outer, *before, *after;
} lips[] = {
    { "2.2", "8.1", "8.6", "8.5" }, { "2.6", "8.5", "8.1", "8.3" }, { "2.7", "8.6", "8.4", "8.1" },
    { "2.3", "8.2", "8.8", "8.7" }, { "2.8", "8.7", "8.2", "8.3" }, { "2.9", "8.8", "8.4", "8.2" },
    { "2.4", "8.3", NULL, NULL },   { "2.5", "8.4", NULL, NULL },
};

/* Upper and lower. */
static const char *const facing[][2] = { { "2.2", "2.3" }, { "2.6", "2.8" }, { "2.7", "2.9" } };

enum { LIPS = sizeof lips / sizeof *lips, FACING = sizeof facing / sizeof *facing };

/* On the bank's face, in the take's millimetres. */
static void rest_place(const performance *p, int point, double out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = fap_bank_point_get(p->face.bank, point)->position_mm[axis] / p->face.scale;
}

static double normalise(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);

    for (int axis = 0; axis < 3 && length > 0; axis++)
        v[axis] /= length;
    return length;
}

/* Rows: along the edge from a to b, across it, out of the lip. 0: the points are one. */
static int edge_frame(const double a[3], const double b[3], double out[3][3])
{
    for (int axis = 0; axis < 3; axis++)
        out[0][axis] = b[axis] - a[axis];
    if (!(normalise(out[0]) > 1e-3))
        return 0;
    const double *t = out[0];
    out[1][0] = -t[1];
    out[1][1] = t[0];
    out[1][2] = 0;
    if (!(normalise(out[1]) > 1e-3))
        return 0;
    const double *y = out[1];
    out[2][0] = t[1] * y[2] - t[2] * y[1];
    out[2][1] = t[2] * y[0] - t[0] * y[2];
    out[2][2] = t[0] * y[1] - t[1] * y[0];
    return 1;
}

static void moved_place(const performance *p, uint32_t frame, int point, double out[3])
{
    rest_place(p, point, out);
    for (int axis = 0; axis < 3; axis++)
        out[axis] += (double)p->point[frame][point][axis];
}

/* How the offset from the outer to the inner point changes as the edge turns. */
static void turn(const performance *p, uint32_t frame, const int point[4], double out[3])
{
    double inner[3], outer[3], a[3], b[3], rest[3][3], now[3][3];

    memset(out, 0, 3 * sizeof *out);
    if (point[2] < 0 || !p->known[point[2]] || !p->known[point[3]] || !p->seen[frame][point[2]] ||
        !p->seen[frame][point[3]])
        return;
    rest_place(p, point[0], inner);
    rest_place(p, point[1], outer);
    rest_place(p, point[2], a);
    rest_place(p, point[3], b);
    if (!edge_frame(a, b, rest))
        return;
    moved_place(p, frame, point[2], a);
    moved_place(p, frame, point[3], b);
    if (!edge_frame(a, b, now))
        return;
    for (int row = 0; row < 3; row++) {
        double along = 0;
        for (int axis = 0; axis < 3; axis++)
            along += rest[row][axis] * (inner[axis] - outer[axis]);
        for (int axis = 0; axis < 3; axis++)
            out[axis] += along * (now[row][axis] - rest[row][axis]);
    }
}

static void derive_point(performance *p, const int point[4])
{
    fap_capture_origin *o = &p->origin[point[0]];

    for (uint32_t f = 0; f < p->frames; f++) {
        double by[3];
        p->seen[f][point[0]] = p->seen[f][point[1]];
        turn(p, f, point, by);
        for (int axis = 0; axis < 3; axis++)
            p->point[f][point[0]][axis] = p->point[f][point[1]][axis] + (float)by[axis];
    }
    *o = p->origin[point[1]];
    o->how = FAP_HOW_DERIVED;
    p->known[point[0]] = 1;
}

static int is_present(const performance *p, int point)
{
    return fap_bank_point_get(p->face.bank, point)->present != 0;
}

static void derive(performance *p, const struct lip *lip)
{
    const int point[4] = { fap_point_by_name(lip->inner), fap_point_by_name(lip->outer),
                           lip->before ? fap_point_by_name(lip->before) : -1,
                           lip->after ? fap_point_by_name(lip->after) : -1 };

    if (!p->known[point[0]] && p->known[point[1]] && is_present(p, point[0]) && is_present(p, point[1]))
        derive_point(p, point);
}

/* They meet in the middle. */
static void keep_apart(performance *p, int upper, int lower)
{
    double a[3], b[3];

    rest_place(p, upper, a);
    rest_place(p, lower, b);
    for (uint32_t f = 0; f < p->frames; f++) {
        float *u = &p->point[f][upper][1], *l = &p->point[f][lower][1];
        const float gap = (float)(a[1] - b[1]) + *u - *l;
        if (gap >= 0 || !p->seen[f][upper] || !p->seen[f][lower])
            continue;
        *u -= gap / 2;
        *l += gap / 2;
    }
}

void lips_derive(performance *p)
{
    for (int i = 0; i < LIPS; i++)
        derive(p, &lips[i]);
    for (int i = 0; i < FACING; i++) {
        const int upper = fap_point_by_name(facing[i][0]), lower = fap_point_by_name(facing[i][1]);
        if (p->known[upper] && p->known[lower] && p->origin[upper].how == FAP_HOW_DERIVED &&
            p->origin[lower].how == FAP_HOW_DERIVED)
            keep_apart(p, upper, lower);
    }
}
