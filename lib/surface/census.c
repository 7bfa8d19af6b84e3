/* SPDX-License-Identifier: BSD-2-Clause */
/* How the triangles of a surface hang together. */
#include <math.h>

#include <fap/studio/surface.h>

#include "base/mem.h"
#include "surface/edges.h"
#include "surface/normals.h"

/* The representative of a vertex's piece; paths are halved on the way. */
static uint32_t find_root(uint32_t *parent, uint32_t v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

static void count_edges(const fap_surface *s, const surface_edges *e, uint32_t *parent,
                        fap_surface_census *out)
{
    double length = 0;

    for (uint32_t i = 0; i < e->count; i++) {
        const surface_edge *edge = &e->edge[i];
        const float *a = s->position[edge->low], *b = s->position[edge->high];
        out->border_edges += edge->triangles == 1;
        out->crowded_edges += edge->triangles > 2;
        out->turned_edges += edge->turned;
        length +=
            sqrt(pow((double)a[0] - b[0], 2) + pow((double)a[1] - b[1], 2) + pow((double)a[2] - b[2], 2));
        parent[find_root(parent, edge->low)] = find_root(parent, edge->high);
    }
    out->edge_mean = e->count ? length / e->count : 0;
}

static void count_pieces(const fap_surface *s, const surface_edges *e, uint32_t *parent, uint8_t *used,
                         fap_surface_census *out)
{
    for (uint32_t i = 0; i < e->count; i++)
        used[e->edge[i].low] = used[e->edge[i].high] = 1;
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        out->pieces += used[v] && find_root(parent, v) == v;
        out->loose += !used[v];
    }
}

fap_err fap_surface_count(const fap_surface *s, fap_surface_census *out)
{
    surface_edges e = { 0 };
    uint32_t *parent = fap_mem_calloc(&s->alloc, s->vertex_count, sizeof *parent);
    uint8_t *used = fap_mem_calloc(&s->alloc, s->vertex_count, 1);
    const int ok = parent && used &&
                   surface_edges_find(&e, (const uint32_t(*)[3])s->triangle, s->triangle_count,
                                      s->vertex_count, &s->alloc) == FAP_OK;

    *out = (fap_surface_census){ 0 };
    for (uint32_t v = 0; ok && v < s->vertex_count; v++)
        parent[v] = v;
    if (ok) {
        count_edges(s, &e, parent, out);
        count_pieces(s, &e, parent, used, out);
    }
    for (uint32_t t = 0; t < s->triangle_count; t++)
        out->area += surface_triangle_area((const float(*)[3])s->position, s->triangle[t]);
    surface_edges_free(&e, &s->alloc);
    fap_mem_free(&s->alloc, parent);
    fap_mem_free(&s->alloc, used);
    return ok ? FAP_OK : FAP_E_NOMEM;
}
