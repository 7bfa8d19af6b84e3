/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Distances along the surface by Dijkstra over edges and over the second diagonal of every pair of triangles;
 * with the diagonals a distance is at most a few per cent too long, without them a grid's is 40 per cent too
 * long one way. Vertices split for texture seams are joined first; two lips that only touch are not, since
 * their motions differ.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bank/face_graph.h"
#include "base/mem.h"

typedef struct fap_graph_entry {
    float distance;
    uint32_t vertex;
} entry;

typedef struct corner {
    uint32_t a, b, opposite; /* edge a < b, and the triangle's third vertex */
} corner;

typedef struct place {
    float p[3];
    uint64_t motion; /* a hash of how every key moves the vertex */
    uint32_t vertex;
} place;

static uint64_t mix(uint64_t h, uint64_t v)
{
    h = (h ^ v) * 0x9e3779b97f4a7c15u;
    return h ^ (h >> 29);
}

static void hash_block(place *places, const fap_key *key, int number, uint32_t b, uint32_t vertex_count)
{
    const int16_t *d = key->delta + 24u * (size_t)b;

    for (uint32_t i = 0; i < FAP_BLOCK; i++) {
        const uint32_t v = (uint32_t)key->block[b] * FAP_BLOCK + i;
        const uint64_t moves =
            (uint64_t)(uint16_t)d[i] << 32 | (uint64_t)(uint16_t)d[i + 8] << 16 | (uint16_t)d[i + 16];
        if (v < vertex_count && moves)
            places[v].motion = mix(places[v].motion, moves << 8 ^ (uint64_t)number);
    }
}

static int by_place(const void *a, const void *b)
{
    const place *x = a, *y = b;

    for (int i = 0; i < 3; i++)
        if (x->p[i] != y->p[i])
            return x->p[i] < y->p[i] ? -1 : 1;
    if (x->motion != y->motion)
        return x->motion < y->motion ? -1 : 1;
    return x->vertex < y->vertex ? -1 : 1;
}

static int same_place(const place *x, const place *y)
{
    return x->p[0] == y->p[0] && x->p[1] == y->p[1] && x->p[2] == y->p[2] && x->motion == y->motion;
}

static void find_places(place *places, const fap_bank *bank, const fap_mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (int axis = 0; axis < 3; axis++)
            places[v].p[axis] = mesh->position[(size_t)axis * mesh->stride + v];
        places[v].motion = mesh->part[v];
        places[v].vertex = v;
    }
    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        for (uint32_t b = 0; b < key->block_count; b++)
            hash_block(places, key, k, b, mesh->vertex_count);
    }
}

static int weld(fap_graph *g, const fap_bank *bank, const fap_mesh *mesh, const fap_allocator *alloc)
{
    place *places = fap_mem_calloc(alloc, mesh->vertex_count, sizeof *places);
    if (!places)
        return 1;
    find_places(places, bank, mesh);
    qsort(places, mesh->vertex_count, sizeof *places, by_place);
    for (uint32_t i = 0, first = 0; i < mesh->vertex_count; i++) {
        if (!same_place(&places[first], &places[i]))
            first = i;
        g->weld[places[i].vertex] = places[first].vertex;
    }
    fap_mem_free(alloc, places);
    return 0;
}

static int by_edge(const void *a, const void *b)
{
    const corner *x = a, *y = b;

    if (x->a != y->a)
        return x->a < y->a ? -1 : 1;
    if (x->b != y->b)
        return x->b < y->b ? -1 : 1;
    return x->opposite < y->opposite ? -1 : x->opposite > y->opposite;
}

static void find_corners(const fap_graph *g, const fap_mesh *mesh, corner *out)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int i = 0; i < 3; i++, out++) {
            const uint32_t *v = mesh->triangle + 3 * (size_t)t;
            const uint32_t a = g->weld[v[i]], b = g->weld[v[(i + 1) % 3]];
            *out = (corner){ a < b ? a : b, a < b ? b : a, g->weld[v[(i + 2) % 3]] };
        }
    qsort(out - 3 * (size_t)mesh->triangle_count, 3 * (size_t)mesh->triangle_count, sizeof *out, by_edge);
}

static float span(const fap_graph *g, uint32_t a, uint32_t b)
{
    float sum = 0;

    for (size_t axis = 0; axis < 3; axis++) {
        const float d = g->position[axis * g->stride + a] - g->position[axis * g->stride + b];
        sum += d * d;
    }
    return sqrtf(sum);
}

/* Counts on the first call (next NULL), stores on the second; start[v] runs from the end of v's part to its
 * beginning. */
static void link_two(fap_graph *g, uint32_t a, uint32_t b)
{
    const uint32_t pair[2] = { a, b };

    if (a == b)
        return;
    for (int i = 0; i < 2; i++) {
        if (!g->next) {
            g->start[pair[i]]++;
            continue;
        }
        const uint32_t at = --g->start[pair[i]];
        g->next[at] = pair[!i];
        g->length[at] = span(g, a, b);
    }
}

static void link_all(fap_graph *g, const corner *corners, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const corner *c = &corners[i];
        const int again = i && c[-1].a == c->a && c[-1].b == c->b;
        if (again)
            link_two(g, c[-1].opposite, c->opposite);
        else
            link_two(g, c->a, c->b);
    }
}

static int link(fap_graph *g, const fap_mesh *mesh, const fap_allocator *alloc)
{
    const size_t corner_count = 3 * (size_t)mesh->triangle_count;
    corner *corners = fap_mem_calloc(alloc, corner_count, sizeof *corners);
    if (!corners)
        return 1;
    find_corners(g, mesh, corners);
    link_all(g, corners, corner_count);
    uint32_t total = 0;
    for (uint32_t v = 0; v < g->vertex_count; v++)
        g->start[v] = total += g->start[v];
    g->start[g->vertex_count] = total;
    g->length = fap_mem_calloc(alloc, total, sizeof *g->length);
    g->next = fap_mem_calloc(alloc, total, sizeof *g->next);
    g->heap = fap_mem_calloc(alloc, (size_t)total + g->vertex_count, sizeof *g->heap);
    const int failed = !g->length || !g->next || !g->heap;
    if (!failed)
        link_all(g, corners, corner_count);
    fap_mem_free(alloc, corners);
    return failed;
}

int fap_graph_open(fap_graph *g, const fap_bank *bank, const fap_allocator *alloc)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    const uint32_t n = mesh->vertex_count;

    *g = (fap_graph){ .vertex_count = n, .position = mesh->position, .stride = mesh->stride };
    g->weld = fap_mem_calloc(alloc, n, sizeof *g->weld);
    g->start = fap_mem_calloc(alloc, (size_t)n + 1, sizeof *g->start);
    g->distance = fap_mem_calloc(alloc, n, sizeof *g->distance);
    g->reached = fap_mem_calloc(alloc, n, sizeof *g->reached);
    if (!g->weld || !g->start || !g->distance || !g->reached || weld(g, bank, mesh, alloc) ||
        link(g, mesh, alloc))
        return 1;
    for (uint32_t v = 0; v < n; v++)
        g->distance[v] = INFINITY;
    return 0;
}

void fap_graph_close(fap_graph *g, const fap_allocator *alloc)
{
    void *const blocks[] = { g->weld, g->start, g->next, g->length, g->distance, g->reached, g->heap };

    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        fap_mem_free(alloc, blocks[i]);
    memset(g, 0, sizeof *g);
}

static void push(entry *heap, uint32_t *count, entry e)
{
    uint32_t i = (*count)++;

    for (; i && heap[(i - 1) / 2].distance > e.distance; i = (i - 1) / 2)
        heap[i] = heap[(i - 1) / 2];
    heap[i] = e;
}

static entry pop(entry *heap, uint32_t *count)
{
    const entry top = heap[0], last = heap[--*count];
    uint32_t i = 0;

    for (uint32_t child; (child = 2 * i + 1) < *count; i = child) {
        child += child + 1 < *count && heap[child + 1].distance < heap[child].distance;
        if (heap[child].distance >= last.distance)
            break;
        heap[i] = heap[child];
    }
    heap[i] = last;
    return top;
}

static void reach(fap_graph *g, uint32_t *heap_count, uint32_t vertex, float distance)
{
    if (distance >= g->distance[vertex])
        return;
    if (isinf(g->distance[vertex]))
        g->reached[g->reached_count++] = vertex;
    g->distance[vertex] = distance;
    push(g->heap, heap_count, (entry){ distance, vertex });
}

static void forget(fap_graph *g)
{
    while (g->reached_count)
        g->distance[g->reached[--g->reached_count]] = INFINITY;
}

void fap_graph_flood(fap_graph *g, const uint32_t *source, uint32_t source_count, float reach_mm)
{
    uint32_t heap_count = 0;

    forget(g);
    for (uint32_t i = 0; i < source_count; i++)
        reach(g, &heap_count, g->weld[source[i]], 0);
    while (heap_count) {
        const entry e = pop(g->heap, &heap_count);
        if (e.distance > g->distance[e.vertex])
            continue;
        for (uint32_t i = g->start[e.vertex]; i < g->start[e.vertex + 1]; i++)
            if (e.distance + g->length[i] <= reach_mm)
                reach(g, &heap_count, g->next[i], e.distance + g->length[i]);
    }
}
