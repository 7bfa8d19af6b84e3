/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The mesh as a graph, for distances along the surface. Made at open, dropped when the fields are done.
 */
#ifndef LIB_BANK_FACE_GRAPH_H
#define LIB_BANK_FACE_GRAPH_H

#include <fap/bank.h>

typedef struct fap_graph {
    uint32_t vertex_count;
    const float *position;
    uint32_t stride;
    uint32_t
        *weld; /* [vertex_count] the first vertex of those that are one place and move as one (UV seams) */
    uint32_t *start; /* [vertex_count + 1] neighbours of a welded vertex */
    uint32_t *next;
    float *length;
    float *distance;   /* [vertex_count] of the last flood, by welded vertex; INFINITY beyond reach */
    uint32_t *reached; /* vertices that have a distance */
    uint32_t reached_count;
    struct fap_graph_entry *heap;
} fap_graph;

/* Non-zero: no memory. Close in either case. */
int fap_graph_open(fap_graph *g, const fap_bank *bank, const fap_allocator *alloc);
void fap_graph_close(fap_graph *g, const fap_allocator *alloc);
/* Distances along the surface from the nearest of @p source, up to @p reach_mm. */
void fap_graph_flood(fap_graph *g, const uint32_t *source, uint32_t source_count, float reach_mm);

#endif
