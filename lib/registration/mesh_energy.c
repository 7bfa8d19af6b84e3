/* SPDX-License-Identifier: BSD-2-Clause */
/* See mesh_energy.h. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/mesh_energy.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void way(const float a[3], const float b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)b[i] - (double)a[i];
}

/* --- how much an edge bends --- */

/* The triangle on one side of an edge. */
typedef struct wing {
    uint32_t corner[3];
    double first[3], second[3], normal[3], twice_area;
} wing;

static void see_wing(const float (*at)[3], uint32_t a, uint32_t b, uint32_t c, wing *w)
{
    memcpy(w->corner, (uint32_t[3]){ a, b, c }, sizeof w->corner);
    way(at[a], at[b], w->first);
    way(at[a], at[c], w->second);
    cross(w->first, w->second, w->normal);
    w->twice_area = fmax(1e-9, sqrt(dot(w->normal, w->normal)));
    for (int i = 0; i < 3; i++)
        w->normal[i] /= w->twice_area;
}

/* The dot product of eq. 18, and the two triangles; each seen from its own side of the edge. */
static double bend_of(const energy_edge *e, const float (*at)[3], wing wings[2])
{
    see_wing(at, e->vertex[0], e->vertex[1], e->vertex[2], &wings[0]);
    see_wing(at, e->vertex[1], e->vertex[0], e->vertex[3], &wings[1]);
    return dot(wings[0].normal, wings[1].normal);
}

/* A triangle's normal is drawn along @p to. */
static void pull_wing(const wing *w, const double to[3], double by, double (*pull)[3])
{
    const double along = dot(w->normal, to);
    double drawn[3], at_first[3], at_second[3];

    for (int i = 0; i < 3; i++)
        drawn[i] = by * (to[i] - along * w->normal[i]) / w->twice_area;
    cross(w->second, drawn, at_first);
    cross(drawn, w->first, at_second);
    for (int i = 0; i < 3; i++) {
        pull[w->corner[1]][i] += at_first[i];
        pull[w->corner[2]][i] += at_second[i];
        pull[w->corner[0]][i] -= at_first[i] + at_second[i];
    }
}

static double edge_length(const energy_edge *e, const float (*at)[3], double along[3])
{
    way(at[e->vertex[0]], at[e->vertex[1]], along);
    return sqrt(dot(along, along));
}

/* --- the terms --- */

double mesh_energy_vertex(const mesh_energy *e, const float (*at)[3], uint32_t vertex, double (*pull)[3])
{
    const elastic_pull *p = &e->pull[vertex];
    const double by = e->weights.dist * p->weight / e->used, slide = e->weights.slide;
    double off[3];

    if (p->weight <= 0)
        return 0;
    for (int i = 0; i < 3; i++)
        off[i] = (double)at[vertex][i] - p->to[i];
    const double out = dot(off, p->normal);
    for (int i = 0; pull && i < 3; i++)
        pull[vertex][i] += 2 * by * ((1 - slide) * out * p->normal[i] + slide * off[i]);
    return by * ((1 - slide) * out * out + slide * dot(off, off));
}

static double strain(const mesh_energy *e, const float (*at)[3], const energy_edge *edge, double (*pull)[3])
{
    double along[3];
    const double length = edge_length(edge, at, along), longer = length - edge->length;
    const double by = e->weights.strain / e->edge_count;

    for (int i = 0; pull && length > 0 && i < 3; i++) {
        const double drawn = 2 * by * longer * along[i] / length;
        pull[edge->vertex[0]][i] -= drawn;
        pull[edge->vertex[1]][i] += drawn;
    }
    return by * longer * longer;
}

static double bend(const mesh_energy *e, const float (*at)[3], const energy_edge *edge, double (*pull)[3])
{
    wing wings[2];
    const double more = bend_of(edge, at, wings) - edge->bend, by = e->weights.bend / e->edge_count;

    if (pull) {
        pull_wing(&wings[0], wings[1].normal, 2 * by * more, pull);
        pull_wing(&wings[1], wings[0].normal, 2 * by * more, pull);
    }
    return by * more * more;
}

double mesh_energy_edge(const mesh_energy *e, const float (*at)[3], uint32_t i, double (*pull)[3])
{
    const energy_edge *edge = &e->edge[i];
    const double cost = strain(e, at, edge, pull);

    return edge->vertex[3] == UINT32_MAX ? cost : cost + bend(e, at, edge, pull);
}

static double pin_cost(const elastic_pin *p, double by, const float (*at)[3], double (*pull)[3])
{
    double sum = 0;

    for (int a = 0; a < 3; a++) {
        double off = -p->to[a];
        for (int k = 0; k < 3; k++)
            off += p->share[k] * (double)at[p->vertex[k]][a];
        sum += by * off * off;
        for (int k = 0; pull && k < 3; k++)
            pull[p->vertex[k]][a] += 2 * by * p->share[k] * off;
    }
    return sum;
}

double mesh_energy_pins(const mesh_energy *e, const float (*at)[3], double (*pull)[3])
{
    double sum = 0;

    for (uint32_t i = 0; i < e->pin_count; i++)
        sum += pin_cost(&e->pin[i], e->weights.pin * e->pin[i].weight / e->pin_count, at, pull);
    return sum;
}

double mesh_energy_all(const mesh_energy *e, const float (*at)[3], double (*pull)[3])
{
    if (pull)
        memset(pull, 0, e->face->vertex_count * sizeof *pull);
    double sum = mesh_energy_pins(e, at, pull);
    for (uint32_t v = 0; v < e->face->vertex_count; v++)
        sum += mesh_energy_vertex(e, at, v, pull);
    for (uint32_t i = 0; i < e->edge_count; i++)
        sum += mesh_energy_edge(e, at, i, pull);
    return sum;
}

/* --- made at open --- */

static uint32_t third(const uint32_t v[3], uint32_t a, uint32_t b)
{
    for (int i = 0; i < 3; i++)
        if (v[i] != a && v[i] != b)
            return v[i];
    return a;
}

/* 1: the triangle goes from @p a to @p b. */
static int goes(const uint32_t v[3], uint32_t a, uint32_t b)
{
    for (int i = 0; i < 3; i++)
        if (v[i] == a && v[(i + 1) % 3] == b)
            return 1;
    return 0;
}

/* Only where two triangles that face alike meet does bending mean something. */
static int bends(const control_face *f, const surface_edge *s)
{
    if (s->triangles != 2 || s->turned)
        return 0;
    for (int k = 0; k < 2; k++)
        if (!f->use[third(f->triangle[s->triangle[k]], s->low, s->high)])
            return 0;
    return 1;
}

static void see_edge(const control_face *f, const surface_edge *s, energy_edge *out)
{
    double along[3];
    wing wings[2];

    *out = (energy_edge){ .vertex = { s->low, s->high, UINT32_MAX, UINT32_MAX } };
    out->length = edge_length(out, f->position, along);
    if (!bends(f, s))
        return;
    const int first = goes(f->triangle[s->triangle[0]], s->low, s->high) ? 0 : 1;
    out->vertex[2] = third(f->triangle[s->triangle[first]], s->low, s->high);
    out->vertex[3] = third(f->triangle[s->triangle[!first]], s->low, s->high);
    out->bend = bend_of(out, f->position, wings);
}

static void list_edges(mesh_energy *e)
{
    const control_face *f = e->face;

    for (uint32_t i = 0; i < f->edges->count; i++) {
        const surface_edge *s = &f->edges->edge[i];
        if (f->use[s->low] && f->use[s->high])
            see_edge(f, s, &e->edge[e->edge_count++]);
    }
}

static void list_around(mesh_energy *e, uint32_t *fill)
{
    for (uint32_t i = 0; i < e->edge_count; i++)
        for (int k = 0; k < 4 && e->edge[i].vertex[k] != UINT32_MAX; k++)
            e->start[e->edge[i].vertex[k] + 1]++;
    for (uint32_t v = 0; v < e->face->vertex_count; v++)
        e->start[v + 1] += e->start[v];
    memcpy(fill, e->start, e->face->vertex_count * sizeof *fill);
    for (uint32_t i = 0; i < e->edge_count; i++)
        for (int k = 0; k < 4 && e->edge[i].vertex[k] != UINT32_MAX; k++)
            e->around[fill[e->edge[i].vertex[k]]++] = i;
}

fap_err mesh_energy_open(mesh_energy *e, const control_face *face, const fap_allocator *alloc)
{
    const size_t n = face->vertex_count, edges = face->edges->count;
    uint32_t *fill = fap_mem_calloc(alloc, n, sizeof *fill);

    *e = (mesh_energy){ .face = face,
                        .weights = { .dist = 1 },
                        .edge = fap_mem_calloc(alloc, edges, sizeof *e->edge),
                        .start = fap_mem_calloc(alloc, n + 1, sizeof *e->start),
                        .around = fap_mem_calloc(alloc, 4 * edges, sizeof *e->around),
                        .pull = fap_mem_calloc(alloc, n, sizeof *e->pull) };
    const int ok = fill && e->edge && e->start && e->around && e->pull;
    if (ok) {
        list_edges(e);
        list_around(e, fill);
    }
    for (size_t v = 0; v < n; v++)
        e->used += face->use[v] != 0;
    fap_mem_free(alloc, fill);
    return ok ? FAP_OK : FAP_E_NOMEM;
}

void mesh_energy_close(mesh_energy *e, const fap_allocator *alloc)
{
    fap_mem_free(alloc, e->edge);
    fap_mem_free(alloc, e->start);
    fap_mem_free(alloc, e->around);
    fap_mem_free(alloc, e->pull);
    *e = (mesh_energy){ 0 };
}
