/* SPDX-License-Identifier: BSD-2-Clause */
/* Where a surface is nearest to a place, and where a ray meets it. nearest_embree.c alone names Embree. */
#ifndef LIB_SURFACE_NEAREST_H
#define LIB_SURFACE_NEAREST_H

#include <stdint.h>

#include <fap/error.h>

typedef struct surface_index surface_index;

typedef struct surface_hit {
    uint32_t triangle;
    float share[3]; /* of each corner: at = sum of share * corner */
    float at[3];
    float distance;
} surface_hit;

/* 1: the triangle may be the answer. */
typedef int (*surface_filter)(const void *user, uint32_t triangle);

/* Both arrays are borrowed. FAP_E_UNSUPPORTED: a build without Embree; FAP_E_NOMEM. */
fap_err surface_index_open(surface_index **out, const float (*position)[3], uint32_t vertex_count,
                           const uint32_t (*triangle)[3], uint32_t triangle_count);
/* Sets @p *index to NULL; accepts NULL. */
void surface_index_close(surface_index **index);

/* The nearest triangle within @p reach that @p filter (NULL: any) lets through; 0: none. Threads may ask at once. */
int surface_index_nearest(const surface_index *index, const float at[3], float reach, surface_filter filter,
                          const void *user, surface_hit *hit);
/* The first triangle along @p direction (unit) between 0 and @p reach; 0: none. */
int surface_index_ray(const surface_index *index, const float from[3], const float direction[3], float reach,
                      surface_hit *hit);

#endif
