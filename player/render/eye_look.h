/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What the eyes' shader has to know of a face. Iris and pupil are painted by the shader, because eyeballs have too few vertices
 * for round ones; their size and colour come from the vertices' colours.
 */
#ifndef PLAYER_RENDER_EYE_LOOK_H
#define PLAYER_RENDER_EYE_LOOK_H

#include <cglm/cglm.h>

#include <fap/bank.h>

typedef struct eye_look {
    float radius_mm;
    float
        limbus; /* the iris' radius as a share of the eyeball's; 0: no iris was found, vertices keep their colours */
    vec3 iris, white;          /* linear */
    uint32_t front;            /* the vertex in the middle of the pupil */
    const fap_bank_point *lid; /* the middle of the upper lid's edge; NULL: this face has none */
} eye_look;

/*
 * @on_eye  [vertex_count][2], of this eye's vertices alone: right and up from the middle of the pupil, 32767 is the radius
 */
void eye_look_measure(eye_look *eye, const fap_bank *bank, int right, int16_t (*on_eye)[2]);

/* Of one pose: where the eye looks, and where the middle of the upper lid is. */
void eye_look_pose(const eye_look *eye, const fap_mesh *mesh, const float *position, const float *normal,
                   vec3 gaze, vec3 lid);

#endif
