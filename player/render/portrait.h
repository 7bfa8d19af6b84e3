/* SPDX-License-Identifier: BSD-2-Clause */
/* The two programs that draw a face, skin with what is inside the mouth and eyes, and what they are told of a picture. */
#ifndef PLAYER_RENDER_PORTRAIT_H
#define PLAYER_RENDER_PORTRAIT_H

#include "player/render/camera.h"
#include "player/render/face_array.h"
#include "player/render/image.h"

typedef struct portrait {
    GLuint skin_program, eye_program;
    GLuint skin_picture; /* or 0: the bank's colours */
    /* uniforms */
    struct {
        GLint view_projection, view, half_key;
    } skin;
    struct {
        GLint view_projection, view, gaze, lid, iris, white, limbus, size;
    } eye;
} portrait;

/* @skin_picture: laid on the skin, or NULL. @where: FAP_ERROR_TEXT_SIZE bytes. FAP_E_LIMIT: that is too large. Harmless to delete after a failure. */
fap_err portrait_make(portrait *p, const gl_functions *gl, const image *skin_picture, char *where);
void portrait_delete(portrait *p, const gl_functions *gl);

/* What is looked at and from where: the arrays that hold the pose, and the pose for what of it is no vertex. */
typedef struct portrait_pose {
    const face_array *face;
    const fap_mesh *mesh;
    const float *position, *normal;
    const head_frame *head;
    const render_lens *lens;
} portrait_pose;

/* Into what is bound, with depth test and culling as they are. */
void portrait_draw(const portrait *p, const gl_functions *gl, const portrait_pose *pose);

#endif
