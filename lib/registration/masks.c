/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Masks on another face. Sanchez Lorenzo et al. 2003, section 6.1, draw the fitted face's mask into a texture of the target's
 * cylinder; here each vertex asks along its own ray, which is that texture without texels, and with every layer: behind a
 * lip there are teeth, and under a lid an eyeball.
 */
#include <math.h>
#include <string.h>

#include <fap/studio/masks.h>

#include "base/mem.h"
#include "registration/cylinder.h"
#include "surface/edges.h"
#include "surface/nearest.h"
#include "surface/normals.h"

/* The fitted face lies within a millimetre; a lip is some millimetres thick. */
static const float reach_mm = 5;
static const double least_cosine = 0.3;
/* What a ray skips to be past a surface. */
static const float past_mm = 0.01F;
enum { LAYERS = 6, VOTES = 3 };

typedef struct mapping {
    const fap_registration *r;
    const fap_generic *generic;
    const fap_surface *face;
    surface_index *laid;
    cylinder axis;
    float (*at)[3], (*normal)[3]; /* of the face, in the head's axes */
    uint8_t *mask, *voted;
    surface_edges edges;
    uint32_t *votes; /* [vertices][FAP_MASK_BITS] */
} mapping;

/* --- one vertex --- */

typedef struct looker {
    const mapping *m;
    uint32_t vertex;
} looker;

static int faces_alike(const void *user, uint32_t t)
{
    const looker *w = user;
    const float(*laid)[3] = fap_registration_positions(w->m->r), *n = w->m->normal[w->vertex];
    double own[3], dot = 0, length = 0;

    surface_triangle_normal(laid, w->m->generic->triangle[t], own);
    for (int a = 0; a < 3; a++) {
        dot += own[a] * (double)n[a];
        length += own[a] * own[a];
    }
    return dot > least_cosine * sqrt(length);
}

/* The nearest layer along one way that faces as the vertex does. */
static int meet(const mapping *m, uint32_t v, const float way[3], surface_hit *hit)
{
    const looker who = { m, v };
    float from[3], gone = 0;

    memcpy(from, m->at[v], sizeof from);
    for (int layer = 0; layer < LAYERS && surface_index_ray(m->laid, from, way, reach_mm - gone, hit);
         layer++) {
        const float step = hit->distance + past_mm;
        hit->distance += gone;
        if (faces_alike(&who, hit->triangle))
            return 1;
        gone += step;
        for (int a = 0; a < 3; a++)
            from[a] += step * way[a];
        if (gone >= reach_mm)
            return 0;
    }
    return 0;
}

static int find_place(const mapping *m, uint32_t v, surface_hit *hit)
{
    const looker who = { m, v };
    float out[3], back[3];
    surface_hit other;

    cylinder_outwards(&m->axis, m->at[v], out);
    for (int a = 0; a < 3; a++)
        back[a] = -out[a];
    const int is_out = meet(m, v, out, hit), is_in = meet(m, v, back, &other);
    if (is_in && (!is_out || other.distance < hit->distance))
        *hit = other;
    return is_out || is_in || surface_index_nearest(m->laid, m->at[v], reach_mm, faces_alike, &who, hit);
}

static uint8_t mask_at(const mapping *m, uint32_t v)
{
    surface_hit hit;

    if (!find_place(m, v, &hit))
        return 0;
    int most = 0;
    for (int c = 1; c < 3; c++)
        if (hit.share[c] > hit.share[most])
            most = c;
    return m->generic->mask[m->generic->triangle[hit.triangle][most]];
}

/* --- neighbours --- */

static void vote(const mapping *m, uint32_t voter, uint32_t v)
{
    for (int bit = 0; bit < FAP_MASK_BITS; bit++)
        m->votes[v * FAP_MASK_BITS + (uint32_t)bit] += m->mask[voter] >> bit & 1;
}

/* Of the sides of one slit, the one that more neighbours are of, where the vertex is of any. */
static uint8_t decide(const uint32_t votes[FAP_MASK_BITS], uint8_t own)
{
    for (int upper = 0; upper < FAP_MASK_BITS; upper += 2) {
        const uint8_t both = (uint8_t)(3 << upper);
        if ((own & both) && votes[upper] != votes[upper + 1])
            own = (uint8_t)((own & ~both) | (votes[upper] > votes[upper + 1] ? 1 : 2) << upper);
    }
    return own;
}

static void let_neighbours_vote(mapping *m)
{
    memset(m->votes, 0, m->face->vertex_count * FAP_MASK_BITS * sizeof *m->votes);
    for (uint32_t i = 0; i < m->edges.count; i++) {
        vote(m, m->edges.edge[i].low, m->edges.edge[i].high);
        vote(m, m->edges.edge[i].high, m->edges.edge[i].low);
    }
    for (uint32_t v = 0; v < m->face->vertex_count; v++)
        m->voted[v] = decide(m->votes + v * FAP_MASK_BITS, m->mask[v]);
    memcpy(m->mask, m->voted, m->face->vertex_count);
}

/* --- the whole --- */

static fap_err open(mapping *m, const fap_allocator *heap)
{
    const fap_surface *f = m->face;
    const float(*laid)[3] = fap_registration_positions(m->r);

    m->at = fap_mem_calloc(heap, f->vertex_count, sizeof *m->at);
    m->normal = fap_mem_calloc(heap, f->vertex_count, sizeof *m->normal);
    m->voted = fap_mem_calloc(heap, f->vertex_count, 1);
    m->votes = fap_mem_calloc(heap, f->vertex_count, FAP_MASK_BITS * sizeof *m->votes);
    if (!m->at || !m->normal || !m->voted || !m->votes)
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < f->vertex_count; v++)
        fap_registration_to_head(m->r, f->position[v], m->at[v]);
    surface_normals((const float(*)[3])m->at, f->vertex_count, (const uint32_t(*)[3])f->triangle,
                    f->triangle_count, m->normal);
    m->axis = cylinder_around(laid, m->generic->vertex_count);
    fap_err err = surface_edges_find(&m->edges, (const uint32_t(*)[3])f->triangle, f->triangle_count,
                                     f->vertex_count, heap);
    return err == FAP_OK ? surface_index_open(&m->laid, laid, m->generic->vertex_count, m->generic->triangle,
                                              m->generic->triangle_count)
                         : err;
}

fap_err fap_masks_retarget(const fap_registration *r, const fap_generic *generic, const fap_surface *face,
                           uint8_t *mask)
{
    const fap_allocator heap = fap_mem_allocator(&face->alloc);
    mapping m = { .r = r, .generic = generic, .face = face, .mask = mask };

    if (!generic->mask || fap_registration_surface(r)->vertex_count != generic->vertex_count)
        return FAP_E_ARG;
    const fap_err err = open(&m, &heap);
    for (uint32_t v = 0; err == FAP_OK && v < face->vertex_count; v++)
        mask[v] = mask_at(&m, v);
    for (int round = 0; err == FAP_OK && round < VOTES; round++)
        let_neighbours_vote(&m);
    surface_index_close(&m.laid);
    surface_edges_free(&m.edges, &heap);
    fap_mem_free(&heap, m.at);
    fap_mem_free(&heap, m.normal);
    fap_mem_free(&heap, m.voted);
    fap_mem_free(&heap, m.votes);
    return err;
}
