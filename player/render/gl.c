/* SPDX-License-Identifier: BSD-2-Clause */
/* See gl.h. Empty in a build without any GL context, where GL/glcorearb.h may be missing too. */
#ifdef HAVE_GL
#include <stddef.h>

#include "player/render/gl.h"

const char *gl_load(gl_functions *gl, gl_function (*get)(const char *name))
{
#define X(type, name)                                                                                        \
    gl->name = (type)get("gl" #name);                                                                        \
    if (!gl->name)                                                                                           \
        return "gl" #name;
    GL_FUNCTIONS(X)
#undef X
    return NULL;
}
#endif
