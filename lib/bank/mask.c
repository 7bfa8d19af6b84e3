/* SPDX-License-Identifier: BSD-2-Clause */
/* See mask.h. */
#include <math.h>
#include <string.h>

#include "bank/face_graph.h"
#include "bank/mask.h"
#include "base/mem.h"

static const float typical_es_mm = 62; /* reaches are for a face with its eyes this far apart */
static const float lip_reach_mm = 16, lid_reach_mm = 10; /* how far a lip or a lid goes from its points */
static const float clearly =
    0.5f; /* nearer than this share of the other side's distance; corners stay free */

enum { SIDE_POINTS = 6 };

/* In the order of the bits: sides of one slit are neighbours, the upper one first. */
static const char *const side_points[FAP_MASK_BITS][SIDE_POINTS + 1] = {
    { "2.2", "2.6", "2.7", "8.1", "8.5", "8.6" },
    { "2.3", "2.8", "2.9", "8.2", "8.7", "8.8" },
    { "3.1" },
    { "3.3" },
    { "3.2" },
    { "3.4" },
};

uint8_t fap_mask_of_point(int point)
{
    for (int bit = 0; bit < FAP_MASK_BITS; bit++)
        for (int i = 0; side_points[bit][i]; i++)
            if (fap_point_by_name(side_points[bit][i]) == point)
                return (uint8_t)(1 << bit);
    return 0;
}

uint8_t fap_mask_across(uint8_t bit)
{
    const uint8_t upper = FAP_MASK_LIP_UPPER | FAP_MASK_LID_UPPER_LEFT | FAP_MASK_LID_UPPER_RIGHT;

    return (uint8_t)(bit & upper ? bit << 1 : bit >> 1);
}

/* Adds the distance of every vertex from the nearest point of the side, INFINITY beyond @p reach_mm. */
static void measure_side(fap_graph *g, const fap_bank *bank, int bit, float reach_mm, float *distance)
{
    for (uint32_t v = 0; v < g->vertex_count; v++)
        distance[v] = INFINITY;
    for (int i = 0; side_points[bit][i]; i++) {
        const fap_bank_point *p = fap_bank_point_get(bank, fap_point_by_name(side_points[bit][i]));
        if (!p->present || !p->vertex_count)
            continue;
        fap_graph_flood(g, p->vertex, p->vertex_count, reach_mm);
        for (uint32_t v = 0; v < g->vertex_count; v++)
            distance[v] = fminf(distance[v], g->distance[g->weld[v]]);
    }
}

static void mark_side(const fap_mesh *mesh, const float *own, const float *other, float reach_mm, uint8_t bit,
                      uint8_t *mask)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (mesh->part[v] == FAP_PART_SKIN && own[v] <= reach_mm && own[v] < clearly * other[v])
            mask[v] |= bit;
}

static void mark_slit(fap_graph *g, const fap_bank *bank, int upper, float *distance, uint8_t *mask)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    const float scale = fap_bank_fapu(bank)->es_mm / typical_es_mm;
    const float reach = scale * (upper == 0 ? lip_reach_mm : lid_reach_mm);
    float *const from_lower = distance + mesh->vertex_count;

    measure_side(g, bank, upper, reach / clearly, distance);
    measure_side(g, bank, upper + 1, reach / clearly, from_lower);
    mark_side(mesh, distance, from_lower, reach, (uint8_t)(1 << upper), mask);
    mark_side(mesh, from_lower, distance, reach, (uint8_t)(2 << upper), mask);
}

int fap_mask_derive(const fap_bank *bank, uint8_t *mask, const fap_allocator *alloc)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    fap_graph g;
    float *distance = fap_mem_calloc(alloc, 2 * (size_t)mesh->vertex_count, sizeof *distance);
    const int failed = fap_graph_open(&g, bank, alloc) || !distance;

    memset(mask, 0, mesh->stride);
    for (int upper = 0; upper < FAP_MASK_BITS && !failed; upper += 2)
        mark_slit(&g, bank, upper, distance, mask);
    fap_graph_close(&g, alloc);
    fap_mem_free(alloc, distance);
    return failed;
}
