/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * An OpenGL 3.3 core context without a window. One driver file each: context_osmesa.c today. The renderer draws into its own
 * framebuffer object whichever it is, so another context is one more file.
 */
#ifndef PLAYER_RENDER_CONTEXT_H
#define PLAYER_RENDER_CONTEXT_H

#include <fap/error.h>

#include "player/render/gl.h"

typedef struct gl_context gl_context;

/* Makes the context current on this thread and loads @gl from it. @where: FAP_ERROR_TEXT_SIZE bytes. */
fap_err gl_context_create(gl_context **out, gl_functions *gl, char *where);
void gl_context_make_current(gl_context *context);
void gl_context_destroy(gl_context *context);

#endif
