/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A vertex normal is the sum of its faces' area vectors: large faces count more, which a fan of slivers round a lip
 * needs. Vertices split for texture seams share their faces, so seams do not show. Face meshes are quads cut in two; the
 * area vector of a quad is half the cross product of its diagonals however it was cut, so the cut is undone: half the
 * work, and normals that do not depend on the diagonal.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bank/face_normals.h"
#include "base/mem.h"

enum { WIDTH_MAX = 8 };
static const float flat_enough = 0.5f; /* cosine between two triangles that may become one quad */

/* --- triangles to quads --- */

/* The corner of @p b that @p a does not have, when they share an edge that both run along in opposite senses; @p first
 * becomes the corner of @p a in front of the edge. */
static int shared_edge(const uint32_t *a, const uint32_t *b, int *first, uint32_t *across)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (a[i] == b[(j + 1) % 3] && a[(i + 1) % 3] == b[j]) {
                *first = i;
                *across = b[(j + 2) % 3];
                return 1;
            }
    return 0;
}

static void area_of(const fap_mesh *mesh, const uint32_t *t, float out[3])
{
    float u[3], v[3];

    for (size_t axis = 0; axis < 3; axis++) {
        const float *p = mesh->position + axis * mesh->stride;
        u[axis] = p[t[1]] - p[t[0]];
        v[axis] = p[t[2]] - p[t[0]];
    }
    for (int axis = 0; axis < 3; axis++) {
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        out[axis] = u[b] * v[c] - u[c] * v[b];
    }
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int are_flat(const fap_mesh *mesh, const uint32_t *s, const uint32_t *t)
{
    float a[3], b[3];

    area_of(mesh, s, a);
    area_of(mesh, t, b);
    return dot(a, b) > flat_enough * sqrtf(dot(a, a) * dot(b, b));
}

/* Cutters write the two halves of a quad one after the other. */
static uint32_t make_quad(const fap_mesh *mesh, uint32_t t, uint32_t quad[4])
{
    const uint32_t *a = mesh->triangle + 3 * (size_t)t, *b = a + 3;
    uint32_t across;
    int first;

    if (t + 1 < mesh->triangle_count && shared_edge(a, b, &first, &across) && are_flat(mesh, a, b)) {
        quad[0] = a[first];
        quad[1] = across;
        quad[2] = a[(first + 1) % 3];
        quad[3] = a[(first + 2) % 3];
        return 2;
    }
    memcpy(quad, a, 3 * sizeof *quad);
    quad[3] = a[2];
    return 1;
}

static uint32_t least_corner(const uint32_t quad[4])
{
    uint32_t least = quad[0];

    for (int i = 1; i < 4; i++)
        least = quad[i] < least ? quad[i] : least;
    return least;
}

/* What is near in memory is worked on together. */
static int by_place(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b, u = least_corner(x), v = least_corner(y);

    if (u != v)
        return u < v ? -1 : 1;
    for (int i = 0; i < 4; i++)
        if (x[i] != y[i])
            return x[i] < y[i] ? -1 : 1;
    return 0;
}

static void list_quads(fap_normals *n, const fap_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->triangle_count;)
        t += make_quad(mesh, t, n->quad[n->quad_count++]);
    qsort(n->quad, n->quad_count, sizeof *n->quad, by_place);
}

/* --- quads round vertices --- */

static int corner_count(const uint32_t quad[4])
{
    return quad[3] == quad[2] ? 3 : 4;
}

/* Most vertices of a quad mesh have four quads, of a triangle mesh six; what is beyond the usual is left over. */
static void choose_width(fap_normals *n, const fap_graph *g, uint8_t *count, uint32_t vertex_count)
{
    uint32_t corners = 0, vertices = 0;

    for (uint32_t q = 0; q < n->quad_count; q++)
        for (int i = 0; i < corner_count(n->quad[q]); i++) {
            uint8_t *c = &count[g->weld[n->quad[q][i]]];
            *c = (uint8_t)(*c + (*c < UINT8_MAX));
            corners++;
        }
    for (uint32_t v = 0; v < vertex_count; v++)
        vertices += count[v] > 0;
    const double usual = vertices ? (double)corners / vertices : 4;
    n->width = usual < 4.5 ? 4 : usual < 6.5 ? 6 : WIDTH_MAX;
}

static void list_round(fap_normals *n, const fap_graph *g, uint8_t *count, const fap_mesh *mesh)
{
    const size_t width = (size_t)n->width;

    for (size_t i = 0; i < mesh->stride * width; i++)
        n->round[i] = n->quad_count;
    memset(count, 0, mesh->vertex_count);
    for (uint32_t q = 0; q < n->quad_count; q++)
        for (int i = 0; i < corner_count(n->quad[q]); i++) {
            const uint32_t v = g->weld[n->quad[q][i]];
            if (count[v] < n->width) {
                n->round[v * width + count[v]++] = q;
                continue;
            }
            n->more[n->more_count][0] = v;
            n->more[n->more_count++][1] = q;
        }
}

static void list_copies(fap_normals *n, const fap_graph *g, uint32_t vertex_count)
{
    for (uint32_t v = 0; v < vertex_count; v++)
        if (g->weld[v] != v) {
            n->copy[n->copy_count][0] = v;
            n->copy[n->copy_count++][1] = g->weld[v];
        }
}

int fap_normals_open(fap_normals *n, const fap_graph *graph, const fap_mesh *mesh, const fap_allocator *alloc)
{
    memset(n, 0, sizeof *n);
    uint8_t *count = fap_mem_calloc(alloc, mesh->vertex_count, sizeof *count);
    n->quad = fap_mem_calloc(alloc, mesh->triangle_count, sizeof *n->quad);
    n->round = fap_mem_calloc(alloc, (size_t)mesh->stride * WIDTH_MAX, sizeof *n->round);
    n->more = fap_mem_calloc(alloc, 3 * (size_t)mesh->triangle_count, sizeof *n->more);
    n->copy = fap_mem_calloc(alloc, mesh->vertex_count, sizeof *n->copy);
    n->normal = fap_mem_calloc(alloc, (size_t)mesh->triangle_count + 1, sizeof *n->normal);
    n->place = fap_mem_calloc(alloc, mesh->stride, sizeof *n->place);
    const int failed = !count || !n->quad || !n->round || !n->more || !n->copy || !n->normal || !n->place;
    if (!failed) {
        list_quads(n, mesh);
        choose_width(n, graph, count, mesh->vertex_count);
        list_round(n, graph, count, mesh);
        list_copies(n, graph, mesh->vertex_count);
    }
    fap_mem_free(alloc, count);
    return failed;
}

void fap_normals_close(fap_normals *n, const fap_allocator *alloc)
{
    void *const blocks[] = { n->quad, n->round, n->more, n->copy, n->normal, n->place };

    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        fap_mem_free(alloc, blocks[i]);
    memset(n, 0, sizeof *n);
}

/* --- every frame --- */

static void add_left_over(const fap_normals *n, size_t stride, float *normal)
{
    for (uint32_t i = 0; i < n->more_count; i++)
        for (size_t axis = 0; axis < 3; axis++)
            normal[axis * stride + n->more[i][0]] += n->normal[n->more[i][1]][axis];
}

void fap_normals_compute(const fap_normals *n, const fap_dsp *dsp, size_t stride, const float *position,
                         float *normal)
{
    dsp->interleave(n->place, position, stride, stride);
    dsp->quad_normals(n->normal, (const float(*)[4])n->place, (const uint32_t(*)[4])n->quad, n->quad_count);
    dsp->sum_normals(normal, stride, (const float(*)[4])n->normal, n->round, n->width, stride);
    add_left_over(n, stride, normal);
    dsp->normalise(normal, stride, stride);
    for (uint32_t i = 0; i < n->copy_count; i++)
        for (size_t axis = 0; axis < 3; axis++)
            normal[axis * stride + n->copy[i][0]] = normal[axis * stride + n->copy[i][1]];
}
