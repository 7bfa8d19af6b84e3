/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The bodies of a face as joints: shoulders, neck, head, eyeballs, and a jaw that nothing hangs on, for others to
 * hang things on. A joint turns the vertices that it carries about its origin; what is left, in coordinates that no
 * joint has turned, is morphing.
 */
#ifndef PLAYER_SINKS_GLB_RIG_H
#define PLAYER_SINKS_GLB_RIG_H

#include <fap/bank.h>
#include <fap/frame.h>

typedef enum glb_joint {
    JOINT_SHOULDERS,
    JOINT_NECK_1,
    JOINT_NECK_2,
    JOINT_NECK_3,
    JOINT_HEAD,
    JOINT_EYE_LEFT,
    JOINT_EYE_RIGHT,
    JOINT_JAW,
    JOINT_COUNT
} glb_joint;

/* How a joint is turned and moved against its parent (head for eyes and jaw, shoulders for the others). */
typedef struct glb_motion {
    float turn[3][3];
    float move_mm[3]; /* from where it rests */
} glb_motion;

/* p -> m p + t */
typedef struct glb_affine {
    float m[3][3], t[3];
} glb_affine;

/* Which two joints carry a vertex; the second carries @share of it, 0 to 65535. */
typedef struct glb_hold {
    uint8_t joint[2];
    uint16_t share;
} glb_hold;

typedef struct glb_rig {
    const fap_bank *bank;
    const fap_mesh *mesh;
    uint8_t present[JOINT_COUNT];
    float origin[JOINT_COUNT][3]; /* at rest, millimetres */
    glb_hold *hold;               /* [vertex_count] */
    uint32_t tooth_count; /* of the lower jaw; below, of each: where it is at rest, where it is now, 1 */
    uint32_t *tooth;
    double (*tooth_rest)[3], (*tooth_now)[3], *tooth_weight;
} glb_rig;

const char *glb_joint_name(glb_joint joint);
glb_joint glb_joint_parent(glb_joint joint);

/* 0: no memory. Close in either case. */
int glb_rig_open(glb_rig *rig, const fap_bank *bank);
void glb_rig_close(glb_rig *rig);

/* Joints of a pose; @position as fap_face_pose() filled it for @frame. */
void glb_rig_move(glb_rig *rig, const fap_frame *frame, const float *position,
                  glb_motion motion[JOINT_COUNT]);
/* What joints do to vertices at rest. */
void glb_rig_affines(const glb_rig *rig, const glb_motion motion[JOINT_COUNT],
                     glb_affine affine[JOINT_COUNT]);
/* What holds vertex @v. */
glb_affine glb_rig_affine(const glb_rig *rig, const glb_affine affine[JOINT_COUNT], uint32_t v);
void glb_affine_apply(const glb_affine *a, const float p[3], float out[3]);
void glb_affine_undo(const glb_affine *a, const float p[3], float out[3]);

#endif
