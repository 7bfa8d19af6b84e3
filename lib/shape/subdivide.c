/* SPDX-License-Identifier: BSD-2-Clause */
/* See subdivide.h. */
#include <stdlib.h>
#include <string.h>

#include "shape/subdivide.h"

enum { NO_FACE = -1 };

typedef struct edge {
    uint32_t a, b; /* a < b */
    int32_t face[2];
} edge;

/* One side of one face, to be sorted so that the sides of an edge meet. */
typedef struct side {
    uint32_t a, b, corner, face;
} side;

typedef struct work {
    const fap_polygons *mesh;
    uint32_t corner_count, edge_count;
    side *sides;
    edge *edges;
    uint32_t *edge_of; /* of each corner: the edge to the corner after it */
    float *dense;      /* one row being summed */
    uint32_t *touched, touched_count;
    uint32_t *use_start, *use_face, *edge_start, *edge_use; /* faces and edges at each vertex */
    fap_subdivision *out;
    uint32_t used, room;
} work;

static int by_edge(const void *x, const void *y)
{
    const side *a = x, *b = y;

    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    if (a->b != b->b)
        return a->b < b->b ? -1 : 1;
    return a->corner < b->corner ? -1 : a->corner > b->corner;
}

static uint32_t next_corner(const fap_polygons *m, uint32_t face, uint32_t corner)
{
    return corner + 1 < m->start[face + 1] ? corner + 1 : m->start[face];
}

static fap_err check(const fap_polygons *m)
{
    if (m->vertex_count > 1u << 22 || m->face_count > 1u << 22 || m->start[m->face_count] > 1u << 24)
        return FAP_E_LIMIT;
    for (uint32_t f = 0; f < m->face_count; f++)
        if (m->start[f + 1] < m->start[f] + 3)
            return FAP_E_DATA;
    for (uint32_t c = 0; c < m->start[m->face_count]; c++)
        if (m->vertex[c] >= m->vertex_count)
            return FAP_E_DATA;
    return FAP_OK;
}

static fap_err find_edges(work *w)
{
    const fap_polygons *m = w->mesh;

    for (uint32_t f = 0; f < m->face_count; f++)
        for (uint32_t c = m->start[f]; c < m->start[f + 1]; c++) {
            const uint32_t a = m->vertex[c], b = m->vertex[next_corner(m, f, c)];
            w->sides[c] = (side){ a < b ? a : b, a < b ? b : a, c, f };
        }
    qsort(w->sides, w->corner_count, sizeof *w->sides, by_edge);
    for (uint32_t i = 0; i < w->corner_count; i++) {
        const side *s = &w->sides[i];
        const int same = i && s->a == s[-1].a && s->b == s[-1].b;
        if (!same)
            w->edges[w->edge_count++] = (edge){ s->a, s->b, { (int32_t)s->face, NO_FACE } };
        else if (w->edges[w->edge_count - 1].face[1] != NO_FACE)
            return FAP_E_DATA;
        else
            w->edges[w->edge_count - 1].face[1] = (int32_t)s->face;
        w->edge_of[s->corner] = w->edge_count - 1;
    }
    return FAP_OK;
}

/* Lists by vertex, counting sort: which faces and which edges meet there. */
static void find_neighbours(work *w)
{
    const fap_polygons *m = w->mesh;

    for (uint32_t c = 0; c < w->corner_count; c++)
        w->use_start[m->vertex[c] + 1]++;
    for (uint32_t e = 0; e < w->edge_count; e++) {
        w->edge_start[w->edges[e].a + 1]++;
        w->edge_start[w->edges[e].b + 1]++;
    }
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        w->use_start[v + 1] += w->use_start[v];
        w->edge_start[v + 1] += w->edge_start[v];
    }
    /* Filling shifts every start to the start of the next vertex; shifted back below. */
    for (uint32_t f = 0; f < m->face_count; f++)
        for (uint32_t c = m->start[f]; c < m->start[f + 1]; c++)
            w->use_face[w->use_start[m->vertex[c]]++] = f;
    for (uint32_t e = 0; e < w->edge_count; e++) {
        w->edge_use[w->edge_start[w->edges[e].a]++] = e;
        w->edge_use[w->edge_start[w->edges[e].b]++] = e;
    }
    memmove(w->use_start + 1, w->use_start, m->vertex_count * sizeof *w->use_start);
    memmove(w->edge_start + 1, w->edge_start, m->vertex_count * sizeof *w->edge_start);
    w->use_start[0] = w->edge_start[0] = 0;
}

static void add(work *w, uint32_t vertex, float weight)
{
    if (w->dense[vertex] == 0)
        w->touched[w->touched_count++] = vertex;
    w->dense[vertex] += weight;
}

static void add_face(work *w, uint32_t face, float weight)
{
    const fap_polygons *m = w->mesh;
    const uint32_t count = m->start[face + 1] - m->start[face];

    for (uint32_t c = m->start[face]; c < m->start[face + 1]; c++)
        add(w, m->vertex[c], weight / (float)count);
}

/* Moves the summed row into the operator. */
static int end_row(work *w, uint32_t row)
{
    fap_subdivision *o = w->out;

    if (w->used + w->touched_count > w->room) {
        w->room = 2 * (w->used + w->touched_count) + 1024;
        uint32_t *column = realloc(o->column, w->room * sizeof *column);
        if (column)
            o->column = column;
        float *weight = realloc(o->weight, w->room * sizeof *weight);
        if (weight)
            o->weight = weight;
        if (!column || !weight)
            return 0;
    }
    for (uint32_t i = 0; i < w->touched_count; i++) {
        o->column[w->used] = w->touched[i];
        o->weight[w->used++] = w->dense[w->touched[i]];
        w->dense[w->touched[i]] = 0;
    }
    w->touched_count = 0;
    o->row[row + 1] = w->used;
    return 1;
}

/* A border vertex minds its two border edges only, so that the border stays a curve of its own. */
static int add_border_vertex(work *w, uint32_t v)
{
    int borders = 0;

    for (uint32_t i = w->edge_start[v]; i < w->edge_start[v + 1]; i++) {
        const edge *e = &w->edges[w->edge_use[i]];
        if (e->face[1] != NO_FACE)
            continue;
        add(w, e->a == v ? e->b : e->a, 0.125f);
        borders++;
    }
    if (borders)
        add(w, v, 1 - 0.125f * (float)borders);
    return borders;
}

/* (Q + 2 R + (n - 3) v) / n: Q mean of the face points, R mean of the edge middles. */
static void add_inner_vertex(work *w, uint32_t v)
{
    const uint32_t n = w->use_start[v + 1] - w->use_start[v];

    if (n < 3) { /* not on any face, or a fan of two: stays */
        add(w, v, 1);
        return;
    }
    const float inv = 1 / (float)n;
    for (uint32_t i = w->use_start[v]; i < w->use_start[v + 1]; i++)
        add_face(w, w->use_face[i], inv * inv);
    for (uint32_t i = w->edge_start[v]; i < w->edge_start[v + 1]; i++) {
        const edge *e = &w->edges[w->edge_use[i]];
        add(w, e->a, inv * inv);
        add(w, e->b, inv * inv);
    }
    add(w, v, ((float)n - 3) * inv);
}

static void add_edge(work *w, const edge *e)
{
    const int inner = e->face[1] != NO_FACE;

    add(w, e->a, inner ? 0.25f : 0.5f);
    add(w, e->b, inner ? 0.25f : 0.5f);
    for (int i = 0; inner && i < 2; i++)
        add_face(w, (uint32_t)e->face[i], 0.25f);
}

static fap_err build_rows(work *w)
{
    const fap_polygons *m = w->mesh;
    uint32_t row = 0;

    for (uint32_t v = 0; v < m->vertex_count; v++, row++) {
        if (!add_border_vertex(w, v))
            add_inner_vertex(w, v);
        if (!end_row(w, row))
            return FAP_E_NOMEM;
    }
    for (uint32_t e = 0; e < w->edge_count; e++, row++) {
        add_edge(w, &w->edges[e]);
        if (!end_row(w, row))
            return FAP_E_NOMEM;
    }
    for (uint32_t f = 0; f < m->face_count; f++, row++) {
        add_face(w, f, 1);
        if (!end_row(w, row))
            return FAP_E_NOMEM;
    }
    return FAP_OK;
}

static void build_quads(work *w)
{
    const fap_polygons *m = w->mesh;
    const uint32_t edge0 = m->vertex_count, face0 = edge0 + w->edge_count;

    for (uint32_t f = 0; f < m->face_count; f++) {
        uint32_t before = m->start[f + 1] - 1;
        for (uint32_t c = m->start[f]; c < m->start[f + 1]; before = c++) {
            uint32_t *q = w->out->quad[c];
            q[0] = m->vertex[c];
            q[1] = edge0 + w->edge_of[c];
            q[2] = face0 + f;
            q[3] = edge0 + w->edge_of[before];
        }
    }
}

static int allocate(work *w)
{
    const size_t corners = w->corner_count, vertices = w->mesh->vertex_count;

    w->sides = malloc((corners + 1) * sizeof *w->sides);
    w->edges = malloc((corners + 1) * sizeof *w->edges);
    w->edge_of = malloc((corners + 1) * sizeof *w->edge_of);
    w->dense = calloc(vertices + 1, sizeof *w->dense);
    w->touched = malloc((2 * vertices + 16) * sizeof *w->touched);
    w->use_start = calloc(vertices + 2, sizeof *w->use_start);
    w->use_face = malloc((corners + 1) * sizeof *w->use_face);
    w->edge_start = calloc(vertices + 2, sizeof *w->edge_start);
    w->edge_use = malloc((2 * corners + 1) * sizeof *w->edge_use);
    return w->sides && w->edges && w->edge_of && w->dense && w->touched && w->use_start && w->use_face &&
           w->edge_start && w->edge_use;
}

static void release(work *w)
{
    free(w->sides);
    free(w->edges);
    free(w->edge_of);
    free(w->dense);
    free(w->touched);
    free(w->use_start);
    free(w->use_face);
    free(w->edge_start);
    free(w->edge_use);
}

static fap_err subdivide(work *w)
{
    fap_subdivision *o = w->out;

    if (!allocate(w))
        return FAP_E_NOMEM;
    const fap_err err = find_edges(w);
    if (err)
        return err;
    find_neighbours(w);
    o->vertex_count = w->mesh->vertex_count + w->edge_count + w->mesh->face_count;
    o->quad_count = w->corner_count;
    o->row = calloc(o->vertex_count + 1u, sizeof *o->row);
    o->quad = malloc((o->quad_count + 1u) * sizeof *o->quad);
    if (!o->row || !o->quad)
        return FAP_E_NOMEM;
    build_quads(w);
    return build_rows(w);
}

fap_err fap_subdivide(fap_subdivision *out, const fap_polygons *mesh)
{
    *out = (fap_subdivision){ 0 };
    fap_err err = check(mesh);
    if (err)
        return err;
    work w = { .mesh = mesh, .corner_count = mesh->start[mesh->face_count], .out = out };
    err = subdivide(&w);
    release(&w);
    if (err)
        fap_subdivision_free(out);
    return err;
}

void fap_subdivision_free(fap_subdivision *s)
{
    free(s->row);
    free(s->column);
    free(s->weight);
    free(s->quad);
    *s = (fap_subdivision){ 0 };
}

void fap_subdivision_apply(const fap_subdivision *s, const float (*in)[3], float (*out)[3])
{
    for (uint32_t v = 0; v < s->vertex_count; v++)
        for (int axis = 0; axis < 3; axis++) {
            float sum = 0;
            for (uint32_t i = s->row[v]; i < s->row[v + 1]; i++)
                sum += s->weight[i] * in[s->column[i]][axis];
            out[v][axis] = sum;
        }
}
