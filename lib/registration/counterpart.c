/* SPDX-License-Identifier: BSD-2-Clause */
/* See counterpart.h. */
#include <math.h>
#include <string.h>

#include "bank/mask.h"
#include "base/mem.h"
#include "registration/counterpart.h"
#include "surface/normals.h"

fap_err counterparts_open(counterparts *c, const laying *l)
{
    *c = (counterparts){ .l = l,
                         .side = fap_mem_calloc(l->alloc, l->scan_triangles, 1),
                         .foreign = fap_mem_calloc(l->alloc, l->scan_triangles, 1) };
    return c->side && c->foreign ? FAP_OK : FAP_E_NOMEM;
}

void counterparts_close(counterparts *c)
{
    if (!c->l)
        return;
    fap_mem_free(c->l->alloc, c->side);
    fap_mem_free(c->l->alloc, c->foreign);
}

/* Which way a triangle of the scan looks, by its corners' normals; not of unit length. */
static void scan_looks(const laying *l, uint32_t t, double normal[3])
{
    for (int a = 0; a < 3; a++) {
        normal[a] = 0;
        for (int c = 0; c < 3; c++)
            normal[a] += (double)l->scan_normal[l->scan_triangle[t][c]][a];
    }
}

/* --- sides of the slits --- */

typedef struct looker {
    const laying *l;
    double normal[3];
} looker;

/* Lips that touch face each other: of two that are as near, the one that looks the same way is meant. */
static int looks_alike(const void *user, uint32_t t)
{
    const looker *w = user;
    double face[3];

    surface_triangle_normal((const float(*)[3])w->l->at, w->l->generic->triangle[t], face);
    return face[0] * w->normal[0] + face[1] * w->normal[1] + face[2] * w->normal[2] > 0;
}

static void mark_triangle(counterparts *c, const surface_index *face, uint32_t t)
{
    const laying *l = c->l;
    const fap_generic *g = l->generic;
    looker way = { .l = l };
    float middle[3];
    surface_hit h;

    c->side[t] = c->foreign[t] = 0;
    for (int a = 0; a < 3; a++)
        middle[a] = (l->scan[l->scan_triangle[t][0]][a] + l->scan[l->scan_triangle[t][1]][a] +
                     l->scan[l->scan_triangle[t][2]][a]) /
                    3;
    scan_looks(l, t, way.normal);
    if (!surface_index_nearest(face, middle, (float)l->cfg->reach_mm, looks_alike, &way, &h))
        return;
    c->foreign[t] = !laying_is_skin(l, g->triangle[h.triangle][0]);
    for (int k = 0; g->mask && k < 3; k++)
        c->side[t] |= g->mask[g->triangle[h.triangle][k]];
}

fap_err counterparts_mark(counterparts *c)
{
    const laying *l = c->l;
    const fap_generic *g = l->generic;
    surface_index *face;

    if (!g->mask && !g->part)
        return FAP_OK;
    const fap_err err =
        surface_index_open(&face, (const float(*)[3])l->at, g->vertex_count, g->triangle, g->triangle_count);
    for (uint32_t t = 0; err == FAP_OK && t < l->scan_triangles; t++)
        mark_triangle(c, face, t);
    surface_index_close(&face);
    return err;
}

/* --- which place --- */

static int is_across(const counterparts *c, uint32_t vertex, uint32_t t)
{
    const uint8_t own = c->l->generic->mask ? c->l->generic->mask[vertex] : 0;
    uint8_t across = 0;

    for (uint8_t bit = 1; bit <= FAP_MASK_LID_LOWER_RIGHT; bit = (uint8_t)(bit << 1))
        across |= own & bit ? fap_mask_across(bit) : 0;
    return (c->side[t] & across) && !(c->side[t] & own);
}

int counterpart_fits(const counterparts *c, uint32_t vertex, uint32_t t, double facing)
{
    const float *n = c->l->normal[vertex];
    double look[3], dot = 0, length = 0;

    if (c->foreign[t] || is_across(c, vertex, t))
        return 0;
    scan_looks(c->l, t, look);
    for (int a = 0; a < 3; a++) {
        dot += look[a] * (double)n[a];
        length += look[a] * look[a];
    }
    return dot > facing * sqrt(length);
}

typedef struct seeker {
    const counterparts *c;
    uint32_t vertex;
    double facing;
} seeker;

static int fits(const void *user, uint32_t t)
{
    const seeker *s = user;

    return counterpart_fits(s->c, s->vertex, t, s->facing);
}

static int is_rim(const laying *l, const surface_hit *h)
{
    for (int c = 0; c < 3; c++)
        if (h->share[c] > 1e-3F && !l->scan_border[l->scan_triangle[h->triangle][c]])
            return 0;
    return 1;
}

/* The mix of the corners' normals. */
static void normal_at(const laying *l, const surface_hit *h, double n[3])
{
    double length = 0;

    for (int a = 0; a < 3; a++) {
        n[a] = 0;
        for (int c = 0; c < 3; c++)
            n[a] += (double)(h->share[c] * l->scan_normal[l->scan_triangle[h->triangle][c]][a]);
        length += n[a] * n[a];
    }
    for (int a = 0; a < 3; a++)
        n[a] /= fmax(1e-9, sqrt(length));
}

void counterpart_find(const counterparts *c, uint32_t vertex, double reach, double facing, elastic_pull *out)
{
    const laying *l = c->l;
    const seeker who = { c, vertex, facing };
    surface_hit h;

    out->weight = 0;
    if (!surface_index_nearest(l->index, l->at[vertex], (float)reach, fits, &who, &h) || is_rim(l, &h))
        return;
    const double far = (double)h.distance / reach;
    out->weight = pow(1 - far * far, 2); /* Tukey's */
    for (int a = 0; a < 3; a++)
        out->to[a] = (double)h.at[a];
    normal_at(l, &h, out->normal);
}
