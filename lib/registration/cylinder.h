/* SPDX-License-Identifier: BSD-2-Clause */
/* Upright about a head: what a cylindrical projection goes by. */
#ifndef LIB_REGISTRATION_CYLINDER_H
#define LIB_REGISTRATION_CYLINDER_H

#include <stdint.h>

typedef struct cylinder {
    double x, z;      /* the axis, along y */
    double low, high; /* of the head */
} cylinder;

/* The middle of the box around all that. */
cylinder cylinder_around(const float (*at)[3], uint32_t count);
/* Away from the axis, of unit length. */
void cylinder_outwards(const cylinder *c, const float at[3], float out[3]);
/* Angle in radians, 0 straight ahead (z), then height and distance from the axis. */
void cylinder_unroll(const cylinder *c, const float at[3], double out[3]);
/*
 * Whether a place on the head's skin is of the face: not of ears, top and back, which scanners see badly and which differ with the
 * hair (Zhu 2006 section 4.6).
 */
int cylinder_is_face(const cylinder *c, const float at[3]);

#endif
