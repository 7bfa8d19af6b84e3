/* SPDX-License-Identifier: BSD-2-Clause */
/* See face_array.h. */
#ifdef HAVE_GL
#include <stdlib.h>
#include <string.h>

#include <cglm/cglm.h>

#include "player/render/face_array.h"
#include "player/render/gl_objects.h"
#include "player/render/occlusion.h"

enum { POSITION, NORMAL, PAINT, SURFACE }; /* the locations in shaders.h */

typedef struct moving_vertex {
    float position[3], normal[3];
} moving_vertex;

typedef struct still_vertex {
    uint8_t paint[4];
    uint8_t open, part, head, unused;
} still_vertex;

static const gl_attribute moving_attributes[] = {
    { POSITION, 3, GL_FLOAT, GL_FALSE, offsetof(moving_vertex, position) },
    { NORMAL, 3, GL_FLOAT, GL_FALSE, offsetof(moving_vertex, normal) },
};
static const gl_attribute still_attributes[] = {
    { PAINT, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(still_vertex, paint) },
    { SURFACE, 3, GL_UNSIGNED_BYTE, GL_FALSE, offsetof(still_vertex, open) },
};

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

static void send_still(face_array *face, const gl_functions *gl, const fap_mesh *mesh, const float *open,
                       still_vertex *still)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        memcpy(still[i].paint, mesh->colour + 4 * (size_t)i, 4);
        still[i].open = (uint8_t)(255 * open[i] + 0.5f);
        still[i].part = mesh->part[i];
        still[i].head = mesh->head_weight[i];
    }
    gl->BindVertexArray(face->array);
    face->still_buffer =
        gl_buffer_make(gl, GL_ARRAY_BUFFER, still, mesh->vertex_count * sizeof *still, GL_STATIC_DRAW);
    gl_attributes_set(gl, still_attributes, 2, sizeof *still);
}

static void make_moving(face_array *face, const gl_functions *gl, const fap_mesh *mesh)
{
    gl->BindVertexArray(face->array);
    face->moving_buffer =
        gl_buffer_make(gl, GL_ARRAY_BUFFER, NULL, mesh->vertex_count * sizeof(moving_vertex), GL_STREAM_DRAW);
    gl_attributes_set(gl, moving_attributes, 2, sizeof(moving_vertex));
}

fap_err face_array_make(face_array *face, const gl_functions *gl, const fap_bank *bank, GLuint depth_program)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    still_vertex *still = calloc(mesh->vertex_count, sizeof *still);
    float *open = calloc(mesh->vertex_count, sizeof *open);
    fap_err err = FAP_E_NOMEM;

    *face = (face_array){ .index_count = (GLsizei)(3 * mesh->triangle_count) };
    gl->GenVertexArrays(1, &face->array);
    gl->BindVertexArray(face->array);
    face->index_buffer =
        gl_buffer_make(gl, GL_ELEMENT_ARRAY_BUFFER, mesh->triangle,
                       (size_t)mesh->triangle_count * 3 * sizeof *mesh->triangle, GL_STATIC_DRAW);
    if (still && open)
        err = occlusion_measure(gl, bank, face->index_buffer, depth_program, open);
    if (!err) {
        light_teeth(mesh, open);
        send_still(face, gl, mesh, open, still);
        make_moving(face, gl, mesh);
    }
    free(open);
    free(still);
    return err;
}

void face_array_delete(face_array *face, const gl_functions *gl)
{
    gl->DeleteVertexArrays(1, &face->array);
    gl->DeleteBuffers(1, &face->index_buffer);
    gl->DeleteBuffers(1, &face->still_buffer);
    gl->DeleteBuffers(1, &face->moving_buffer);
    *face = (face_array){ 0 };
}

/* Written straight into the buffer: the context gives fresh memory while the picture before may still be drawn from the old. */
fap_err face_array_send(const face_array *face, const gl_functions *gl, const fap_mesh *mesh,
                        const float *position, const float *normal)
{
    const size_t stride = mesh->stride;

    gl->BindBuffer(GL_ARRAY_BUFFER, face->moving_buffer);
    moving_vertex *v =
        gl->MapBufferRange(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(mesh->vertex_count * sizeof(moving_vertex)),
                           GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    if (!v)
        return FAP_E_NOMEM;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        v[i] = (moving_vertex){ { position[i], position[stride + i], position[2 * stride + i] },
                                { normal[i], normal[stride + i], normal[2 * stride + i] } };
    /* GL_FALSE: the memory was lost while it was written (a display mode change); the next picture is whole again. */
    gl->UnmapBuffer(GL_ARRAY_BUFFER);
    return FAP_OK;
}

void face_array_draw(const face_array *face, const gl_functions *gl)
{
    gl->BindVertexArray(face->array);
    gl->DrawElements(GL_TRIANGLES, face->index_count, GL_UNSIGNED_INT, NULL);
}
#endif
