/* SPDX-License-Identifier: BSD-2-Clause */
/* Embree answers; the foot of a perpendicular on a triangle is ours. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <embree3/rtcore.h>

#include "surface/foot.h"
#include "surface/nearest.h"

struct surface_index {
    RTCDevice device;
    RTCScene scene;
    const float (*position)[3];
    const uint32_t (*triangle)[3];
};

/* Embree reads 16 bytes at the last vertex, so positions are copied into a buffer of its own. */
static int add_mesh(surface_index *x, uint32_t vertex_count, uint32_t triangle_count)
{
    RTCGeometry mesh = rtcNewGeometry(x->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *position = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                              sizeof *x->position, vertex_count);
    uint32_t *triangle = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                 sizeof *x->triangle, triangle_count);
    const int ok = position && triangle;

    if (ok) {
        memcpy(position, x->position, vertex_count * sizeof *x->position);
        memcpy(triangle, x->triangle, triangle_count * sizeof *x->triangle);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(x->scene, mesh);
    }
    rtcReleaseGeometry(mesh);
    return ok;
}

fap_err surface_index_open(surface_index **out, const float (*position)[3], uint32_t vertex_count,
                           const uint32_t (*triangle)[3], uint32_t triangle_count)
{
    surface_index *x = calloc(1, sizeof *x);
    int ok = 0;

    *out = x;
    if (!x)
        return FAP_E_NOMEM;
    x->position = position;
    x->triangle = triangle;
    x->device = rtcNewDevice(NULL);
    x->scene = x->device ? rtcNewScene(x->device) : NULL;
    if (x->scene) {
        rtcSetSceneFlags(x->scene, RTC_SCENE_FLAG_ROBUST);
        ok = !triangle_count || add_mesh(x, vertex_count, triangle_count);
        rtcCommitScene(x->scene);
        ok = ok && rtcGetDeviceError(x->device) == RTC_ERROR_NONE;
    }
    if (!ok)
        surface_index_close(out);
    return ok ? FAP_OK : FAP_E_NOMEM;
}

void surface_index_close(surface_index **index)
{
    surface_index *x = *index;

    if (!x)
        return;
    if (x->scene)
        rtcReleaseScene(x->scene);
    if (x->device)
        rtcReleaseDevice(x->device);
    free(x);
    *index = NULL;
}

typedef struct search {
    const surface_index *index;
    surface_filter filter;
    const void *user;
    surface_hit *hit;
    int found;
} search;

/* Embree calls this for each triangle within the radius, which shrinks with every better one. */
static bool look(struct RTCPointQueryFunctionArguments *args)
{
    const search *const s = args->userPtr;
    const uint32_t t = args->primID, *v = s->index->triangle[t];
    const float at[3] = { args->query->x, args->query->y, args->query->z };
    surface_hit h = { .triangle = t };

    surface_foot(s->index->position[v[0]], s->index->position[v[1]], s->index->position[v[2]], at, h.share,
                 h.at);
    h.distance = sqrtf((h.at[0] - at[0]) * (h.at[0] - at[0]) + (h.at[1] - at[1]) * (h.at[1] - at[1]) +
                       (h.at[2] - at[2]) * (h.at[2] - at[2]));
    /* Of two that are as near, the lower number: the order Embree finds them in must not matter. */
    const int better =
        !s->found ? h.distance <= args->query->radius
                  : h.distance < s->hit->distance || (h.distance == s->hit->distance && t < s->hit->triangle);
    if (!better || (s->filter && !s->filter(s->user, t)))
        return false;
    *s->hit = h;
    ((search *)args->userPtr)->found = 1;
    args->query->radius = h.distance;
    return true;
}

int surface_index_nearest(const surface_index *index, const float at[3], float reach, surface_filter filter,
                          const void *user, surface_hit *hit)
{
    search s = { index, filter, user, hit, 0 };
    struct RTCPointQuery query = { .x = at[0], .y = at[1], .z = at[2], .radius = reach };
    struct RTCPointQueryContext context;

    rtcInitPointQueryContext(&context);
    rtcPointQuery(index->scene, &query, &context, look, &s);
    return s.found;
}

int surface_index_ray(const surface_index *index, const float from[3], const float direction[3], float reach,
                      surface_hit *hit)
{
    struct RTCRayHit ray = { .ray = { .org_x = from[0],
                                      .org_y = from[1],
                                      .org_z = from[2],
                                      .dir_x = direction[0],
                                      .dir_y = direction[1],
                                      .dir_z = direction[2],
                                      .tfar = reach,
                                      .mask = UINT32_MAX } };
    struct RTCIntersectContext context;

    ray.hit.geomID = ray.hit.primID = RTC_INVALID_GEOMETRY_ID;
    rtcInitIntersectContext(&context);
    rtcIntersect1(index->scene, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return 0;
    hit->triangle = ray.hit.primID;
    hit->share[1] = ray.hit.u;
    hit->share[2] = ray.hit.v;
    hit->share[0] = 1 - ray.hit.u - ray.hit.v;
    hit->distance = ray.ray.tfar;
    for (int a = 0; a < 3; a++)
        hit->at[a] = from[a] + direction[a] * ray.ray.tfar;
    return 1;
}
