/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What blending leaves over: a small smooth field round every feature point, so that each commanded point
 * arrives exactly where it should. Fields reach along the surface, never across the slit of the mouth or of
 * an eye.
 */
#ifndef LIB_BANK_RESIDUAL_H
#define LIB_BANK_RESIDUAL_H

#include <fap/bank.h>

#include "bank/face_graph.h"
#include "dsp/dsp.h"

typedef struct fap_field {
    uint32_t block_count; /* 0: the point has no field */
    uint16_t *block;
    float *value; /* [block_count][FAP_BLOCK], 1 at the point, 0 from its radius on */
} fap_field;

typedef struct fap_residual {
    fap_field field[FAP_POINT_COUNT];
    float pull[FAP_POINT_COUNT][FAP_POINT_COUNT]; /* [p][q]: how far point p goes with 1 mm of field q */
    double matrix[FAP_POINT_COUNT][FAP_POINT_COUNT + 1]; /* work */
} fap_residual;

/*
 * @param follows  [vertex_count]: the vertex whose field value a vertex takes (a lash its lid's), itself for
 * most
 * @return non-zero: no memory. Close in either case.
 */
int fap_residual_open(fap_residual *r, const fap_bank *bank, fap_graph *graph, const uint32_t *follows,
                      const fap_allocator *alloc);
void fap_residual_close(fap_residual *r, const fap_allocator *alloc);

/*
 * Strengths of the fields along one axis, so that every point with on[p] moves by error[p].
 * A point that cannot move apart from another one (shared vertices) gives way.
 */
void fap_residual_solve(fap_residual *r, const uint8_t on[FAP_POINT_COUNT],
                        const float error[FAP_POINT_COUNT], float strength[FAP_POINT_COUNT]);
/* How far point @p p goes with those strengths. */
float fap_residual_pull(const fap_residual *r, int p, const float strength[FAP_POINT_COUNT]);
void fap_residual_apply(const fap_residual *r, const fap_dsp *dsp, const float strength[3][FAP_POINT_COUNT],
                        float *xyz, size_t stride);

#endif
