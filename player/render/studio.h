/* SPDX-License-Identifier: BSD-2-Clause */
/* The end of a picture: what was drawn, larger than the picture and before nothing, becomes smaller before the backdrop. */
#ifndef PLAYER_RENDER_STUDIO_H
#define PLAYER_RENDER_STUDIO_H

#include <fap/error.h>

#include "player/render/gl.h"
#include "player/render/look.h"

typedef struct studio {
    GLuint program, empty_array; /* core profiles want an array even where no vertices are read */
    GLint place, first_on_top, cover;
    GLuint picture; /* BACKDROP_PICTURE, or 0 */
    int picture_width, picture_height;
} studio;

/* @where: FAP_ERROR_TEXT_SIZE bytes. FAP_E_LIMIT: the picture is too large. Harmless to delete after a failure. */
fap_err studio_make(studio *s, const gl_functions *gl, const render_look *look, char *where);
void studio_delete(studio *s, const gl_functions *gl);

/*
 * Into what is bound, its corner at (@x, @y) as OpenGL counts.
 * @drawn         texture, any size
 * @first_on_top  0: rows go up, as OpenGL's; 1: down, as a picture's
 */
void studio_draw(const studio *s, const gl_functions *gl, GLuint drawn, int x, int y, int width, int height,
                 int first_on_top);

#endif
