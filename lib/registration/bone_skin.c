/* SPDX-License-Identifier: BSD-2-Clause */
/* See bone_skin.h. */
#include <math.h>
#include <string.h>

#include "bank/mask.h"
#include "base/mem.h"
#include "registration/bone_pull.h"
#include "registration/bone_skin.h"

/* Of a bone's shortest edge; the paper says "a fraction of the closest distance to a connected vertex". */
static const float radius_share = 1;
/* A vertex that no radius reaches is carried by what is nearest: their radii grow until it is this share inside. */
static const float reach_more = 1.3f;
static const float least_weight = 1e-3f;

enum { CANDIDATES = 256 };

/* What looking for the bones of one vertex needs. */
typedef struct search {
    bone_skin *skin;
    const control_face *face;
    uint32_t *stamp; /* [bones] the vertex that last looked at it */
    float *radius;
    uint8_t *mask; /* [bones] sides of slits that its corners are on */
    uint32_t found, bone[CANDIDATES];
    float distance[CANDIDATES];
    fap_bone_place place[CANDIDATES];
} search;

/* --- lists --- */

static void list_around(bone_skin *s, uint32_t *fill)
{
    const control_mesh *m = s->mesh;

    for (uint32_t k = 0; k < 3 * m->bone_count; k++)
        s->start[m->bone[k / 3][k % 3] + 1]++;
    for (uint32_t c = 0; c < m->count; c++)
        s->start[c + 1] += s->start[c];
    memcpy(fill, s->start, m->count * sizeof *fill);
    for (uint32_t k = 0; k < 3 * m->bone_count; k++)
        s->around[fill[m->bone[k / 3][k % 3]]++] = k / 3;
}

static float shortest_edge(const fap_planar_bone *b)
{
    float least = INFINITY;

    for (int i = 0; i < 3; i++)
        least = fminf(least, b->edge[i][0] * b->edge[i][0] + b->edge[i][1] * b->edge[i][1] +
                                 b->edge[i][2] * b->edge[i][2]);
    return sqrtf(least);
}

static uint8_t across(uint8_t mask)
{
    uint8_t out = 0;

    for (uint8_t bit = 1; bit <= FAP_MASK_LID_LOWER_RIGHT; bit = (uint8_t)(bit << 1))
        out |= mask & bit ? fap_mask_across(bit) : 0;
    return out;
}

/* --- who carries a vertex --- */

/* Section 4.3: a bone on the other side of a slit has no say. */
static void look_at(search *q, uint32_t v, uint32_t bone)
{
    const uint8_t own = q->face->mask ? q->face->mask[v] : 0;

    if (q->stamp[bone] == v + 1 || q->found == CANDIDATES || !(q->radius[bone] > 0))
        return;
    q->stamp[bone] = v + 1;
    if ((q->mask[bone] & across(own)) && !(q->mask[bone] & own))
        return;
    q->bone[q->found] = bone;
    q->distance[q->found] =
        fap_planar_bone_locate(&q->skin->bone[bone], q->face->position[v], &q->place[q->found]);
    q->found++;
}

static void look_around(search *q, uint32_t v, uint32_t point)
{
    const bone_skin *s = q->skin;

    for (uint32_t k = s->start[point]; k < s->start[point + 1]; k++)
        look_at(q, v, s->around[k]);
}

/* Bones around the nearest control point and around its neighbours: farther ones are another part of the face. */
static void find_near(search *q, uint32_t v)
{
    const bone_skin *s = q->skin;
    const int32_t owner = s->mesh->owner[v];

    q->found = 0;
    if (owner < 0)
        return;
    look_around(q, v, (uint32_t)owner);
    for (uint32_t k = s->start[owner]; k < s->start[owner + 1]; k++)
        for (int c = 0; c < 3; c++)
            look_around(q, v, s->mesh->bone[s->around[k]][c]);
    for (uint32_t b = 0; !q->found && b < s->mesh->bone_count; b++) /* a loose piece */
        look_at(q, v, b);
}

/* How much all radii must grow for one to reach the vertex. */
static float grow(const search *q)
{
    float least = INFINITY;

    for (uint32_t i = 0; i < q->found; i++)
        least = fminf(least, q->distance[i] / q->radius[q->bone[i]]);
    return fmaxf(1, reach_more * least);
}

/* Heaviest first. */
static void keep(bone_skin *s, uint32_t v, const bone_say *say)
{
    int i = s->says[v];

    if (i == BONE_SAYS && s->say[v][i - 1].weight >= say->weight)
        return;
    if (i < BONE_SAYS)
        s->says[v]++;
    else
        i--;
    for (; i && s->say[v][i - 1].weight < say->weight; i--)
        s->say[v][i] = s->say[v][i - 1];
    s->say[v][i] = *say;
}

/* Eq. 11 needs weights that sum to one; eq. 12 gives some that do not. */
static void share_out(bone_skin *s, uint32_t v)
{
    float sum = 0;

    for (int i = 0; i < s->says[v]; i++)
        sum += s->say[v][i].weight;
    for (int i = 0; i < s->says[v]; i++)
        s->say[v][i].weight /= sum;
}

static void find_says(search *q, uint32_t v)
{
    find_near(q, v);
    const float more = grow(q);
    for (uint32_t i = 0; i < q->found; i++) {
        const bone_say say = { q->place[i],
                               fap_planar_bone_weight(q->distance[i], more * q->radius[q->bone[i]]),
                               q->bone[i] };
        if (say.weight > least_weight)
            keep(q->skin, v, &say);
    }
    share_out(q->skin, v);
}

static void prepare(search *q)
{
    bone_skin *s = q->skin;
    const control_mesh *m = s->mesh;

    for (uint32_t b = 0; b < m->bone_count; b++) {
        float corner[3][3];
        for (int c = 0; c < 3; c++) {
            const uint32_t v = m->vertex[m->bone[b][c]];
            memcpy(corner[c], q->face->position[v], sizeof corner[c]);
            q->mask[b] |= q->face->mask ? q->face->mask[v] : 0;
        }
        const int is_frame = fap_planar_bone_set(&s->bone[b], (const float(*)[3])corner);
        q->radius[b] = is_frame ? radius_share * shortest_edge(&s->bone[b]) : 0;
    }
}

fap_err bone_skin_open(bone_skin *s, const control_face *face, const control_mesh *mesh,
                       const fap_allocator *alloc)
{
    const uint32_t n = face->vertex_count, bones = mesh->bone_count;
    search q = { .skin = s,
                 .face = face,
                 .stamp = fap_mem_calloc(alloc, bones, sizeof *q.stamp),
                 .radius = fap_mem_calloc(alloc, bones, sizeof *q.radius),
                 .mask = fap_mem_calloc(alloc, bones, 1) };
    uint32_t *fill = fap_mem_calloc(alloc, mesh->count, sizeof *fill);

    *s = (bone_skin){ .mesh = mesh,
                      .vertex_count = n,
                      .says = fap_mem_calloc(alloc, n, 1),
                      .say = fap_mem_calloc(alloc, n, sizeof *s->say),
                      .bone = fap_mem_calloc(alloc, bones, sizeof *s->bone),
                      .start = fap_mem_calloc(alloc, (size_t)mesh->count + 1, sizeof *s->start),
                      .around = fap_mem_calloc(alloc, 3 * (size_t)bones, sizeof *s->around),
                      .pull = fap_mem_calloc(alloc, bones, sizeof *s->pull) };
    const int ok = q.stamp && q.radius && q.mask && fill && s->says && s->say && s->bone && s->start &&
                   s->around && s->pull;
    if (ok) {
        list_around(s, fill);
        prepare(&q);
    }
    for (uint32_t v = 0; ok && v < n; v++)
        if (face->use[v])
            find_says(&q, v);
    fap_mem_free(alloc, q.stamp);
    fap_mem_free(alloc, q.radius);
    fap_mem_free(alloc, q.mask);
    fap_mem_free(alloc, fill);
    return ok ? FAP_OK : FAP_E_NOMEM;
}

void bone_skin_close(bone_skin *s, const fap_allocator *alloc)
{
    fap_mem_free(alloc, s->says);
    fap_mem_free(alloc, s->say);
    fap_mem_free(alloc, s->bone);
    fap_mem_free(alloc, s->start);
    fap_mem_free(alloc, s->around);
    fap_mem_free(alloc, s->pull);
    *s = (bone_skin){ 0 };
}

/* --- posed --- */

static int set_bone(bone_skin *s, const double (*control)[3], uint32_t b)
{
    float corner[3][3];

    for (int c = 0; c < 3; c++)
        for (int a = 0; a < 3; a++)
            corner[c][a] = (float)control[s->mesh->bone[b][c]][a];
    return fap_planar_bone_set(&s->bone[b], (const float(*)[3])corner);
}

int bone_skin_set(bone_skin *s, const double (*control)[3], uint32_t point)
{
    int ok = 1;

    if (point == UINT32_MAX)
        for (uint32_t b = 0; b < s->mesh->bone_count; b++)
            ok &= set_bone(s, control, b);
    else
        for (uint32_t k = s->start[point]; k < s->start[point + 1]; k++)
            ok &= set_bone(s, control, s->around[k]);
    return ok;
}

void bone_skin_carry(const bone_skin *s, uint32_t vertex, float at[3])
{
    if (!s->says[vertex])
        return;
    at[0] = at[1] = at[2] = 0;
    for (int i = 0; i < s->says[vertex]; i++) {
        const bone_say *say = &s->say[vertex][i];
        float there[3];
        fap_planar_bone_carry(&s->bone[say->bone], &say->place, there);
        for (int a = 0; a < 3; a++)
            at[a] += say->weight * there[a];
    }
}

void bone_skin_pull(bone_skin *s, const double (*vertex)[3], double (*control)[3])
{
    memset(s->pull, 0, s->mesh->bone_count * sizeof *s->pull);
    for (uint32_t v = 0; v < s->vertex_count; v++)
        for (int i = 0; i < s->says[v]; i++) {
            const bone_say *say = &s->say[v][i];
            bone_pull_add(&s->pull[say->bone], &s->bone[say->bone], &say->place, vertex[v],
                          (double)say->weight);
        }
    memset(control, 0, s->mesh->count * sizeof *control);
    for (uint32_t b = 0; b < s->mesh->bone_count; b++) {
        double corner[3][3];
        bone_pull_corners(&s->pull[b], &s->bone[b], corner);
        for (int c = 0; c < 3; c++)
            for (int a = 0; a < 3; a++)
                control[s->mesh->bone[b][c]][a] += corner[c][a];
    }
}
