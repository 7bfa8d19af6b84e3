/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A coarse net of triangles over a fine face: control points spread along the surface, joined where the parts of the skin that
 * each is nearest to meet. A slit is a border, so no triangle spans one. Source for what it is for: Sanchez Lorenzo et al.
 * 2003, section 4 and 6.
 */
#ifndef LIB_REGISTRATION_CONTROL_MESH_H
#define LIB_REGISTRATION_CONTROL_MESH_H

#include <stdint.h>

#include <fap/alloc.h>
#include <fap/error.h>

#include "surface/edges.h"

/* The fine face; all borrowed. */
typedef struct control_face {
    const float (*position)[3];
    uint32_t vertex_count;
    const uint32_t (*triangle)[3];
    uint32_t triangle_count;
    const surface_edges *edges;
    const uint8_t *use;  /* [vertex_count] 0: takes no part */
    const uint8_t *mask; /* [vertex_count] of ::fap_mask bits; NULL: no slits */
} control_face;

enum { CONTROL_NONE = -1 };

typedef struct control_mesh {
    uint32_t count;      /* of control points */
    uint32_t *vertex;    /* [count] the fine face's, where each is */
    int32_t *owner;      /* [vertex_count] the control point nearest along the surface, or CONTROL_NONE */
    uint32_t bone_count; /* triangles, facing as the fine face does */
    uint32_t (*bone)[3];
} control_mesh;

/*
 * @p seed  vertices that are control points in any case; more are added where the net is widest, to @p count in all, on lips
 *          and lids twice as close. FAP_E_DATA: too few for a triangle. FAP_E_NOMEM. control_mesh_free() in any case.
 */
fap_err control_mesh_make(control_mesh *out, const control_face *face, const uint32_t *seed,
                          uint32_t seed_count, uint32_t count, const fap_allocator *alloc);
void control_mesh_free(control_mesh *m, const fap_allocator *alloc);

#endif
