/* SPDX-License-Identifier: BSD-2-Clause */
/* OSMesa: OpenGL in software, without display or driver files. Debian 12 and 13 have it; Mesa 25.1 dropped it. */
#ifdef HAVE_OSMESA
#include "player/render/context.h"

/* GL/osmesa.h would pull in GL/gl.h, whose prototypes clash with glcorearb.h. */
#define __gl_h_    1
#define GLAPIENTRY APIENTRY
#include <GL/osmesa.h>

enum { DUMMY_SIZE = 16 };

/* OSMesa wants a buffer of its own even though nothing is drawn there. */
typedef struct osmesa_state {
    OSMesaContext osmesa;
    unsigned char dummy[DUMMY_SIZE * DUMMY_SIZE * 4];
} osmesa_state;

static int make_current(osmesa_state *s)
{
    return OSMesaMakeCurrent(s->osmesa, s->dummy, GL_UNSIGNED_BYTE, DUMMY_SIZE, DUMMY_SIZE);
}

static int osmesa_open(void *state)
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
    osmesa_state *s = state;

    s->osmesa = OSMesaCreateContextAttribs(attributes, NULL);
    return s->osmesa && make_current(s);
}

static void osmesa_make_current(void *state)
{
    make_current(state);
}

static gl_function osmesa_get_function(const char *name)
{
    return (gl_function)OSMesaGetProcAddress(name);
}

static void osmesa_close(void *state)
{
    osmesa_state *s = state;
    if (s->osmesa)
        OSMesaDestroyContext(s->osmesa);
}

const gl_context_driver gl_context_osmesa = {
    .name = "osmesa",
    .missing = "OSMesa gives no OpenGL 3.3 core context",
    .state_size = sizeof(osmesa_state),
    .open = osmesa_open,
    .make_current = osmesa_make_current,
    .get_function = osmesa_get_function,
    .close = osmesa_close,
};
#endif
