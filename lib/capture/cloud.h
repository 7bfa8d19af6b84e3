/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Points nobody has named against the feature points of a face: where the face is among them, how its features are spread,
 * and which point is which. Soft correspondences: every point belongs to every feature a little, until it is clear; some
 * belong to none. Source: A. Myronenko, X. Song 2010, Point set registration: coherent point drift.
 */
#ifndef LIB_CAPTURE_CLOUD_H
#define LIB_CAPTURE_CLOUD_H

#include <fap/alloc.h>
#include <fap/bank.h>

#include "capture/rigid.h"

/* The features, millimetres of the face. */
typedef struct cloud_model {
    int count, point[FAP_POINT_COUNT]; /* -1: skin that markers are put on, but no feature point */
    double at[FAP_POINT_COUNT][3];
    double share[FAP_POINT_COUNT]; /* how likely a marker is to be there, against the others */
} cloud_model;

/* The face among the points: pose(scale * face). */
typedef struct cloud_fit {
    double scale;
    rigid_pose pose;
    double likelihood; /* logarithm of it, a point; comparable between fits of the same points */
    double rival;      /* of the best fit that has the face elsewhere or the other way round */
} cloud_fit;

/* More points than this are thinned for the fit. */
enum { CLOUD_MOST = 160 };

/* From everywhere. 0: too few points, or all in one place. */
int cloud_align(const cloud_model *model, const double (*at)[3], uint32_t count, cloud_fit *fit);
/* From a pose that is about right. */
void cloud_refine(const cloud_model *model, const double (*at)[3], uint32_t count, cloud_fit *fit);
/* A place among the points on the face. */
void cloud_to_face(const cloud_fit *fit, const double at[3], double face[3]);
/* Moves the features smoothly to where the points, on the face, want them. */
void cloud_bend(cloud_model *model, const double (*face)[3], uint32_t count);
/*
 * One to one: the sum of squared distances and of the @p price of each feature that is used is least; a feature farther than
 * its @p gate_mm from every point that is left goes without. @p index [model->count]: the point, -1 none.
 * @return 0: no memory
 */
int cloud_assign(const cloud_model *model, const double (*face)[3], uint32_t count, const double *gate_mm,
                 int *index, const fap_allocator *a);

#endif
