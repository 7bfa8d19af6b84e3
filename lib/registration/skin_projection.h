/* SPDX-License-Identifier: BSD-2-Clause */
/* The last half millimetre: skin to the scan along rays from the head's axis. Source: Sanchez Lorenzo et al. 2003, section 6. */
#ifndef LIB_REGISTRATION_SKIN_PROJECTION_H
#define LIB_REGISTRATION_SKIN_PROJECTION_H

#include "registration/control_mesh.h"
#include "registration/counterpart.h"
#include "registration/cylinder.h"

/*
 * Moves @p at, which l->at is, to where the rays meet the scan, no farther than @p limit; the ways of neighbours are smoothed, for a
 * scanner's noise is not the person's. FAP_E_NOMEM.
 */
fap_err skin_project(const counterparts *c, const control_face *face, const cylinder *axis, double limit,
                     float (*at)[3]);

#endif
