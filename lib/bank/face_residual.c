/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Which points the residual moves where: the commanded ones exactly, and across the mouth and the eyes those
 * that would otherwise end up on the wrong side of their opposite. Source: DESIGN.md section 5.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"

static const float farthest_mm = 40; /* no FAP pulls a point further than this from where blending put it */
static const float apart_near_mm = 4,
                   apart_far_mm = 8; /* lips this far apart in depth pass one another freely */

typedef struct plan {
    uint8_t on[3][FAP_POINT_COUNT];
    float error[3][FAP_POINT_COUNT]; /* how far each point still has to go */
    float strength[3][FAP_POINT_COUNT];
} plan;

static float clampf(float x, float lo, float hi)
{
    return fminf(hi, fmaxf(lo, x));
}

static void set_goal(plan *p, int point, int axis, float error)
{
    p->on[axis][point] = 1;
    p->error[axis][point] = clampf(error, -farthest_mm, farthest_mm);
}

static void set_commanded(const fap_face *face, plan *p)
{
    for (int r = 0; r < face->row_count; r++) {
        const int point = face->row[r] / 3, axis = face->row[r] % 3;
        const float neutral = face->neutral[point][axis];
        set_goal(p, point, axis, neutral + face->target[point][axis] - face->point[point][axis]);
    }
}

/* Where a point will be once the fields have acted. */
static float landing(const fap_face *face, const plan *p, int point, int axis)
{
    return face->point[point][axis] + fap_residual_pull(&face->residual, point, p->strength[axis]);
}

static float neutral_gap(const fap_face *face, int upper, int lower)
{
    return face->neutral[upper][1] - face->neutral[lower][1];
}

/* How much of a crossing to undo: all where the two are one in front of the other, none where they are far
 * apart. */
static float overlap(const fap_face *face, const plan *p, int upper, int lower)
{
    const float crossing =
        fminf(0, neutral_gap(face, upper, lower)) - (landing(face, p, upper, 1) - landing(face, p, lower, 1));
    const float depth = fabsf(landing(face, p, upper, 2) - landing(face, p, lower, 2));
    return crossing * clampf((apart_far_mm - depth) / (apart_far_mm - apart_near_mm), 0, 1);
}

/* A commanded point stands and its opposite gives way; two commanded ones, or two free ones, meet in the
 * middle. */
static int part_slit(const fap_face *face, plan *p, int upper, int lower)
{
    const float crossing = overlap(face, p, upper, lower);
    if (!(crossing > 1e-4f) || !face->solvable[upper] || !face->solvable[lower])
        return 0;
    const int up = p->on[1][upper], low = p->on[1][lower];
    const float up_share = up == low ? 0.5f : up ? 0 : 1;
    const float up_error = landing(face, p, upper, 1) - face->point[upper][1] + up_share * crossing;
    const float low_error = landing(face, p, lower, 1) - face->point[lower][1] - (1 - up_share) * crossing;
    if (up_share > 0)
        set_goal(p, upper, 1, up_error);
    if (up_share < 1)
        set_goal(p, lower, 1, low_error);
    return 1;
}

static int part_slits(const fap_face *face, plan *p)
{
    int changed = 0;

    for (int i = 0; i < FAP_SLITS; i++)
        changed |= part_slit(face, p, face->slit[i][0], face->slit[i][1]);
    return changed;
}

void fap_face_find_slits(fap_face *face)
{
    static const char *const names[FAP_SLITS][2] = {
        { "2.2", "2.3" }, { "2.6", "2.8" }, { "2.7", "2.9" }, { "3.1", "3.3" }, { "3.2", "3.4" },
    };

    for (int i = 0; i < FAP_SLITS; i++)
        for (int side = 0; side < 2; side++)
            face->slit[i][side] = fap_point_by_name(names[i][side]);
}

static void solve_axis(fap_face *face, plan *p, int axis)
{
    fap_residual_solve(&face->residual, p->on[axis], p->error[axis], p->strength[axis]);
}

static void act(const fap_face *face, const float strength[3][FAP_POINT_COUNT], float *position)
{
    fap_residual_apply(&face->residual, &face->dsp, strength, position, face->mesh->stride);
}

void fap_face_plan_fields(fap_face *face)
{
    plan p;

    memset(&p, 0, sizeof p);
    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r];
        const float way = fap_blend_row_target(face, row) - fap_blend_row_motion(face, row, face->weight);
        const int past =
            way * fap_blend_shortfall(face, row, face->weight) < 0; /* a lid shut tighter than shut */
        set_goal(&p, row / 3, row % 3, past ? 0 : way);
    }
    for (int axis = 0; axis < 3; axis++)
        solve_axis(face, &p, axis);
    memcpy(face->field, p.strength, sizeof face->field);
    for (int row = 0; row < FAP_ROWS; row++)
        face->field_motion[row] = fap_residual_pull(&face->residual, row / 3, face->field[row % 3]);
}

void fap_face_apply_fields(const fap_face *face, float *position)
{
    float strength[3][FAP_POINT_COUNT];

    for (int i = 0; i < FAP_ROWS; i++)
        strength[i % 3][i / 3] = face->field_share * face->field[i % 3][i / 3];
    act(face, (const float(*)[FAP_POINT_COUNT])strength, position);
}

void fap_face_correct(fap_face *face, float *position)
{
    plan p;

    if (!face->row_count)
        return;
    memset(&p, 0, sizeof p);
    set_commanded(face, &p);
    for (int axis = 0; axis < 3; axis++)
        solve_axis(face, &p, axis);
    if (part_slits(face, &p))
        solve_axis(face, &p, 1);
    act(face, (const float(*)[FAP_POINT_COUNT])p.strength, position);
}
