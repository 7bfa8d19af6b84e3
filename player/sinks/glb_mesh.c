/* SPDX-License-Identifier: BSD-2-Clause */
/* See glb_mesh.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "player/sinks/glb_mesh.h"

static const float metre = 1e-3f;        /* per millimetre */
static const float least_motion = 1e-7f; /* metres: nobody sees a ten thousandth of a millimetre */
static const float least_turn = 2e-3f;   /* of a normal: a tenth of a degree */

glb_group glb_group_of(fap_part part)
{
    switch (part) {
    case FAP_PART_EYE_LEFT:
    case FAP_PART_EYE_RIGHT: return GROUP_EYES;
    case FAP_PART_TEETH_UPPER:
    case FAP_PART_TEETH_LOWER:
    case FAP_PART_TONGUE: return GROUP_MOUTH;
    case FAP_PART_LASHES: return GROUP_LASHES;
    default: return GROUP_SKIN;
    }
}

/* Everything that is filled for one group after the other. */
typedef struct builder {
    const fap_mesh *mesh;
    const glb_rig *rig;
    const glb_shape *shape;
    glb_file *file;
    uint32_t *new_number;     /* [vertex_count]: in its group */
    uint32_t *integer;        /* [4 * vertex_count, 3 * triangle_count] */
    float *number;            /* [3 * vertex_count] */
    float *shape_mm, *normal; /* [3 * stride] */
    float *rest_normal;
    int textured;
} builder;

/* --- normals --- */

static void triangle_normal(const fap_mesh *mesh, const float *p, const uint32_t t[3], float out[3])
{
    float u[3], v[3];

    for (size_t axis = 0; axis < 3; axis++) {
        const float *row = p + axis * mesh->stride;
        u[axis] = row[t[1]] - row[t[0]];
        v[axis] = row[t[2]] - row[t[0]];
    }
    for (int i = 0; i < 3; i++)
        out[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

static void make_unit(const fap_mesh *mesh, float *normal)
{
    float *x = normal, *y = x + mesh->stride, *z = y + mesh->stride;

    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float length = sqrtf(x[v] * x[v] + y[v] * y[v] + z[v] * z[v]);
        const int none = !(length > 1e-12f);
        x[v] = none ? 0 : x[v] / length;
        y[v] = none ? 0 : y[v] / length;
        z[v] = none ? 1 : z[v] / length;
    }
}

/* Every triangle counts by its area. */
static void find_normals(const fap_mesh *mesh, const float *position, float *normal)
{
    memset(normal, 0, 3 * (size_t)mesh->stride * sizeof *normal);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = mesh->triangle + (size_t)3 * t;
        float n[3];
        triangle_normal(mesh, position, corner, n);
        for (int c = 0; c < 3; c++)
            for (size_t axis = 0; axis < 3; axis++)
                normal[axis * mesh->stride + corner[c]] += n[axis];
    }
    make_unit(mesh, normal);
}

/* --- what a group is made of --- */

static int list_group(builder *b, glb_primitive *p, glb_group group)
{
    p->vertex = calloc(b->mesh->vertex_count, sizeof *p->vertex);
    if (!p->vertex)
        return 0;
    for (uint32_t v = 0; v < b->mesh->vertex_count; v++) {
        if (glb_group_of(b->mesh->part[v]) != group)
            continue;
        b->new_number[v] = p->vertex_count;
        p->vertex[p->vertex_count++] = v;
    }
    return 1;
}

static void add_triangles(builder *b, glb_primitive *p, glb_group group)
{
    const int wide = p->vertex_count > 65535; /* 65535 itself is not a vertex: it restarts a strip */

    for (uint32_t t = 0; t < b->mesh->triangle_count; t++) {
        const uint32_t *corner = b->mesh->triangle + (size_t)3 * t;
        if (glb_group_of(b->mesh->part[corner[0]]) != group)
            continue;
        for (int c = 0; c < 3; c++)
            b->integer[3 * p->triangle_count + (uint32_t)c] = b->new_number[corner[c]];
        p->triangle_count++;
    }
    if (p->triangle_count)
        p->triangles = glb_add_integers(b->file, SECTION_TRIANGLES, wide ? GLB_U32 : GLB_U16, b->integer,
                                        3 * p->triangle_count, 1, 0);
}

/* b->number: the group's part of rows x, y and z. */
static const float *gather(const builder *b, const glb_primitive *p, const float *rows, float scale)
{
    for (uint32_t i = 0; i < p->vertex_count; i++)
        for (size_t axis = 0; axis < 3; axis++)
            b->number[3 * i + axis] = scale * rows[axis * b->mesh->stride + p->vertex[i]];
    return b->number;
}

static void add_surface(builder *b, glb_primitive *p)
{
    p->position =
        glb_add_floats(b->file, SECTION_POSITION, gather(b, p, b->mesh->position, metre), p->vertex_count, 3);
    glb_set_range(b->file, p->position, b->number);
    p->normal = glb_add_floats(b->file, SECTION_NORMAL, gather(b, p, b->rest_normal, 1), p->vertex_count, 3);
}

/* glTF's vertex colours are linear light; 16 bits keep what 8 bits of sRGB had. */
static uint32_t linear16(uint8_t srgb)
{
    const double c = srgb / 255.0;
    return (uint32_t)(65535 * (c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4)) + 0.5);
}

static void add_colours(builder *b, glb_primitive *p)
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        const uint8_t *colour = b->mesh->colour + (size_t)4 * p->vertex[i];
        for (uint32_t k = 0; k < 3; k++)
            b->integer[4 * i + k] = linear16(colour[k]);
        b->integer[4 * i + 3] = 65535;
    }
    p->colour = glb_add_integers(b->file, SECTION_COLOUR, GLB_U16, b->integer, p->vertex_count, 4, 1);
}

static float mean_gloss(const builder *b, const glb_primitive *p)
{
    float sum = 0;

    for (uint32_t i = 0; i < p->vertex_count; i++)
        sum += (float)b->mesh->colour[(size_t)4 * p->vertex[i] + 3] / 255;
    return sum / (float)p->vertex_count;
}

/* glTF's v goes down, the bank's up. */
static void add_uv(builder *b, glb_primitive *p)
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        const float *uv = b->mesh->uv + (size_t)2 * p->vertex[i];
        b->number[2 * i] = uv[0];
        b->number[2 * i + 1] = 1 - uv[1];
    }
    p->uv = glb_add_floats(b->file, SECTION_UV, b->number, p->vertex_count, 2);
}

static void add_numbers(builder *b, glb_primitive *p)
{
    for (uint32_t i = 0; i < p->vertex_count; i++)
        b->number[i] = (float)p->vertex[i];
    p->number = glb_add_floats(b->file, SECTION_VERTEX, b->number, p->vertex_count, 1);
}

/* A joint that holds nothing must be called 0. */
static void add_joints(builder *b, glb_primitive *p, const int joint_number[JOINT_COUNT])
{
    memset(b->integer, 0, 4 * (size_t)p->vertex_count * sizeof *b->integer);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        const glb_hold *hold = &b->rig->hold[p->vertex[i]];
        const int only = hold->share == 0 ? 0 : hold->share == 65535 ? 1 : -1;
        b->integer[4 * i] = (uint32_t)joint_number[hold->joint[only == 1]];
        b->integer[4 * i + 1] = only < 0 ? (uint32_t)joint_number[hold->joint[1]] : 0;
    }
    p->joints = glb_add_integers(b->file, SECTION_JOINTS, GLB_U8, b->integer, p->vertex_count, 4, 0);
    memset(b->integer, 0, 4 * (size_t)p->vertex_count * sizeof *b->integer);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        const uint16_t share = b->rig->hold[p->vertex[i]].share;
        b->integer[4 * i] = share == 65535 ? share : 65535u - share;
        b->integer[4 * i + 1] = share == 65535 ? 0 : share;
    }
    p->shares = glb_add_integers(b->file, SECTION_SHARES, GLB_U16, b->integer, p->vertex_count, 4, 1);
}

static int add_group(builder *b, glb_primitive *p, glb_group group, const int joint_number[JOINT_COUNT])
{
    p->uv = p->colour = -1;
    if (!list_group(b, p, group))
        return 0;
    add_triangles(b, p, group);
    if (!p->triangle_count)
        return 1;
    p->target_position = calloc((size_t)glb_shape_target_count(b->shape), sizeof(int));
    p->target_normal = calloc((size_t)glb_shape_target_count(b->shape), sizeof(int));
    if (!p->target_position || !p->target_normal)
        return 0;
    add_surface(b, p);
    p->gloss = mean_gloss(b, p);
    if (group != GROUP_SKIN || !b->textured) /* a texture is in place of them */
        add_colours(b, p);
    if (b->mesh->uv)
        add_uv(b, p);
    add_numbers(b, p);
    add_joints(b, p, joint_number);
    return 1;
}

/* --- targets --- */

static void add_target(builder *b, glb_mesh *m, int target)
{
    const size_t floats = b->shape->length;

    glb_shape_target(b->shape, target, b->shape_mm);
    for (size_t i = 0; i < floats; i++)
        b->shape_mm[i] += b->mesh->position[i];
    find_normals(b->mesh, b->shape_mm, b->normal);
    for (size_t i = 0; i < floats; i++) {
        b->shape_mm[i] -= b->mesh->position[i];
        b->normal[i] -= b->rest_normal[i];
    }
    for (int i = 0; i < GROUP_COUNT; i++) {
        glb_primitive *p = &m->group[i];
        if (!p->triangle_count)
            continue;
        gather(b, p, b->shape_mm, metre);
        p->target_position[target] =
            glb_add_motion(b->file, (const float(*)[3])b->number, p->vertex_count, least_motion);
        gather(b, p, b->normal, 1);
        p->target_normal[target] =
            glb_add_motion(b->file, (const float(*)[3])b->number, p->vertex_count, least_turn);
    }
}

/* --- all of it --- */

static int open_builder(builder *b)
{
    const size_t vertices = b->mesh->vertex_count, triangles = b->mesh->triangle_count;

    b->new_number = calloc(vertices, sizeof *b->new_number);
    b->integer = calloc(4 * vertices > 3 * triangles ? 4 * vertices : 3 * triangles, sizeof *b->integer);
    b->number = calloc(3 * vertices, sizeof *b->number);
    b->shape_mm = calloc(b->shape->length, sizeof *b->shape_mm);
    b->normal = calloc(b->shape->length, sizeof *b->normal);
    b->rest_normal = calloc(b->shape->length, sizeof *b->rest_normal);
    return b->new_number && b->integer && b->number && b->shape_mm && b->normal && b->rest_normal;
}

static void close_builder(builder *b)
{
    void *const blocks[] = { b->new_number, b->integer, b->number, b->shape_mm, b->normal, b->rest_normal };

    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        free(blocks[i]);
}

int glb_mesh_open(glb_mesh *m, glb_file *g, const glb_rig *rig, const glb_shape *shape,
                  const int joint_number[JOINT_COUNT], int textured)
{
    builder b = { .mesh = rig->mesh, .rig = rig, .shape = shape, .file = g, .textured = textured };

    *m = (glb_mesh){ .target_count = glb_shape_target_count(shape) };
    int ok = open_builder(&b);
    if (ok)
        find_normals(b.mesh, b.mesh->position, b.rest_normal);
    for (int i = 0; ok && i < GROUP_COUNT; i++)
        ok = add_group(&b, &m->group[i], (glb_group)i, joint_number);
    for (int target = 0; ok && target < m->target_count; target++)
        add_target(&b, m, target);
    close_builder(&b);
    return ok && !g->failed;
}

void glb_mesh_close(glb_mesh *m)
{
    for (int i = 0; i < GROUP_COUNT; i++) {
        free(m->group[i].vertex);
        free(m->group[i].target_position);
        free(m->group[i].target_normal);
    }
    *m = (glb_mesh){ 0 };
}
