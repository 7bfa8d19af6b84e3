/* SPDX-License-Identifier: BSD-2-Clause */
/* See fit_dress.h. */
#include <stdlib.h>
#include <string.h>

#include "databank/fit/fit_dress.h"
#include "surface/nearest.h"

/* Farther than any two places of a head are. */
static const float anywhere_mm = 1000;

static void dress_vertex(fit_work *w, uint32_t i, const surface_hit *h)
{
    const fap_surface *s = w->scan;
    const uint32_t *v = s->triangle[h->triangle];

    for (int a = 0; s->uv && a < 2; a++)
        for (int c = 0; c < 3; c++)
            w->uv[i][a] += h->share[c] * s->uv[v[c]][a];
    if (!s->colour)
        return;
    for (int a = 0; a < 3; a++) {
        float mixed = 0.5F;
        for (int c = 0; c < 3; c++)
            mixed += h->share[c] * (float)s->colour[v[c]][a];
        w->colour[i][a] = (uint8_t)mixed;
    }
    w->colour[i][3] = h->distance < (float)w->opt->fit.reach_mm ? 255 : 0;
}

static fap_err find_all(fit_work *w, const float (*in_head)[3])
{
    const fap_surface *face = fap_registration_surface(w->registration);
    surface_index *index;
    const fap_err err = surface_index_open(&index, in_head, w->scan->vertex_count,
                                           (const uint32_t(*)[3])w->scan->triangle, w->scan->triangle_count);

    for (uint32_t i = 0; err == FAP_OK && i < face->vertex_count; i++) {
        surface_hit h;
        if (surface_index_nearest(index, face->position[i], anywhere_mm, NULL, NULL, &h))
            dress_vertex(w, i, &h);
    }
    surface_index_close(&index);
    return err;
}

fap_err fit_dress(fit_work *w)
{
    const fap_surface *s = w->scan;
    const uint32_t n = fap_registration_surface(w->registration)->vertex_count;

    if (!s->uv && !s->colour)
        return FAP_OK;
    float(*in_head)[3] = malloc(s->vertex_count * sizeof *in_head);
    w->uv = s->uv ? calloc(n, sizeof *w->uv) : NULL;
    w->colour = s->colour ? calloc(n, sizeof *w->colour) : NULL;
    fap_err err = in_head && (!s->uv || w->uv) && (!s->colour || w->colour) ? FAP_OK : FAP_E_NOMEM;
    for (uint32_t i = 0; err == FAP_OK && i < s->vertex_count; i++)
        fap_registration_to_head(w->registration, s->position[i], in_head[i]);
    if (err == FAP_OK)
        err = find_all(w, (const float(*)[3])in_head);
    free(in_head);
    return err;
}

static void mean_colour(const fit_work *w, const fap_mesh *mesh, uint8_t out[3])
{
    uint64_t sum[3] = { 0, 0, 0 }, count = 0;

    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (mesh->part[i] == FAP_PART_SKIN && w->colour[i][3]) {
            for (int a = 0; a < 3; a++)
                sum[a] += w->colour[i][a];
            count++;
        }
    for (int a = 0; a < 3; a++)
        out[a] = (uint8_t)(count ? sum[a] / count : 128);
}

fap_err fit_dress_bank(const fit_work *w)
{
    const fap_mesh *mesh = fap_bank_mesh(w->bank);
    uint8_t mean[3];

    if (!w->colour)
        return FAP_OK;
    uint8_t(*colour)[4] = malloc(mesh->vertex_count * sizeof *colour);
    if (!colour)
        return FAP_E_NOMEM;
    mean_colour(w, mesh, mean);
    memcpy(colour, mesh->colour, mesh->vertex_count * sizeof *colour);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (mesh->part[i] == FAP_PART_SKIN)
            memcpy(colour[i], w->colour[i][3] ? w->colour[i] : mean, 3); /* the gloss stays */
    fap_bank_builder_colours(w->face, (const uint8_t(*)[4])colour);
    free(colour);
    return FAP_OK;
}

void fit_undress(fit_work *w)
{
    free(w->uv);
    free(w->colour);
    w->uv = NULL;
    w->colour = NULL;
}
