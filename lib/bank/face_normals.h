/* SPDX-License-Identifier: BSD-2-Clause */
/* Area-weighted vertex normals from an adjacency made once. */
#ifndef LIB_BANK_FACE_NORMALS_H
#define LIB_BANK_FACE_NORMALS_H

#include "bank/face_graph.h"
#include "dsp/dsp.h"

typedef struct fap_normals {
    uint32_t (*quad)
        [4]; /* two triangles in one where they share an edge; a lone triangle repeats its last corner */
    uint32_t quad_count;
    int width;           /* quads round a vertex that are summed at once ... */
    uint32_t *round;     /* [stride][width]: which; quad_count: none */
    uint32_t (*more)[2]; /* ... and vertex and quad of those that are left over */
    uint32_t more_count;
    uint32_t (*copy)[2]; /* to, from: vertices that take the normal of the one they are welded to */
    uint32_t copy_count;
    float (*place)[4], (*normal)[4]; /* work; normal[quad_count] stays 0 */
} fap_normals;

/* Non-zero: no memory. Close in either case. */
int fap_normals_open(fap_normals *n, const fap_graph *graph, const fap_mesh *mesh,
                     const fap_allocator *alloc);
void fap_normals_close(fap_normals *n, const fap_allocator *alloc);
/* @p position, @p normal  x[stride] y[stride] z[stride] */
void fap_normals_compute(const fap_normals *n, const fap_dsp *dsp, size_t stride, const float *position,
                         float *normal);

#endif
