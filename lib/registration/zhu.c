/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * --method zhu: consistent parameterisation as Zhu 2006 has it, chapter 4. Landmarks bend space by Hardy's multiquadrics, met
 * exactly (4.3); the face is made finer by Loop's scheme (4.4; "a factor of eight" for two steps is a slip: 1,485 triangles
 * become 23,760, which is sixteen); then each vertex goes along a ray to the scan, about the head's axis or along its
 * normal, if that is not too far (4.5). What a scanner sees badly, ears, the top and the back of the head, is not projected
 * and can be left out (4.6). The affine part of the bending is ours: without it a head that is larger everywhere comes out
 * lumpy between the landmarks; and what is not projected bends along with what is, as our generic face, unlike the thesis's, has an
 * inside of lips and lids.
 */
#include <string.h>

#include "base/mem.h"
#include "registration/cylinder.h"
#include "registration/laying.h"
#include "surface/normals.h"

/* --- 4.5, 4.6 --- */

/* The nearer of what is met outwards and inwards; 0: nothing within the limit. */
static int project(const laying *l, uint32_t i, const float direction[3], float out[3])
{
    const float back[3] = { -direction[0], -direction[1], -direction[2] }, limit = (float)l->cfg->limit_mm;
    surface_hit outwards, inwards;

    const int is_out = surface_index_ray(l->index, l->at[i], direction, limit, &outwards);
    const int is_in = surface_index_ray(l->index, l->at[i], back, limit, &inwards);
    if (!is_out && !is_in)
        return 0;
    memcpy(out, is_out && (!is_in || outwards.distance < inwards.distance) ? outwards.at : inwards.at,
           3 * sizeof *out);
    return 1;
}

/* @seen: of the generic face; what is behind it, the inside of lips and lids, is behind the scan as well. */
static void project_all(const laying *l, const cylinder *c, const uint8_t *seen, elastic_pull *pull)
{
    for (uint32_t i = 0; i < l->generic->vertex_count; i++) {
        float direction[3], to[3];
        if (!seen[i] || !cylinder_is_face(c, l->generic->position[i]))
            continue;
        if (l->cfg->along_normals)
            memcpy(direction, l->normal[i], sizeof direction);
        else
            cylinder_outwards(c, l->at[i], direction);
        if (!project(l, i, direction, to))
            continue;
        pull[i].weight = 1;
        for (int a = 0; a < 3; a++) {
            pull[i].to[a] = (double)to[a];
            pull[i].normal[a] = (double)l->normal[i][a];
        }
    }
}

static fap_err refine(laying *l)
{
    const fap_generic *g = l->generic;
    const cylinder c = cylinder_around(g->position, g->vertex_count);
    uint8_t *seen = fap_mem_calloc(l->alloc, g->vertex_count, 1);
    elastic_pull *pull = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *pull);

    fap_err err = seen && pull ? laying_find_seen(l, &c, seen) : FAP_E_NOMEM;
    if (err == FAP_OK) {
        surface_normals((const float(*)[3])l->at, g->vertex_count, g->triangle, g->triangle_count, l->normal);
        project_all(l, &c, seen, pull);
        err = laying_sew(l, pull);
    }
    fap_mem_free(l->alloc, seen);
    fap_mem_free(l->alloc, pull);
    return err;
}

fap_err laying_zhu(laying *l)
{
    fap_err err = laying_bend(l, WARP_HARDY, 0);

    for (int step = 0; step < l->cfg->subdivisions && err == FAP_OK; step++)
        err = laying_subdivide(l, 0);
    if (err == FAP_OK)
        err = laying_progress(l, 0.5);
    if (err == FAP_OK)
        err = refine(l);
    if (err == FAP_OK)
        laying_bring_inside(l);
    return err;
}
