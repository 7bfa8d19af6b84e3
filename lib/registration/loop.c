/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See loop.h. Inner edges: 3/8 of their ends, 1/8 of what is across. Inner vertices: Warren's weights, 3/16 with three neighbours
 * and 3/(8n) with n. Borders and what is no manifold are a curve: 1/2 and 1/2, 1/8 3/4 1/8.
 */
#include <string.h>

#include <fap/studio/surface.h>

#include "base/mem.h"
#include "registration/loop.h"
#include "surface/edges.h"

typedef struct step {
    const float (*old)[3];
    const uint32_t (*triangle)[3];
    uint32_t vertex_count;
    surface_edges edges;
    uint32_t *around, *rims; /* neighbours of a vertex, and those along a border */
    loop_mesh *out;
    int flat;
} step;

static int is_rim(const surface_edge *e)
{
    return e->triangles != 2;
}

static void add(float to[3], double weight, const float from[3])
{
    for (int a = 0; a < 3; a++)
        to[a] += (float)(weight * (double)from[a]);
}

static uint32_t across(const step *s, const surface_edge *e, int side)
{
    const uint32_t *v = s->triangle[e->triangle[side]];

    for (int c = 0; c < 3; c++)
        if (v[c] != e->low && v[c] != e->high)
            return v[c];
    return e->low;
}

static void place_edge(step *s, uint32_t i)
{
    const surface_edge *e = &s->edges.edge[i];
    float *at = s->out->position[s->vertex_count + i];
    const int straight = is_rim(e) || s->flat;
    const double end = straight ? 0.5 : 0.375;

    add(at, end, s->old[e->low]);
    add(at, end, s->old[e->high]);
    for (int side = 0; !straight && side < 2; side++)
        add(at, 0.125, s->old[across(s, e, side)]);
}

static void count_neighbours(step *s)
{
    for (uint32_t i = 0; i < s->edges.count; i++) {
        const surface_edge *e = &s->edges.edge[i];
        s->around[e->low]++, s->around[e->high]++;
        if (is_rim(e))
            s->rims[e->low]++, s->rims[e->high]++;
    }
}

/* Of one neighbour; 0: the vertex stays for it. A border's corner, or where borders meet, does not move. */
static double neighbour_weight(const step *s, uint32_t v, const surface_edge *e)
{
    if (s->rims[v])
        return s->rims[v] == 2 && is_rim(e) ? 0.125 : 0;
    return s->around[v] == 3 ? 3.0 / 16 : 3.0 / (8 * (double)s->around[v]);
}

static void place_vertices(step *s)
{
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const double moved = s->flat             ? 0
                             : s->rims[v]        ? (s->rims[v] == 2 ? 0.25 : 0)
                             : s->around[v] == 3 ? 9.0 / 16
                                                 : 3.0 / 8;
        add(s->out->position[v], s->around[v] ? 1 - moved : 1, s->old[v]);
    }
    for (uint32_t i = 0; !s->flat && i < s->edges.count; i++) {
        const surface_edge *e = &s->edges.edge[i];
        add(s->out->position[e->low], neighbour_weight(s, e->low, e), s->old[e->high]);
        add(s->out->position[e->high], neighbour_weight(s, e->high, e), s->old[e->low]);
    }
}

static void divide(step *s, uint32_t t)
{
    const uint32_t *v = s->triangle[t];
    uint32_t middle[3];
    uint32_t(*out)[3] = s->out->triangle + 4 * (size_t)t;

    for (int c = 0; c < 3; c++)
        middle[c] = s->vertex_count + surface_edges_between(&s->edges, v[c], v[(c + 1) % 3]);
    for (int c = 0; c < 3; c++) {
        out[c][0] = v[c];
        out[c][1] = middle[c];
        out[c][2] = middle[(c + 2) % 3];
    }
    memcpy(out[3], middle, sizeof middle);
}

static void pass_on(const step *s, const uint8_t *old, uint8_t *out, int both)
{
    if (!old)
        return;
    memcpy(out, old, s->vertex_count);
    for (uint32_t i = 0; i < s->edges.count; i++)
        out[s->vertex_count + i] =
            both ? old[s->edges.edge[i].low] & old[s->edges.edge[i].high] : old[s->edges.edge[i].low];
}

static fap_err divide_all(loop_mesh *out, const float (*position)[3], uint32_t vertex_count,
                          const uint32_t (*triangle)[3], uint32_t triangle_count, const uint8_t *part,
                          const uint8_t *mask, const fap_allocator *alloc, int flat)
{
    step s = {
        .old = position, .triangle = triangle, .vertex_count = vertex_count, .out = out, .flat = flat
    };

    *out = (loop_mesh){ 0 };
    fap_err err = surface_edges_find(&s.edges, triangle, triangle_count, vertex_count, alloc);
    if (err != FAP_OK)
        return err;
    if (s.edges.count > FAP_SURFACE_MAX_VERTICES - vertex_count ||
        triangle_count > FAP_SURFACE_MAX_TRIANGLES / 4) {
        surface_edges_free(&s.edges, alloc);
        return FAP_E_LIMIT;
    }
    const size_t n = (size_t)vertex_count + s.edges.count;
    *out = (loop_mesh){ .vertex_count = (uint32_t)n,
                        .triangle_count = 4 * triangle_count,
                        .position = fap_mem_calloc(alloc, n, sizeof *out->position),
                        .triangle = fap_mem_calloc(alloc, 4 * (size_t)triangle_count, sizeof *out->triangle),
                        .part = part ? fap_mem_calloc(alloc, n, 1) : NULL,
                        .mask = mask ? fap_mem_calloc(alloc, n, 1) : NULL };
    s.around = fap_mem_calloc(alloc, vertex_count, sizeof *s.around);
    s.rims = fap_mem_calloc(alloc, vertex_count, sizeof *s.rims);
    if (!out->position || !out->triangle || (part && !out->part) || (mask && !out->mask) || !s.around ||
        !s.rims)
        err = FAP_E_NOMEM;
    if (err == FAP_OK) {
        count_neighbours(&s);
        place_vertices(&s);
        for (uint32_t i = 0; i < s.edges.count; i++)
            place_edge(&s, i);
        for (uint32_t t = 0; t < triangle_count; t++)
            divide(&s, t);
        pass_on(&s, part, out->part, 0);
        pass_on(&s, mask, out->mask, 1);
    }
    surface_edges_free(&s.edges, alloc);
    fap_mem_free(alloc, s.around);
    fap_mem_free(alloc, s.rims);
    return err;
}

fap_err loop_subdivide(loop_mesh *out, const float (*position)[3], uint32_t vertex_count,
                       const uint32_t (*triangle)[3], uint32_t triangle_count, const uint8_t *part,
                       const uint8_t *mask, const fap_allocator *alloc)
{
    return divide_all(out, position, vertex_count, triangle, triangle_count, part, mask, alloc, 0);
}

fap_err loop_split(loop_mesh *out, const float (*position)[3], uint32_t vertex_count,
                   const uint32_t (*triangle)[3], uint32_t triangle_count, const uint8_t *part,
                   const uint8_t *mask, const fap_allocator *alloc)
{
    return divide_all(out, position, vertex_count, triangle, triangle_count, part, mask, alloc, 1);
}

void loop_free(loop_mesh *m, const fap_allocator *alloc)
{
    fap_mem_free(alloc, m->position);
    fap_mem_free(alloc, m->triangle);
    fap_mem_free(alloc, m->part);
    fap_mem_free(alloc, m->mask);
    *m = (loop_mesh){ 0 };
}
