/* SPDX-License-Identifier: BSD-2-Clause */
/* See studio.h. */
#ifdef HAVE_GL
#include "player/render/gl_objects.h"
#include "player/render/shaders.h"
#include "player/render/studio.h"

enum { UNIT_DRAWN, UNIT_PICTURE };

/* What never changes from picture to picture. */
static void set_uniforms(const studio *s, const gl_functions *gl, const render_look *look)
{
    const float plain[4] = { look->rgb[0] / 255.0f, look->rgb[1] / 255.0f, look->rgb[2] / 255.0f, 1 };

    gl->UseProgram(s->program);
    gl->Uniform1i(gl->GetUniformLocation(s->program, "drawn"), UNIT_DRAWN);
    gl->Uniform1i(gl->GetUniformLocation(s->program, "picture"), UNIT_PICTURE);
    gl->Uniform4fv(gl->GetUniformLocation(s->program, "plain"), 1, plain);
}

static fap_err take_picture(studio *s, const gl_functions *gl, const image *picture, char *where)
{
    s->picture = gl_texture_make(gl, picture);
    s->picture_width = picture->width;
    s->picture_height = picture->height;
    if (s->picture)
        return FAP_OK;
    snprintf(where, FAP_ERROR_TEXT_SIZE, "this OpenGL takes no picture of %d x %d pixels", picture->width,
             picture->height);
    return FAP_E_LIMIT;
}

fap_err studio_make(studio *s, const gl_functions *gl, const render_look *look, char *where)
{
    *s = (studio){ .program = gl_program_make(gl, studio_vertex_source,
                                              studio_fragment_sources[look->backdrop], where) };
    if (!s->program)
        return FAP_E_UNSUPPORTED;
    gl->GenVertexArrays(1, &s->empty_array);
    s->place = gl->GetUniformLocation(s->program, "place");
    s->first_on_top = gl->GetUniformLocation(s->program, "first_on_top");
    s->cover = gl->GetUniformLocation(s->program, "cover");
    set_uniforms(s, gl, look);
    return look->backdrop == BACKDROP_PICTURE ? take_picture(s, gl, look->picture, where) : FAP_OK;
}

void studio_delete(studio *s, const gl_functions *gl)
{
    gl->DeleteProgram(s->program); /* OpenGL ignores 0 */
    gl->DeleteVertexArrays(1, &s->empty_array);
    gl->DeleteTextures(1, &s->picture);
    *s = (studio){ 0 };
}

/* The largest part of the picture, from its middle, that has the frame's shape: corner and size, in shares of it. */
static void find_cover(const studio *s, int width, int height, float cover[4])
{
    const double wide = (double)width * s->picture_height, high = (double)height * s->picture_width;

    cover[2] = wide < high ? (float)(wide / high) : 1;
    cover[3] = wide > high ? (float)(high / wide) : 1;
    cover[0] = (1 - cover[2]) / 2;
    cover[1] = (1 - cover[3]) / 2;
}

static void hang_picture(const studio *s, const gl_functions *gl, int width, int height)
{
    float cover[4];

    find_cover(s, width, height, cover);
    gl->Uniform4fv(s->cover, 1, cover);
    gl->ActiveTexture(GL_TEXTURE0 + UNIT_PICTURE);
    gl->BindTexture(GL_TEXTURE_2D, s->picture);
}

void studio_draw(const studio *s, const gl_functions *gl, GLuint drawn, int x, int y, int width, int height,
                 int first_on_top)
{
    const float place[4] = { (float)x, (float)y, (float)width, (float)height };

    gl->Viewport(x, y, width, height);
    gl->UseProgram(s->program);
    if (s->picture)
        hang_picture(s, gl, width, height);
    gl->ActiveTexture(GL_TEXTURE0 + UNIT_DRAWN);
    gl->BindTexture(GL_TEXTURE_2D, drawn);
    gl->Uniform4fv(s->place, 1, place);
    gl->Uniform1i(s->first_on_top, first_on_top);
    gl->BindVertexArray(s->empty_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}
#endif
