/* SPDX-License-Identifier: BSD-2-Clause */
/* Which triangles meet at which edge: borders, neighbours, pieces. */
#ifndef LIB_SURFACE_EDGES_H
#define LIB_SURFACE_EDGES_H

#include <stdint.h>

#include <fap/alloc.h>
#include <fap/error.h>

typedef struct surface_edge {
    uint32_t low, high;   /* vertices, low < high */
    uint32_t triangle[2]; /* the first two on it; UINT32_MAX: none */
    uint32_t triangles;   /* how many share it */
    uint8_t turned;       /* 1: two triangles go along it the same way */
} surface_edge;

/* Ascending by low, then high. */
typedef struct surface_edges {
    surface_edge *edge;
    uint32_t count;
    uint32_t *first; /* [vertex_count + 1]: edges whose lower vertex it is */
} surface_edges;

/* Vertices of each triangle are in range. FAP_E_NOMEM. */
fap_err surface_edges_find(surface_edges *out, const uint32_t (*triangle)[3], uint32_t triangle_count,
                           uint32_t vertex_count, const fap_allocator *alloc);
void surface_edges_free(surface_edges *e, const fap_allocator *alloc);
/* The edge of two vertices, UINT32_MAX: none. */
uint32_t surface_edges_between(const surface_edges *e, uint32_t a, uint32_t b);

#endif
