/* SPDX-License-Identifier: BSD-2-Clause */
/* A build without Embree: nothing is found. */
#include <stddef.h>

#include "surface/nearest.h"

fap_err surface_index_open(surface_index **out, const float (*position)[3], uint32_t vertex_count,
                           const uint32_t (*triangle)[3], uint32_t triangle_count)
{
    (void)position, (void)vertex_count, (void)triangle, (void)triangle_count;
    *out = NULL;
    return FAP_E_UNSUPPORTED;
}

void surface_index_close(surface_index **index)
{
    *index = NULL;
}

int surface_index_nearest(const surface_index *index, const float at[3], float reach, surface_filter filter,
                          const void *user, surface_hit *hit)
{
    (void)index, (void)at, (void)reach, (void)filter, (void)user, (void)hit;
    return 0;
}

int surface_index_ray(const surface_index *index, const float from[3], const float direction[3], float reach,
                      surface_hit *hit)
{
    (void)index, (void)from, (void)direction, (void)reach, (void)hit;
    return 0;
}
