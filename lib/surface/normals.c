/* SPDX-License-Identifier: BSD-2-Clause */
/* See normals.h. */
#include <math.h>
#include <string.h>

#include "surface/normals.h"

void surface_triangle_normal(const float (*position)[3], const uint32_t v[3], double normal[3])
{
    const float *a = position[v[0]], *b = position[v[1]], *c = position[v[2]];
    double u[3], w[3];

    for (int i = 0; i < 3; i++) {
        u[i] = (double)b[i] - (double)a[i];
        w[i] = (double)c[i] - (double)a[i];
    }
    normal[0] = u[1] * w[2] - u[2] * w[1];
    normal[1] = u[2] * w[0] - u[0] * w[2];
    normal[2] = u[0] * w[1] - u[1] * w[0];
}

double surface_triangle_area(const float (*position)[3], const uint32_t v[3])
{
    double n[3];

    surface_triangle_normal(position, v, n);
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
}

void surface_normals(const float (*position)[3], uint32_t vertex_count, const uint32_t (*triangle)[3],
                     uint32_t triangle_count, float (*normal)[3])
{
    memset(normal, 0, vertex_count * sizeof *normal);
    for (uint32_t t = 0; t < triangle_count; t++) {
        double n[3];
        surface_triangle_normal(position, triangle[t], n);
        for (int c = 0; c < 3; c++)
            for (int a = 0; a < 3; a++)
                normal[triangle[t][c]][a] += (float)n[a];
    }
    for (uint32_t v = 0; v < vertex_count; v++) {
        float *n = normal[v];
        const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int a = 0; length > 0 && a < 3; a++)
            n[a] /= length;
    }
}
