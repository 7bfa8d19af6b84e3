/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Control points that are moved until the skin on their planar bones costs least. Source: Sanchez Lorenzo et al. 2003,
 * section 6.
 */
#ifndef LIB_REGISTRATION_CONTROL_FIT_H
#define LIB_REGISTRATION_CONTROL_FIT_H

#include <fap/studio/registration.h>

#include "registration/bone_skin.h"
#include "registration/mesh_energy.h"
#include "registration/minimise.h"

typedef struct control_fit {
    bone_skin *skin;
    mesh_energy *energy;
    fap_allocator alloc;
    double (*control)[3]; /* [skin->mesh->count] */
    double (*first)[3];   /* [the same] where their motion counts from */
    double even;    /* weight of how unevenly they moved: ours, for what no scan draws; the caller sets it */
    float (*at)[3]; /* [vertices] where the bones carry them */
    double (*pull)[3]; /* [vertices] */
    lbfgs *lower;
    uint32_t *vertex_stamp, *edge_stamp, stamp; /* simplex: what one control point changes */
    uint32_t *vertex, vertex_count, *edge, edge_count, point;
} control_fit;

/*
 * Both are borrowed, and must outlive it. Control points are where the face is, and have moved from where @p first, [vertices],
 * has them. FAP_E_NOMEM. control_fit_close() in any case.
 */
fap_err control_fit_open(control_fit *f, bone_skin *skin, mesh_energy *energy, const float (*first)[3],
                         fap_optimizer optimizer, const fap_allocator *alloc);
void control_fit_close(control_fit *f);
/* f->at by f->control. 0: a bone has become a line. */
int control_fit_carry(control_fit *f);
/* Value, and gradient where @p gradient is not NULL, for all control points: of minimise.h's kind. */
double control_fit_value(void *user, const double *x, double *gradient);
/* Some steps down, with the pulls as they are. Returns the energy. */
double control_fit_lbfgs(control_fit *f, int iterations);
/* Each control point in turn by a simplex of its own: one of a thousand unknowns would not move. Returns the energy. */
double control_fit_simplex(control_fit *f, double edge_mm);

#endif
