/* SPDX-License-Identifier: BSD-2-Clause */
/* Area-weighted vertex normals from an adjacency made once. */
#ifndef LIB_BANK_FACE_NORMALS_H
#define LIB_BANK_FACE_NORMALS_H

#include "bank/face_graph.h"
#include "dsp/dsp.h"

typedef struct fap_normals {
    uint32_t *start, *index; /* triangles round each welded vertex */
    uint32_t (*copy)[2];     /* to, from: vertices that take the normal of the one they are welded to */
    uint32_t copy_count;
    float (*place)[4], (*triangle)[4]; /* work */
} fap_normals;

/* Non-zero: no memory. Close in either case. */
int fap_normals_open(fap_normals *n, const fap_graph *graph, const fap_mesh *mesh,
                     const fap_allocator *alloc);
void fap_normals_close(fap_normals *n, const fap_allocator *alloc);
void fap_normals_compute(const fap_normals *n, const fap_dsp *dsp, const fap_mesh *mesh,
                         const float *position, float *normal);

#endif
