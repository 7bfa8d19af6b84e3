/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A vertex normal is the sum of the cross products of its triangles: large triangles count more, which a fan
 * of slivers round a lip needs. Vertices split for texture seams share their triangles, so seams do not show.
 */
#include <string.h>

#include "bank/face_normals.h"
#include "base/mem.h"

/* Triangles of welded vertices only; start[w] runs from the end of w's part to its beginning. */
static void list_round(fap_normals *n, const fap_graph *g, const fap_mesh *mesh)
{
    const size_t corner_count = 3 * (size_t)mesh->triangle_count;

    for (size_t i = 0; i < corner_count; i++)
        n->start[g->weld[mesh->triangle[i]]]++;
    for (uint32_t v = 1; v <= mesh->vertex_count; v++)
        n->start[v] += n->start[v - 1];
    for (size_t i = corner_count; i-- > 0;)
        n->index[--n->start[g->weld[mesh->triangle[i]]]] = (uint32_t)(i / 3);
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
    n->start = fap_mem_calloc(alloc, (size_t)mesh->vertex_count + 1, sizeof *n->start);
    n->index = fap_mem_calloc(alloc, 3 * (size_t)mesh->triangle_count, sizeof *n->index);
    n->copy = fap_mem_calloc(alloc, mesh->vertex_count, sizeof *n->copy);
    n->triangle = fap_mem_calloc(alloc, mesh->triangle_count, sizeof *n->triangle);
    n->place = fap_mem_calloc(alloc, mesh->stride, sizeof *n->place);
    if (!n->start || !n->index || !n->copy || !n->triangle || !n->place)
        return 1;
    list_round(n, graph, mesh);
    list_copies(n, graph, mesh->vertex_count);
    return 0;
}

void fap_normals_close(fap_normals *n, const fap_allocator *alloc)
{
    fap_mem_free(alloc, n->start);
    fap_mem_free(alloc, n->index);
    fap_mem_free(alloc, n->copy);
    fap_mem_free(alloc, n->triangle);
    fap_mem_free(alloc, n->place);
    memset(n, 0, sizeof *n);
}

void fap_normals_compute(const fap_normals *n, const fap_dsp *dsp, const fap_mesh *mesh,
                         const float *position, float *normal)
{
    dsp->interleave(n->place, position, mesh->stride, mesh->stride);
    dsp->triangle_normals(n->triangle, (const float(*)[4])n->place, mesh->triangle, mesh->triangle_count);
    dsp->sum_normals(normal, mesh->stride, (const float(*)[4])n->triangle, n->start, n->index,
                     mesh->vertex_count);
    for (int axis = 0; axis < 3; axis++) /* padding is nobody's */
        memset(normal + (size_t)axis * mesh->stride + mesh->vertex_count, 0,
               (mesh->stride - mesh->vertex_count) * sizeof *normal);
    dsp->normalise(normal, mesh->stride, mesh->stride);
    for (uint32_t i = 0; i < n->copy_count; i++)
        for (size_t axis = 0; axis < 3; axis++)
            normal[axis * mesh->stride + n->copy[i][0]] = normal[axis * mesh->stride + n->copy[i][1]];
}
