/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Motions of a face of another structure on ours. Source: Zhu 2006 section 5.2. One thing is different: a normal that misses
 * (a nostril's rim, a lip seen from behind) takes the nearest place that faces the same way; and where there is none, motion
 * comes from the neighbours, so that the back of the head does not stand still beside a cheek that moves.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/retarget.h>

#include "base/mem.h"
#include "surface/edges.h"
#include "surface/nearest.h"
#include "surface/normals.h"

enum { SPREAD_ROUNDS = 64 };

typedef struct sampling {
    const float (*laid)[3];
    float (*normal)[3], (*source_normal)[3];
    const fap_surface *source;
    const float (*delta)[3];
    surface_index *index;
    uint8_t *known; /* 1: sampled; 2: from neighbours */
    float (*work)[3];
    surface_edges edges;
    uint32_t count;
    double reach;
} sampling;

static void mix(const sampling *s, const surface_hit *h, float out[3])
{
    const uint32_t *v = s->source->triangle[h->triangle];

    for (int a = 0; a < 3; a++)
        out[a] = h->share[0] * s->delta[v[0]][a] + h->share[1] * s->delta[v[1]][a] +
                 h->share[2] * s->delta[v[2]][a];
}

typedef struct facing {
    const sampling *s;
    uint32_t vertex;
} facing;

static int faces_alike(const void *user, uint32_t t)
{
    const facing *f = user;
    const uint32_t *v = f->s->source->triangle[t];
    double dot = 0;

    for (int c = 0; c < 3; c++)
        for (int a = 0; a < 3; a++)
            dot += (double)f->s->source_normal[v[c]][a] * (double)f->s->normal[f->vertex][a];
    return dot > 0;
}

/* Along the normal, outwards and inwards; the nearer of the two. */
static int meet(const sampling *s, uint32_t i, surface_hit *h)
{
    const float *n = s->normal[i], back[3] = { -n[0], -n[1], -n[2] };
    const facing who = { s, i };
    surface_hit out, in;

    const int is_out =
        surface_index_ray(s->index, s->laid[i], n, (float)s->reach, &out) && faces_alike(&who, out.triangle);
    const int is_in =
        surface_index_ray(s->index, s->laid[i], back, (float)s->reach, &in) && faces_alike(&who, in.triangle);
    if (!is_out && !is_in)
        return surface_index_nearest(s->index, s->laid[i], (float)s->reach, faces_alike, &who, h);
    *h = is_out && (!is_in || out.distance < in.distance) ? out : in;
    return 1;
}

static uint32_t sample(sampling *s, const uint8_t *use, float (*out)[3])
{
    uint32_t met = 0;

    for (uint32_t i = 0; i < s->count; i++) {
        surface_hit h;
        memset(out[i], 0, sizeof out[i]);
        s->known[i] = (uint8_t)((!use || use[i]) && meet(s, i, &h));
        if (!s->known[i])
            continue;
        mix(s, &h, out[i]);
        met++;
    }
    return met;
}

/* Each round one ring further; what has been sampled stays. */
static void spread(sampling *s, const uint8_t *use, float (*out)[3])
{
    uint8_t *near = s->known;

    for (int round = 0; round < SPREAD_ROUNDS; round++) {
        uint32_t grown = 0;
        for (uint32_t i = 0; i < s->edges.count; i++) {
            const surface_edge *e = &s->edges.edge[i];
            const uint32_t ends[2] = { e->low, e->high };
            for (int k = 0; k < 2; k++) {
                const uint32_t to = ends[k], from = ends[1 - k];
                if (near[to] || !near[from] || near[from] == 3 || (use && !use[to]))
                    continue;
                for (int a = 0; a < 3; a++)
                    out[to][a] = 0.9F * out[from][a]; /* it fades on its way to the back of the head */
                near[to] = 3;
                grown++;
            }
        }
        for (uint32_t i = 0; i < s->count; i++)
            near[i] = near[i] == 3 ? 2 : near[i];
        if (!grown)
            break;
    }
}

/* The mean of a vertex and all that share an edge with it: once, as the thesis does it. */
static void smooth(sampling *s, float (*out)[3])
{
    uint32_t *n = fap_mem_calloc(&s->source->alloc, s->count, sizeof *n);

    if (!n)
        return; /* rougher, not wrong */
    memcpy(s->work, out, s->count * sizeof *out);
    for (uint32_t i = 0; i < s->edges.count; i++) {
        const surface_edge *e = &s->edges.edge[i];
        if (!s->known[e->low] || !s->known[e->high])
            continue;
        n[e->low]++, n[e->high]++;
        for (int a = 0; a < 3; a++) {
            s->work[e->low][a] += out[e->high][a];
            s->work[e->high][a] += out[e->low][a];
        }
    }
    for (uint32_t i = 0; i < s->count; i++)
        for (int a = 0; a < 3; a++)
            out[i][a] = s->work[i][a] / (float)(n[i] + 1);
    fap_mem_free(&s->source->alloc, n);
}

static fap_err open(sampling *s, const uint32_t (*triangle)[3], uint32_t triangle_count)
{
    const fap_surface *src = s->source;
    const fap_allocator *a = &src->alloc;

    s->normal = fap_mem_calloc(a, s->count, sizeof *s->normal);
    s->source_normal = fap_mem_calloc(a, src->vertex_count, sizeof *s->source_normal);
    s->known = fap_mem_calloc(a, s->count, 1);
    s->work = fap_mem_calloc(a, s->count, sizeof *s->work);
    if (!s->normal || !s->source_normal || !s->known || !s->work)
        return FAP_E_NOMEM;
    surface_normals(s->laid, s->count, triangle, triangle_count, s->normal);
    surface_normals((const float(*)[3])src->position, src->vertex_count, (const uint32_t(*)[3])src->triangle,
                    src->triangle_count, s->source_normal);
    const fap_err err = surface_edges_find(&s->edges, triangle, triangle_count, s->count, a);
    return err == FAP_OK ? surface_index_open(&s->index, (const float(*)[3])src->position, src->vertex_count,
                                              (const uint32_t(*)[3])src->triangle, src->triangle_count)
                         : err;
}

static void close(sampling *s)
{
    const fap_allocator *a = &s->source->alloc;

    surface_index_close(&s->index);
    surface_edges_free(&s->edges, a);
    fap_mem_free(a, s->normal);
    fap_mem_free(a, s->source_normal);
    fap_mem_free(a, s->known);
    fap_mem_free(a, s->work);
}

fap_err fap_motion_resample(const float (*laid)[3], uint32_t vertex_count, const uint32_t (*triangle)[3],
                            uint32_t triangle_count, const uint8_t *use, double reach,
                            const fap_surface *source, const float (*delta)[3], float (*out)[3])
{
    sampling s = { .laid = laid, .source = source, .delta = delta, .count = vertex_count, .reach = reach };

    fap_err err = open(&s, triangle, triangle_count);
    if (err == FAP_OK && !sample(&s, use, out))
        err = FAP_E_NOT_FOUND;
    if (err == FAP_OK) {
        spread(&s, use, out);
        smooth(&s, out);
    }
    close(&s);
    return err;
}
