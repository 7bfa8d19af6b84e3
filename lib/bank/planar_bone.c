/* SPDX-License-Identifier: BSD-2-Clause */
/* See planar_bone.h. */
#include <math.h>
#include <string.h>

#include "bank/planar_bone.h"

static const float flattest =
    1e-4f; /* a triangle's height against its longest edge; flatter ones have no normal */
static const float pi = 3.14159265f;

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void subtract(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

/* out += by * a */
static void add(float out[3], const float a[3], float by)
{
    for (int i = 0; i < 3; i++)
        out[i] += by * a[i];
}

static void scale_to_one(float v[3])
{
    const float length = sqrtf(dot(v, v));

    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

int fap_planar_bone_set(fap_planar_bone *bone, const float corner[3][3])
{
    float longest = 0;

    memcpy(bone->corner, corner, sizeof bone->corner);
    for (int i = 0; i < 3; i++) {
        subtract(corner[(i + 1) % 3], corner[i], bone->edge[i]);
        longest = fmaxf(longest, dot(bone->edge[i], bone->edge[i]));
    }
    cross(bone->edge[0], bone->edge[1], bone->normal);
    if (!(sqrtf(dot(bone->normal, bone->normal)) > flattest * longest))
        return 0;
    scale_to_one(bone->normal);
    for (int i = 0; i < 3; i++) {
        cross(bone->edge[i], bone->normal, bone->side[i]);
        scale_to_one(bone->side[i]);
    }
    return 1;
}

/* --- regions --- */

/*
 * Eq. 3 to 5 give each place to what is nearest in the plane: the triangle, an edge, a corner. Said here by that distance.
 * Returns it, squared.
 */
static float nearest_edge(const fap_planar_bone *b, const float at[3], int *region)
{
    float least = INFINITY;

    for (int i = 0; i < 3; i++) {
        float way[3];
        subtract(at, b->corner[i], way);
        const float out = dot(way, b->side[i]), length = sqrtf(dot(b->edge[i], b->edge[i]));
        const float along = dot(way, b->edge[i]) / length;
        const float past = along < 0 ? along : along > length ? along - length : 0;
        if (out <= 0 || out * out + past * past >= least)
            continue;
        least = out * out + past * past;
        *region = past < 0 ? 4 + i : past > 0 ? 4 + (i + 1) % 3 : 1 + i;
    }
    return least;
}

/* In the triangle's own frame: way = a (P - O) + b (Q - O) + height n. */
static void see_from_face(const fap_planar_bone *b, const float way[3], float local[3])
{
    const float *p = b->edge[0];
    const float q[3] = { -b->edge[2][0], -b->edge[2][1], -b->edge[2][2] };
    const float pp = dot(p, p), pq = dot(p, q), qq = dot(q, q), det = pp * qq - pq * pq;

    local[0] = (qq * dot(way, p) - pq * dot(way, q)) / det;
    local[1] = (pp * dot(way, q) - pq * dot(way, p)) / det;
}

static void see_from_edge(const fap_planar_bone *b, int i, const float way[3], float local[3])
{
    local[0] = dot(way, b->edge[i]) / dot(b->edge[i], b->edge[i]);
    local[1] = dot(way, b->side[i]);
}

static void see_from_corner(const fap_planar_bone *b, int i, const float way[3], float local[3])
{
    const float *s = b->side[i], *t = b->side[(i + 2) % 3];
    const float g = dot(s, t), det = 1 - g * g, along_s = dot(way, s), along_t = dot(way, t);

    local[0] = (along_s - g * along_t) / det;
    local[1] = (along_t - g * along_s) / det;
}

static int corner_of(int region)
{
    return region == 0 ? 0 : (region - 1) % 3;
}

float fap_planar_bone_locate(const fap_planar_bone *b, const float at[3], fap_bone_place *place)
{
    float way[3];

    *place = (fap_bone_place){ 0 };
    float aside = nearest_edge(b, at, &place->region);
    if (isinf(aside))
        aside = 0;
    const int i = corner_of(place->region);
    subtract(at, b->corner[i], way);
    const float height = dot(way, b->normal);
    place->local[2] = height;
    if (place->region == 0)
        see_from_face(b, way, place->local);
    else if (place->region < 4)
        see_from_edge(b, i, way, place->local);
    else
        see_from_corner(b, i, way, place->local);
    place->beyond = sqrtf(fmaxf(0, dot(way, way) - height * height));
    return sqrtf(aside + height * height);
}

/* --- carrying --- */

/*
 * Eq. 10 with the scale on the two vectors of the plane alone: with it on the third, too, as printed, places off the plane
 * would part from those beside the edge next to them.
 */
static void carry_beyond_corner(const fap_planar_bone *b, int i, const fap_bone_place *place, float at[3])
{
    float way[3] = { 0 };

    add(way, b->side[i], place->local[0]);
    add(way, b->side[(i + 2) % 3], place->local[1]);
    const float length = sqrtf(dot(way, way));
    add(at, way, length > 0 ? place->beyond / length : 0);
}

void fap_planar_bone_carry(const fap_planar_bone *b, const fap_bone_place *place, float at[3])
{
    const int i = corner_of(place->region);

    memcpy(at, b->corner[i], 3 * sizeof *at);
    if (place->region == 0) {
        add(at, b->edge[0], place->local[0]);
        add(at, b->edge[2], -place->local[1]);
    } else if (place->region < 4) {
        add(at, b->edge[i], place->local[0]);
        add(at, b->side[i], place->local[1]);
    } else {
        carry_beyond_corner(b, i, place, at);
    }
    add(at, b->normal, place->local[2]);
}

float fap_planar_bone_weight(float distance, float radius)
{
    return distance < radius ? 0.5f * (1 + cosf(pi * distance / radius)) : 0;
}
