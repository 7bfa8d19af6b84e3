/* SPDX-License-Identifier: BSD-2-Clause */
/* What all predictors share: see predict.h. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "capture/predict.h"

/* --- the head, as all points together tell --- */

/* Evenly spread over the take's points where there are too many. */
static void list_points(const fap_take *take, rigid_body *body)
{
    const uint32_t count = take->point_count < RIGID_MAX_POINTS ? take->point_count : RIGID_MAX_POINTS;

    body->count = count;
    for (uint32_t i = 0; i < count; i++)
        body->point[i] = (uint16_t)((uint64_t)i * take->point_count / count);
}

/*
 * Points that move a lot weigh little: it need not be the skull, only a frame of reference that does not run away. The
 * true head is found later, when the markers are known.
 */
fap_err scene_open(scene *s, const fap_take *take)
{
    *s = (scene){ .take = take };
    list_points(take, &s->body);
    if (s->body.count < 4 || !rigid_body_learn(&s->body, take))
        return FAP_OK;
    s->pose = fap_mem_calloc(&take->alloc, take->frame_count, sizeof *s->pose);
    s->posed = fap_mem_calloc(&take->alloc, take->frame_count, 1);
    if (!s->pose || !s->posed) {
        scene_close(s);
        return FAP_E_NOMEM;
    }
    return FAP_OK;
}

static int is_seen_throughout(const fap_take *take, uint32_t point, span s)
{
    for (uint32_t f = s.first; f <= s.last; f++)
        if (!take->valid[(size_t)f * take->point_count + point])
            return 0;
    return 1;
}

/* The body with the points of a mask only. */
static rigid_body part_of(const rigid_body *body, const uint8_t *in_use)
{
    rigid_body part = { .rms_mm = body->rms_mm };

    for (uint32_t i = 0; i < body->count; i++) {
        if (!in_use[i])
            continue;
        part.point[part.count] = body->point[i];
        part.weight[part.count] = body->weight[i];
        memcpy(part.model[part.count++], body->model[i], sizeof body->model[i]);
    }
    return part;
}

void scene_focus(scene *s, span hidden)
{
    uint8_t in_use[RIGID_MAX_POINTS] = { 0 };

    if (!s->pose)
        return;
    for (uint32_t i = 0; i < s->body.count; i++)
        in_use[i] = (uint8_t)is_seen_throughout(s->take, s->body.point[i], hidden);
    if (!memcmp(in_use, s->in_use, sizeof in_use))
        return;
    memcpy(s->in_use, in_use, sizeof in_use);
    const rigid_body part = part_of(&s->body, in_use);
    for (uint32_t f = 0; f < s->take->frame_count; f++)
        s->posed[f] = part.count >= 3 && rigid_body_pose(&part, s->take, f, &s->pose[f]);
}

void scene_close(scene *s)
{
    if (!s->take)
        return;
    fap_mem_free(&s->take->alloc, s->pose);
    fap_mem_free(&s->take->alloc, s->posed);
    *s = (scene){ 0 };
}

int scene_still(const scene *s, uint32_t frame, uint32_t point, double out[3])
{
    const float *v = fap_take_sample(s->take, frame, point);

    if (!v || (s->pose && !s->posed[frame]))
        return 0;
    const double seen[3] = { v[0], v[1], v[2] };
    if (s->pose)
        rigid_undo(&s->pose[frame], seen, out);
    else
        memcpy(out, seen, sizeof seen);
    return 1;
}

int scene_back(const scene *s, uint32_t frame, const double still[3], double out[3])
{
    if (s->pose && !s->posed[frame])
        return 0;
    if (s->pose)
        rigid_apply(&s->pose[frame], still, out);
    else
        memcpy(out, still, 3 * sizeof *out);
    return 1;
}

/* --- witnesses --- */

static int is_sure(const gap *g, uint32_t frame, uint32_t point)
{
    const uint8_t v = g->scene->take->valid[(size_t)frame * g->scene->take->point_count + point];
    return v == FAP_SAMPLE_MEASURED || v == FAP_SAMPLE_SPLINE;
}

static int sees_all(const gap *g, uint32_t point)
{
    for (uint32_t f = g->hidden.first; f <= g->hidden.last; f++)
        if (!is_sure(g, f, point))
            return 0;
    return 1;
}

uint32_t gap_step(const gap *g, uint32_t most_frames)
{
    return 1 + g->scene->take->frame_count / most_frames;
}

int gap_teaches(const gap *g, uint32_t frame, double out[3])
{
    if (frame >= g->hidden.first && frame <= g->hidden.last)
        return 0;
    return g->scene->take->valid[(size_t)frame * g->scene->take->point_count + g->point] ==
               FAP_SAMPLE_MEASURED &&
           scene_still(g->scene, frame, g->point, out);
}

/* Mean distance while both are seen; INFINITY when that is too seldom to learn from. */
static double distance(const gap *g, uint32_t other)
{
    double sum = 0, a[3], b[3];
    uint32_t n = 0, own = 0;

    for (uint32_t f = 0; f < g->scene->take->frame_count; f += gap_step(g, 100)) {
        if (!gap_teaches(g, f, a))
            continue;
        own++;
        if (!scene_still(g->scene, f, other, b))
            continue;
        sum += sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
        n++;
    }
    return n && n * 2 > own ? sum / n : INFINITY;
}

void gap_call_witnesses(gap *g)
{
    double far[MAX_WITNESSES];

    g->count = 0;
    for (uint32_t i = 0; i < g->scene->take->point_count; i++) {
        const double d = i != g->point && sees_all(g, i) ? distance(g, i) : INFINITY;
        if (!isfinite(d) || (g->count == MAX_WITNESSES && d >= far[MAX_WITNESSES - 1]))
            continue;
        uint32_t k = g->count < MAX_WITNESSES ? g->count++ : MAX_WITNESSES - 1;
        for (; k && far[k - 1] > d; k--) {
            far[k] = far[k - 1];
            g->witness[k] = g->witness[k - 1];
        }
        far[k] = d;
        g->witness[k] = (uint16_t)i;
    }
}
