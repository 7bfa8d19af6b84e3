/* SPDX-License-Identifier: BSD-2-Clause */
/* What no scanner sees: eyes, teeth, tongue and lashes go where the skin around them went, turned, moved and scaled. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/laying.h"

/* Skin this near counts most. */
static const double near_mm = 6;

typedef struct around {
    double (*from)[3], (*to)[3], *weight;
    uint32_t count;
    double centre[3];
} around;

static int find_centre(const laying *l, uint8_t part, double centre[3])
{
    const fap_generic *g = l->generic;
    uint32_t count = 0;

    centre[0] = centre[1] = centre[2] = 0;
    for (uint32_t i = 0; i < g->vertex_count; i++) {
        if (g->part[i] != part)
            continue;
        count++;
        for (int a = 0; a < 3; a++)
            centre[a] += (double)g->position[i][a];
    }
    for (int a = 0; a < 3; a++)
        centre[a] /= count ? count : 1;
    return count > 0;
}

/* Skin counts by how near it is to the middle, beyond the nearest of it. */
static void gather(const laying *l, around *r)
{
    const fap_generic *g = l->generic;
    double least = INFINITY;

    r->count = 0;
    for (uint32_t i = 0; i < g->vertex_count; i++) {
        if (!laying_is_skin(l, i))
            continue;
        double sum = 0;
        for (int a = 0; a < 3; a++) {
            r->from[r->count][a] = (double)g->position[i][a];
            r->to[r->count][a] = (double)l->at[i][a];
            sum += pow((double)g->position[i][a] - r->centre[a], 2);
        }
        r->weight[r->count++] = sqrt(sum);
        least = fmin(least, sqrt(sum));
    }
    for (uint32_t i = 0; i < r->count; i++)
        r->weight[i] = exp(-pow((r->weight[i] - least) / near_mm, 2));
}

static void middle_and_size(const double (*p)[3], const double *weight, uint32_t n, double middle[3],
                            double *size)
{
    double total = 0, sum = 0;

    middle[0] = middle[1] = middle[2] = 0;
    for (uint32_t i = 0; i < n; i++) {
        total += weight[i];
        for (int a = 0; a < 3; a++)
            middle[a] += weight[i] * p[i][a];
    }
    for (int a = 0; a < 3; a++)
        middle[a] /= total;
    for (uint32_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            sum += weight[i] * pow(p[i][a] - middle[a], 2);
    *size = sqrt(sum / total);
}

static void move_part(laying *l, uint8_t part, around *r)
{
    const fap_generic *g = l->generic;
    double from[3], to[3], from_size, to_size;
    rigid_pose pose;

    middle_and_size((const double(*)[3])r->from, r->weight, r->count, from, &from_size);
    middle_and_size((const double(*)[3])r->to, r->weight, r->count, to, &to_size);
    const double scale = from_size > 0 ? to_size / from_size : 1;
    for (uint32_t i = 0; i < r->count; i++)
        for (int a = 0; a < 3; a++)
            r->from[i][a] *= scale;
    if (!rigid_fit((const double(*)[3])r->from, (const double(*)[3])r->to, r->weight, r->count, &pose))
        return;
    for (uint32_t i = 0; i < g->vertex_count; i++) {
        double at[3], there[3];
        if (g->part[i] != part)
            continue;
        for (int a = 0; a < 3; a++)
            at[a] = (double)g->position[i][a] * scale;
        rigid_apply(&pose, at, there);
        for (int a = 0; a < 3; a++)
            l->at[i][a] = (float)there[a];
    }
}

void laying_bring_inside(laying *l)
{
    const fap_generic *g = l->generic;
    around r = { .from = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *r.from),
                 .to = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *r.to),
                 .weight = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *r.weight) };

    for (int part = FAP_PART_SKIN + 1; g->part && r.from && r.to && r.weight && part < FAP_PART_COUNT; part++)
        if (find_centre(l, (uint8_t)part, r.centre)) {
            gather(l, &r);
            if (r.count)
                move_part(l, (uint8_t)part, &r);
        }
    fap_mem_free(l->alloc, r.from);
    fap_mem_free(l->alloc, r.to);
    fap_mem_free(l->alloc, r.weight);
}
