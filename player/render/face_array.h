/* SPDX-License-Identifier: BSD-2-Clause */
/* The face as vertex arrays: what never moves is sent once, positions and normals are streamed once a picture. */
#ifndef PLAYER_RENDER_FACE_ARRAY_H
#define PLAYER_RENDER_FACE_ARRAY_H

#include <fap/bank.h>

#include "player/render/eye_look.h"
#include "player/render/gl.h"

/* Triangles that are drawn by one call, in this order: what hides the most comes first. */
typedef enum face_range { RANGE_SKIN, RANGE_EYE_LEFT, RANGE_EYE_RIGHT, RANGE_INSIDE, RANGE_COUNT } face_range;

typedef struct face_array {
    GLuint array;
    GLuint index_buffer, still_buffer, uv_buffer, moving_buffer; /* uv: 0 where the face has none */
    GLsizei first[RANGE_COUNT + 1]; /* indices in front of each range; then all */
    eye_look eye[2];                /* left, right */
} face_array;

/* @depth_program: draws depth alone, for measuring openness; see occlusion.h. Harmless to delete after a failure. */
fap_err face_array_make(face_array *face, const gl_functions *gl, const fap_bank *bank, GLuint depth_program);
void face_array_delete(face_array *face, const gl_functions *gl);

/* A pose, as fap_face_pose() gives it. FAP_E_NOMEM: the context has no room. */
fap_err face_array_send(const face_array *face, const gl_functions *gl, const fap_mesh *mesh,
                        const float *position, const float *normal);
void face_array_draw(const face_array *face, const gl_functions *gl, face_range range);

#endif
