/* SPDX-License-Identifier: BSD-2-Clause */
/* The control surface of the planar bones: triangles between feature points. bones.c holds the table. */
#ifndef LIB_BANK_BONES_H
#define LIB_BANK_BONES_H

#include <stdint.h>

#include <fap/tables.h>

/*
 * The standard has one point in the middle of a lid, and a lid of two straight halves does not shut round an eyeball: eight
 * hypothetical points (a term of Lin et al. 2001, section 5.2) lie between the middles and the corners.
 */
enum { FAP_BONE_HYPOTHETICAL = 8, FAP_BONE_CORNERS = FAP_POINT_COUNT + FAP_BONE_HYPOTHETICAL };

/* A corner from FAP_POINT_COUNT on lies between two feature points. */
typedef struct fap_bone_between {
    uint8_t middle, end;
} fap_bone_between;

void fap_bones_hypothetical(fap_bone_between out[FAP_BONE_HYPOTHETICAL]);
/* Index of the hypothetical point on the other lid of the same eye. */
int fap_bone_opposite(int hypothetical);

enum { FAP_BONES_MAX = 128 };

/* Corners of each bone, those of the right half mirrored from the left; their number. */
int fap_bones_list(uint8_t corner[FAP_BONES_MAX][3]);

/* A point that no FAP commands along an axis goes this share of the way of another one. */
typedef struct fap_bone_follower {
    uint8_t point, leader;
    float share;
} fap_bone_follower;

/* In the order to go through them; their number. */
int fap_bones_followers(fap_bone_follower out[FAP_BONES_MAX]);

#endif
