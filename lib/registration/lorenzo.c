/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * --method lorenzo: mesh registration of Sanchez Lorenzo et al. 2003, section 6. A net of control points lies over the face, and
 * its triangles carry the skin (planar bones, section 4). Landmarks bend space and a cylindrical projection brings the
 * control points near the scan; then alpha E_dist + beta E_strain + gamma E_bend is minimised over them, and at last the skin
 * is projected. Ours: the net is made of the face itself, landmarks first; space is bent no more than landmarks are sure of; L-BFGS
 * beside the simplex.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/control_fit.h"
#include "registration/counterpart.h"
#include "registration/cylinder.h"
#include "registration/laying.h"
#include "registration/skin_projection.h"
#include "registration/warp.h"
#include "surface/normals.h"

/* From stiff to loose; alpha is 1. All constants were found with tests/bench/registration.c. */
static const struct stage {
    double strain, bend; /* beta, gamma */
    double pin;          /* of landmarks: without them an open mouth shuts */
    double even;         /* of the net, see control_fit.h */
    double reach_share;  /* of the configuration's reach */
    double facing;
    int rounds, iterations; /* of looking for what is near; of L-BFGS a round */
} stages[] = {
    { 1.0, 20, 0.005, 2, 1.0, 0.5, 3, 10 },
    { 0.4, 8, 0.005, 0.3, 0.6, 0.5, 3, 10 },
    { 0.1, 3, 0.0005, 0.03, 0.4, 0.5, 3, 10 },
};
enum { STAGES = sizeof stages / sizeof *stages, SIMPLEX_ROUNDS = 1 };

/* Across the scan's normal a vertex is drawn this much less. */
static const double slide = 0.1;
/* How far the bent space may stay off landmarks that are a millimetre off themselves. More than auto.c's: bones come after. */
static const double slack_per_mm2 = 30;
/* A ray that meets the scan at a grazing angle tells a control point nothing. */
static const double least_cosine = 0.4;
/* After the bones: what is left is no farther than this, against the limit of the configuration. */
static const double last_share = 0.2;
static const double simplex_edge_mm = 1.5;

typedef struct lorenzo {
    laying *l;
    control_face face; /* after the landmarks have bent it */
    float (*bent)[3];
    uint8_t *use;
    uint32_t *seed;
    elastic_pin *pin; /* [pins] */
    cylinder axis;
    control_mesh mesh;
    bone_skin skin;
    mesh_energy energy;
    control_fit fit;
    counterparts near;
} lorenzo;

/* --- the start: landmarks, then a cylindrical projection --- */

/* The nearer of what is met outwards and inwards, where that is the same side of the same thing. */
static int meet_scan(const lorenzo *z, uint32_t v, float at[3])
{
    const laying *l = z->l;
    float out[3], back[3];
    surface_hit hit, other;

    cylinder_outwards(&z->axis, l->at[v], out);
    for (int a = 0; a < 3; a++)
        back[a] = -out[a];
    const float squarely = out[0] * l->normal[v][0] + out[1] * l->normal[v][1] + out[2] * l->normal[v][2];
    const int is_out = surface_index_ray(l->index, l->at[v], out, (float)l->cfg->limit_mm, &hit);
    const int is_in = surface_index_ray(l->index, l->at[v], back, (float)l->cfg->limit_mm, &other);
    if (is_in && (!is_out || other.distance < hit.distance))
        hit = other;
    if ((!is_out && !is_in) || (double)squarely < least_cosine ||
        !counterpart_fits(&z->near, v, hit.triangle, least_cosine))
        return 0;
    memcpy(at, hit.at, sizeof hit.at);
    return 1;
}

static void project_controls(lorenzo *z)
{
    for (uint32_t i = 0; i < z->mesh.count; i++) {
        float at[3];
        if (meet_scan(z, z->mesh.vertex[i], at))
            for (int a = 0; a < 3; a++)
                z->fit.control[i][a] = (double)at[a];
    }
}

/* --- the net --- */

static void set_pins(lorenzo *z)
{
    const laying *l = z->l;

    for (uint32_t i = 0; i < l->pin_count; i++) {
        elastic_pin *p = &z->pin[i];
        p->weight = l->pin[i].weight / (l->cfg->pin_error_mm * l->cfg->pin_error_mm);
        for (int k = 0; k < 3; k++) {
            p->vertex[k] = l->pin[i].vertex[k];
            p->share[k] = l->pin[i].share[k];
            p->to[k] = l->pin[i].at[k];
        }
    }
    z->energy.pin = z->pin;
    z->energy.pin_count = l->pin_count;
}

/* A landmark's vertex, and none twice. */
static uint32_t find_seeds(lorenzo *z)
{
    const laying *l = z->l;

    for (uint32_t i = 0; i < l->pin_count; i++) {
        const laid_pin *p = &l->pin[i];
        int most = 0;
        for (int k = 1; k < 3; k++)
            if (p->share[k] > p->share[most])
                most = k;
        z->seed[i] = p->vertex[most];
    }
    return l->pin_count;
}

static fap_err open_net(lorenzo *z)
{
    laying *l = z->l;
    const fap_generic *g = l->generic;

    memcpy(z->bent, l->at, g->vertex_count * sizeof *z->bent);
    z->face = (control_face){ .position = (const float(*)[3])z->bent,
                              .vertex_count = g->vertex_count,
                              .triangle = g->triangle,
                              .triangle_count = g->triangle_count,
                              .edges = &l->edges,
                              .use = z->use,
                              .mask = g->mask };
    const uint32_t seeds = find_seeds(z);
    fap_err err =
        control_mesh_make(&z->mesh, &z->face, z->seed, seeds, (uint32_t)l->cfg->control_points, l->alloc);
    if (err == FAP_E_DATA)
        return laying_fail(l, err, "the generic face has too little skin for a net of control points");
    if (err == FAP_OK)
        err = bone_skin_open(&z->skin, &z->face, &z->mesh, l->alloc);
    if (err == FAP_OK)
        err = mesh_energy_open(&z->energy, &z->face, l->alloc);
    if (err == FAP_OK)
        set_pins(z);
    if (err == FAP_OK)
        err = control_fit_open(&z->fit, &z->skin, &z->energy, g->position, l->cfg->optimizer, l->alloc);
    return err;
}

static fap_err open(lorenzo *z)
{
    laying *l = z->l;
    const fap_generic *g = l->generic;

    z->use = fap_mem_calloc(l->alloc, g->vertex_count, 1);
    z->bent = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *z->bent);
    z->seed = fap_mem_calloc(l->alloc, l->pin_count, sizeof *z->seed);
    z->pin = fap_mem_calloc(l->alloc, l->pin_count, sizeof *z->pin);
    if (!z->use || !z->bent || !z->seed || !z->pin)
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < g->vertex_count; v++)
        z->use[v] = (uint8_t)laying_is_skin(l, v);
    z->axis = cylinder_around(g->position, g->vertex_count);
    return counterparts_open(&z->near, l);
}

static void close(lorenzo *z)
{
    const fap_allocator *alloc = z->l->alloc;

    control_fit_close(&z->fit);
    mesh_energy_close(&z->energy, alloc);
    bone_skin_close(&z->skin, alloc);
    control_mesh_free(&z->mesh, alloc);
    counterparts_close(&z->near);
    fap_mem_free(alloc, z->use);
    fap_mem_free(alloc, z->bent);
    fap_mem_free(alloc, z->seed);
    fap_mem_free(alloc, z->pin);
}

/* --- the descent --- */

static void see_normals(const laying *l)
{
    const fap_generic *g = l->generic;

    surface_normals((const float(*)[3])l->at, g->vertex_count, g->triangle, g->triangle_count, l->normal);
}

/* The face where the bones have it, and what of the scan draws it there. */
static void look(lorenzo *z, const struct stage *s)
{
    laying *l = z->l;

    for (uint32_t v = 0; v < z->face.vertex_count; v++)
        if (z->skin.says[v])
            memcpy(l->at[v], z->fit.at[v], sizeof l->at[v]);
    see_normals(l);
    for (uint32_t v = 0; v < z->face.vertex_count; v++)
        if (z->use[v])
            counterpart_find(&z->near, v, l->cfg->reach_mm * s->reach_share, s->facing, &z->energy.pull[v]);
}

static fap_err run_stage(lorenzo *z, int stage)
{
    const struct stage *s = &stages[stage];
    const int is_simplex = z->l->cfg->optimizer == FAP_OPTIMIZER_SIMPLEX;
    const int rounds = is_simplex ? SIMPLEX_ROUNDS : s->rounds;
    fap_err err = FAP_OK;

    z->energy.weights =
        (energy_weights){ .dist = 1, .strain = s->strain, .bend = s->bend, .pin = s->pin, .slide = slide };
    z->fit.even = s->even;
    for (int round = 0; round < rounds && err == FAP_OK; round++) {
        look(z, s);
        if (is_simplex)
            control_fit_simplex(&z->fit, simplex_edge_mm);
        else
            control_fit_lbfgs(&z->fit, s->iterations);
        err = laying_progress(z->l, (stage + (round + 1.0) / rounds) / STAGES);
    }
    return err;
}

static fap_err descend(lorenzo *z)
{
    fap_err err = FAP_OK;

    see_normals(z->l);
    err = counterparts_mark(&z->near);
    if (err == FAP_OK) {
        project_controls(z);
        control_fit_carry(&z->fit);
    }
    for (int s = 0; s < STAGES && err == FAP_OK; s++) {
        err = run_stage(z, s);
        if (err == FAP_OK)
            look(z, &stages[s]);
        if (err == FAP_OK)
            err = counterparts_mark(&z->near);
    }
    return err;
}

fap_err laying_lorenzo(laying *l)
{
    lorenzo z = { .l = l };
    const int points = l->cfg->control_points;

    if (points < FAP_CONTROL_POINTS_MIN || points > FAP_CONTROL_POINTS_MAX ||
        !fap_optimizer_name((int)l->cfg->optimizer))
        return laying_fail(l, FAP_E_ARG, "no such number of control points, or no such optimizer");
    fap_err err = open(&z);
    if (err == FAP_OK)
        err = laying_bend(l, WARP_BIHARMONIC, slack_per_mm2 * l->cfg->pin_error_mm * l->cfg->pin_error_mm);
    if (err == FAP_OK)
        err = open_net(&z);
    if (err == FAP_OK)
        err = descend(&z);
    if (err == FAP_OK)
        err = skin_project(&z.near, &z.face, &z.axis, last_share * l->cfg->limit_mm, l->at);
    if (err == FAP_OK)
        laying_bring_inside(l);
    close(&z);
    return err;
}
