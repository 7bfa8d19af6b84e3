/* SPDX-License-Identifier: BSD-2-Clause */
/* See studio.h. */
#ifdef HAVE_GL
#include "player/render/gl_objects.h"
#include "player/render/shaders.h"
#include "player/render/studio.h"

fap_err studio_make(studio *s, const gl_functions *gl, char *where)
{
    *s = (studio){ .program = gl_program_make(gl, studio_vertex_source, studio_fragment_source, where) };
    if (!s->program)
        return FAP_E_UNSUPPORTED;
    gl->GenVertexArrays(1, &s->empty_array);
    s->place = gl->GetUniformLocation(s->program, "place");
    s->first_on_top = gl->GetUniformLocation(s->program, "first_on_top");
    s->drawn = gl->GetUniformLocation(s->program, "drawn");
    return FAP_OK;
}

void studio_delete(studio *s, const gl_functions *gl)
{
    gl->DeleteProgram(s->program);
    gl->DeleteVertexArrays(1, &s->empty_array);
    *s = (studio){ 0 };
}

void studio_draw(const studio *s, const gl_functions *gl, GLuint drawn, int x, int y, int width, int height,
                 int first_on_top)
{
    const float place[4] = { (float)x, (float)y, (float)width, (float)height };

    gl->Viewport(x, y, width, height);
    gl->UseProgram(s->program);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, drawn);
    gl->Uniform1i(s->drawn, 0);
    gl->Uniform4fv(s->place, 1, place);
    gl->Uniform1i(s->first_on_top, first_on_top);
    gl->BindVertexArray(s->empty_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}
#endif
