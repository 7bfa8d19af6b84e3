/* SPDX-License-Identifier: BSD-2-Clause */
/* See skin_projection.h. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/skin_projection.h"

/* A ray that grazes the scan slides along it far for a little noise. */
static const double least_cosine = 0.35, facing = 0.5;
/* How much a vertex follows its neighbours, against a ray that meets the scan squarely. */
static const double smoothness = 0.6;
enum { ROUNDS = 12 };

typedef struct projection {
    const counterparts *c;
    const control_face *face;
    float (*outwards)[3];
    double *way, *seen, *weight, *sum, *sum_weight;
} projection;

static double dot(const double a[3], const float b[3])
{
    return a[0] * (double)b[0] + a[1] * (double)b[1] + a[2] * (double)b[2];
}

/* Where the ray meets the scan, by its tangent plane at the nearest place that fits: no ray goes through a slit to the other lip. */
static void see(projection *p, uint32_t v, double limit)
{
    const laying *l = p->c->l;
    elastic_pull pull;
    double off[3];

    counterpart_find(p->c, v, limit, facing, &pull);
    const double cosine = pull.weight > 0 ? dot(pull.normal, p->outwards[v]) : 0;
    if (cosine < least_cosine)
        return;
    for (int a = 0; a < 3; a++)
        off[a] = pull.to[a] - (double)l->at[v][a];
    const double way = (off[0] * pull.normal[0] + off[1] * pull.normal[1] + off[2] * pull.normal[2]) / cosine;
    if (fabs(way) > limit)
        return;
    p->seen[v] = p->way[v] = way;
    p->weight[v] = pull.weight * cosine * cosine;
}

/* Each takes the mean of what it sees and what its neighbours do (Jacobi). */
static void smooth(projection *p)
{
    const surface_edges *e = p->face->edges;
    const uint32_t n = p->face->vertex_count;

    memset(p->sum, 0, n * sizeof *p->sum);
    memset(p->sum_weight, 0, n * sizeof *p->sum_weight);
    for (uint32_t i = 0; i < e->count; i++) {
        const uint32_t a = e->edge[i].low, b = e->edge[i].high;
        if (!p->face->use[a] || !p->face->use[b])
            continue;
        p->sum[a] += p->way[b];
        p->sum[b] += p->way[a];
        p->sum_weight[a]++;
        p->sum_weight[b]++;
    }
    for (uint32_t v = 0; v < n; v++) {
        if (!(p->sum_weight[v] > 0))
            continue;
        const double around = p->sum[v] / p->sum_weight[v];
        p->way[v] = (p->weight[v] * p->seen[v] + smoothness * around) / (p->weight[v] + smoothness);
    }
}

static void tidy(projection *p)
{
    const fap_allocator *alloc = p->c->l->alloc;

    fap_mem_free(alloc, p->outwards);
    fap_mem_free(alloc, p->way);
    fap_mem_free(alloc, p->seen);
    fap_mem_free(alloc, p->weight);
    fap_mem_free(alloc, p->sum);
    fap_mem_free(alloc, p->sum_weight);
}

fap_err skin_project(const counterparts *c, const control_face *face, const cylinder *axis, double limit,
                     float (*at)[3])
{
    const laying *l = c->l;
    const uint32_t n = face->vertex_count;
    projection p = { .c = c,
                     .face = face,
                     .outwards = fap_mem_calloc(l->alloc, n, sizeof *p.outwards),
                     .way = fap_mem_calloc(l->alloc, n, sizeof *p.way),
                     .seen = fap_mem_calloc(l->alloc, n, sizeof *p.seen),
                     .weight = fap_mem_calloc(l->alloc, n, sizeof *p.weight),
                     .sum = fap_mem_calloc(l->alloc, n, sizeof *p.sum),
                     .sum_weight = fap_mem_calloc(l->alloc, n, sizeof *p.sum_weight) };
    const int ok = p.outwards && p.way && p.seen && p.weight && p.sum && p.sum_weight;

    for (uint32_t v = 0; ok && v < n; v++) {
        if (!face->use[v])
            continue;
        if (l->cfg->along_normals)
            memcpy(p.outwards[v], l->normal[v], sizeof p.outwards[v]);
        else
            cylinder_outwards(axis, l->at[v], p.outwards[v]);
        see(&p, v, limit);
    }
    for (int round = 0; ok && round < ROUNDS; round++)
        smooth(&p);
    for (uint32_t v = 0; ok && v < n; v++)
        for (int a = 0; a < 3; a++)
            at[v][a] += (float)p.way[v] * p.outwards[v][a];
    tidy(&p);
    return ok ? FAP_OK : FAP_E_NOMEM;
}
