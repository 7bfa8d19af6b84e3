/* SPDX-License-Identifier: BSD-2-Clause */
/* The values of --gl, in every build: asking for one that is not built in is no mistake in the command line. */
#include <string.h>

#include "player/render/renderer.h"

int render_gl_known(const char *name)
{
    return !strcmp(name, "osmesa") || !strcmp(name, "egl") || !strcmp(name, "glfw");
}
