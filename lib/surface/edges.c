/* SPDX-License-Identifier: BSD-2-Clause */
/* See edges.h. Half edges are dealt out by their lower vertex, where only a handful need sorting. */
#include <string.h>

#include "base/mem.h"
#include "surface/edges.h"

typedef struct half {
    uint32_t high, triangle;
    uint8_t down; /* the triangle goes from high to low */
} half;

static void count_halves(uint32_t *first, const uint32_t (*triangle)[3], uint32_t count,
                         uint32_t vertex_count)
{
    for (uint32_t t = 0; t < count; t++)
        for (int c = 0; c < 3; c++) {
            const uint32_t a = triangle[t][c], b = triangle[t][(c + 1) % 3];
            first[(a < b ? a : b) + 1]++;
        }
    for (uint32_t v = 0; v < vertex_count; v++)
        first[v + 1] += first[v];
}

static void deal_halves(half *out, uint32_t *next, const uint32_t (*triangle)[3], uint32_t count)
{
    for (uint32_t t = 0; t < count; t++)
        for (int c = 0; c < 3; c++) {
            const uint32_t a = triangle[t][c], b = triangle[t][(c + 1) % 3];
            out[next[a < b ? a : b]++] = (half){ a < b ? b : a, t, a > b };
        }
}

/* By vertex, then by triangle; insertion, as a vertex has few. */
static void sort_halves(half *h, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        const half moved = h[i];
        uint32_t k = i;
        for (; k && h[k - 1].high > moved.high; k--)
            h[k] = h[k - 1];
        h[k] = moved;
    }
}

static surface_edge make_edge(uint32_t low, const half *h, uint32_t count)
{
    return (surface_edge){
        .low = low,
        .high = h[0].high,
        .triangle = { h[0].triangle, count > 1 ? h[1].triangle : UINT32_MAX },
        .triangles = count,
        .turned = count == 2 && h[0].down == h[1].down,
    };
}

/* first[v]: where v's half edges end before, where its edges begin afterwards. */
static void join_halves(surface_edges *e, half *h, const uint32_t *end, uint32_t vertex_count)
{
    uint32_t at = 0;

    for (uint32_t v = 0; v < vertex_count; v++) {
        e->first[v] = e->count;
        sort_halves(h + at, end[v] - at);
        while (at < end[v]) {
            uint32_t same = 1;
            while (at + same < end[v] && h[at + same].high == h[at].high)
                same++;
            e->edge[e->count++] = make_edge(v, h + at, same);
            at += same;
        }
    }
    e->first[vertex_count] = e->count;
}

fap_err surface_edges_find(surface_edges *out, const uint32_t (*triangle)[3], uint32_t triangle_count,
                           uint32_t vertex_count, const fap_allocator *alloc)
{
    const size_t halves = 3 * (size_t)triangle_count;
    half *h = fap_mem_calloc(alloc, halves, sizeof *h);
    uint32_t *next = fap_mem_calloc(alloc, (size_t)vertex_count + 1, sizeof *next);

    *out = (surface_edges){ .edge = fap_mem_calloc(alloc, halves, sizeof *out->edge),
                            .first = fap_mem_calloc(alloc, (size_t)vertex_count + 1, sizeof *out->first) };
    const int ok = h && next && out->edge && out->first;
    if (ok) {
        count_halves(next, triangle, triangle_count, vertex_count);
        deal_halves(h, next, triangle, triangle_count); /* next[v] is v's end from now on */
        join_halves(out, h, next, vertex_count);
    }
    fap_mem_free(alloc, h);
    fap_mem_free(alloc, next);
    if (!ok)
        surface_edges_free(out, alloc);
    return ok ? FAP_OK : FAP_E_NOMEM;
}

void surface_edges_free(surface_edges *e, const fap_allocator *alloc)
{
    fap_mem_free(alloc, e->edge);
    fap_mem_free(alloc, e->first);
    *e = (surface_edges){ 0 };
}

uint32_t surface_edges_between(const surface_edges *e, uint32_t a, uint32_t b)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;

    for (uint32_t i = e->first[low]; i < e->first[low + 1]; i++)
        if (e->edge[i].high == high)
            return i;
    return UINT32_MAX;
}
