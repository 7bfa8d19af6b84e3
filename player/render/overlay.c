/* SPDX-License-Identifier: BSD-2-Clause */
/* See overlay.h. */
#ifdef HAVE_GL
#include "player/render/gl_objects.h"
#include "player/render/overlay.h"
#include "player/render/shaders.h"

enum { PLACE, COLOUR };

static const gl_attribute mark_attributes[] = {
    { PLACE, 3, GL_FLOAT, GL_FALSE, offsetof(render_mark, place_mm) },
    { COLOUR, 3, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(render_mark, rgb) },
};

fap_err overlay_make(overlay *o, const gl_functions *gl, char *where)
{
    *o = (overlay){
        .wire_program = gl_program_make(gl, depth_vertex_source, wire_fragment_source, where),
        .mark_program = gl_program_make(gl, mark_vertex_source, mark_fragment_source, where),
    };
    if (!o->wire_program || !o->mark_program)
        return FAP_E_UNSUPPORTED;
    o->wire_view = gl->GetUniformLocation(o->wire_program, "view_projection");
    o->mark_view = gl->GetUniformLocation(o->mark_program, "view_projection");
    o->mark_size = gl->GetUniformLocation(o->mark_program, "size");
    o->mark_nearer = gl->GetUniformLocation(o->mark_program, "nearer");
    o->mark_eye = gl->GetUniformLocation(o->mark_program, "eye");
    o->mark_alpha = gl->GetUniformLocation(o->mark_program, "alpha");
    gl->GenVertexArrays(1, &o->mark_array);
    gl->BindVertexArray(o->mark_array);
    o->mark_buffer = gl_buffer_make(gl, GL_ARRAY_BUFFER, NULL, sizeof(render_mark), GL_STREAM_DRAW);
    gl_attributes_set(gl, mark_attributes, 2, sizeof(render_mark));
    return FAP_OK;
}

void overlay_delete(overlay *o, const gl_functions *gl)
{
    gl->DeleteProgram(o->wire_program);
    gl->DeleteProgram(o->mark_program);
    gl->DeleteVertexArrays(1, &o->mark_array);
    gl->DeleteBuffers(1, &o->mark_buffer);
    *o = (overlay){ 0 };
}

/* Lines lie in the triangles they border on: a step towards the eye makes them win. */
void overlay_draw_wire(const overlay *o, const gl_functions *gl, const face_array *face,
                       const render_lens *lens)
{
    gl->UseProgram(o->wire_program);
    gl->UniformMatrix4fv(o->wire_view, 1, GL_FALSE, lens->view_projection[0]);
    gl->Enable(GL_POLYGON_OFFSET_LINE);
    gl->PolygonOffset(-1, -2);
    gl->PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    for (int range = 0; range < RANGE_COUNT; range++)
        face_array_draw(face, gl, (face_range)range);
    gl->PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    gl->Disable(GL_POLYGON_OFFSET_LINE);
}

void overlay_draw_marks(const overlay *o, const gl_functions *gl, const render_mark *mark, int count,
                        const render_lens *lens, float size_px)
{
    /* Share of the distance to the eye that a mark on the skin is drawn nearer, so that its disc is not half inside. */
    const float nearer = 0.008f, behind_alpha = 0.3f;

    gl->BindVertexArray(o->mark_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, o->mark_buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)((size_t)count * sizeof *mark), mark, GL_STREAM_DRAW);
    gl->UseProgram(o->mark_program);
    gl->UniformMatrix4fv(o->mark_view, 1, GL_FALSE, lens->view_projection[0]);
    gl->Uniform1f(o->mark_size, size_px);
    gl->Uniform1f(o->mark_nearer, nearer);
    gl->Uniform3fv(o->mark_eye, 1, lens->eye);
    gl->Enable(GL_PROGRAM_POINT_SIZE);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl->Disable(GL_DEPTH_TEST);
    gl->Uniform1f(o->mark_alpha, behind_alpha);
    gl->DrawArrays(GL_POINTS, 0, count);
    gl->Enable(GL_DEPTH_TEST);
    gl->Uniform1f(o->mark_alpha, 1);
    gl->DrawArrays(GL_POINTS, 0, count);
    gl->Disable(GL_BLEND);
    gl->Disable(GL_PROGRAM_POINT_SIZE);
}
#endif
