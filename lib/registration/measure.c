/* SPDX-License-Identifier: BSD-2-Clause */
/* See measure.h. */
#include <math.h>

#include "registration/measure.h"
#include "surface/normals.h"

/* Least cosine between two surfaces that are taken for one. */
static const double alike = 0.5;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int is_border(const laying *l, const surface_hit *h)
{
    for (int c = 0; c < 3; c++)
        if (h->share[c] > 1e-4F && !l->scan_border[l->scan_triangle[h->triangle][c]])
            return 0;
    return 1;
}

/* The inside of a mouth or a nostril lies near the scan, but not on it. */
static int faces_alike(const laying *l, uint32_t vertex, const surface_hit *h)
{
    double sum = 0;

    for (int c = 0; c < 3; c++)
        for (int a = 0; a < 3; a++)
            sum += (double)(h->share[c] * l->scan_normal[l->scan_triangle[h->triangle][c]][a] *
                            l->normal[vertex][a]);
    return sum > alike;
}

static void measure_surface(laying *l)
{
    fap_registration_report *r = l->report;
    const fap_generic *g = l->generic;
    double sum = 0;

    surface_normals((const float(*)[3])l->at, g->vertex_count, g->triangle, g->triangle_count, l->normal);
    for (uint32_t i = 0; i < g->vertex_count; i++) {
        surface_hit h;
        if (!laying_is_skin(l, i))
            continue;
        r->skin++;
        if (!surface_index_nearest(l->index, l->at[i], (float)l->cfg->reach_mm, NULL, NULL, &h) ||
            is_border(l, &h) || !faces_alike(l, i, &h))
            continue;
        r->seen++;
        sum += (double)h.distance * (double)h.distance;
        r->surface_max_mm = fmax(r->surface_max_mm, (double)h.distance);
    }
    r->surface_rms_mm = r->seen ? sqrt(sum / r->seen) : 0;
}

static void measure_pins(laying *l)
{
    double sum = 0;
    uint32_t used = 0;

    for (uint32_t i = 0; i < l->pin_count; i++) {
        double place[3];
        if (l->pin[i].weight <= 0)
            continue;
        laying_pin_place(&l->pin[i], (const float(*)[3])l->at, place);
        for (int a = 0; a < 3; a++)
            sum += pow(place[a] - l->pin[i].at[a], 2);
        used++;
    }
    l->report->pin_rms_mm = used ? sqrt(sum / used) : 0;
}

/* An edge across which the skin has come to point back that did not do so on the generic face. */
static void count_folds(laying *l)
{
    const uint32_t(*triangle)[3] = l->generic->triangle;

    for (uint32_t i = 0; i < l->edges.count; i++) {
        const surface_edge *e = &l->edges.edge[i];
        double before[2][3], after[2][3];
        if (e->triangles != 2 || e->turned || !laying_is_skin(l, e->low))
            continue;
        for (int k = 0; k < 2; k++) {
            surface_triangle_normal(l->generic->position, triangle[e->triangle[k]], before[k]);
            surface_triangle_normal((const float(*)[3])l->at, triangle[e->triangle[k]], after[k]);
        }
        l->report->folded += dot(before[0], before[1]) > 0 && dot(after[0], after[1]) < 0;
    }
}

void laying_measure(laying *l)
{
    measure_surface(l);
    measure_pins(l);
    count_folds(l);
}
