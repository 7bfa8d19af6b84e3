/* SPDX-License-Identifier: BSD-2-Clause */
/* Which way a surface faces. */
#ifndef LIB_SURFACE_NORMALS_H
#define LIB_SURFACE_NORMALS_H

#include <stdint.h>

/* Not normalised: its length is twice the triangle's area. */
void surface_triangle_normal(const float (*position)[3], const uint32_t v[3], double normal[3]);
double surface_triangle_area(const float (*position)[3], const uint32_t v[3]);
/* Unit normals, each triangle counting by its area; 0 for a vertex of none. */
void surface_normals(const float (*position)[3], uint32_t vertex_count, const uint32_t (*triangle)[3],
                     uint32_t triangle_count, float (*normal)[3]);

#endif
