/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What a face does apart from its joints, as morph targets: the key models with the weights that the player found, and
 * behind them corrections, for what weights cannot say: the residual, lids on eyeballs, teeth that clamp, pupils, the
 * tongue's curl. Corrections are learnt from the take: one is added whenever a frame is off by more than a tolerance.
 *
 * All weights are within 0 and 1: Blender's importer cuts what is not (its sliders go as far as the first key frame). What
 * the player finds beyond is left to the corrections; what these have below 0 is a last target of its own, at 1 for the
 * whole performance.
 */
#ifndef PLAYER_SINKS_GLB_SHAPE_H
#define PLAYER_SINKS_GLB_SHAPE_H

#include <fap/bank.h>

#include "player/sinks/glb_rig.h"

typedef struct glb_shape {
    const fap_bank *bank;
    const fap_mesh *mesh;
    const glb_rig *rig;
    size_t length; /* of a shape: 3 * stride, laid out as fap_mesh.position */
    int key_count, correction_count, room;
    float *correction;    /* [room][length], orthonormal while learning; millimetres at weight 1 afterwards */
    float *norm;          /* [room]: square of each correction's length, afterwards */
    double *gram;         /* [room][room]: of all coefficients so far */
    double *work;         /* [2 * room * room + 2 * room] */
    float *wanted, *rest; /* of the frame; in the end rest is the last target */
    float *share;         /* [key_count]: the player's weights, cut to 0 and 1 */
} glb_shape;

/* 0: no memory. Close in either case. */
int glb_shape_open(glb_shape *s, const fap_bank *bank, const glb_rig *rig);
void glb_shape_close(glb_shape *s);

/* The first time: takes a pose into account. @weight: of the key models. */
void glb_shape_learn(glb_shape *s, const float *position, const float *weight,
                     const glb_affine affine[JOINT_COUNT]);
/* Between: keeps the corrections that matter. */
void glb_shape_settle(glb_shape *s);
/* The second time: weights of all targets, [key_count + correction_count], and how far off that leaves vertices. */
void glb_shape_fit(glb_shape *s, const float *position, const float *weight,
                   const glb_affine affine[JOINT_COUNT], float *target_weight, double *worst_mm,
                   double *square_mm2);

/* In the end: @weight[frame_count][target_count] of what was fitted, made to lie within 0 and 1. */
void glb_shape_fold(glb_shape *s, float *weight, uint32_t frame_count, int target_count);

/* Key models, corrections, and the one that holds what is always there. */
int glb_shape_target_count(const glb_shape *s);
/* Motion of a target at weight 1, [length]. */
void glb_shape_target(const glb_shape *s, int target, float *motion);

#endif
