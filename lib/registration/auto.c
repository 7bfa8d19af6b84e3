/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * --method auto: what the three works have in common, joined. Landmarks bend space (Zhu, Yano, Sanchez Lorenzo: RBF first);
 * then the skin is drawn to the scan from coarse to fine, bending as little as it must. A place of the scan draws a vertex
 * only where both face the same way and lie on the same side of the slits (the discontinuity masks of Sanchez Lorenzo,
 * section 4.3); nobody is drawn to a hole's rim. After Amberg, Romdhani, Vetter 2007 for the stages.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/counterpart.h"
#include "registration/elastic.h"
#include "registration/laying.h"
#include "surface/normals.h"

/* From coarse to fine. */
static const struct stage {
    double stiffness, stretch; /* see elastic.h */
    double pin;                /* weight of a landmark of trust 1, against a vertex's pull */
    double reach_share;        /* of the configuration's reach */
    double facing;             /* least cosine between the normals */
    int rounds;                /* of looking for what is near */
} stages[] = {
    { 3000, 0.3, 20, 1.0, 0.5, 3 },
    { 300, 0.3, 10, 0.7, 0.5, 3 },
    { 100, 0.3, 3, 0.5, 0.6, 3 },
    { 10, 1, 0.2, 0.4, 0.3, 4 },
};
enum { STAGES = sizeof stages / sizeof *stages, CG_ROUNDS = 60 };

/* Across the normal a vertex is drawn hardly at all: where it belongs, smoothness knows better than the nearest point. */
static const double slide = 0.02;

/* How far the bent space may stay off landmarks that are a millimetre off themselves; found with tests/bench/registration.c. */
static const double slack_per_mm2 = 3;

typedef struct autofit {
    laying *l;
    elastic *skin;
    uint8_t *use;       /* [vertices] */
    elastic_pull *pull; /* [vertices] */
    elastic_pin *pin;   /* [pins] */
    counterparts near;
    double ease; /* of a mesh with long edges, which bending is counted in */
} autofit;

static void find_pull(autofit *f, uint32_t i, const struct stage *s)
{
    f->pull[i].weight = 0;
    if (f->use[i])
        counterpart_find(&f->near, i, f->l->cfg->reach_mm * s->reach_share, s->facing, &f->pull[i]);
}

static void set_pins(autofit *f, const struct stage *s)
{
    const laying *l = f->l;
    const double sure = 1 / (l->cfg->pin_error_mm * l->cfg->pin_error_mm);

    for (uint32_t i = 0; i < l->pin_count; i++) {
        elastic_pin *p = &f->pin[i];
        p->weight = s->pin * l->pin[i].weight * sure;
        for (int k = 0; k < 3; k++) {
            p->vertex[k] = l->pin[i].vertex[k];
            p->share[k] = l->pin[i].share[k];
            p->to[k] = l->pin[i].at[k];
        }
    }
}

static void run_round(autofit *f, const struct stage *s)
{
    laying *l = f->l;
    const fap_generic *g = l->generic;
    const elastic_task task = { .pull = f->pull,
                                .pin = f->pin,
                                .pin_count = l->pin_count,
                                .slide = slide,
                                .stiffness = s->stiffness * f->ease,
                                .stretch = s->stretch,
                                .rounds = CG_ROUNDS,
                                .enough = 1e-3 };

    surface_normals((const float(*)[3])l->at, g->vertex_count, g->triangle, g->triangle_count, l->normal);
    for (uint32_t i = 0; i < g->vertex_count; i++)
        find_pull(f, i, s);
    set_pins(f, s);
    elastic_solve(f->skin, &task, l->at);
}

static fap_err run_stages(autofit *f)
{
    fap_err err = FAP_OK;

    for (int s = 0; s < STAGES && err == FAP_OK; s++) {
        err = counterparts_mark(&f->near);
        for (int round = 0; round < stages[s].rounds && err == FAP_OK; round++) {
            run_round(f, &stages[s]);
            err = laying_progress(f->l, (s + (round + 1.0) / stages[s].rounds) / STAGES);
        }
    }
    return err;
}

/* The stages are for faces of ten thousand vertices; a squared Laplacian goes with the fourth power of the edges. */
static const double usual_edge_mm = 2;

static double mean_edge(const laying *l)
{
    const float(*p)[3] = l->generic->position;
    double sum = 0;
    uint32_t count = 0;

    for (uint32_t i = 0; i < l->edges.count; i++) {
        const float *a = p[l->edges.edge[i].low], *b = p[l->edges.edge[i].high];
        if (!laying_is_skin(l, l->edges.edge[i].low))
            continue;
        sum += sqrt(pow((double)a[0] - (double)b[0], 2) + pow((double)a[1] - (double)b[1], 2) +
                    pow((double)a[2] - (double)b[2], 2));
        count++;
    }
    return count ? sum / count : usual_edge_mm;
}

static fap_err open(autofit *f)
{
    const laying *l = f->l;
    const fap_generic *g = l->generic;
    const fap_allocator *a = l->alloc;

    f->ease = fmin(1, pow(usual_edge_mm / mean_edge(l), 4));
    f->use = fap_mem_calloc(a, g->vertex_count, 1);
    f->pull = fap_mem_calloc(a, g->vertex_count, sizeof *f->pull);
    f->pin = fap_mem_calloc(a, l->pin_count, sizeof *f->pin);
    if (!f->use || !f->pull || !f->pin || counterparts_open(&f->near, l) != FAP_OK)
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < g->vertex_count; i++)
        f->use[i] = (uint8_t)laying_is_skin(l, i);
    return elastic_open(&f->skin, g->position, g->vertex_count, g->triangle, g->triangle_count, &l->edges,
                        f->use, a);
}

static void close(autofit *f)
{
    const fap_allocator *a = f->l->alloc;

    elastic_close(&f->skin);
    fap_mem_free(a, f->use);
    fap_mem_free(a, f->pull);
    fap_mem_free(a, f->pin);
    counterparts_close(&f->near);
}

fap_err laying_auto(laying *l)
{
    autofit f = { .l = l };

    fap_err err = open(&f);
    if (err == FAP_OK)
        err = laying_bend(l, WARP_BIHARMONIC, slack_per_mm2 * l->cfg->pin_error_mm * l->cfg->pin_error_mm);
    if (err == FAP_OK)
        err = run_stages(&f);
    if (err == FAP_OK)
        laying_bring_inside(l);
    close(&f);
    return err;
}
