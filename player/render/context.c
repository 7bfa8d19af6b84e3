/* SPDX-License-Identifier: BSD-2-Clause */
/* See context.h. Adding a context: its driver file, a line here, a line in the Makefile. */
#ifdef HAVE_GL
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "player/render/context.h"

const gl_context_driver *const gl_context_drivers[] = {
#ifdef HAVE_OSMESA
    &gl_context_osmesa,
#endif
#ifdef HAVE_EGL
    &gl_context_egl,
#endif
#ifdef HAVE_GLFW
    &gl_context_glfw,
#endif
    NULL,
};

static void add_words(char *where, const char *words)
{
    const size_t used = strlen(where);
    snprintf(where + used, FAP_ERROR_TEXT_SIZE - used, "%s%s", used ? "; " : "", words);
}

static fap_err open_driver(gl_context *context, const gl_context_driver *driver, char *where)
{
    *context = (gl_context){ driver, calloc(1, driver->state_size) };
    if (!context->state)
        return FAP_E_NOMEM;
    if (driver->open(context->state))
        return FAP_OK;
    gl_context_close(context);
    add_words(where, driver->missing);
    return FAP_E_UNSUPPORTED;
}

fap_err gl_context_open(gl_context *context, const char *name, char *where)
{
    fap_err err = FAP_E_UNSUPPORTED;

    *where = '\0';
    for (int i = 0; gl_context_drivers[i] && err == FAP_E_UNSUPPORTED; i++)
        if (!name || !strcmp(gl_context_drivers[i]->name, name))
            err = open_driver(context, gl_context_drivers[i], where);
    if (err && !*where)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "built without %s",
                 name ? name : "a way to draw without a window");
    return err;
}

void gl_context_close(gl_context *context)
{
    if (context->state)
        context->driver->close(context->state);
    free(context->state);
    *context = (gl_context){ 0 };
}
#endif
