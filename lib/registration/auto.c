/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * --method auto: what the three works have in common, joined. Landmarks bend space (Zhu, Yano, Sanchez Lorenzo: RBF first);
 * then the skin is drawn to the scan from coarse to fine, bending as little as it must. A place of the scan draws a vertex
 * only where both face the same way and lie on the same side of the slits (the discontinuity masks of Sanchez Lorenzo,
 * section 4.3); nobody is drawn to a hole's rim. After Amberg, Romdhani, Vetter 2007 for the stages.
 */
#include <math.h>
#include <string.h>

#include "bank/mask.h"
#include "base/mem.h"
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
    uint8_t *side;      /* [scan triangles] mask bits of the face laid over it */
    double ease;        /* of a mesh with long edges, which bending is counted in */
    uint8_t *foreign;   /* [scan triangles] 1: nearest to something that is no skin */
} autofit;

/* --- which side of the slits the scan is on --- */

typedef struct turned {
    const laying *l;
    double normal[3];
} turned;

/* Lips that touch face each other: of two that are as near, the one that looks the same way is meant. */
static int looks_alike(const void *user, uint32_t t)
{
    const turned *w = user;
    double face[3];

    surface_triangle_normal((const float(*)[3])w->l->at, w->l->generic->triangle[t], face);
    return face[0] * w->normal[0] + face[1] * w->normal[1] + face[2] * w->normal[2] > 0;
}

static fap_err mark_sides(autofit *f)
{
    laying *l = f->l;
    const fap_generic *g = l->generic;
    surface_index *face;

    if (!g->mask && !g->part)
        return FAP_OK;
    const fap_err err =
        surface_index_open(&face, (const float(*)[3])l->at, g->vertex_count, g->triangle, g->triangle_count);
    for (uint32_t t = 0; err == FAP_OK && t < l->scan_triangles; t++) {
        float middle[3];
        surface_hit h;
        for (int a = 0; a < 3; a++)
            middle[a] = (l->scan[l->scan_triangle[t][0]][a] + l->scan[l->scan_triangle[t][1]][a] +
                         l->scan[l->scan_triangle[t][2]][a]) /
                        3;
        f->side[t] = f->foreign[t] = 0;
        turned way = { .l = l };
        for (int a = 0; a < 3; a++)
            for (int c = 0; c < 3; c++)
                way.normal[a] += (double)l->scan_normal[l->scan_triangle[t][c]][a];
        if (!surface_index_nearest(face, middle, (float)l->cfg->reach_mm, looks_alike, &way, &h))
            continue;
        f->foreign[t] = !laying_is_skin(l, g->triangle[h.triangle][0]);
        for (int c = 0; g->mask && c < 3; c++)
            f->side[t] |= g->mask[g->triangle[h.triangle][c]];
    }
    surface_index_close(&face);
    return err;
}

typedef struct seeker {
    const autofit *f;
    uint32_t vertex;
    double facing;
} seeker;

static int is_across(const autofit *f, uint32_t vertex, uint32_t t)
{
    const uint8_t own = f->l->generic->mask ? f->l->generic->mask[vertex] : 0;
    uint8_t across = 0;

    for (uint8_t bit = 1; bit <= FAP_MASK_LID_LOWER_RIGHT; bit = (uint8_t)(bit << 1))
        across |= own & bit ? fap_mask_across(bit) : 0;
    return (f->side[t] & across) && !(f->side[t] & own);
}

static int is_fit(const void *user, uint32_t t)
{
    const seeker *s = user;
    const autofit *f = s->f;
    const float *n = f->l->normal[s->vertex];
    double dot = 0, length = 0;

    if (f->foreign[t] || is_across(f, s->vertex, t))
        return 0;
    for (int a = 0; a < 3; a++) {
        double face = 0;
        for (int c = 0; c < 3; c++)
            face += (double)f->l->scan_normal[f->l->scan_triangle[t][c]][a];
        dot += face * (double)n[a];
        length += face * face;
    }
    return dot > s->facing * sqrt(length);
}

static int is_rim(const laying *l, const surface_hit *h)
{
    for (int c = 0; c < 3; c++)
        if (h->share[c] > 1e-3F && !l->scan_border[l->scan_triangle[h->triangle][c]])
            return 0;
    return 1;
}

/* What is seen on the scan at a hit: the mix of its corners' normals. */
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

static void find_pull(autofit *f, uint32_t i, const struct stage *s)
{
    const laying *l = f->l;
    const double reach = l->cfg->reach_mm * s->reach_share;
    const seeker who = { f, i, s->facing };
    elastic_pull *p = &f->pull[i];
    surface_hit h;

    p->weight = 0;
    if (!f->use[i] || !surface_index_nearest(l->index, l->at[i], (float)reach, is_fit, &who, &h) ||
        is_rim(l, &h))
        return;
    const double far = (double)h.distance / reach;
    p->weight = pow(1 - far * far, 2); /* Tukey's */
    for (int a = 0; a < 3; a++)
        p->to[a] = (double)h.at[a];
    normal_at(l, &h, p->normal);
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
        err = mark_sides(f);
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
    f->side = fap_mem_calloc(a, l->scan_triangles, 1);
    f->foreign = fap_mem_calloc(a, l->scan_triangles, 1);
    if (!f->use || !f->pull || !f->pin || !f->side || !f->foreign)
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
    fap_mem_free(a, f->side);
    fap_mem_free(a, f->foreign);
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
