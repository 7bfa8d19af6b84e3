/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The surrounding rigid group: witnesses whose distances to one another and to the hidden point change least carry it
 * along. Source: Sanchez Lorenzo et al. 2003, section 5.2.
 */
#include <math.h>
#include <string.h>

#include "capture/predict.h"

enum { GROUP = 5 };

typedef struct rigid_state {
    rigid_body body;
    double place[3]; /* of the hidden point on the body */
} rigid_state;

/* How much the witness's distance to the hidden point varies while that is seen. */
static double change(const gap *g, uint32_t other)
{
    double sum = 0, square = 0, a[3], b[3];
    uint32_t n = 0;

    for (uint32_t f = 0; f < g->scene->take->frame_count; f += gap_step(g, 200)) {
        if (!gap_teaches(g, f, a) || !scene_still(g->scene, f, other, b))
            continue;
        const double d = pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2);
        sum += sqrt(d);
        square += d;
        n++;
    }
    return n > 1 ? sqrt(fmax(0, square / n - sum / n * (sum / n))) : INFINITY;
}

static void choose_group(rigid_body *body, const gap *g)
{
    double worst[GROUP];

    body->count = 0;
    for (uint32_t i = 0; i < g->count; i++) {
        const double c = change(g, g->witness[i]);
        if (!isfinite(c) || (body->count == GROUP && c >= worst[GROUP - 1]))
            continue;
        uint32_t k = body->count < GROUP ? body->count++ : GROUP - 1;
        for (; k && worst[k - 1] > c; k--) {
            worst[k] = worst[k - 1];
            body->point[k] = body->point[k - 1];
        }
        worst[k] = c;
        body->point[k] = g->witness[i];
    }
}

static int prepare(void *state, const gap *g)
{
    rigid_state *s = state;

    choose_group(&s->body, g);
    return s->body.count >= 3 && rigid_body_learn(&s->body, g->scene->take);
}

static int learn(void *state, const gap *g)
{
    rigid_state *s = state;
    double still[3], seen[3], model[3];
    rigid_pose pose;
    uint32_t n = 0;

    s->place[0] = s->place[1] = s->place[2] = 0;
    for (uint32_t f = 0; f < g->scene->take->frame_count; f += gap_step(g, 200)) {
        if (!gap_teaches(g, f, still) || !scene_back(g->scene, f, still, seen) ||
            !rigid_body_pose(&s->body, g->scene->take, f, &pose))
            continue;
        rigid_undo(&pose, seen, model);
        for (int axis = 0; axis < 3; axis++)
            s->place[axis] += model[axis];
        n++;
    }
    for (int axis = 0; axis < 3 && n; axis++)
        s->place[axis] /= n;
    return n > 0;
}

/* From the take to still coordinates. */
static int make_still(const scene *s, uint32_t frame, const double seen[3], double out[3])
{
    if (s->pose && !s->posed[frame])
        return 0;
    if (s->pose)
        rigid_undo(&s->pose[frame], seen, out);
    else
        memcpy(out, seen, 3 * sizeof *out);
    return 1;
}

static int at(const void *state, const gap *g, uint32_t frame, double out[3])
{
    const rigid_state *s = state;
    rigid_pose pose;
    double seen[3];

    if (!rigid_body_pose(&s->body, g->scene->take, frame, &pose))
        return 0;
    rigid_apply(&pose, s->place, seen);
    return make_still(g->scene, frame, seen, out);
}

const predictor predictor_rigid = { FAP_SAMPLE_RIGID, sizeof(rigid_state), prepare, learn, at };
