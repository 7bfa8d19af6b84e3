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

static void set_borders(const gl_functions *gl)
{
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GLuint gl_texture_make(const gl_functions *gl, const image *picture)
{
    GLint most = 0;
    GLuint texture;

    gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (picture->width > most || picture->height > most)
        return 0;
    gl->GenTextures(1, &texture);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture->width, picture->height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   picture->rgba);
    gl->GenerateMipmap(GL_TEXTURE_2D);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    set_borders(gl);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    return texture;
}

static GLuint make_colour(const gl_functions *gl, int width, int height)
{
    GLuint texture;

    gl->GenTextures(1, &texture);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    set_borders(gl);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    return texture;
}

static GLuint make_depth(const gl_functions *gl, int width, int height)
{
    GLuint store;

    gl->GenRenderbuffers(1, &store);
    gl->BindRenderbuffer(GL_RENDERBUFFER, store);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, store);
    return store;
}

int gl_target_make(const gl_functions *gl, gl_target *target, int width, int height, int has_depth)
{
    *target = (gl_target){ 0 };
    gl->GenFramebuffers(1, &target->frame);
    gl->BindFramebuffer(GL_FRAMEBUFFER, target->frame);
    target->colour = make_colour(gl, width, height);
    if (has_depth)
        target->depth = make_depth(gl, width, height);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return 1;
    gl_target_delete(gl, target);
    return 0;
}

void gl_target_delete(const gl_functions *gl, gl_target *target)
{
    gl->DeleteFramebuffers(1, &target->frame); /* OpenGL ignores 0 */
    gl->DeleteTextures(1, &target->colour);
    gl->DeleteRenderbuffers(1, &target->depth);
    *target = (gl_target){ 0 };
}
#endif
