/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What a projection leaves over: which skin of the generic face is seen from outside at all, and where the rest of it goes once
 * the seen skin has its places.
 */
#include <string.h>

#include "base/mem.h"
#include "registration/laying.h"

enum { SEAM_ROUNDS = 80 };
/* Skin is seen where nothing is in front of it; this much is numbers' noise. */
static const float noise_mm = 0.3F, outside_mm = 300;
/* What has its place draws; what bends where nothing has, bends little. */
static const double seam_stiffness = 0.05, seam_stretch = 0.3;

static int is_seen(const laying *l, const cylinder *axis, const surface_index *face, uint32_t i)
{
    const float *at = l->generic->position[i];
    float out[3], from[3], back[3];
    surface_hit h;

    cylinder_outwards(axis, at, out);
    for (int a = 0; a < 3; a++) {
        from[a] = at[a] + outside_mm * out[a];
        back[a] = -out[a];
    }
    return !surface_index_ray(face, from, back, outside_mm - noise_mm, &h);
}

fap_err laying_find_seen(const laying *l, const cylinder *axis, uint8_t *seen)
{
    const fap_generic *g = l->generic;
    surface_index *face;
    const fap_err err =
        surface_index_open(&face, g->position, g->vertex_count, g->triangle, g->triangle_count);

    for (uint32_t i = 0; err == FAP_OK && i < g->vertex_count; i++)
        seen[i] = (uint8_t)(laying_is_skin(l, i) && is_seen(l, axis, face, i));
    surface_index_close(&face);
    return err;
}

fap_err laying_sew(laying *l, const elastic_pull *pull)
{
    const fap_generic *g = l->generic;
    float(*rest)[3] = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *rest);
    uint8_t *use = fap_mem_calloc(l->alloc, g->vertex_count, 1);
    elastic *skin = NULL;
    const elastic_task task = { .pull = pull,
                                .slide = 1,
                                .stiffness = seam_stiffness,
                                .stretch = seam_stretch,
                                .rounds = SEAM_ROUNDS,
                                .enough = 1e-3 };

    fap_err err = rest && use ? FAP_OK : FAP_E_NOMEM;
    if (err == FAP_OK) {
        memcpy(rest, l->at, g->vertex_count * sizeof *rest);
        for (uint32_t i = 0; i < g->vertex_count; i++)
            use[i] = (uint8_t)laying_is_skin(l, i);
        err = elastic_open(&skin, (const float(*)[3])rest, g->vertex_count, g->triangle, g->triangle_count,
                           &l->edges, use, l->alloc);
    }
    if (err == FAP_OK)
        elastic_solve(skin, &task, l->at);
    elastic_close(&skin);
    fap_mem_free(l->alloc, rest);
    fap_mem_free(l->alloc, use);
    return err;
}
