/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Markers on a bank's face: where on its skin each marker of a take would sit, were it glued there. A similarity brings
 * the heads together, radial functions the features, then the skin is found below. Source: Sanchez Lorenzo et al. 2003,
 * section 5.1.
 */
#ifndef LIB_CAPTURE_ON_FACE_H
#define LIB_CAPTURE_ON_FACE_H

#include <fap/bank.h>

#include "capture/rigid.h"

typedef struct face_spot {
    uint8_t known, side; /* side: fap_mask bits of the skin there */
    double at[3];        /* on the skin; in the mouth or the air as it is, without a triangle */
    double off_mm;       /* how far the skin was */
    uint32_t vertex[3];
    float share[3]; /* of each vertex; all 0: no triangle */
} face_spot;

typedef struct on_face {
    const fap_bank *bank;
    fap_bank *own;   /* the built-in face, where no other was given */
    uint8_t *mask;   /* [vertices] */
    double scale;    /* millimetres of the bank's face in one of the take's; 0: no fit */
    rigid_pose pose; /* of scaled places, head axes, on the bank's face */
    face_spot *spot; /* [points of the take] */
} on_face;

/* The skin next to a place; 0 where there is none within @p reach_mm. */
int on_face_nearest(const on_face *face, const double at[3], double reach_mm, face_spot *out);

#endif
