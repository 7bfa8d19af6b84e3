/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Where the eyes look. A pupil is measured against the corners of its eye, since what is wrong with the head's pose is wrong
 * with both; it is believed while it is where a pupil can be and the lids let it be seen; and both eyes look at one thing,
 * so that they share what was believed. Landmarks need this: in narrowed eyes they put a pupil 13 mm aside. Without markers
 * on the corners a pupil stays as it was measured.
 */
#include <math.h>
#include <string.h>

#include "capture/performance.h"

static const struct eye_names {
    const char *pupil, *outer, *inner, *upper, *lower;
} eye_names[2] = { { "3.5", "3.7", "3.11", "3.1", "3.3" }, { "3.6", "3.12", "3.8", "3.2", "3.4" } };

/* An eye turns some 45 degrees; that far goes the pupil of a ball of 12 mm. */
static const double farthest_mm = 8.5;
/* Lids closer than this share of what they are apart at rest hide the pupil. */
static const double least_open = 0.4;

typedef struct eye {
    int pupil, outer, inner, upper, lower; /* feature points */
    int has_lids;
} eye;

/* 0: nothing to measure the pupil against. */
static int open_eye(const performance *p, const struct eye_names *n, eye *e)
{
    *e = (eye){ fap_point_by_name(n->pupil), fap_point_by_name(n->outer), fap_point_by_name(n->inner),
                fap_point_by_name(n->upper), fap_point_by_name(n->lower), 0 };
    e->has_lids = p->known[e->upper] && p->known[e->lower];
    return p->known[e->pupil] && p->known[e->outer] && p->known[e->inner];
}

static int is_open(const performance *p, const eye *e, uint32_t frame)
{
    if (!e->has_lids || !p->seen[frame][e->upper] || !p->seen[frame][e->lower])
        return 1;
    const double rest = (double)(p->neutral[e->upper][1] - p->neutral[e->lower][1]);
    const double closed = (double)(p->point[frame][e->lower][1] - p->point[frame][e->upper][1]);
    return rest - closed > least_open * rest;
}

/* From rest, against the corners; 0: not to be believed. */
static int measure(const performance *p, const eye *e, uint32_t frame, double out[3])
{
    if (!p->seen[frame][e->pupil] || !p->seen[frame][e->outer] || !p->seen[frame][e->inner])
        return 0;
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (double)p->point[frame][e->pupil][axis] -
                    0.5 * (double)(p->point[frame][e->outer][axis] + p->point[frame][e->inner][axis]);
    return hypot(out[0], out[1]) < farthest_mm && is_open(p, e, frame);
}

static void share_frame(performance *p, const eye e[2], uint32_t frame)
{
    double moved[2][3], sum[3] = { 0 };
    int believed = 0;

    for (int i = 0; i < 2; i++) {
        if (!measure(p, &e[i], frame, moved[i]))
            continue;
        believed++;
        for (int axis = 0; axis < 3; axis++)
            sum[axis] += moved[i][axis];
    }
    for (int i = 0; i < 2; i++) {
        if (!believed)
            p->seen[frame][e[i].pupil] = FAP_SAMPLE_MISSING;
        else if (!p->seen[frame][e[i].pupil])
            p->seen[frame][e[i].pupil] = p->seen[frame][e[1 - i].pupil];
        for (int axis = 0; axis < 3 && believed; axis++)
            p->point[frame][e[i].pupil][axis] = (float)(sum[axis] / believed);
    }
}

static void share_origin(performance *p, const eye e[2])
{
    fap_capture_origin o = { .how = FAP_HOW_DIRECT };

    for (int i = 0; i < 2; i++) {
        const fap_capture_origin *own = &p->origin[e[i].pupil];
        for (int k = 0; k < own->marker_count && o.marker_count < FAP_CAPTURE_MARKERS; k++) {
            o.marker[o.marker_count] = own->marker[k];
            o.share[o.marker_count++] = own->share[k] / 2;
        }
    }
    p->origin[e[0].pupil] = p->origin[e[1].pupil] = o;
}

void gaze_settle(performance *p)
{
    eye e[2];

    if (!open_eye(p, &eye_names[0], &e[0]) || !open_eye(p, &eye_names[1], &e[1]))
        return;
    for (uint32_t f = 0; f < p->frames; f++)
        share_frame(p, e, f);
    share_origin(p, e);
}
