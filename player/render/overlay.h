/* SPDX-License-Identifier: BSD-2-Clause */
/* What is drawn over the face on demand: the edges of its triangles, and discs at marked places. */
#ifndef PLAYER_RENDER_OVERLAY_H
#define PLAYER_RENDER_OVERLAY_H

#include "player/render/camera.h"
#include "player/render/face_array.h"
#include "player/render/renderer.h"

typedef struct overlay {
    GLuint wire_program, mark_program;
    GLint wire_view, mark_view, mark_eye, mark_size, mark_nearer, mark_alpha; /* uniforms */
    GLuint mark_array, mark_buffer;
} overlay;

/* @where: FAP_ERROR_TEXT_SIZE bytes. Harmless to delete after a failure. */
fap_err overlay_make(overlay *o, const gl_functions *gl, char *where);
void overlay_delete(overlay *o, const gl_functions *gl);

/* Both draw into what is bound, tested against the face's depth. */
void overlay_draw_wire(const overlay *o, const gl_functions *gl, const face_array *face,
                       const render_lens *lens);
void overlay_draw_marks(const overlay *o, const gl_functions *gl, const render_mark *mark, int count,
                        const render_lens *lens, float size_px);

#endif
