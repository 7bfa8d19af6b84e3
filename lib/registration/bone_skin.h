/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A skin that planar bones carry: which of them have a say in which vertex, where it goes when their corners go, and the
 * other way round. Source: Sanchez Lorenzo et al. 2003, section 4 (eq. 1 to 12).
 */
#ifndef LIB_REGISTRATION_BONE_SKIN_H
#define LIB_REGISTRATION_BONE_SKIN_H

#include "bank/planar_bone.h"
#include "registration/control_mesh.h"

/* At most this many bones carry one vertex; lighter ones are left out. */
enum { BONE_SAYS = 8 };

typedef struct bone_say {
    fap_bone_place place;
    float weight;
    uint32_t bone;
} bone_say;

typedef struct bone_pull bone_pull; /* what is drawn at a bone's vectors */

typedef struct bone_skin {
    const control_mesh *mesh;
    uint32_t vertex_count;
    uint8_t *says;              /* [vertex_count] how many; 0: nobody carries it */
    bone_say (*say)[BONE_SAYS]; /* weights sum to one */
    fap_planar_bone *bone;      /* [mesh->bone_count], as posed */
    uint32_t *start, *around;   /* bones of each control point */
    bone_pull *pull;
} bone_skin;

/* Bones at rest where the face is; @p mesh is borrowed. FAP_E_NOMEM. bone_skin_close() in any case. */
fap_err bone_skin_open(bone_skin *s, const control_face *face, const control_mesh *mesh,
                       const fap_allocator *alloc);
void bone_skin_close(bone_skin *s, const fap_allocator *alloc);

/* Bones go where the control points are. 0: one of those around @p point (UINT32_MAX: of all) has become a line. */
int bone_skin_set(bone_skin *s, const double (*control)[3], uint32_t point);
void bone_skin_carry(const bone_skin *s, uint32_t vertex, float at[3]);
/* What is drawn at the vertices becomes what is drawn at the control points: the transposed derivative of carrying. */
void bone_skin_pull(bone_skin *s, const double (*vertex)[3], double (*control)[3]);

#endif
