/* SPDX-License-Identifier: BSD-2-Clause */
/* Programs, buffers and framebuffers of OpenGL in a call each. */
#ifndef PLAYER_RENDER_GL_OBJECTS_H
#define PLAYER_RENDER_GL_OBJECTS_H

#include <stddef.h>

#include "player/render/gl.h"
#include "player/render/image.h"

/* 0 on failure, with the compiler's words in @where (FAP_ERROR_TEXT_SIZE bytes). */
GLuint gl_program_make(const gl_functions *gl, const char *vertex_source, const char *fragment_source,
                       char *where);

/* @data may be NULL: room only. */
GLuint gl_buffer_make(const gl_functions *gl, GLenum target, const void *data, size_t size, GLenum usage);

/* An attribute of the bound vertex array out of the bound buffer. */
typedef struct gl_attribute {
    GLuint index;
    int size;
    GLenum type;
    GLboolean normalized;
    size_t offset;
} gl_attribute;

void gl_attributes_set(const gl_functions *gl, const gl_attribute *attribute, int count, size_t stride);

/* A picture to look up, its first row at 0, smoothed where it becomes smaller. 0: the context takes none of this size. */
GLuint gl_texture_make(const gl_functions *gl, const image *picture);

/* A framebuffer object and what it is made of. */
typedef struct gl_target {
    GLuint frame, colour, depth; /* colour: a texture, read between its pixels */
} gl_target;

/* @has_depth: 0 colour alone. @return 0: too large, and nothing was made */
int gl_target_make(const gl_functions *gl, gl_target *target, int width, int height, int has_depth);
/* Harmless on a zeroed one. */
void gl_target_delete(const gl_functions *gl, gl_target *target);

#endif
