/* SPDX-License-Identifier: BSD-2-Clause */
/* The point of a triangle that is nearest to a place. */
#ifndef LIB_SURFACE_FOOT_H
#define LIB_SURFACE_FOOT_H

/* @p share: of each corner, 0 to 1, together 1. @p foot: the point itself. */
void surface_foot(const float a[3], const float b[3], const float c[3], const float at[3], float share[3],
                  float foot[3]);

#endif
