/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * One step of Catmull-Clark subdivision as a linear operator: the same weights serve positions and every
 * motion vector. Source: Catmull, Clark 1978; borders by the usual cubic B-spline rule.
 */
#ifndef LIB_SHAPE_SUBDIVIDE_H
#define LIB_SHAPE_SUBDIVIDE_H

#include <stdint.h>

#include <fap/error.h>

/* Polygons in a row: face f has the corners start[f] .. start[f + 1] - 1. */
typedef struct fap_polygons {
    uint32_t face_count, vertex_count;
    const uint32_t *start, *vertex;
} fap_polygons;

/*
 * New vertices: first the old ones moved, then one an edge, then one a face. Row v is the sum of weight[i]
 * times column[i], i from row[v] to row[v + 1] - 1. Quad q of corner c of the old faces starts at that
 * corner, goes the old way round: corner, edge after it, face, edge before it.
 */
typedef struct fap_subdivision {
    uint32_t vertex_count, quad_count;
    uint32_t *row, *column;
    float *weight;
    uint32_t (*quad)[4];
} fap_subdivision;

/* FAP_E_DATA: an index out of range or an edge with more than two faces. FAP_E_NOMEM, FAP_E_LIMIT. */
fap_err fap_subdivide(fap_subdivision *out, const fap_polygons *mesh);
void fap_subdivision_free(fap_subdivision *s);
/* out[v] = sum of weight * in[column]: one vector a vertex. */
void fap_subdivision_apply(const fap_subdivision *s, const float (*in)[3], float (*out)[3]);

#endif
