/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * One step of Catmull-Clark subdivision of the built-in face's cage, with creases: the line where the lips
 * meet and the edges of the lids follow their own vertices alone, so two edges that coincide in the cage
 * coincide in the face. Sources: Catmull, Clark 1978; Hoppe et al. 1994 (sharp edges).
 */
#include <string.h>

#include "bank/builtin.h"

static int corner_count(const uint16_t face[4])
{
    return face[2] == face[3] ? 3 : 4;
}

static uint16_t find_edge(cage *c, uint16_t a, uint16_t b)
{
    for (uint32_t e = 0; e < c->edge_count; e++)
        if (c->edge[e].end[0] == b && c->edge[e].end[1] == a)
            return (uint16_t)e;
    c->edge[c->edge_count] = (cage_edge){ { a, b }, { 0, 0 }, 0, c->sharp[a] && c->sharp[b] };
    return (uint16_t)c->edge_count++;
}

/* An edge of one face is the border of the neck or of a lining and stays a line, too. */
static void count_edges(cage *c)
{
    for (uint32_t e = 0; e < c->edge_count; e++) {
        cage_edge *edge = &c->edge[e];
        edge->sharp |= edge->face_count < 2;
        for (int i = 0; i < 2; i++) {
            c->valence[edge->end[i]]++;
            c->sharp_edges[edge->end[i]] = (uint8_t)(c->sharp_edges[edge->end[i]] + edge->sharp);
        }
    }
}

void cage_link(cage *c)
{
    for (uint32_t f = 0; f < c->face_count; f++) {
        const int n = corner_count(c->face[f]);
        for (int i = 0; i < n; i++) {
            const uint16_t e = find_edge(c, c->face[f][i], c->face[f][(i + 1) % n]);
            c->face_edge[f][i] = e;
            c->edge[e].face[c->edge[e].face_count++] = (uint16_t)f;
        }
    }
    count_edges(c);
}

uint32_t cage_fine_count(const cage *c)
{
    return c->vertex_count + c->edge_count + c->face_count;
}

static void add(float out[3], float weight, const float in[3])
{
    for (int i = 0; i < 3; i++)
        out[i] += weight * in[i];
}

static int is_crease(const cage *c, uint32_t v)
{
    return c->sharp_edges[v] == 2;
}

/* A smooth vertex: (n - 3) / n of itself, the faces' points and the edges' middles by 1 / n and 2 / n of their means. */
static void start_vertex(const cage *c, const float (*in)[3], float (*out)[3], uint32_t v)
{
    const float n = c->valence[v];
    add(out[v], is_crease(c, v) ? 0.75f : (n - 3) / n, in[v]);
}

static void set_face(const cage *c, const float (*in)[3], float (*out)[3], uint32_t f)
{
    const int n = corner_count(c->face[f]);
    float *centre = out[c->vertex_count + c->edge_count + f];

    for (int i = 0; i < n; i++)
        add(centre, 1.0f / (float)n, in[c->face[f][i]]);
    for (int i = 0; i < n; i++) {
        const uint16_t v = c->face[f][i];
        if (!is_crease(c, v))
            add(out[v], 1.0f / (float)(c->valence[v] * c->valence[v]), centre);
    }
}

static void set_edge(const cage *c, const float (*in)[3], float (*out)[3], uint32_t e)
{
    const cage_edge *edge = &c->edge[e];
    const float(*centre)[3] = (const float(*)[3])out + c->vertex_count + c->edge_count;
    float *middle = out[c->vertex_count + e];

    for (int i = 0; i < 2; i++) {
        const uint16_t v = edge->end[i], n = c->valence[v];
        add(middle, edge->sharp ? 0.5f : 0.25f, in[v]);
        if (!edge->sharp)
            add(middle, 0.25f, centre[edge->face[i]]);
        if (is_crease(c, v) && edge->sharp)
            add(out[v], 0.125f, in[edge->end[!i]]);
        for (int j = 0; j < 2 && !is_crease(c, v); j++)
            add(out[v], 1.0f / (float)(n * n), in[edge->end[j]]);
    }
}

void cage_smooth(const cage *c, const float (*in)[3], float (*out)[3])
{
    memset(out, 0, cage_fine_count(c) * sizeof *out);
    for (uint32_t v = 0; v < c->vertex_count; v++)
        start_vertex(c, in, out, v);
    for (uint32_t f = 0; f < c->face_count; f++)
        set_face(c, in, out, f);
    for (uint32_t e = 0; e < c->edge_count; e++)
        set_edge(c, in, out, e);
}

uint32_t cage_fine_triangles(const cage *c, uint32_t (*triangle)[3])
{
    uint32_t count = 0;

    for (uint32_t f = 0; f < c->face_count; f++) {
        const uint32_t centre = c->vertex_count + c->edge_count + f;
        const int n = corner_count(c->face[f]);
        for (int i = 0; i < n; i++) {
            const uint32_t corner = c->face[f][i], after = c->vertex_count + c->face_edge[f][i],
                           before = c->vertex_count + c->face_edge[f][(i + n - 1) % n];
            memcpy(triangle[count++], (uint32_t[]){ corner, after, centre }, sizeof *triangle);
            memcpy(triangle[count++], (uint32_t[]){ corner, centre, before }, sizeof *triangle);
        }
    }
    return count;
}
