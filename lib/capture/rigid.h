/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Rigid motion between two sets of points, and which points of a take move rigidly.
 * Sources: B. K. P. Horn, Closed-form solution of absolute orientation using unit quaternions, 1987: the same
 * least squares as Arun, Huang and Blostein 1987, and never a reflection.
 */
#ifndef LIB_CAPTURE_RIGID_H
#define LIB_CAPTURE_RIGID_H

#include <fap/studio/take.h>

/* seen = r * model + t */
typedef struct rigid_pose {
    double r[3][3], t[3];
} rigid_pose;

/*
 * Least squares over @p n points with weights. @return 0 when the model is no triangle: fewer than three
 * points, or all on a line.
 */
int rigid_fit(const double (*model)[3], const double (*seen)[3], const double *weight, uint32_t n,
              rigid_pose *pose);
/* Into and out of the model's coordinates. */
void rigid_apply(const rigid_pose *pose, const double model[3], double seen[3]);
void rigid_undo(const rigid_pose *pose, const double seen[3], double model[3]);

/* A rigid body made of points of a take: its shape, and how far each can be trusted. */
enum { RIGID_MAX_POINTS = 64 };
typedef struct rigid_body {
    uint32_t count;
    uint16_t point[RIGID_MAX_POINTS];
    double weight[RIGID_MAX_POINTS];
    double model[RIGID_MAX_POINTS][3];
    double rms_mm; /* over all frames and points, weighted */
} rigid_body;

/* Shape and weights from the take; the points are set. @return 0 when they form no triangle in any frame. */
int rigid_body_learn(rigid_body *body, const fap_take *take);
/* How far one of its points strays from its place, rms, mm; what its weight comes from. */
double rigid_body_stray(const rigid_body *body, uint32_t i);
/* Where the body is in a frame; 0 when too little of it is seen. */
int rigid_body_pose(const rigid_body *body, const fap_take *take, uint32_t frame, rigid_pose *pose);
/*
 * The largest group of @p candidates that keep their distances over time; 0 when there is none of three. Every pair is tried
 * as a start and grown by whatever fits best: what RANSAC would do by lot, complete, as 64 points are few.
 */
int rigid_body_find(rigid_body *body, const fap_take *take, const uint16_t *candidate, uint32_t count);
/* Adds those of @p candidates that stay within @p limit_mm of their place on the body. */
void rigid_body_extend(rigid_body *body, const fap_take *take, const uint16_t *candidate, uint32_t count,
                       double limit_mm);

#endif
