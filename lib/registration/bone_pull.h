/* SPDX-License-Identifier: BSD-2-Clause */
/* fap_planar_bone_carry() the other way round: what is drawn at carried places, gathered at the corners of the bone. */
#ifndef LIB_REGISTRATION_BONE_PULL_H
#define LIB_REGISTRATION_BONE_PULL_H

#include "bank/planar_bone.h"

/* By the vectors of the bone that a place is mixed of. */
typedef struct bone_pull {
    double corner[3][3], edge[3][3], side[3][3], normal[3];
} bone_pull;

/* @p pull: at the place, times @p weight. */
void bone_pull_add(struct bone_pull *p, const fap_planar_bone *bone, const fap_bone_place *place,
                   const double pull[3], double weight);
void bone_pull_corners(const struct bone_pull *p, const fap_planar_bone *bone, double corner[3][3]);

#endif
