/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Iterative closest points: the rigid motion that brings a surface over another, by turns finding what is nearest and moving
 * there. Sources: Besl and McKay 1992; the farthest pairs are left out as in Chetverikov's trimmed ICP, 2002.
 */
#ifndef LIB_REGISTRATION_ICP_H
#define LIB_REGISTRATION_ICP_H

#include "capture/rigid.h"
#include "surface/nearest.h"

typedef struct icp_task {
    const float (*model)[3],
        (*normal)[3];   /* [count] points that are to come over the surface, and which way they face */
    const uint8_t *use; /* [count] 0: does not take part */
    uint32_t count;
    const surface_index *surface;
    const float (*surface_normal)[3]; /* [vertices] */
    const uint32_t (*surface_triangle)[3];
    double keep;     /* share of the nearest pairs that count */
    double reach_mm; /* of a pair at most */
    int rounds;      /* at most */
} icp_task;

typedef struct icp_outcome {
    int rounds;
    double before_mm, after_mm; /* rms of the pairs that counted */
} icp_outcome;

/* surface = pose of model; in: where to begin. FAP_E_DATA: nothing is near; FAP_E_NOMEM. */
fap_err icp_align(const icp_task *task, rigid_pose *pose, icp_outcome *out, const fap_allocator *alloc);

#endif
