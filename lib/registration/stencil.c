/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See stencil.h. The text leaves open where its five paths run ("defined empirically"). Ours: along the brows, the hair line, the
 * line of the eyes over the ridge of the nose, and from either eye's outer corner to the ear. With spheres of 20 mm that is all above the
 * cheeks and the tip of the nose, and nothing of the upper lip.
 */
#include <math.h>
#include <string.h>

#include "bank/face_graph.h"
#include "base/mem.h"
#include "registration/stencil.h"

enum { PATHS = 5, PATH_STEPS_MAX = 4096 };

static const char *const paths[PATHS][2] = {
    { "4.6", "4.5" }, { "11.2", "11.3" }, { "3.12", "3.7" }, { "3.7", "10.9" }, { "3.12", "10.10" }
};
/* Farther than around any head. */
static const float everywhere_mm = 1000;

static int vertex_of(const fap_bank *bank, const char *name, uint32_t *vertex)
{
    const fap_bank_point *p = fap_bank_point_get(bank, fap_point_by_name(name));

    if (!p->present || !p->vertex_count || fap_bank_mesh(bank)->part[p->vertex[0]] != FAP_PART_SKIN)
        return 0;
    *vertex = p->vertex[0];
    return 1;
}

/* The neighbour from which it is shortest; itself at the end. */
static uint32_t step(const fap_graph *g, uint32_t v)
{
    uint32_t best = v;
    float least = INFINITY;

    for (uint32_t i = g->start[v]; i < g->start[v + 1]; i++) {
        const float way = g->distance[g->next[i]] + g->length[i];
        if (g->distance[g->next[i]] < g->distance[v] && way < least) {
            least = way;
            best = g->next[i];
        }
    }
    return best;
}

/* @return how many were marked. */
static uint32_t mark_path(fap_graph *g, uint32_t from, uint32_t to, uint8_t *seed)
{
    uint32_t count = 0, v = g->weld[from];

    fap_graph_flood(g, &to, 1, everywhere_mm);
    if (!isfinite(g->distance[v]))
        return 0; /* two pieces */
    for (int steps = 0; steps < PATH_STEPS_MAX; steps++) {
        count += !seed[v];
        seed[v] = 1;
        const uint32_t next = step(g, v);
        if (next == v)
            break;
        v = next;
    }
    return count;
}

static uint32_t find_seeds(fap_graph *g, const fap_bank *bank, uint8_t *seed)
{
    uint32_t count = 0, from, to;

    for (int i = 0; i < PATHS; i++)
        if (vertex_of(bank, paths[i][0], &from) && vertex_of(bank, paths[i][1], &to))
            count += mark_path(g, from, to, seed);
    return count;
}

static int is_within(const float a[3], const float b[3], double radius)
{
    return pow((double)a[0] - (double)b[0], 2) + pow((double)a[1] - (double)b[1], 2) +
               pow((double)a[2] - (double)b[2], 2) <=
           radius * radius;
}

static void cover(const fap_mesh *mesh, const float (*at)[3], const uint8_t *seed, double radius,
                  uint8_t *out)
{
    for (uint32_t s = 0; s < mesh->vertex_count; s++)
        for (uint32_t v = 0; seed[s] && v < mesh->vertex_count; v++)
            if (!out[v] && mesh->part[v] == FAP_PART_SKIN && is_within(at[s], at[v], radius))
                out[v] = 1;
}

fap_err stencil_find(const fap_bank *bank, const float (*at)[3], double radius_mm, uint8_t *out,
                     const fap_allocator *alloc)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    uint8_t *seed = fap_mem_calloc(alloc, mesh->vertex_count, 1);
    fap_graph g;

    memset(out, 0, mesh->vertex_count);
    fap_err err = fap_graph_open(&g, bank, alloc) || !seed ? FAP_E_NOMEM : FAP_OK;
    if (err == FAP_OK && !find_seeds(&g, bank, seed))
        err = FAP_E_DATA;
    if (err == FAP_OK)
        cover(mesh, at, seed, radius_mm, out);
    fap_graph_close(&g, alloc);
    fap_mem_free(alloc, seed);
    return err;
}
