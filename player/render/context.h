/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * OpenGL 3.3 core contexts without a window: one driver file each, and the list of those in this build. The renderer draws
 * into its own framebuffer object whichever it is; the context of a window is the window's own and comes to the
 * renderer as a gl_context_source.
 */
#ifndef PLAYER_RENDER_CONTEXT_H
#define PLAYER_RENDER_CONTEXT_H

#include <stddef.h>

#include <fap/error.h>

#include "player/render/gl.h"

typedef struct gl_context_driver {
    const char *name;    /* of --gl */
    const char *missing; /* what to say when it cannot be had */
    size_t state_size;
    int (*open)(void *state); /* 0: none to be had; current on this thread when it succeeds */
    void (*make_current)(void *state);
    gl_function (*get_function)(const char *name);
    void (*close)(void *state); /* also after a failed open */
} gl_context_driver;

extern const gl_context_driver gl_context_osmesa, gl_context_egl, gl_context_glfw;
/* Those in this build in the order they are tried, then NULL. */
extern const gl_context_driver *const gl_context_drivers[];

typedef struct gl_context {
    const gl_context_driver *driver;
    void *state;
} gl_context;

/*
 * @name  of the driver; NULL: the first that works
 * @where FAP_ERROR_TEXT_SIZE bytes: why there is none
 */
fap_err gl_context_open(gl_context *context, const char *name, char *where);
/* Harmless on a zeroed one. */
void gl_context_close(gl_context *context);

#endif
