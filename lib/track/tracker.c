/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * All dots from picture to picture, in the steps of Lin, Yeh, Ouhyoung 2001, section 3.2: predict, search, variance from the cost,
 * filter. What is added: a hidden dot is carried by its neighbours' motion, and one place has one dot.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/track.h>

#include "base/mem.h"
#include "track/dot.h"
#include "track/kalman.h"

enum { NEIGHBOURS = 4 };
static const double likely_cost = 0.05;

typedef struct follower {
    dot look;
    kalman filter;
    double found[2]; /* in this picture */
    int unseen;      /* pictures since it was seen */
    int neighbour[NEIGHBOURS], neighbours;
} follower;

struct fap_tracker {
    fap_tracker_config cfg;
    int count, width_px, height_px;
    follower *dot;
    fap_track_point *point;
};

void fap_tracker_config_init(fap_tracker_config *cfg)
{
    *cfg = (fap_tracker_config){ .struct_size = sizeof *cfg,
                                 .search_px = 24,
                                 .base_variance_px2 = 0.04,
                                 .cost_weight_px2 = 4,
                                 .velocity_variance = 1.5,
                                 .lost_cost = 0.5,
                                 .lost_frames = 15 };
}

/* --- opening --- */

static int inside(const fap_picture *p, const double at[2])
{
    return at[0] >= 0 && at[1] >= 0 && at[0] <= p->width_px - 1 && at[1] <= p->height_px - 1;
}

/* The nearest others, nearest first. */
static void find_neighbours(fap_tracker *t, int i)
{
    follower *f = &t->dot[i];
    double far[NEIGHBOURS];

    for (int k = 0; k < t->count; k++) {
        if (k == i)
            continue;
        const double *a = f->filter.p, *b = t->dot[k].filter.p, d = hypot(a[0] - b[0], a[1] - b[1]);
        int at = f->neighbours < NEIGHBOURS ? f->neighbours++ : NEIGHBOURS;
        for (; at > 0 && d < far[at - 1]; at--)
            if (at < NEIGHBOURS) {
                far[at] = far[at - 1];
                f->neighbour[at] = f->neighbour[at - 1];
            }
        if (at < NEIGHBOURS) {
            far[at] = d;
            f->neighbour[at] = k;
        }
    }
}

static void tell(fap_tracker *t, int i, double cost)
{
    const follower *f = &t->dot[i];

    t->point[i] = (fap_track_point){ f->filter.p[0], f->filter.p[1], f->filter.pp, cost,
                                     !f->unseen                        ? FAP_TRACK_SEEN
                                     : f->unseen <= t->cfg.lost_frames ? FAP_TRACK_PREDICTED
                                                                       : FAP_TRACK_LOST };
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double middle_radius(const fap_tracker *t)
{
    double radius[FAP_TRACK_MAX_POINTS];

    for (int i = 0; i < t->count; i++)
        radius[i] = t->dot[i].look.radius;
    qsort(radius, (size_t)t->count, sizeof *radius, by_size);
    return radius[t->count / 2];
}

/* Dots of one face are of one size: one that seems to be much larger has something of its colour beside it. */
static void learn(fap_tracker *t, const fap_picture *first, const double (*at)[2])
{
    for (int i = 0; i < t->count; i++)
        dot_learn(&t->dot[i].look, first, (double[2]){ at[i][0], at[i][1] }, t->cfg.radius_px);
    const double usual = middle_radius(t);
    for (int i = 0; i < t->count; i++) {
        follower *f = &t->dot[i];
        double middle[2] = { at[i][0], at[i][1] };
        dot_learn(&f->look, first, middle, f->look.radius > 1.4 * usual ? usual : t->cfg.radius_px);
        kalman_start(&f->filter, middle, t->cfg.base_variance_px2);
        tell(t, i, 0);
    }
    for (int i = 0; i < t->count; i++)
        find_neighbours(t, i);
}

static int is_picture(const fap_picture *p)
{
    return p->rgb && p->width_px > 0 && p->height_px > 0 && p->stride >= 3 * (size_t)p->width_px;
}

fap_err fap_tracker_open(fap_tracker **out, const fap_tracker_config *cfg, const fap_picture *first,
                         const double (*at)[2], int count)
{
    fap_tracker_config defaults;

    *out = NULL;
    fap_tracker_config_init(&defaults);
    const fap_allocator alloc = fap_mem_allocator(cfg ? &cfg->alloc : NULL);
    if (count < 1 || !is_picture(first))
        return FAP_E_ARG;
    if (count > FAP_TRACK_MAX_POINTS)
        return FAP_E_LIMIT;
    for (int i = 0; i < count; i++)
        if (!inside(first, at[i]))
            return FAP_E_ARG;
    fap_tracker *t = fap_mem_calloc(&alloc, 1, sizeof *t);
    if (!t)
        return FAP_E_NOMEM;
    t->cfg = cfg ? *cfg : defaults;
    t->cfg.alloc = alloc;
    t->count = count;
    t->width_px = first->width_px;
    t->height_px = first->height_px;
    t->dot = fap_mem_calloc(&alloc, (size_t)count, sizeof *t->dot);
    t->point = fap_mem_calloc(&alloc, (size_t)count, sizeof *t->point);
    if (!t->dot || !t->point) {
        fap_tracker_close(&t);
        return FAP_E_NOMEM;
    }
    learn(t, first, at);
    *out = t;
    return FAP_OK;
}

void fap_tracker_close(fap_tracker **t)
{
    if (!*t)
        return;
    const fap_allocator alloc = (*t)->cfg.alloc;
    fap_mem_free(&alloc, (*t)->dot);
    fap_mem_free(&alloc, (*t)->point);
    fap_mem_free(&alloc, *t);
    *t = NULL;
}

/* --- a step --- */

/* As far as its uncertainty makes it worth, and some more. */
static double search_of(const fap_tracker *t, const follower *f)
{
    const double slack = 3 + 3 * sqrt(f->filter.pp + t->cfg.base_variance_px2);
    return fmin(slack, t->cfg.search_px);
}

/* One standard deviation costs as much as a slight difference in looks. */
static double pull_of(const fap_tracker *t, const follower *f)
{
    return likely_cost / (f->filter.pp + t->cfg.base_variance_px2);
}

static void look_for(fap_tracker *t, int i, const fap_picture *picture)
{
    follower *f = &t->dot[i];

    memcpy(f->found, f->filter.p, sizeof f->found);
    t->point[i].cost = dot_find(&f->look, picture, search_of(t, f), pull_of(t, f), f->found);
}

static int is_seen(const fap_tracker *t, int i)
{
    return t->point[i].cost < t->cfg.lost_cost;
}

/* How surprised a dot would be to be found there: in standard deviations, and by its looks. */
static double surprise(const fap_tracker *t, int i)
{
    const follower *f = &t->dot[i];
    const double off = hypot(f->found[0] - f->filter.p[0], f->found[1] - f->filter.p[1]);

    return off / sqrt(f->filter.pp + t->cfg.base_variance_px2) + 4 * t->point[i].cost;
}

/* Two that were found in one place: who fits it worse was not seen. */
static void settle_quarrels(fap_tracker *t)
{
    for (int i = 0; i < t->count; i++)
        for (int k = 0; k < t->dot[i].neighbours; k++) {
            const int other = t->dot[i].neighbour[k];
            const double *a = t->dot[i].found, *b = t->dot[other].found;
            if (!is_seen(t, i) || !is_seen(t, other) ||
                hypot(a[0] - b[0], a[1] - b[1]) >
                    0.7 * fmin(t->dot[i].look.radius, t->dot[other].look.radius))
                continue;
            t->point[surprise(t, i) > surprise(t, other) ? i : other].cost = 1;
        }
}

static void filter(fap_tracker *t, int i, const fap_picture *picture)
{
    follower *f = &t->dot[i];
    const double cost = t->point[i].cost;

    if (is_seen(t, i)) {
        kalman_measure(&f->filter, f->found, t->cfg.base_variance_px2 + t->cfg.cost_weight_px2 * cost);
        f->unseen = 0;
        if (cost < 0.1 * t->cfg.lost_cost)
            dot_follow(&f->look, picture, f->filter.p);
    } else if (f->unseen < 1 << 30) {
        f->unseen++;
    }
}

/* A hidden dot moves as its neighbours do, as far as any is seen; its own last velocity is soon worth nothing. */
static void carry(fap_tracker *t, int i)
{
    follower *f = &t->dot[i];
    double v[2] = { 0, 0 };
    int seen = 0;

    if (!f->unseen)
        return;
    for (int k = 0; k < f->neighbours; k++) {
        const follower *n = &t->dot[f->neighbour[k]];
        if (n->unseen)
            continue;
        v[0] += n->filter.v[0];
        v[1] += n->filter.v[1];
        seen++;
    }
    for (int axis = 0; axis < 2; axis++)
        f->filter.v[axis] = seen ? v[axis] / seen : 0.7 * f->filter.v[axis];
    f->filter.pv = 0;
    f->filter.vv = fmin(f->filter.vv, 4);
    /* Farther than it is ever looked for it need not be lost. */
    f->filter.pp = fmin(f->filter.pp, t->cfg.search_px * t->cfg.search_px / 9);
}

/* Nobody is followed out of the picture. */
static void keep_inside(const fap_tracker *t, kalman *k)
{
    const double limit[2] = { t->width_px - 1, t->height_px - 1 };

    for (int i = 0; i < 2; i++) {
        if (k->p[i] >= 0 && k->p[i] <= limit[i])
            continue;
        k->p[i] = fmin(fmax(k->p[i], 0), limit[i]);
        k->v[i] = 0;
    }
}

fap_err fap_tracker_step(fap_tracker *t, const fap_picture *picture, double frames)
{
    if (!is_picture(picture) || picture->width_px != t->width_px || picture->height_px != t->height_px ||
        !(frames > 0))
        return FAP_E_ARG;
    for (int i = 0; i < t->count; i++) {
        kalman_predict(&t->dot[i].filter, frames, t->cfg.velocity_variance);
        keep_inside(t, &t->dot[i].filter);
        look_for(t, i, picture);
    }
    settle_quarrels(t);
    for (int i = 0; i < t->count; i++)
        filter(t, i, picture);
    for (int i = 0; i < t->count; i++) {
        carry(t, i);
        tell(t, i, t->point[i].cost);
    }
    return FAP_OK;
}

const fap_track_point *fap_tracker_points(const fap_tracker *t)
{
    return t->point;
}

double fap_tracker_radius(const fap_tracker *t, int point)
{
    return t->dot[point].look.radius;
}
