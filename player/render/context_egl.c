/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * EGL without a surface: OpenGL on a machine that has a driver but no display, in software where there is no graphics card.
 * Mesa's way forward since it dropped OSMesa; the pictures are the same bits where both draw in software.
 * Source: EGL_MESA_platform_surfaceless, EGL_KHR_surfaceless_context.
 */
#ifdef HAVE_EGL
#include "player/render/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

typedef struct egl_state {
    EGLDisplay display;
    EGLContext context;
} egl_state;

static EGLDisplay open_display(void)
{
    const PFNEGLGETPLATFORMDISPLAYEXTPROC get =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    const EGLDisplay display =
        get ? get(EGL_PLATFORM_SURFACELESS_MESA, (void *)EGL_DEFAULT_DISPLAY, NULL) : EGL_NO_DISPLAY;

    return display != EGL_NO_DISPLAY && eglInitialize(display, NULL, NULL) ? display : EGL_NO_DISPLAY;
}

static EGLContext create_context(EGLDisplay display)
{
    static const EGLint wanted[] = { EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                     EGL_NONE };
    static const EGLint attributes[] = { EGL_CONTEXT_MAJOR_VERSION,
                                         3,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         3,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_NONE };
    EGLConfig config;
    EGLint count;

    if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, wanted, &config, 1, &count) || count < 1)
        return EGL_NO_CONTEXT;
    return eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
}

static int make_current(egl_state *s)
{
    return eglMakeCurrent(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, s->context) == EGL_TRUE;
}

static int egl_open(void *state)
{
    egl_state *s = state;

    s->context = EGL_NO_CONTEXT;
    s->display = open_display();
    if (s->display != EGL_NO_DISPLAY)
        s->context = create_context(s->display);
    return s->context != EGL_NO_CONTEXT && make_current(s);
}

static void egl_make_current(void *state)
{
    make_current(state);
}

static gl_function egl_get_function(const char *name)
{
    return (gl_function)eglGetProcAddress(name);
}

/* The display is the process's: eglTerminate() would take it from other contexts too. */
static void egl_close(void *state)
{
    egl_state *s = state;

    if (s->context == EGL_NO_CONTEXT)
        return;
    eglMakeCurrent(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(s->display, s->context);
}

const gl_context_driver gl_context_egl = {
    .name = "egl",
    .missing = "EGL gives no OpenGL 3.3 core context without a display",
    .state_size = sizeof(egl_state),
    .open = egl_open,
    .make_current = egl_make_current,
    .get_function = egl_get_function,
    .close = egl_close,
};
#endif
