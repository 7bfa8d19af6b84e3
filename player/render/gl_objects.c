/* SPDX-License-Identifier: BSD-2-Clause */
/* See gl_objects.h. */
#ifdef HAVE_GL
#include <fap/error.h>

#include "player/render/gl_objects.h"

static GLuint compile(const gl_functions *gl, GLenum type, const char *source, char *where)
{
    const GLuint shader = gl->CreateShader(type);
    GLint ok;

    gl->ShaderSource(shader, 1, &source, NULL);
    gl->CompileShader(shader);
    gl->GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok)
        return shader;
    gl->GetShaderInfoLog(shader, FAP_ERROR_TEXT_SIZE, NULL, where);
    gl->DeleteShader(shader);
    return 0;
}

static GLuint link(const gl_functions *gl, GLuint vertex, GLuint fragment, char *where)
{
    const GLuint program = gl->CreateProgram();
    GLint ok;

    gl->AttachShader(program, vertex);
    gl->AttachShader(program, fragment);
    gl->LinkProgram(program);
    gl->GetProgramiv(program, GL_LINK_STATUS, &ok);
    if (ok)
        return program;
    gl->GetProgramInfoLog(program, FAP_ERROR_TEXT_SIZE, NULL, where);
    gl->DeleteProgram(program);
    return 0;
}

GLuint gl_program_make(const gl_functions *gl, const char *vertex_source, const char *fragment_source,
                       char *where)
{
    const GLuint vertex = compile(gl, GL_VERTEX_SHADER, vertex_source, where);
    const GLuint fragment = vertex ? compile(gl, GL_FRAGMENT_SHADER, fragment_source, where) : 0;
    const GLuint program = fragment ? link(gl, vertex, fragment, where) : 0;

    gl->DeleteShader(vertex); /* goes with the program */
    gl->DeleteShader(fragment);
    return program;
}

GLuint gl_buffer_make(const gl_functions *gl, GLenum target, const void *data, size_t size, GLenum usage)
{
    GLuint buffer;

    gl->GenBuffers(1, &buffer);
    gl->BindBuffer(target, buffer);
    gl->BufferData(target, (GLsizeiptr)size, data, usage);
    return buffer;
}

void gl_attributes_set(const gl_functions *gl, const gl_attribute *attribute, int count, size_t stride)
{
    for (const gl_attribute *a = attribute; a < attribute + count; a++) {
        gl->EnableVertexAttribArray(a->index);
        gl->VertexAttribPointer(a->index, a->size, a->type, a->normalized, (GLsizei)stride,
                                (const void *)a->offset);
    }
}

static GLuint make_store(const gl_functions *gl, GLenum attachment, GLenum format, int width, int height,
                         int samples)
{
    GLuint store;

    gl->GenRenderbuffers(1, &store);
    gl->BindRenderbuffer(GL_RENDERBUFFER, store);
    gl->RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, store);
    return store;
}

int gl_target_make(const gl_functions *gl, gl_target *target, int width, int height, int samples,
                   int has_depth)
{
    *target = (gl_target){ 0 };
    gl->GenFramebuffers(1, &target->frame);
    gl->BindFramebuffer(GL_FRAMEBUFFER, target->frame);
    target->colour = make_store(gl, GL_COLOR_ATTACHMENT0, GL_RGBA8, width, height, samples);
    if (has_depth)
        target->depth = make_store(gl, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, width, height, samples);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return 1;
    gl_target_delete(gl, target);
    return 0;
}

void gl_target_delete(const gl_functions *gl, gl_target *target)
{
    gl->DeleteFramebuffers(1, &target->frame); /* OpenGL ignores 0 */
    gl->DeleteRenderbuffers(1, &target->colour);
    gl->DeleteRenderbuffers(1, &target->depth);
    *target = (gl_target){ 0 };
}
#endif
