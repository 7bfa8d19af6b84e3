/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What a laid mesh costs: alpha E_dist + beta E_strain + gamma E_bend. Source: Sanchez Lorenzo et al. 2003, section 6, eq. 17
 * and 18; with squares for absolute values, so that there is a gradient where nothing is left to gain.
 */
#ifndef LIB_REGISTRATION_MESH_ENERGY_H
#define LIB_REGISTRATION_MESH_ENERGY_H

#include "registration/control_mesh.h"
#include "registration/elastic.h"

typedef struct energy_weights {
    double dist, strain, bend; /* alpha; beta: mm^2 of length; gamma: mm^2 at a cosine that is 1 off */
    double pin;                /* ours: what landmarks may be off; a mean, as the others are */
    double slide;              /* share of the distance that counts across the scan's normal */
} energy_weights;

/* One edge and what it was like at first. */
typedef struct energy_edge {
    uint32_t vertex[4]; /* its ends, then the far corners of its two triangles; UINT32_MAX: a border */
    double length, bend;
} energy_edge;

typedef struct mesh_energy {
    const control_face *face;
    energy_weights weights;
    uint32_t edge_count, used; /* vertices that take part */
    energy_edge *edge;
    uint32_t *start, *around; /* edges whose cost a vertex changes */
    elastic_pull *pull;       /* [vertex_count] the scan's; the caller fills it */
    const elastic_pin *pin;   /* borrowed; the caller sets them */
    uint32_t pin_count;
} mesh_energy;

/* As @p face is: nothing is strained or bent. FAP_E_NOMEM. mesh_energy_close() in any case. */
fap_err mesh_energy_open(mesh_energy *e, const control_face *face, const fap_allocator *alloc);
void mesh_energy_close(mesh_energy *e, const fap_allocator *alloc);

/* Terms of it; @p pull (NULL: not asked for) gains its gradient. */
double mesh_energy_vertex(const mesh_energy *e, const float (*at)[3], uint32_t vertex, double (*pull)[3]);
double mesh_energy_edge(const mesh_energy *e, const float (*at)[3], uint32_t edge, double (*pull)[3]);
double mesh_energy_pins(const mesh_energy *e, const float (*at)[3], double (*pull)[3]);
/* All of it; @p pull is set, not added to. */
double mesh_energy_all(const mesh_energy *e, const float (*at)[3], double (*pull)[3]);

#endif
