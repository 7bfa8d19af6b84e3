/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See glb_rig.h. The player twists the neck along its length: a vertex of head weight w turns by w times the head's
 * angles. Between two joints a vertex goes straight, so the neck has three of its own; with one of them alone a head
 * turned by 30 degrees would thin the neck by 2 mm.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/fapu.h>
#include <fap/tables.h>

#include "capture/rigid.h"
#include "player/sinks/glb_rig.h"

enum { FULL = 255, STOP_COUNT = 5 };

/* Joints along the neck, and the head weight each stands for. */
static const uint8_t stop_weight[STOP_COUNT] = { 0, 64, 128, 191, FULL };

static const float no_turn[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };

const char *glb_joint_name(glb_joint joint)
{
    static const char *const name[JOINT_COUNT] = { "shoulders", "neck_1",   "neck_2",    "neck_3",
                                                   "head",      "eye_left", "eye_right", "jaw" };
    return name[joint];
}

glb_joint glb_joint_parent(glb_joint joint)
{
    return joint > JOINT_HEAD ? JOINT_HEAD : JOINT_SHOULDERS;
}

/* --- at rest --- */

static glb_hold hold_by_weight(uint8_t weight)
{
    int i = 0;

    while (i + 2 < STOP_COUNT && weight > stop_weight[i + 1])
        i++;
    const int from = stop_weight[i], to = stop_weight[i + 1];
    return (glb_hold){ { (uint8_t)(JOINT_SHOULDERS + i), (uint8_t)(JOINT_SHOULDERS + i + 1) },
                       (uint16_t)((weight - from) * 65535 / (to - from)) };
}

static glb_hold hold_of(const glb_rig *rig, uint32_t v)
{
    const fap_part part = rig->mesh->part[v];

    if (part == FAP_PART_EYE_LEFT && rig->present[JOINT_EYE_LEFT])
        return (glb_hold){ { JOINT_EYE_LEFT, JOINT_HEAD }, 0 };
    if (part == FAP_PART_EYE_RIGHT && rig->present[JOINT_EYE_RIGHT])
        return (glb_hold){ { JOINT_EYE_RIGHT, JOINT_HEAD }, 0 };
    return hold_by_weight(rig->mesh->head_weight[v]);
}

static void place_joints(glb_rig *rig)
{
    const float *spine = fap_bank_point_get(rig->bank, fap_point_by_name("7.1"))->position_mm;
    float radius;

    for (int j = 0; j <= JOINT_HEAD; j++) {
        rig->present[j] = 1;
        memcpy(rig->origin[j], spine, sizeof rig->origin[j]);
    }
    rig->present[JOINT_EYE_LEFT] = (uint8_t)fap_bank_eye(rig->bank, 0, rig->origin[JOINT_EYE_LEFT], &radius);
    rig->present[JOINT_EYE_RIGHT] =
        (uint8_t)fap_bank_eye(rig->bank, 1, rig->origin[JOINT_EYE_RIGHT], &radius);
}

static void list_teeth(glb_rig *rig)
{
    const fap_mesh *mesh = rig->mesh;

    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (mesh->part[v] != FAP_PART_TEETH_LOWER)
            continue;
        double *rest = rig->tooth_rest[rig->tooth_count];
        for (size_t axis = 0; axis < 3; axis++)
            rest[axis] = mesh->position[axis * mesh->stride + v];
        rig->tooth_weight[rig->tooth_count] = 1;
        rig->tooth[rig->tooth_count++] = v;
    }
}

/* The hinge is beside the ears, where a face has ears and teeth to see it by. */
static void place_jaw(glb_rig *rig)
{
    const fap_bank_point *left = fap_bank_point_get(rig->bank, fap_point_by_name("10.7"));
    const fap_bank_point *right = fap_bank_point_get(rig->bank, fap_point_by_name("10.8"));

    rig->present[JOINT_JAW] = rig->tooth_count >= 3 && left->present && right->present;
    for (int axis = 0; axis < 3; axis++)
        rig->origin[JOINT_JAW][axis] = (left->position_mm[axis] + right->position_mm[axis]) / 2;
}

int glb_rig_open(glb_rig *rig, const fap_bank *bank)
{
    const size_t n = fap_bank_mesh(bank)->vertex_count;

    *rig = (glb_rig){ .bank = bank, .mesh = fap_bank_mesh(bank) };
    rig->hold = calloc(n, sizeof *rig->hold);
    rig->tooth = calloc(n, sizeof *rig->tooth);
    rig->tooth_rest = calloc(n, sizeof *rig->tooth_rest);
    rig->tooth_now = calloc(n, sizeof *rig->tooth_now);
    rig->tooth_weight = calloc(n, sizeof *rig->tooth_weight);
    if (!rig->hold || !rig->tooth || !rig->tooth_rest || !rig->tooth_now || !rig->tooth_weight)
        return 0;
    place_joints(rig);
    list_teeth(rig);
    place_jaw(rig);
    for (uint32_t v = 0; v < n; v++)
        rig->hold[v] = hold_of(rig, v);
    return 1;
}

void glb_rig_close(glb_rig *rig)
{
    free(rig->hold);
    free(rig->tooth);
    free(rig->tooth_rest);
    free(rig->tooth_now);
    free(rig->tooth_weight);
    *rig = (glb_rig){ 0 };
}

/* --- in motion --- */

static int32_t value_of(const fap_frame *frame, int fap)
{
    return frame->state[fap] == FAP_ABSENT ? 0 : frame->value[fap];
}

static int32_t part_of(int32_t angle, int weight)
{
    return (int32_t)((int64_t)angle * weight / FULL);
}

static void turn_neck(const fap_frame *frame, glb_motion motion[JOINT_COUNT])
{
    for (int i = 0; i < STOP_COUNT; i++)
        fap_head_rotation(part_of(value_of(frame, 48), stop_weight[i]),
                          part_of(value_of(frame, 49), stop_weight[i]),
                          part_of(value_of(frame, 50), stop_weight[i]), motion[JOINT_SHOULDERS + i].turn);
}

/* FAPs 23 to 28, as lib/bank/face_rigid.c has them. */
static void turn_eyes(const glb_rig *rig, const fap_frame *frame, glb_motion motion[JOINT_COUNT])
{
    const float step = fap_fapu_step(fap_bank_fapu(rig->bank), FAP_UNIT_ES), farthest_mm = 40;

    for (int right = 0; right < 2; right++) {
        glb_motion *eye = &motion[JOINT_EYE_LEFT + right];
        const float thrust = (float)value_of(frame, 27 + right) * step;
        fap_head_rotation(value_of(frame, 25 + right), value_of(frame, 23 + right), 0, eye->turn);
        eye->move_mm[2] = fminf(farthest_mm, fmaxf(-farthest_mm, thrust));
    }
}

static void vertex_at(const fap_mesh *mesh, const float *position, uint32_t v, float out[3])
{
    for (size_t axis = 0; axis < 3; axis++)
        out[axis] = position[axis * mesh->stride + v];
}

/* The jaw is where the lower teeth are. */
static void turn_jaw(glb_rig *rig, const glb_affine *head, const float *position, glb_motion *jaw)
{
    const float *hinge = rig->origin[JOINT_JAW];
    rigid_pose pose;

    for (uint32_t i = 0; i < rig->tooth_count; i++) {
        float p[3], now[3];
        vertex_at(rig->mesh, position, rig->tooth[i], p);
        glb_affine_undo(head, p, now);
        for (int axis = 0; axis < 3; axis++)
            rig->tooth_now[i][axis] = now[axis];
    }
    if (!rigid_fit((const double(*)[3])rig->tooth_rest, (const double(*)[3])rig->tooth_now, rig->tooth_weight,
                   rig->tooth_count, &pose))
        return;
    for (int i = 0; i < 3; i++) {
        double at = pose.t[i];
        for (int k = 0; k < 3; k++) {
            jaw->turn[i][k] = (float)pose.r[i][k];
            at += pose.r[i][k] * hinge[k];
        }
        jaw->move_mm[i] = (float)(at - hinge[i]);
    }
}

static glb_affine affine_about(const glb_motion *motion, const float origin[3])
{
    glb_affine a;

    memcpy(a.m, motion->turn, sizeof a.m);
    for (int i = 0; i < 3; i++)
        a.t[i] = origin[i] + motion->move_mm[i] -
                 (a.m[i][0] * origin[0] + a.m[i][1] * origin[1] + a.m[i][2] * origin[2]);
    return a;
}

void glb_rig_move(glb_rig *rig, const fap_frame *frame, const float *position, glb_motion motion[JOINT_COUNT])
{
    for (int j = 0; j < JOINT_COUNT; j++) {
        memcpy(motion[j].turn, no_turn, sizeof no_turn);
        memset(motion[j].move_mm, 0, sizeof motion[j].move_mm);
    }
    turn_neck(frame, motion);
    turn_eyes(rig, frame, motion);
    const glb_affine head = affine_about(&motion[JOINT_HEAD], rig->origin[JOINT_HEAD]);
    if (rig->present[JOINT_JAW])
        turn_jaw(rig, &head, position, &motion[JOINT_JAW]);
}

static glb_affine chain(const glb_affine *outer, const glb_affine *inner)
{
    glb_affine a;

    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            a.m[i][k] = outer->m[i][0] * inner->m[0][k] + outer->m[i][1] * inner->m[1][k] +
                        outer->m[i][2] * inner->m[2][k];
    }
    glb_affine_apply(outer, inner->t, a.t);
    return a;
}

void glb_rig_affines(const glb_rig *rig, const glb_motion motion[JOINT_COUNT], glb_affine affine[JOINT_COUNT])
{
    for (int j = 0; j < JOINT_COUNT; j++) {
        const glb_affine own = affine_about(&motion[j], rig->origin[j]);
        affine[j] = j > JOINT_HEAD ? chain(&affine[JOINT_HEAD], &own) : own;
    }
}

glb_affine glb_rig_affine(const glb_rig *rig, const glb_affine affine[JOINT_COUNT], uint32_t v)
{
    const glb_hold *hold = &rig->hold[v];
    const glb_affine *a = &affine[hold->joint[0]], *b = &affine[hold->joint[1]];
    const float share = (float)hold->share / 65535;
    glb_affine out = *a;

    if (!hold->share)
        return out;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            out.m[i][k] += share * (b->m[i][k] - a->m[i][k]);
        out.t[i] += share * (b->t[i] - a->t[i]);
    }
    return out;
}

void glb_affine_apply(const glb_affine *a, const float p[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a->m[i][0] * p[0] + a->m[i][1] * p[1] + a->m[i][2] * p[2] + a->t[i];
}

static void cross(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Rows of the inverse times the determinant are cross products of columns. A matrix that cannot be undone is one of
 * two opposite turns: the point stays where it is. */
void glb_affine_undo(const glb_affine *a, const float p[3], float out[3])
{
    const float d[3] = { p[0] - a->t[0], p[1] - a->t[1], p[2] - a->t[2] };
    float column[3][3], row[3][3];

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            column[k][i] = a->m[i][k];
    for (int i = 0; i < 3; i++)
        cross(column[(i + 1) % 3], column[(i + 2) % 3], row[i]);
    const float det = column[0][0] * row[0][0] + column[0][1] * row[0][1] + column[0][2] * row[0][2];
    for (int i = 0; i < 3; i++)
        out[i] = fabsf(det) < 1e-3f ? p[i] : (row[i][0] * d[0] + row[i][1] * d[1] + row[i][2] * d[2]) / det;
}
