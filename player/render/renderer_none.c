/* SPDX-License-Identifier: BSD-2-Clause */
/* The renderer of a build without OpenGL: it says so. */
#ifndef HAVE_GL
#include "player/render/renderer.h"

static fap_err none(renderer **out, char *where)
{
    *out = NULL;
    snprintf(where, FAP_ERROR_TEXT_SIZE,
             "built without OpenGL: install libosmesa6-dev or libegl-dev and build again");
    return FAP_E_UNSUPPORTED;
}

fap_err renderer_create(renderer **out, const char *gl, const fap_bank *bank, int width, int height,
                        char *where)
{
    (void)gl, (void)bank, (void)width, (void)height;
    return none(out, where);
}

fap_err renderer_create_on(renderer **out, const gl_context_source *source, const fap_bank *bank, int width,
                           int height, char *where)
{
    (void)source, (void)bank, (void)width, (void)height;
    return none(out, where);
}

void renderer_destroy(renderer **r)
{
    *r = NULL;
}

fap_err renderer_dress(renderer *r, const render_look *look, char *where)
{
    (void)r, (void)look;
    *where = '\0';
    return FAP_E_UNSUPPORTED;
}

fap_err renderer_resize(renderer *r, int width, int height)
{
    (void)r, (void)width, (void)height;
    return FAP_E_UNSUPPORTED;
}

fap_err renderer_draw(renderer *r, const render_scene *scene, image *out)
{
    (void)r, (void)scene, (void)out;
    return FAP_E_UNSUPPORTED;
}

fap_err renderer_begin(renderer *r, const render_scene *scene)
{
    (void)r, (void)scene;
    return FAP_E_UNSUPPORTED;
}

fap_err renderer_finish(renderer *r, image *out)
{
    (void)r, (void)out;
    return FAP_E_UNSUPPORTED;
}

fap_err renderer_show(renderer *r, const render_scene *scene, render_target target)
{
    (void)r, (void)scene, (void)target;
    return FAP_E_UNSUPPORTED;
}

int renderer_project(const renderer *r, const render_view *view, const float place_mm[3], float pixel[3])
{
    (void)r, (void)view, (void)place_mm, (void)pixel;
    return 0;
}

const char *renderer_description(const renderer *r)
{
    (void)r;
    return "none";
}

const char *renderer_gl_name(int i)
{
    (void)i;
    return NULL;
}
#else
typedef int renderer_none_is_empty;
#endif
