/* SPDX-License-Identifier: BSD-2-Clause */
/* See control_mesh.h. The net is the dual of the geodesic Voronoi cells, whose sites are put where the farthest vertex is. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/control_mesh.h"

/* Where lips and lids are, half the way counts as the whole. */
static const float fine_share = 2;

typedef struct entry {
    float distance;
    uint32_t vertex;
} entry;

/* Distances along edges from the nearest control point, kept while points are added. */
typedef struct spread {
    const control_face *face;
    control_mesh *mesh;
    uint32_t *start, *next; /* neighbours of a vertex */
    float *length, *distance;
    entry *heap;
    size_t heap_count;
} spread;

/* --- the graph --- */

static int takes_part(const control_face *f, const surface_edge *e)
{
    return f->use[e->low] && f->use[e->high];
}

static float length_of(const control_face *f, const surface_edge *e)
{
    const float *a = f->position[e->low], *b = f->position[e->high];
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrtf(x * x + y * y + z * z);
}

static void put(spread *s, uint32_t *fill, uint32_t from, uint32_t to, float length)
{
    s->next[fill[from]] = to;
    s->length[fill[from]++] = length;
}

static void join(spread *s, uint32_t *fill)
{
    const control_face *f = s->face;

    for (uint32_t i = 0; i < f->edges->count; i++)
        if (takes_part(f, &f->edges->edge[i])) {
            s->start[f->edges->edge[i].low + 1]++;
            s->start[f->edges->edge[i].high + 1]++;
        }
    for (uint32_t v = 0; v < f->vertex_count; v++)
        s->start[v + 1] += s->start[v];
    memcpy(fill, s->start, f->vertex_count * sizeof *fill);
    for (uint32_t i = 0; i < f->edges->count; i++) {
        const surface_edge *e = &f->edges->edge[i];
        if (!takes_part(f, e))
            continue;
        put(s, fill, e->low, e->high, length_of(f, e));
        put(s, fill, e->high, e->low, length_of(f, e));
    }
}

static fap_err open(spread *s, const fap_allocator *alloc)
{
    const size_t n = s->face->vertex_count, ways = 2 * (size_t)s->face->edges->count + 1;
    uint32_t *fill = fap_mem_calloc(alloc, n, sizeof *fill);

    s->start = fap_mem_calloc(alloc, n + 1, sizeof *s->start);
    s->next = fap_mem_calloc(alloc, ways, sizeof *s->next);
    s->length = fap_mem_calloc(alloc, ways, sizeof *s->length);
    s->distance = fap_mem_calloc(alloc, n, sizeof *s->distance);
    s->heap =
        fap_mem_calloc(alloc, ways, sizeof *s->heap); /* each way is taken once a flood, and pushes once */
    const int ok = fill && s->start && s->next && s->length && s->distance && s->heap;
    if (ok)
        join(s, fill);
    for (size_t v = 0; ok && v < n; v++) {
        s->distance[v] = INFINITY;
        s->mesh->owner[v] = CONTROL_NONE;
    }
    fap_mem_free(alloc, fill);
    return ok ? FAP_OK : FAP_E_NOMEM;
}

static void close(spread *s, const fap_allocator *alloc)
{
    fap_mem_free(alloc, s->start);
    fap_mem_free(alloc, s->next);
    fap_mem_free(alloc, s->length);
    fap_mem_free(alloc, s->distance);
    fap_mem_free(alloc, s->heap);
}

/* --- floods --- */

static void push(spread *s, float distance, uint32_t vertex)
{
    size_t i = s->heap_count++;

    for (; i && s->heap[(i - 1) / 2].distance > distance; i = (i - 1) / 2)
        s->heap[i] = s->heap[(i - 1) / 2];
    s->heap[i] = (entry){ distance, vertex };
}

static entry pop(spread *s)
{
    const entry top = s->heap[0], last = s->heap[--s->heap_count];
    size_t i = 0;

    for (size_t child = 1; child < s->heap_count; child = 2 * i + 1) {
        child += child + 1 < s->heap_count && s->heap[child + 1].distance < s->heap[child].distance;
        if (s->heap[child].distance >= last.distance)
            break;
        s->heap[i] = s->heap[child];
        i = child;
    }
    s->heap[i] = last;
    return top;
}

/* A new control point takes what is nearer to it than to any before. */
static void add_point(spread *s, uint32_t vertex)
{
    control_mesh *m = s->mesh;
    const int32_t point = (int32_t)m->count;

    m->vertex[m->count++] = vertex;
    s->distance[vertex] = 0;
    m->owner[vertex] = point;
    push(s, 0, vertex);
    while (s->heap_count) {
        const entry e = pop(s);
        if (e.distance > s->distance[e.vertex])
            continue;
        for (uint32_t k = s->start[e.vertex]; k < s->start[e.vertex + 1]; k++) {
            const float d = e.distance + s->length[k];
            if (d >= s->distance[s->next[k]])
                continue;
            s->distance[s->next[k]] = d;
            m->owner[s->next[k]] = point;
            push(s, d, s->next[k]);
        }
    }
}

/* Vertices of no edge are nobody's. UINT32_MAX: all are taken. */
static uint32_t farthest(const spread *s)
{
    float most = 0;
    uint32_t best = UINT32_MAX;

    for (uint32_t v = 0; v < s->face->vertex_count; v++) {
        const int is_fine = s->face->mask && s->face->mask[v];
        const float far = s->distance[v] * (is_fine ? fine_share : 1);
        if (s->start[v] < s->start[v + 1] && far > most) {
            most = far;
            best = v;
        }
    }
    return best;
}

static void spread_points(spread *s, const uint32_t *seed, uint32_t seed_count, uint32_t count)
{
    for (uint32_t i = 0; i < seed_count && s->mesh->count < count; i++)
        if (s->face->use[seed[i]] && s->distance[seed[i]] > 0)
            add_point(s, seed[i]);
    while (s->mesh->count < count) {
        const uint32_t v = farthest(s);
        if (v == UINT32_MAX)
            return;
        add_point(s, v);
    }
}

/* --- triangles --- */

static int is_known(const control_mesh *m, const uint32_t corner[3])
{
    for (uint32_t b = 0; b < m->bone_count; b++) {
        const uint32_t *k = m->bone[b];
        int same = 0;
        for (int c = 0; c < 3; c++)
            same += corner[c] == k[0] || corner[c] == k[1] || corner[c] == k[2];
        if (same == 3)
            return 1;
    }
    return 0;
}

/* Where three cells meet there is a triangle between their points. Once to count, at most, once to write. */
static uint32_t join_points(const control_face *f, control_mesh *m, int write)
{
    uint32_t count = 0;

    for (uint32_t t = 0; t < f->triangle_count; t++) {
        const int32_t a = m->owner[f->triangle[t][0]], b = m->owner[f->triangle[t][1]],
                      c = m->owner[f->triangle[t][2]];
        if (a < 0 || b < 0 || c < 0 || a == b || b == c || c == a)
            continue;
        const uint32_t corner[3] = { (uint32_t)a, (uint32_t)b, (uint32_t)c };
        count++;
        if (write && !is_known(m, corner))
            memcpy(m->bone[m->bone_count++], corner, sizeof corner);
    }
    return count;
}

fap_err control_mesh_make(control_mesh *out, const control_face *face, const uint32_t *seed,
                          uint32_t seed_count, uint32_t count, const fap_allocator *alloc)
{
    spread s = { .face = face, .mesh = out };

    *out = (control_mesh){ .vertex = fap_mem_calloc(alloc, count, sizeof *out->vertex),
                           .owner = fap_mem_calloc(alloc, face->vertex_count, sizeof *out->owner) };
    fap_err err = out->vertex && out->owner ? open(&s, alloc) : FAP_E_NOMEM;
    if (err == FAP_OK) {
        spread_points(&s, seed, seed_count, count);
        out->bone = fap_mem_calloc(alloc, join_points(face, out, 0), sizeof *out->bone);
        err = out->bone ? FAP_OK : FAP_E_NOMEM;
    }
    if (err == FAP_OK)
        join_points(face, out, 1);
    close(&s, alloc);
    return err == FAP_OK && !out->bone_count ? FAP_E_DATA : err;
}

void control_mesh_free(control_mesh *m, const fap_allocator *alloc)
{
    fap_mem_free(alloc, m->vertex);
    fap_mem_free(alloc, m->owner);
    fap_mem_free(alloc, m->bone);
    *m = (control_mesh){ 0 };
}
