/* SPDX-License-Identifier: BSD-2-Clause */
/* OSMesa: OpenGL in software, without display or driver files. Debian 12 and 13 have it; Mesa 25.1 dropped
 * it. */
#ifdef HAVE_OSMESA
#include <stdio.h>
#include <stdlib.h>

#include "player/render/context.h"

/* GL/osmesa.h would pull in GL/gl.h, whose prototypes clash with glcorearb.h. */
#define __gl_h_    1
#define GLAPIENTRY APIENTRY
#include <GL/osmesa.h>

enum { DUMMY_SIZE = 16 };

/* OSMesa wants a buffer of its own even though nothing is drawn there. */
struct gl_context {
    OSMesaContext osmesa;
    unsigned char dummy[DUMMY_SIZE * DUMMY_SIZE * 4];
};

static gl_function get_function(const char *name)
{
    return (gl_function)OSMesaGetProcAddress(name);
}

void gl_context_make_current(gl_context *context)
{
    OSMesaMakeCurrent(context->osmesa, context->dummy, GL_UNSIGNED_BYTE, DUMMY_SIZE, DUMMY_SIZE);
}

fap_err gl_context_create(gl_context **out, gl_functions *gl, char *where)
{
    static const int attributes[] = { OSMESA_FORMAT,
                                      OSMESA_RGBA,
                                      OSMESA_DEPTH_BITS,
                                      24,
                                      OSMESA_PROFILE,
                                      OSMESA_CORE_PROFILE,
                                      OSMESA_CONTEXT_MAJOR_VERSION,
                                      3,
                                      OSMESA_CONTEXT_MINOR_VERSION,
                                      3,
                                      0 };
    gl_context *context = calloc(1, sizeof *context);

    *out = NULL;
    if (!context)
        return FAP_E_NOMEM;
    context->osmesa = OSMesaCreateContextAttribs(attributes, NULL);
    if (!context->osmesa) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "OSMesa gives no OpenGL 3.3 core context");
        free(context);
        return FAP_E_UNSUPPORTED;
    }
    gl_context_make_current(context);
    const char *missing = gl_load(gl, get_function);
    if (missing) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "OSMesa has no %s", missing);
        gl_context_destroy(context);
        return FAP_E_UNSUPPORTED;
    }
    *out = context;
    return FAP_OK;
}

void gl_context_destroy(gl_context *context)
{
    if (!context)
        return;
    OSMesaDestroyContext(context->osmesa);
    free(context);
}
#endif
