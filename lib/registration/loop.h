/* SPDX-License-Identifier: BSD-2-Clause */
/* Loop's subdivision of a triangle mesh. Source: C. Loop, Smooth subdivision surfaces based on triangles, 1987; Zhu 2006 section 4.4. */
#ifndef LIB_REGISTRATION_LOOP_H
#define LIB_REGISTRATION_LOOP_H

#include <stdint.h>

#include <fap/alloc.h>
#include <fap/error.h>

/* Vertices: the old ones first, in their order, then one an edge. Four triangles for one, the corners' first. */
typedef struct loop_mesh {
    uint32_t vertex_count, triangle_count;
    float (*position)[3];
    uint32_t (*triangle)[3];
    uint8_t *part,
        *mask; /* a new vertex has the part of its edge, and what both its ends have of the masks */
} loop_mesh;

/*
 * One step. @p part and @p mask may be NULL, and are in @p out then. FAP_E_LIMIT past FAP_SURFACE_MAX_VERTICES; FAP_E_NOMEM.
 * loop_free() in any case.
 */
fap_err loop_subdivide(loop_mesh *out, const float (*position)[3], uint32_t vertex_count,
                       const uint32_t (*triangle)[3], uint32_t triangle_count, const uint8_t *part,
                       const uint8_t *mask, const fap_allocator *alloc);
/* One-to-four without rounding: old vertices stay, new ones are in the middle of their edges (Yano & Harada 2009, 3.1). */
fap_err loop_split(loop_mesh *out, const float (*position)[3], uint32_t vertex_count,
                   const uint32_t (*triangle)[3], uint32_t triangle_count, const uint8_t *part,
                   const uint8_t *mask, const fap_allocator *alloc);
void loop_free(loop_mesh *m, const fap_allocator *alloc);

#endif
