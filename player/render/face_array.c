/* SPDX-License-Identifier: BSD-2-Clause */
/* See face_array.h. */
#ifdef HAVE_GL
#include <stdlib.h>
#include <string.h>

#include <cglm/cglm.h>

#include "player/render/face_array.h"
#include "player/render/gl_objects.h"
#include "player/render/occlusion.h"

enum { POSITION, NORMAL, PAINT, SURFACE, ON_EYE, UV }; /* the locations in shaders.h */

typedef struct moving_vertex {
    float position[3], normal[3];
} moving_vertex;

typedef struct still_vertex {
    uint8_t paint[4];
    uint8_t open, key, part, head;
    int16_t on_eye[2];
} still_vertex;

static const gl_attribute moving_attributes[] = {
    { POSITION, 3, GL_FLOAT, GL_FALSE, offsetof(moving_vertex, position) },
    { NORMAL, 3, GL_FLOAT, GL_FALSE, offsetof(moving_vertex, normal) },
};
static const gl_attribute still_attributes[] = {
    { PAINT, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(still_vertex, paint) },
    { SURFACE, 4, GL_UNSIGNED_BYTE, GL_FALSE, offsetof(still_vertex, open) },
    { ON_EYE, 2, GL_SHORT, GL_TRUE, offsetof(still_vertex, on_eye) },
};

/* What the closed lips hide of it, but not to its ends: they would light up in the corners of the mouth. */
static void light_part(const fap_mesh *mesh, fap_part part, float least, float bright_mm, float dark_mm,
                       float *open)
{
    const float *z = mesh->position + 2 * (size_t)mesh->stride;
    float front = -1e9f;

    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (mesh->part[i] == part && z[i] > front)
            front = z[i];
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (mesh->part[i] == part)
            open[i] =
                (least + (1 - least) * open[i]) * glm_smoothstep(front - dark_mm, front - bright_mm, z[i]);
}

/* Teeth and tongue shine out of the open mouth; their openness was measured with lips hardly parted. */
static void light_mouth(const fap_mesh *mesh, float *open)
{
    light_part(mesh, FAP_PART_TEETH_UPPER, 0.40f, 5, 16, open);
    light_part(mesh, FAP_PART_TEETH_LOWER, 0.40f, 5, 16, open);
    light_part(mesh, FAP_PART_TONGUE, 0.34f, 6, 40, open);
}

/* What is measured of every vertex before anything is drawn. */
typedef struct survey {
    float *open, *key; /* how much of the sky and of the key lamp is seen */
    int16_t (*on_eye)[2];
    still_vertex *still;
    uint32_t *index;
} survey;

static int survey_make(survey *s, const fap_mesh *mesh)
{
    const size_t n = mesh->vertex_count;

    *s = (survey){
        .open = calloc(n, sizeof *s->open),
        .key = calloc(n, sizeof *s->key),
        .on_eye = calloc(n, sizeof *s->on_eye),
        .still = calloc(n, sizeof *s->still),
        .index = calloc(3 * (size_t)mesh->triangle_count, sizeof *s->index),
    };
    return s->open && s->key && s->on_eye && s->still && s->index;
}

static void survey_free(survey *s)
{
    free(s->open);
    free(s->key);
    free(s->on_eye);
    free(s->still);
    free(s->index);
}

static face_range range_of(const fap_mesh *mesh, uint32_t triangle)
{
    switch (mesh->part[mesh->triangle[3 * (size_t)triangle]]) {
    case FAP_PART_EYE_LEFT: return RANGE_EYE_LEFT;
    case FAP_PART_EYE_RIGHT: return RANGE_EYE_RIGHT;
    case FAP_PART_TEETH_UPPER:
    case FAP_PART_TEETH_LOWER:
    case FAP_PART_TONGUE: return RANGE_INSIDE;
    default: return RANGE_SKIN;
    }
}

/* Parts never share a triangle. */
static void sort_triangles(face_array *face, const fap_mesh *mesh, uint32_t *index)
{
    GLsizei next = 0;

    for (int range = 0; range < RANGE_COUNT; range++) {
        face->first[range] = next;
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
            if ((int)range_of(mesh, t) == range) {
                memcpy(index + next, mesh->triangle + 3 * (size_t)t, 3 * sizeof *index);
                next += 3;
            }
    }
    face->first[RANGE_COUNT] = next;
}

static void send_still(face_array *face, const gl_functions *gl, const fap_mesh *mesh, const survey *s)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        still_vertex *v = &s->still[i];
        memcpy(v->paint, mesh->colour + 4 * (size_t)i, 4);
        v->open = (uint8_t)(255 * s->open[i] + 0.5f);
        v->key = (uint8_t)(255 * s->key[i] + 0.5f);
        v->part = mesh->part[i];
        v->head = mesh->head_weight[i];
        memcpy(v->on_eye, s->on_eye[i], sizeof v->on_eye);
    }
    gl->BindVertexArray(face->array);
    face->still_buffer =
        gl_buffer_make(gl, GL_ARRAY_BUFFER, s->still, mesh->vertex_count * sizeof *s->still, GL_STATIC_DRAW);
    gl_attributes_set(gl, still_attributes, 3, sizeof *s->still);
}

static void send_uv(face_array *face, const gl_functions *gl, const fap_mesh *mesh)
{
    static const gl_attribute uv = { UV, 2, GL_FLOAT, GL_FALSE, 0 };
    const size_t one = 2 * sizeof *mesh->uv;

    gl->BindVertexArray(face->array);
    face->uv_buffer = gl_buffer_make(gl, GL_ARRAY_BUFFER, mesh->uv, mesh->vertex_count * one, GL_STATIC_DRAW);
    gl_attributes_set(gl, &uv, 1, one);
}

static void make_moving(face_array *face, const gl_functions *gl, const fap_mesh *mesh)
{
    gl->BindVertexArray(face->array);
    face->moving_buffer =
        gl_buffer_make(gl, GL_ARRAY_BUFFER, NULL, mesh->vertex_count * sizeof(moving_vertex), GL_STREAM_DRAW);
    gl_attributes_set(gl, moving_attributes, 2, sizeof(moving_vertex));
}

static fap_err make_arrays(face_array *face, const gl_functions *gl, const fap_bank *bank,
                           GLuint depth_program, survey *s)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);

    gl->GenVertexArrays(1, &face->array);
    gl->BindVertexArray(face->array);
    sort_triangles(face, mesh, s->index);
    face->index_buffer = gl_buffer_make(gl, GL_ELEMENT_ARRAY_BUFFER, s->index,
                                        (size_t)face->first[RANGE_COUNT] * sizeof *s->index, GL_STATIC_DRAW);
    const fap_err err = occlusion_measure(gl, bank, face->index_buffer, depth_program, s->open, s->key);
    if (err)
        return err;
    light_mouth(mesh, s->open);
    for (int right = 0; right < 2; right++)
        eye_look_measure(&face->eye[right], bank, right, s->on_eye);
    send_still(face, gl, mesh, s);
    if (mesh->uv)
        send_uv(face, gl, mesh);
    make_moving(face, gl, mesh);
    return FAP_OK;
}

fap_err face_array_make(face_array *face, const gl_functions *gl, const fap_bank *bank, GLuint depth_program)
{
    survey s;

    *face = (face_array){ 0 };
    const fap_err err =
        survey_make(&s, fap_bank_mesh(bank)) ? make_arrays(face, gl, bank, depth_program, &s) : FAP_E_NOMEM;
    survey_free(&s);
    return err;
}

void face_array_delete(face_array *face, const gl_functions *gl)
{
    gl->DeleteVertexArrays(1, &face->array);
    gl->DeleteBuffers(1, &face->index_buffer);
    gl->DeleteBuffers(1, &face->still_buffer);
    gl->DeleteBuffers(1, &face->uv_buffer);
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

void face_array_draw(const face_array *face, const gl_functions *gl, face_range range)
{
    const size_t skipped = (size_t)face->first[range] * sizeof(uint32_t);

    gl->BindVertexArray(face->array);
    gl->DrawElements(GL_TRIANGLES, face->first[range + 1] - face->first[range], GL_UNSIGNED_INT,
                     (const void *)skipped);
}
#endif
