/* SPDX-License-Identifier: BSD-2-Clause */
/* The renderer of a build without OpenGL: it says so. */
#ifndef HAVE_OSMESA
#include "player/render/renderer.h"

fap_err renderer_create(renderer **out, const fap_bank *bank, int width, int height, char *where)
{
    (void)bank, (void)width, (void)height;
    *out = NULL;
    snprintf(where, FAP_ERROR_TEXT_SIZE, "built without OSMesa: install libosmesa6-dev and build again");
    return FAP_E_UNSUPPORTED;
}

void renderer_destroy(renderer **r)
{
    *r = NULL;
}

fap_err renderer_draw(renderer *r, const float *position, const float *normal, render_camera camera,
                      image *out)
{
    (void)r, (void)position, (void)normal, (void)camera, (void)out;
    return FAP_E_UNSUPPORTED;
}

const char *renderer_description(const renderer *r)
{
    (void)r;
    return "none";
}
#else
typedef int renderer_none_is_empty;
#endif
