/* SPDX-License-Identifier: BSD-2-Clause */
/* See renderer.h. */
#ifdef HAVE_OSMESA
#include <stdlib.h>
#include <string.h>

#include "player/render/camera.h"
#include "player/render/context.h"
#include "player/render/occlusion.h"
#include "player/render/renderer.h"
#include "player/render/shaders.h"

enum { SAMPLES = 4 };
enum { ATTRIBUTE_POSITION, ATTRIBUTE_NORMAL, ATTRIBUTE_PAINT, ATTRIBUTE_SURFACE };

typedef struct moving_vertex {
    float position[3], normal[3];
} moving_vertex;

typedef struct still_vertex {
    uint8_t paint[4];
    uint8_t open, part, head, unused;
} still_vertex;

struct renderer {
    gl_context *context;
    gl_functions gl;
    const fap_bank *bank;
    int width, height;
    moving_vertex *moving;
    GLuint drawn, resolved; /* framebuffers: multisampled, and what is read back */
    GLuint background, face;
    GLuint background_array, face_array, moving_buffer, index_buffer;
    GLint view_projection, eye;
};

static GLuint compile(gl_functions *gl, GLenum type, const char *source, char *where)
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

/* 0 on failure, with the compiler's words in @where. */
static GLuint build_program(gl_functions *gl, const char *vertex_source, const char *fragment_source,
                            char *where)
{
    const GLuint vertex = compile(gl, GL_VERTEX_SHADER, vertex_source, where);
    const GLuint fragment = vertex ? compile(gl, GL_FRAGMENT_SHADER, fragment_source, where) : 0;
    GLint ok;

    if (!fragment)
        return 0;
    const GLuint program = gl->CreateProgram();
    gl->AttachShader(program, vertex);
    gl->AttachShader(program, fragment);
    gl->LinkProgram(program);
    gl->GetProgramiv(program, GL_LINK_STATUS, &ok);
    return ok ? program : 0;
}

static GLuint make_target(renderer *r, int samples)
{
    gl_functions *gl = &r->gl;
    GLuint frame, store[2];

    gl->GenFramebuffers(1, &frame);
    gl->BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl->GenRenderbuffers(2, store);
    gl->BindRenderbuffer(GL_RENDERBUFFER, store[0]);
    gl->RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, r->width, r->height);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, store[0]);
    gl->BindRenderbuffer(GL_RENDERBUFFER, store[1]);
    gl->RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, r->width, r->height);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, store[1]);
    return gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE ? frame : 0;
}

static GLuint make_buffer(gl_functions *gl, GLenum target, const void *data, size_t size)
{
    GLuint buffer;

    gl->GenBuffers(1, &buffer);
    gl->BindBuffer(target, buffer);
    gl->BufferData(target, (GLsizeiptr)size, data, GL_STATIC_DRAW);
    return buffer;
}

static void attribute(gl_functions *gl, GLuint index, int size, GLenum type, GLboolean normalized,
                      size_t stride, size_t offset)
{
    gl->EnableVertexAttribArray(index);
    gl->VertexAttribPointer(index, size, type, normalized, (GLsizei)stride, (const void *)offset);
}

/*
 * Teeth shine out of the mouth whatever the closed lips hide of them, but only the front ones: the ends of
 * the row would light up in the corners of the mouth.
 */
static void light_teeth(const fap_mesh *mesh, float *open)
{
    const float dark_mm = 15, bright_mm = 5; /* behind the foremost tooth */
    const float *z = mesh->position + 2 * (size_t)mesh->stride;

    for (int part = FAP_PART_TEETH_UPPER; part <= FAP_PART_TEETH_LOWER; part++) {
        float front = -1e9f;
        for (uint32_t i = 0; i < mesh->vertex_count; i++)
            if (mesh->part[i] == part && z[i] > front)
                front = z[i];
        for (uint32_t i = 0; i < mesh->vertex_count; i++)
            if (mesh->part[i] == part)
                open[i] =
                    (0.35f + 0.65f * open[i]) * glm_smoothstep(front - dark_mm, front - bright_mm, z[i]);
    }
}

/* Colours, openness and parts never move; positions and normals are sent anew for every picture. */
static fap_err make_face(renderer *r, GLuint depth_program)
{
    gl_functions *gl = &r->gl;
    const fap_mesh *mesh = fap_bank_mesh(r->bank);
    still_vertex *still = calloc(mesh->vertex_count, sizeof *still);
    float *open = calloc(mesh->vertex_count, sizeof *open);
    fap_err err = FAP_E_NOMEM;

    gl->GenVertexArrays(1, &r->background_array);
    gl->GenVertexArrays(1, &r->face_array);
    gl->BindVertexArray(r->face_array);
    r->index_buffer = make_buffer(gl, GL_ELEMENT_ARRAY_BUFFER, mesh->triangle,
                                  (size_t)mesh->triangle_count * 3 * sizeof *mesh->triangle);
    if (still && open)
        err = occlusion_measure(gl, r->bank, r->index_buffer, depth_program, open);
    if (err == FAP_OK) {
        light_teeth(mesh, open);
        for (uint32_t i = 0; i < mesh->vertex_count; i++) {
            memcpy(still[i].paint, mesh->colour + 4 * (size_t)i, 4);
            still[i].open = (uint8_t)(255 * open[i] + 0.5f);
            still[i].part = mesh->part[i];
            still[i].head = mesh->head_weight[i];
        }
        gl->BindVertexArray(r->face_array);
        make_buffer(gl, GL_ARRAY_BUFFER, still, mesh->vertex_count * sizeof *still);
        attribute(gl, ATTRIBUTE_PAINT, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof *still,
                  offsetof(still_vertex, paint));
        attribute(gl, ATTRIBUTE_SURFACE, 3, GL_UNSIGNED_BYTE, GL_FALSE, sizeof *still,
                  offsetof(still_vertex, open));
        r->moving_buffer = make_buffer(gl, GL_ARRAY_BUFFER, NULL, mesh->vertex_count * sizeof(moving_vertex));
        attribute(gl, ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, sizeof(moving_vertex),
                  offsetof(moving_vertex, position));
        attribute(gl, ATTRIBUTE_NORMAL, 3, GL_FLOAT, GL_FALSE, sizeof(moving_vertex),
                  offsetof(moving_vertex, normal));
    }
    free(open);
    free(still);
    return err;
}

static fap_err make_scene(renderer *r, char *where)
{
    gl_functions *gl = &r->gl;
    const GLuint depth = build_program(gl, depth_vertex_source, depth_fragment_source, where);

    r->background = build_program(gl, background_vertex_source, background_fragment_source, where);
    r->face = build_program(gl, face_vertex_source, face_fragment_source, where);
    if (!depth || !r->background || !r->face)
        return FAP_E_UNSUPPORTED;
    r->view_projection = gl->GetUniformLocation(r->face, "view_projection");
    r->eye = gl->GetUniformLocation(r->face, "eye");
    const fap_err err = make_face(r, depth);
    if (err != FAP_OK)
        return err;
    r->drawn = make_target(r, SAMPLES);
    r->resolved = make_target(r, 0);
    if (r->drawn && r->resolved)
        return FAP_OK;
    snprintf(where, FAP_ERROR_TEXT_SIZE, "no framebuffer of %d x %d pixels", r->width, r->height);
    return FAP_E_LIMIT;
}

fap_err renderer_create(renderer **out, const fap_bank *bank, int width, int height, char *where)
{
    *out = NULL;
    *where = '\0';
    if (width < 1 || height < 1 || width > RENDER_MAX_SIZE || height > RENDER_MAX_SIZE)
        return FAP_E_ARG;
    renderer *r = calloc(1, sizeof *r);
    if (!r)
        return FAP_E_NOMEM;
    r->bank = bank;
    r->width = width;
    r->height = height;
    r->moving = calloc(fap_bank_mesh(bank)->vertex_count, sizeof *r->moving);
    fap_err err = r->moving ? gl_context_create(&r->context, &r->gl, where) : FAP_E_NOMEM;
    if (err == FAP_OK)
        err = make_scene(r, where);
    if (err == FAP_OK)
        *out = r;
    else
        renderer_destroy(&r);
    return err;
}

/* Deleting the context deletes what it holds. */
void renderer_destroy(renderer **r)
{
    if (!*r)
        return;
    gl_context_destroy((*r)->context);
    free((*r)->moving);
    free(*r);
    *r = NULL;
}

const char *renderer_description(const renderer *r)
{
    return (const char *)r->gl.GetString(GL_RENDERER);
}

static void send_pose(renderer *r, const float *position, const float *normal)
{
    const fap_mesh *mesh = fap_bank_mesh(r->bank);
    const size_t stride = mesh->stride;

    for (size_t i = 0; i < mesh->vertex_count; i++)
        r->moving[i] = (moving_vertex){ { position[i], position[stride + i], position[2 * stride + i] },
                                        { normal[i], normal[stride + i], normal[2 * stride + i] } };
    r->gl.BindBuffer(GL_ARRAY_BUFFER, r->moving_buffer);
    r->gl.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(mesh->vertex_count * sizeof *r->moving), r->moving,
                     GL_STREAM_DRAW);
}

static void draw_scene(renderer *r, render_camera camera)
{
    gl_functions *gl = &r->gl;
    mat4 view_projection;
    vec3 eye;

    gl->BindFramebuffer(GL_FRAMEBUFFER, r->drawn);
    gl->Viewport(0, 0, r->width, r->height);
    gl->Clear(GL_DEPTH_BUFFER_BIT);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
    gl->UseProgram(r->background);
    gl->BindVertexArray(r->background_array);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);

    camera_place(r->bank, camera, (float)r->width / (float)r->height, view_projection, eye);
    gl->Enable(GL_DEPTH_TEST);
    gl->Enable(GL_CULL_FACE); /* the back of the head is half of the triangles */
    gl->UseProgram(r->face);
    gl->UniformMatrix4fv(r->view_projection, 1, GL_FALSE, view_projection[0]);
    gl->Uniform3fv(r->eye, 1, eye);
    gl->BindVertexArray(r->face_array);
    gl->DrawElements(GL_TRIANGLES, (GLsizei)(3 * fap_bank_mesh(r->bank)->triangle_count), GL_UNSIGNED_INT,
                     NULL);
}

/* OpenGL's rows start at the bottom. */
static void turn_over(image *im)
{
    const size_t row = (size_t)im->width * 4;

    for (int y = 0; y < im->height / 2; y++) {
        uint8_t *a = im->rgba + (size_t)y * row, *b = im->rgba + (size_t)(im->height - 1 - y) * row;
        for (size_t i = 0; i < row; i++) {
            const uint8_t swap = a[i];
            a[i] = b[i];
            b[i] = swap;
        }
    }
}

fap_err renderer_draw(renderer *r, const float *position, const float *normal, render_camera camera,
                      image *out)
{
    gl_functions *gl = &r->gl;

    if (out->width != r->width || out->height != r->height)
        return FAP_E_ARG;
    gl_context_make_current(r->context);
    send_pose(r, position, normal);
    draw_scene(r, camera);
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, r->drawn);
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, r->resolved);
    gl->BlitFramebuffer(0, 0, r->width, r->height, 0, 0, r->width, r->height, GL_COLOR_BUFFER_BIT,
                        GL_NEAREST);
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, r->resolved);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(0, 0, r->width, r->height, GL_RGBA, GL_UNSIGNED_BYTE, out->rgba);
    turn_over(out);
    return gl->GetError() == GL_NO_ERROR ? FAP_OK : FAP_E_IO;
}
#endif
