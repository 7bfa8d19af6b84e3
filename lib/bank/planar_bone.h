/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Planar bones: a triangle that carries what is near it along, by its own frame above and below it, by an edge's or an
 * apex's frame beside it. Source: Sanchez Lorenzo et al. 2003, section 4.1 and 4.2.
 */
#ifndef LIB_BANK_PLANAR_BONE_H
#define LIB_BANK_PLANAR_BONE_H

/* One triangle, at rest or moved. */
typedef struct fap_planar_bone {
    float corner[3][3];
    float edge[3][3]; /* eq. 6: from corner i to the next */
    float side[3][3]; /* unit, in the plane, outward across edge i */
    float normal[3];  /* unit */
} fap_planar_bone;

/* Where a place is, as seen from a bone at rest; what is kept of it. */
typedef struct fap_bone_place {
    int region; /* 0: A, above or below; 1 + i: B, beside edge i; 4 + i: C, beyond corner i (eq. 3 to 5) */
    float local[3]; /* coordinates in the region's frame (eq. 2, 7, 8) */
    float beyond;   /* C: distance from the corner in the plane, D of eq. 10 */
} fap_bone_place;

/* 0: the three corners are on one line and make no frame. */
int fap_planar_bone_set(fap_planar_bone *bone, const float corner[3][3]);
/* Returns the distance from the triangle. */
float fap_planar_bone_locate(const fap_planar_bone *rest, const float at[3], fap_bone_place *place);
/* Eq. 1, 9, 10: where the place is once the bone has moved. */
void fap_planar_bone_carry(const fap_planar_bone *moved, const fap_bone_place *place, float at[3]);
/* Eq. 12: a raised cosine, 1 at the triangle, 0 from @p radius on. */
float fap_planar_bone_weight(float distance, float radius);

#endif
